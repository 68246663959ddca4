//! Foothold of the step that has just begun.

use crate::placement::foot::Scene;
use crate::placement::foothold::{ASKEW_COST, Foothold, MOST_ASIDE_M, SHIFT_COST, Search};
use crate::placement::frame::Frame;
use crate::placement::landings::Landing;
use crate::placement::profile::Profile;
use crate::placement::terrain::Terrain;
use crate::rocker::RockerFoot;
use footfall_core::ease::smooth_step;
use glam::Vec3;

/// Length below which steps are not aimed, metres.
const SHORT_STEP_M: f32 = 0.1;
/// Least length of a step, as a share of its own; and its greatest lengthening, as a share and in metres.
const LEAST_SHARE: f32 = 0.3;
const MORE_SHARE: f32 = 0.3;
const MOST_MORE_M: f32 = 0.16;
/// Distance between candidate places, metres.
const TRIAL_M: f32 = 0.01;
/// The same where places beside the way are tried, too, as a multiple: there are many.
const SPREAD: usize = 2;
/// Least lateral distance of footprints when a foothold avoids an edge, metres.
const LEAST_BASE_M: f32 = 0.06;
/// Height differences of a step without effort, and those out of reach, in leg lengths; and the cost of a metre of effort.
const EASY_RISE: f32 = 0.28;
const MOST_RISE: f32 = 0.6;
const RISE_COST: f32 = 6.0;
/// Least height of an edge, metres, up or down which a foot lands on its ball.
const EDGE_M: f32 = 0.08;
/// Pitch of a foot that comes down with its toes first, radians, and the falls at which it begins to and does so fully, metres.
const TOES_FIRST: f32 = 0.4;
const TOES_FALL_M: [f32; 2] = [0.08, 0.15];
/// Grade above which each tread takes one step, the cost of a second step on a tread, and the greatest lengthening of a step, as a share.
const STAIRS_GRADE: f32 = 0.2;
const SAME_TREAD_COST: f32 = 0.2;
const STAIRS_MORE_SHARE: f32 = 0.5;
/// Factor of the cost of lengthening over shortening.
const LONGER_COST: f32 = 1.5;

/// A place for the foot of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    pub(super) foothold: Foothold,
    /// Length that the step needs, as a share of its own.
    pub(super) share: f32,
    /// Rise of the ground from this foothold to about the next one, metres.
    pub(super) next_rise_m: f32,
    /// Grade of the ground ahead over two steps from the standing foot.
    pub(super) grade: f32,
}

/// Step to aim: the standing foot, the landing, and the leg that takes it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<'a> {
    /// The sole of the standing foot, in the world.
    pub(super) standing: Frame,
    pub(super) landing: &'a Landing,
    pub(super) rocker: &'a RockerFoot,
    pub(super) leg_m: f32,
    /// Grade between the two footholds before it.
    pub(super) grade: f32,
    /// True if the length of the step can still change; otherwise only its foot is moved.
    pub(super) may_stretch: bool,
}

/// The ground along the step, and its limits.
struct StepGround {
    profile: Profile,
    /// The sole's place in the animation, in the world, and its distance from the standing foot, metres.
    flat: Frame,
    length: f32,
    /// Height of the standing foot, metres.
    standing: f32,
    /// Largest distances by which the foot may land short of its place and beyond it, metres.
    bounds: (f32, f32),
}

impl Step<'_> {
    /// Chooses where it lands; `None` where there is no ground within reach.
    pub(super) fn aim<T: Terrain>(&self, scene: &mut Scene<'_, T>) -> Option<Aim> {
        let floor = scene.world_from_floor;
        let up = floor.up();
        let flat = floor.child(&self.landing.flat);
        let along = floor.rotation * (self.landing.hips * Vec3::new(1.0, 0.0, 1.0));
        let along = along.normalize_or(floor.forward());
        let length = (flat.position - self.standing.position).dot(along);
        if length < SHORT_STEP_M {
            return self.beside(scene, &flat);
        }
        let start = flat.position - along * length;
        let start = start + up * (self.standing.position - start).dot(up);
        let max_step = scene.config.max_step_m;
        let profile = Profile::trace(
            scene.terrain,
            [start, along, up],
            2.0 * length + MOST_MORE_M,
            max_step,
        );
        let search = Search {
            above_m: max_step,
            below_m: max_step,
            aside_m: self.room_aside(&flat),
            ..scene.search()
        };
        let ground = StepGround {
            profile,
            flat,
            length,
            standing: self.standing.position.dot(up),
            bounds: self.bounds(length, search.may_shift),
        };
        let straight = Search {
            aside_m: [0.0; 2],
            ..search
        };
        let best = self.search(scene, &ground, &straight, 1, None);
        // What is found on the way rules out most of what lies beside it before a ray is cast.
        let best = self.search(scene, &ground, &search, SPREAD, best);
        let best = best.filter(|(cost, _)| *cost < ASKEW_COST).or_else(|| {
            let thorough = Search {
                thorough: true,
                ..search
            };
            self.search(scene, &ground, &thorough, SPREAD, None)
        });
        best.map(|(_, aim)| aim)
    }

    /// The best place on the ground along the step and its cost, where it is better than `best`. Places are this multiple of the smallest distance apart.
    fn search<T: Terrain>(
        &self,
        scene: &mut Scene<'_, T>,
        ground: &StepGround,
        search: &Search,
        spread: usize,
        mut best: Option<(f32, Aim)>,
    ) -> Option<(f32, Aim)> {
        let (least, most) = ground.bounds;
        let trials = (least.max(most) / TRIAL_M) as usize;
        for trial in (0..=trials).step_by(spread) {
            let shift = TRIAL_M * trial as f32;
            // No farther one is better.
            if best.is_some_and(|(cost, _)| cost <= SHIFT_COST * shift) {
                break;
            }
            for shift in [shift, -shift] {
                if shift > most || -shift > least {
                    continue;
                }
                let least = best.map_or(f32::MAX, |(cost, _)| cost);
                if let Some(better) = self.weigh(scene, ground, search, shift, least) {
                    best = Some(better);
                }
            }
        }
        best
    }

    /// A place at this shift along the step, and its cost if that is less than `most`.
    fn weigh<T: Terrain>(
        &self,
        scene: &mut Scene<'_, T>,
        ground: &StepGround,
        search: &Search,
        shift: f32,
        most: f32,
    ) -> Option<(f32, Aim)> {
        let (length, profile) = (ground.length, &ground.profile);
        let place = Frame {
            position: profile.at(length + shift, profile.height(length + shift)?),
            ..ground.flat
        };
        let farther = if shift > 0.0 { LONGER_COST } else { 1.0 };
        let shifted = farther * SHIFT_COST * shift.abs();
        let (lie, cost) = search.judge(scene.terrain, &place, self.rocker, most - shifted)?;
        let sole = lie.sole.position.dot(search.up);
        let rise = (sole - ground.standing) / self.leg_m;
        let effort = RISE_COST * self.leg_m * (rise.abs() - EASY_RISE).max(0.0);
        let stays = (sole - ground.standing).abs() < EDGE_M && self.is_on_stairs();
        let cost = cost + shifted + effort + if stays { SAME_TREAD_COST } else { 0.0 };
        if rise.abs() > MOST_RISE || cost >= most {
            return None;
        }
        let height = |along_m: f32| profile.height(along_m);
        let next = height(2.0 * length + shift).or(height(1.5 * length + shift));
        let easy = EASY_RISE * self.leg_m;
        let ahead = next.map_or(0.0, |next| next - ground.standing);
        let mut foothold = lie.foothold(scene.terrain)?;
        let normal = lie.sole.up();
        let slope = -normal.dot(profile.along) / normal.dot(search.up).max(0.5);
        let edge = sole - ground.standing - slope * (length + shift);
        foothold.on_ball |= edge.abs() > EDGE_M;
        let [least, most] = TOES_FALL_M;
        foothold.pitch = TOES_FIRST * smooth_step((-edge - least) / (most - least));
        let aim = Aim {
            foothold,
            share: (length + shift) / length,
            next_rise_m: next.map_or(0.0, |next| (next - sole).clamp(-easy, easy)),
            grade: (ahead / (2.0 * length)).clamp(-1.0, 1.0),
        };
        Some((cost, aim))
    }

    /// Returns true when the way goes up or down as stairs do.
    fn is_on_stairs(&self) -> bool {
        self.grade.abs() > STAIRS_GRADE
    }

    /// Largest distances by which the foot may land short of its place and beyond it, metres.
    fn bounds(&self, length: f32, may_shift: bool) -> (f32, f32) {
        let share = if self.is_on_stairs() {
            STAIRS_MORE_SHARE
        } else {
            MORE_SHARE
        };
        let more = MOST_MORE_M.min(share * length);
        if self.may_stretch {
            ((1.0 - LEAST_SHARE) * length, more)
        } else if may_shift {
            (MOST_MORE_M, more)
        } else {
            (0.0, 0.0)
        }
    }

    /// Largest shifts of the foot to the left and to the right that keep it out of the other's way, metres.
    fn room_aside(&self, flat: &Frame) -> [f32; 2] {
        let left = flat.rotation * Vec3::X;
        let apart = (flat.position - self.standing.position).dot(left);
        let inwards = (apart.abs() - LEAST_BASE_M).clamp(0.0, MOST_ASIDE_M);
        if apart > 0.0 {
            [MOST_ASIDE_M, inwards]
        } else {
            [inwards, MOST_ASIDE_M]
        }
    }

    /// A foot that lands beside the other, or behind it.
    fn beside<T: Terrain>(&self, scene: &mut Scene<'_, T>, flat: &Frame) -> Option<Aim> {
        let search = scene.search();
        Some(Aim {
            foothold: search.find(scene.terrain, flat, self.rocker)?,
            share: 1.0,
            next_rise_m: 0.0,
            grade: 0.0,
        })
    }
}
