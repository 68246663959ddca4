//! Places on the ground where a sole can lie.

use crate::placement::frame::Frame;
use crate::placement::lie::Lie;
use crate::placement::terrain::{Ground, SupportId, Terrain};
use crate::rocker::RockerFoot;
use glam::Vec3;

/// Greatest distance of the points of a flat sole from the ground, metres.
pub(super) const FLAT_M: f32 = 0.008;

/// Shifts of a foot that would stand across an edge, ahead or back, in the order of trial, metres.
const SHIFTS_M: [f32; 17] = [
    0.0, 0.02, -0.02, 0.04, -0.04, 0.06, -0.06, 0.08, -0.08, 0.1, -0.1, 0.12, -0.12, 0.14, -0.14,
    0.16, -0.16,
];

/// Greatest lateral shift of a sole whose rim lies across an edge, and the distance between the candidates, metres.
pub(crate) const MOST_ASIDE_M: f32 = 0.1;
const ASIDE_M: f32 = 0.02;

/// A place for a sole, on something that may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Foothold {
    /// True if the foot lands on its ball: its heel extends over an edge, or it has gone up or down one.
    pub(crate) on_ball: bool,
    /// Pitch at which the foot lands there, heel up, radians: people reach down with their toes.
    pub(crate) pitch: f32,
    support: SupportId,
    support_from_sole: Frame,
}

impl Foothold {
    /// Place of the sole in the world now: the origin lies on the ground under the ankle of a flat foot, +Y is the ground's normal
    /// and +Z points to the toes. `None` if its support is gone.
    pub(crate) fn world_from_sole(&self, terrain: &mut impl Terrain) -> Option<Frame> {
        let support = terrain.support(self.support)?;
        Some(support.child(&self.support_from_sole))
    }

    /// Its support.
    pub(crate) fn support(&self) -> SupportId {
        self.support
    }
}

/// Costs of a place: a metre of shift, higher ground nearby, and a heel or toes beyond an edge. A sole with less support
/// costs more than any of them.
pub(crate) const SHIFT_COST: f32 = 1.0;
const TIGHT_COST: f32 = 0.08;
const OVERHANG_COST: f32 = 0.3;
/// Least cost of a sole that does not lie flat.
pub(crate) const ASKEW_COST: f32 = 1.0;
/// Costs of a metre to the side, and of each point of the rim without ground.
const ASIDE_COST: f32 = 1.0;
const RIM_COST: f32 = 0.05;

impl Lie {
    /// Converts it to a place on its support; `None` if that is gone.
    pub(crate) fn foothold(&self, terrain: &mut impl Terrain) -> Option<Foothold> {
        Some(Foothold {
            on_ball: self.heel_hangs,
            pitch: 0.0,
            support: self.support,
            support_from_sole: terrain.support(self.support)?.local(&self.sole),
        })
    }
}

/// Limits of a search for footholds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search {
    /// The direction against gravity, of the world.
    pub(crate) up: Vec3,
    /// Range in which ground is looked for above and below the animation's floor, metres.
    pub(crate) above_m: f32,
    pub(crate) below_m: f32,
    /// Greatest tilt of a sole, radians.
    pub(crate) max_tilt: f32,
    /// True if the sole may move ahead or back, away from an edge.
    pub(crate) may_shift: bool,
    /// Largest shifts to the left and to the right, metres.
    pub(crate) aside_m: [f32; 2],
    /// True if it also does so with an edge under its middle. Most edges lie across the path, where a lateral shift is useless. Candidates are then
    /// farther apart: thousands of rays in one frame would cost too much.
    pub(crate) thorough: bool,
}

/// Distance between the places to the side of a thorough search, as a multiple of that of another one.
const THOROUGH_SPREAD: usize = 2;

impl Search {
    /// The ground above or below a point.
    pub(crate) fn cast(&self, terrain: &mut impl Terrain, at: Vec3) -> Option<Ground> {
        let way = self.up * (self.above_m + self.below_m);
        terrain.cast(at + self.up * self.above_m, -way)
    }

    /// The best place for a sole that the animation puts at `world_from_flat`; `None` where there is no ground.
    pub(crate) fn find(
        &self,
        terrain: &mut impl Terrain,
        world_from_flat: &Frame,
        foot: &RockerFoot,
    ) -> Option<Foothold> {
        let forward = world_from_flat.forward();
        let shifts = if self.may_shift {
            &SHIFTS_M[..]
        } else {
            &SHIFTS_M[..1]
        };
        let mut best: Option<(f32, Lie)> = None;
        for shift in shifts {
            // No farther one is better.
            if best.is_some_and(|(least, ..)| least <= SHIFT_COST * shift.abs()) {
                break;
            }
            let flat = Frame {
                position: world_from_flat.position + forward * *shift,
                ..*world_from_flat
            };
            let way = SHIFT_COST * shift.abs();
            let most = best.map_or(f32::MAX, |(least, ..)| least) - way;
            let Some((lie, cost)) = self.judge(terrain, &flat, foot, most) else {
                continue;
            };
            let cost = cost + way;
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, lie));
            }
        }
        best?.1.foothold(terrain)
    }

    /// Judges a place: how a sole lies there, or a little to the side, and the cost of that beyond the way to it. `None` where there is no
    /// ground, or where it would cost `most` and more.
    pub(crate) fn judge(
        &self,
        terrain: &mut impl Terrain,
        flat: &Frame,
        foot: &RockerFoot,
        most: f32,
    ) -> Option<(Lie, f32)> {
        let here = self.weigh(terrain, flat, foot, most)?;
        // Nothing is known of the rim of a sole that was ruled out before: it may still lie well beside.
        let rests = here.1.is_finite()
            && here.0.rim_rests()
            && (!self.thorough || here.0.borne_gap <= FLAT_M);
        let mut best = Some(here).filter(|(_, cost)| *cost < most);
        if !self.may_shift || rests {
            return best;
        }
        let left = flat.rotation * Vec3::X;
        let spread = if self.thorough { THOROUGH_SPREAD } else { 1 };
        let trials = (MOST_ASIDE_M / ASIDE_M) as usize;
        for trial in (spread..=trials).step_by(spread) {
            let aside = ASIDE_M * trial as f32;
            let way = ASIDE_COST * aside;
            for (aside, room) in [(aside, self.aside_m[0]), (-aside, self.aside_m[1])] {
                let least = best.map_or(most, |(_, cost)| cost);
                if aside.abs() > room || way >= least {
                    continue;
                }
                let flat = Frame {
                    position: flat.position + left * aside,
                    ..*flat
                };
                let there = self.weigh(terrain, &flat, foot, least - way);
                if let Some((lie, cost)) = there.filter(|(_, cost)| cost + way < least) {
                    best = Some((lie, cost + way));
                }
            }
        }
        best
    }

    /// Weighs this very place: how a sole lies there and the cost of that. The cost is infinite where it reaches `most` before the whole
    /// rim is looked at.
    fn weigh(
        &self,
        terrain: &mut impl Terrain,
        flat: &Frame,
        foot: &RockerFoot,
        most: f32,
    ) -> Option<(Lie, f32)> {
        let mut lie = self.lay(terrain, flat, foot)?;
        let mut cost = if lie.borne_gap > FLAT_M {
            ASKEW_COST + lie.gap
        } else if lie.gap > FLAT_M {
            OVERHANG_COST
        } else if self.is_tight(terrain, &lie.sole, foot) {
            TIGHT_COST
        } else {
            0.0
        };
        if cost >= most {
            return Some((lie, f32::INFINITY));
        }
        let with_rim = |lie: &Lie| {
            if lie.rim_cut > FLAT_M {
                ASKEW_COST + lie.gap.max(lie.rim_cut)
            } else {
                cost + RIM_COST * lie.rim_hangs as f32
            }
        };
        // Further points of the rim make a sole that lies flat no cheaper.
        let too_dear = |lie: &Lie| cost < ASKEW_COST && with_rim(lie) >= most;
        cost = if self.widen(terrain, &mut lie, foot, too_dear) {
            with_rim(&lie)
        } else {
            f32::INFINITY
        };
        Some((lie, cost))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Side, Skeleton};

    /// Ground whose height is a formula of x and z.
    struct Formula<F>(F);

    impl<F: Fn(f32, f32) -> f32> Terrain for Formula<F> {
        fn cast(&mut self, from: Vec3, way: Vec3) -> Option<Ground> {
            let height = (self.0)(from.x, from.z);
            (from.y + way.y..=from.y)
                .contains(&height)
                .then_some(Ground {
                    position: Vec3::new(from.x, height, from.z),
                    normal: Vec3::Y,
                    support: 0,
                })
        }

        fn support(&mut self, _: SupportId) -> Option<Frame> {
            Some(Frame::IDENTITY)
        }
    }

    const SEARCH: Search = Search {
        up: Vec3::Y,
        above_m: 0.5,
        below_m: 0.5,
        max_tilt: 0.6,
        may_shift: true,
        aside_m: [MOST_ASIDE_M; 2],
        thorough: false,
    };

    /// The same for a foot without shifts.
    const FIXED: Search = Search {
        may_shift: false,
        ..SEARCH
    };

    /// Place of the sole of a foot at the origin, and heights of its rim above the ground.
    fn put(search: &Search, height: impl Fn(f32, f32) -> f32) -> (Vec3, Vec<f32>) {
        let foot = RockerFoot::new(&Skeleton::standard(), Side::Left);
        let mut ground = Formula(&height);
        let hold = search.find(&mut ground, &Frame::IDENTITY, &foot);
        let sole = hold.and_then(|hold| hold.world_from_sole(&mut ground));
        let sole = sole.expect("there is ground everywhere");
        let rim = foot.sole_rim();
        let above = rim.as_flattened().iter().map(|point| {
            let point = sole.point(*point);
            point.y - height(point.x, point.z)
        });
        (sole.position, above.collect())
    }

    #[test]
    fn a_sole_goes_aside_until_its_whole_breadth_lies() {
        for (edge, higher) in [(0.03, 0.1), (-0.03, 0.1), (0.01, -0.1), (-0.01, -0.1)] {
            let step = |x: f32, _: f32| if x > edge { higher } else { 0.0 };
            let (place, above) = put(&SEARCH, step);
            assert!(place.x != 0.0 && place.z == 0.0, "{place} beside {edge}");
            assert!(place.x.abs() < 0.07, "{place} beside {edge}");
            assert!(
                above.iter().all(|above| above.abs() < FLAT_M),
                "{above:?} beside {edge}"
            );
        }
    }

    #[test]
    fn nothing_cuts_into_a_sole_that_cannot_go_aside() {
        let (_, above) = put(&FIXED, |x, _| if x > 0.03 { 0.1 } else { 0.0 });
        assert!(above.iter().all(|above| *above > -FLAT_M), "{above:?}");
        assert!(above.iter().any(|above| above.abs() < FLAT_M), "{above:?}");
    }

    #[test]
    fn a_wall_beside_a_sole_is_not_stood_on() {
        let (place, _) = put(&FIXED, |x, _| if x > 0.03 { 0.4 } else { 0.0 });
        assert!(place.y.abs() < 1e-6, "{place}");
    }
}
