//! Where the pelvis goes: as high as the ground under it has it, and no higher than the legs reach.

use crate::leg::{FootTarget, reach_height};
use crate::placement::foot::{Foot, Mode};
use crate::placement::frame::Frame;
use crate::placement::pelvis::plane_height;
use crate::placement::{FootPlacer, PlacementInput};
use footfall_core::ease::smooth_step;
use footfall_core::{Joint, Pose, Side};
use glam::Vec3;

/// Legs are stretched to this share of their length for the pelvis' sake, unless the animation stretches them more.
const EASY_EXTENSION: f32 = 0.98;
/// Legs are never stretched more.
const MAX_EXTENSION: f32 = 0.999;
/// From so long before a foot lands until so long before, the pelvis comes to where the leg can reach the ground, seconds: it takes
/// a while to get there.
const LANDING_SECS: [f32; 2] = [0.35, 0.1];
/// A foot of which nobody knows when it lands is about to when it is lower than this, metres.
const SOON_M: f32 = 0.15;
/// A foot that lands has its ankle so much higher than a flat one, for its toes are up, metres.
const LANDING_ANKLE_M: f32 = 0.015;
/// Soles that are farther apart than this tell the grade, metres, which follows within this time, seconds.
const GRADE_RUN_M: f32 = 0.2;
const GRADE_SECS: f32 = 0.3;

impl FootPlacer {
    /// Moves the pelvis up or down so that both legs reach the ground, now and at the next landing.
    pub(super) fn carry_pelvis(
        &mut self,
        dt_secs: f32,
        input: &PlacementInput,
        soles: &[Frame; 2],
        pose: &mut Pose,
        targets: &[FootTarget; 2],
    ) {
        let floor = input.world_from_floor;
        let floor_height = floor.position.dot(floor.up());
        let hips = pose.root_position;
        let hips_rotation = pose.rotations[Joint::Hips.index()];
        let grounded = |foot: &Foot| foot.mode != Mode::Free && foot.over_ground;
        let mut offset = 0.0;
        if self.feet.iter().all(grounded) {
            let planes = self
                .feet
                .map(|foot| plane_height(foot.sole.position, foot.sole.up(), hips));
            offset = 0.5 * (planes[0] + planes[1]);
        }
        self.ground_m = offset;
        let carried = self.carried(soles);
        let velocity = self.level_velocity(dt_secs, &floor, carried);
        let mut hard_limit = f32::MAX;
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
            if foot.mode == Mode::Locked {
                let animated = self.foot_of(Side::BOTH[index], pose).ankle;
                let stretch = (animated - hips - hip).length() / length;
                let ankle = targets[index].ankle;
                let easy = stretch.clamp(EASY_EXTENSION, MAX_EXTENSION);
                offset = offset.min(limit(ankle, easy));
                hard_limit = hard_limit.min(limit(ankle, MAX_EXTENSION));
            } else if let Some(lands) = foot.lands {
                // The hips will have come nearer by then.
                let height = self.rockers[index].ankle_height() + LANDING_ANKLE_M;
                let above = Vec3::Y * height - velocity * lands.secs;
                let [real, flat] =
                    [lands.sole, lands.flat].map(|sole| limit(sole + above, EASY_EXTENSION));
                // What the leg lacks on the animation's own floor is the animation's affair.
                let easy = (real - flat.min(0.0)).min(offset);
                let [from, until] = LANDING_SECS;
                let share = smooth_step((from - lands.secs) / (from - until));
                offset += share * (easy - offset);
            } else {
                // Nobody knows when it will stand: the lower, the sooner.
                let ankle = targets[index].ankle;
                let lift = ankle.y - foot.sole.position.y - self.rockers[index].ankle_height();
                let easy = limit(ankle, EASY_EXTENSION).min(offset);
                offset += smooth_step(1.0 - lift / SOON_M) * (easy - offset);
            }
        }
        let bound = self.config.max_pelvis_m;
        let target = floor_height + offset.clamp(-bound, bound);
        if self.memory.is_some() {
            self.pelvis.value += carried.dot(floor.up());
            let half_life = self.config.pelvis_half_life_secs;
            self.pelvis.follow(target, half_life, dt_secs);
        } else {
            self.pelvis.jump(target);
        }
        self.pelvis
            .hold_below(floor_height + hard_limit.max(-bound));
        pose.root_position.y += self.pelvis.value - floor_height;
    }

    /// Follows the grade between the soles while they are apart.
    pub(super) fn measure_grade(&mut self, dt_secs: f32) {
        // A foot on its way is where it will land.
        let [left, right] = self
            .feet
            .map(|foot| foot.lands.map_or(foot.sole.position, |lands| lands.sole));
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

    /// How fast the animation's floor travels over what supports the feet, in its own axes, without its rise, m/s.
    fn level_velocity(&self, dt_secs: f32, floor: &Frame, carried: Vec3) -> Vec3 {
        let Some(memory) = self.memory.as_ref().filter(|_| dt_secs > 0.0) else {
            return Vec3::ZERO;
        };
        let travel = floor.position - memory.world_from_floor.position - carried;
        floor.rotation.conjugate() * travel * Vec3::new(1.0, 0.0, 1.0) / dt_secs
    }

    /// How far the supports of locked feet moved since the last frame.
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
