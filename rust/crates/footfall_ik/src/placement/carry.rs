//! Height of the pelvis: above the ground under it, within the reach of the legs.

use crate::leg::{FootTarget, reach_height};
use crate::placement::foot::{Animated, Ankle, Foot, Mode, Scene};
use crate::placement::frame::Frame;
use crate::placement::pelvis::plane_height;
use crate::placement::terrain::Terrain;
use crate::placement::{FootPlacer, PlacementInput};
use crate::rocker::foot_pitch;
use footfall_core::ease::smooth_step;
use footfall_core::{Joint, Pose, Side};
use glam::{Quat, Vec3};

/// Greatest extension of legs by the pelvis, as a share of their length, unless the animation extends them further.
pub(super) const EASY_EXTENSION: f32 = 0.98;
/// Extension of its leg beyond which a standing foot raises its heel, unless the animation extends the leg further.
const FIRM_EXTENSION: f32 = 0.995;
/// Greatest extension of a leg, as a share of its length.
const MAX_EXTENSION: f32 = 0.999;
/// Pitch from which a foot has landed on its toes, as in a step backwards, radians: its heel does not rise again.
const TOES_FIRST_PITCH: f32 = 0.1;
/// Height below which a foot without a known landing is about to land, metres.
const SOON_M: f32 = 0.15;
/// Distance of the soles beyond which they give the grade, metres, and the time within which the grade follows, seconds.
const GRADE_RUN_M: f32 = 0.2;
const GRADE_SECS: f32 = 0.3;

/// One frame of the animation, and how long it lasts.
pub(super) struct Moment<'a> {
    pub(super) dt_secs: f32,
    pub(super) input: &'a PlacementInput,
    pub(super) animated: &'a [Animated; 2],
}

impl FootPlacer {
    /// Moves the pelvis up or down so that both legs reach the ground, now and at the next landing, and raises the heels of standing
    /// feet whose legs fall short.
    pub(super) fn carry_pelvis(
        &mut self,
        moment: &Moment<'_>,
        soles: &[Frame; 2],
        terrain: &mut impl Terrain,
        pose: &mut Pose,
        targets: &mut [FootTarget; 2],
    ) {
        let (dt_secs, animated) = (moment.dt_secs, moment.animated);
        let floor = moment.input.world_from_floor;
        let floor_height = floor.position.dot(floor.up());
        let hips = pose.root_position;
        let hips_rotation = pose.rotations[Joint::Hips.index()];
        self.ground_m = self.ground_under(hips);
        let bound = self.config.max_pelvis_m;
        let arrival = self.arrival(moment, terrain, hips_rotation);
        // Without known landings, nothing says that the heel is about to rise anyway.
        let firm = if arrival.is_some() {
            FIRM_EXTENSION
        } else {
            MAX_EXTENSION
        };
        let rise = self.carried(soles).dot(floor.up());
        self.pelvis.carry(rise);
        let known = self.memory.is_some();
        let before = self.pelvis.value;
        if let Some(arrival) = arrival.filter(|_| known) {
            let target = floor_height + arrival.offset_m.clamp(-bound, bound);
            let arrives = [target, arrival.rise_mps];
            self.pelvis
                .arrive(arrives, arrival.bow_m, arrival.secs, dt_secs);
        } else {
            let offset = self.easy_offset(hips, hips_rotation, pose, targets);
            let target = floor_height + offset.clamp(-bound, bound);
            if known {
                let half_life = self.config.pelvis_half_life_secs;
                self.pelvis.settle(target, half_life, dt_secs);
            } else {
                self.pelvis.jump(target);
            }
        }
        let limit = self.hard_limit(animated, hips, hips_rotation, firm);
        let limit = floor_height + limit.max(-bound);
        self.pelvis.hold_below(limit, before, dt_secs);
        let carried = hips + Vec3::Y * (self.pelvis.value - floor_height);
        self.fit_legs([hips, carried], hips_rotation, firm, animated, targets);
        pose.root_position = carried;
    }

    /// Raises the heels of standing feet that legs cannot reach or whose ankles would bend too far, and shortens the way of swinging ones that are out of
    /// reach. `hips` are those of the animation and the carried ones.
    fn fit_legs(
        &mut self,
        hips: [Vec3; 2],
        hips_rotation: Quat,
        firm: f32,
        animated: &[Animated; 2],
        targets: &mut [FootTarget; 2],
    ) {
        // While one foot reaches down, and once it has, the heel of the other rises, which stood before.
        let reaches_down = [0, 1].map(|index| {
            let (foot, other) = (&self.feet[index], &self.feet[1 - index]);
            let stood = foot.mode == Mode::Locked && foot.swing_secs > other.swing_secs;
            let foothold = foot.plan.map(|plan| plan.foothold).or(foot.hold);
            foothold.is_some_and(|foothold| foothold.on_ball && foothold.pitch > 0.0) && !stood
        });
        for (index, target) in targets.iter_mut().enumerate() {
            let stretch = self.stretch(index, animated, hips[0], hips_rotation);
            let [animated_hip, hip] =
                hips.map(|hips| hips + hips_rotation * self.hips_from_hip[index]);
            let (length, rocker) = (self.leg_lengths[index], &self.rockers[index]);
            let reach = stretch.clamp(firm, MAX_EXTENSION) * length;
            let (foot, animated) = (&mut self.feet[index], &animated[index]);
            let pitch = foot_pitch(target.foot);
            let short = |foot: &FootTarget| foot.ankle.distance(hip) - reach;
            foot.rise(rocker, animated, short, target);
            let ankle = Ankle::below(&self.legs[index], hip, &animated.foot, animated_hip);
            if reaches_down[1 - index] {
                foot.rise(rocker, animated, |foot| ankle.excess(foot), target);
            }
            foot.raised = foot_pitch(target.foot) - pitch;
            if foot.mode != Mode::Locked {
                let (easy, most) = (stretch.max(EASY_EXTENSION) * length, MAX_EXTENSION * length);
                target.ankle = hip + yielded(target.ankle - hip, easy, most);
            }
            foot.note_lean(&ankle, target);
        }
    }

    /// Ends the contact of a foot behind the body that cannot stay where it stands, heel up, unless it pulls the pelvis down: once the
    /// other foot stands, or in a run.
    pub(super) fn let_go<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        animated: &mut [Animated; 2],
        pose: &Pose,
    ) {
        let hips_rotation = pose.rotations[Joint::Hips.index()];
        let hips = pose.root_position + Vec3::Y * (self.pelvis.value - scene.floor_m());
        let stand =
            [0, 1].map(|index| self.feet[index].mode == Mode::Locked && animated[index].contact);
        let takes_off = [0, 1].map(|index| {
            let landing = animated[1 - index].landing;
            landing.is_some_and(|landing| self.is_off(index, &landing))
        });
        for (index, animated) in animated.iter_mut().enumerate() {
            let foot = &self.feet[index];
            let reach = FIRM_EXTENSION * self.leg_lengths[index];
            let hip = hips + hips_rotation * self.hips_from_hip[index];
            let short = (stand == [true; 2] || stand[index] && takes_off[index])
                && foot
                    .highest_ankle(scene, &self.rockers[index], animated.pitch)
                    .map(|ankle| ankle - hip)
                    .is_some_and(|leg| leg.length() > reach && leg.dot(foot.sole.forward()) < 0.0);
            let foot = &mut self.feet[index];
            foot.let_go_early = animated.contact && (foot.let_go_early || short);
            animated.contact &= !foot.let_go_early;
        }
    }

    /// Height of the ground under a place between the soles, above the animation's floor; 0 where there is none.
    fn ground_under(&self, place: Vec3) -> f32 {
        if !self.feet.iter().all(grounded) {
            return 0.0;
        }
        let plane = |foot: &Foot| plane_height(foot.sole.position, foot.sole.up(), place);
        0.5 * (plane(&self.feet[0]) + plane(&self.feet[1]))
    }

    /// Share of its length to which a leg of the animation is stretched.
    fn stretch(&self, index: usize, animated: &[Animated; 2], hips: Vec3, rotation: Quat) -> f32 {
        let hip = hips + rotation * self.hips_from_hip[index];
        animated[index].foot.ankle.distance(hip) / self.leg_lengths[index]
    }

    /// Greatest height of the pelvis above the animation's floor with legs that are not stretched, where the place of the next landing is
    /// unknown.
    fn easy_offset(
        &self,
        hips: Vec3,
        hips_rotation: Quat,
        pose: &Pose,
        targets: &[FootTarget; 2],
    ) -> f32 {
        let mut offset = self.ground_m;
        for (index, foot) in self.feet.iter().enumerate() {
            if !grounded(foot) {
                continue;
            }
            let length = self.leg_lengths[index];
            let hip = hips_rotation * self.hips_from_hip[index];
            let limit = |ankle: Vec3, extension: f32| {
                reach_height(hips, hip, ankle, length, extension)
                    .map_or(0.0, |height| height - hips.y)
            };
            let ankle = targets[index].ankle;
            if foot.mode == Mode::Locked {
                let animated = self.foot_of(Side::BOTH[index], pose).ankle;
                let stretch = (animated - hips - hip).length() / length;
                let easy = stretch.clamp(EASY_EXTENSION, MAX_EXTENSION);
                offset = offset.min(limit(ankle, easy));
            } else {
                // The time of its landing is unknown: the lower, the sooner.
                let lift = ankle.y - foot.sole.position.y - self.rockers[index].ankle_height();
                let easy = limit(ankle, EASY_EXTENSION).min(offset);
                offset += smooth_step(1.0 - lift / SOON_M) * (easy - offset);
            }
        }
        offset
    }

    /// The highest above the animation's floor that the pelvis can be for every standing foot to stay where it is.
    fn hard_limit(
        &self,
        animated: &[Animated; 2],
        hips: Vec3,
        hips_rotation: Quat,
        firm: f32,
    ) -> f32 {
        let mut lowest = f32::MAX;
        for (index, foot) in self.feet.iter().enumerate() {
            if foot.mode == Mode::Locked {
                let hip = hips_rotation * self.hips_from_hip[index];
                let stretch = self.stretch(index, animated, hips, hips_rotation);
                let extension = stretch.clamp(firm, MAX_EXTENSION);
                let limit = |pitch: f32| {
                    let ankle = foot.ankle_at(&self.rockers[index], pitch);
                    let length = self.leg_lengths[index];
                    reach_height(hips, hip, ankle, length, extension)
                };
                // The heel of a foot behind the body can rise; one ahead would only go farther away.
                let pitch = foot.on_ball(animated[index].pitch);
                let limit = if foot.landed_pitch > TOES_FIRST_PITCH {
                    limit(pitch)
                } else {
                    let risen = limit(foot.highest_pitch(pitch));
                    limit(pitch).map_or(risen, |flat| {
                        risen.map(|risen| risen.max(flat)).or(Some(flat))
                    })
                };
                lowest = lowest.min(limit.map_or(0.0, |height| height - hips.y));
            }
        }
        lowest
    }

    /// Follows the grade between the soles while they are apart.
    pub(super) fn measure_grade(&mut self, dt_secs: f32) {
        // A foot on its way is where it will land.
        let [left, right] = self
            .feet
            .map(|foot| foot.lands.unwrap_or(foot.sole.position));
        let way = left - right;
        let grounded = self.feet.iter().all(|foot| foot.over_ground);
        let grade = if !grounded {
            0.0
        } else if way.z.abs() > GRADE_RUN_M {
            (way.y / way.z).clamp(-1.0, 1.0)
        } else {
            return;
        };
        self.grade += (grade - self.grade) * (1.0 - (-dt_secs / GRADE_SECS).exp());
    }

    /// Motion of the supports of locked feet since the last frame.
    fn carried(&self, soles: &[Frame; 2]) -> Vec3 {
        let Some(memory) = &self.memory else {
            return Vec3::ZERO;
        };
        let mut sum = Vec3::ZERO;
        let mut count = 0.0_f32;
        for (index, foot) in self.feet.iter().enumerate() {
            if foot.mode == Mode::Locked && self.placed[index].locked {
                sum += soles[index].position - memory.soles[index].position;
                count += 1.0;
            }
        }
        sum / count.max(1.0)
    }
}

/// A leg that gets ever harder to stretch from an easy length on, and never reaches the most: one that is straightened all at once
/// snaps its knee.
fn yielded(leg: Vec3, easy: f32, most: f32) -> Vec3 {
    let (beyond, room) = (leg.length() - easy, most - easy);
    if beyond <= 0.0 || room <= 0.0 {
        return leg;
    }
    leg.normalize() * (easy + room * (1.0 - (-beyond / room).exp()))
}

/// Returns true when there is ground under a foot that looks for it.
fn grounded(foot: &Foot) -> bool {
    foot.mode != Mode::Free && foot.over_ground
}
