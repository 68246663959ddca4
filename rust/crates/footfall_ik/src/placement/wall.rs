//! Lateral motion of a swinging foot out of walls, where that is shorter than over them.

use crate::placement::foot::{Foot, Scene};
use crate::placement::guard::RIM;
use crate::placement::terrain::Terrain;
use glam::Vec3;

/// Greatest push of a foot out of a wall, metres.
const MOST_PUSH_M: f32 = 0.06;
/// Length of the search steps for the way out, metres, and the number of bisections of the last one.
const STEP_M: f32 = 0.01;
const HALVINGS: usize = 4;
/// Time constant of that push, seconds.
const PUSH_SECS: f32 = 0.02;
/// A point that is no deeper in the ground than this is out of the wall: toes that roll off a tread sink into it by less.
pub(super) const SUNK_M: f32 = 0.005;
/// Ways by which a point is farther inside than it may be, metres, and the depth that each metre of it counts as: a foot that goes back into a riser by
/// millimetres, faster than it is pushed out of it, is not thrown over it.
const FARTHER_M: [f32; 4] = [0.0, 0.0015, 0.003, 0.005];
const FARTHER_DEPTH: f32 = 8.0;
/// Cosine of the angle to the rest of the sole beyond which a direction leads inwards.
const INWARDS: f32 = 0.25;
/// Length below which a push counts as none, metres.
const NOTHING_M: f32 = 1e-4;
/// Ways out, in the axes of the floor.
const WAYS: [Vec3; 4] = [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z];

impl Foot {
    /// Follows the way on which a foot comes out of the walls that points of its sole are inside by more than `touch_m`: a heel that comes down just behind an
    /// edge need not be held up until it is past it. `under` has the height and the normal of the ground at each point.
    pub(super) fn push_out<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        points: &[Vec3; RIM],
        under: &[Option<(f32, Vec3)>; RIM],
        touch_m: f32,
    ) {
        let mut push = Vec3::ZERO;
        for (point, ground) in points.iter().zip(under) {
            let depth = ground.map_or(0.0, |(height, _)| height - point.y);
            if depth > touch_m
                && let Some(out) = scene.way_out(*point, depth.min(MOST_PUSH_M))
                && out.length_squared() > push.length_squared()
            {
                push = out;
            }
        }
        let beyond = (push.length() - touch_m).max(0.0);
        let share = 1.0 - (-scene.dt_secs / PUSH_SECS).exp();
        self.pushed += (push.normalize_or_zero() * beyond - self.pushed) * share;
        if self.pushed.length_squared() < NOTHING_M * NOTHING_M {
            self.pushed = Vec3::ZERO;
        }
    }
}

impl<T: Terrain> Scene<'_, T> {
    /// Least depth below the ground of a point of a sole that goes so far to any side on which the sole is: its middle, or the other side of its rim, since a sole is narrow. It is at most 0 where
    /// the point comes out of the ground. It may go a little farther than that, which counts as [`FARTHER_DEPTH`] has it. Walls that it would leave on the other sides are under the sole.
    pub(super) fn depth_beside(&mut self, point: Vec3, sole: [Vec3; 2], distance_m: f32) -> f32 {
        let inwards = sole.map(|within| (within - point).with_y(0.0).normalize_or_zero());
        let leads = |way: &Vec3| inwards.iter().any(|inwards| way.dot(*inwards) > INWARDS);
        WAYS.into_iter().filter(leads).fold(f32::MAX, |least, way| {
            FARTHER_M.into_iter().fold(least, |least, farther| {
                let depth = self.depth(point + way * (distance_m + farther));
                least.min(depth.max(0.0) + FARTHER_DEPTH * farther)
            })
        })
    }

    /// Returns the shortest way to the side on which a point that is below the ground comes out of it; `None` where it is longer than `most_m`.
    fn way_out(&mut self, point: Vec3, most_m: f32) -> Option<Vec3> {
        let mut shortest = None;
        let mut most = most_m;
        for way in WAYS {
            let steps = (most / STEP_M).floor() as usize;
            let mut distances = (1..=steps).map(|step| step as f32 * STEP_M);
            let free = distances.find(|distance| self.is_free(point + way * *distance));
            let Some(mut out) = free else { continue };
            let mut within = out - STEP_M;
            for _ in 0..HALVINGS {
                let middle = 0.5 * (within + out);
                if self.is_free(point + way * middle) {
                    out = middle;
                } else {
                    within = middle;
                }
            }
            most = out;
            shortest = Some(way * out);
        }
        shortest
    }

    /// Returns true when a point is above the ground or hardly below it, or there is none.
    fn is_free(&mut self, point: Vec3) -> bool {
        self.depth(point) <= SUNK_M
    }

    /// Depth of a point below the ground, negative above it and where there is none.
    fn depth(&mut self, point: Vec3) -> f32 {
        self.ground(point)
            .map_or(f32::MIN, |(height, _)| height - point.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::{Frame, Ground, PlacementConfig};

    /// A riser of 17 cm across the way at z = 0.
    fn riser(from: Vec3, way: Vec3) -> Option<Ground> {
        let height = if from.z < 0.0 { 0.0 } else { 0.17 };
        let position = from.with_y(height);
        (from.y + way.y..=from.y)
            .contains(&height)
            .then_some(Ground {
                position,
                normal: Vec3::Y,
                support: 0,
            })
    }

    fn before_riser<R>(
        ask: impl FnOnce(&mut Scene<'_, fn(Vec3, Vec3) -> Option<Ground>>) -> R,
    ) -> R {
        ask(&mut Scene {
            terrain: &mut (riser as fn(Vec3, Vec3) -> Option<Ground>),
            world_from_floor: Frame::IDENTITY,
            config: &PlacementConfig::default(),
            soles_m: [0.0; 2],
            dt_secs: 1.0 / 60.0,
        })
    }

    #[test]
    fn toes_a_hair_in_a_riser_and_below_their_tread_are_no_deeper_than_that() {
        let toes = Vec3::new(0.0, -0.001, 0.0003);
        let depth = |toes: Vec3, middle: f32| {
            before_riser(|scene| scene.depth_beside(toes, [Vec3::Z * middle; 2], 0.015))
        };
        let touching = depth(toes, -0.1);
        assert!((touching - 0.001).abs() < 1e-6, "{touching}");
        // A little farther in than they may be, they lift a little.
        let grazing = depth(toes.with_z(0.0165), -0.1);
        assert!((0.01..0.03).contains(&grazing), "{grazing}");
        // Farther in, nothing beside them is lower, nor does a heel leave through an edge that its sole lies across.
        for [z, middle] in [[0.03, -0.1], [0.0003, 0.1]] {
            let within = depth(toes.with_z(z), middle);
            assert!((within - 0.171).abs() < 1e-6, "{within}");
        }
    }

    #[test]
    fn a_sole_along_a_wall_is_beside_it_where_its_other_rim_is() {
        let rim = Vec3::Z * 0.006;
        let along = rim + Vec3::X * 0.2;
        let depth =
            |other: Vec3| before_riser(|scene| scene.depth_beside(rim, [along, other], 0.015));
        assert!(depth(rim - Vec3::Z * 0.07) <= 0.0);
        assert!((depth(rim + Vec3::Z * 0.07) - 0.17).abs() < 1e-6);
    }

    #[test]
    fn toes_below_their_tread_come_out_of_a_riser_the_way_they_went_in() {
        for sunk in [0.0, 0.001] {
            let toes = Vec3::new(0.0, -sunk, 0.03);
            let out = before_riser(|scene| scene.way_out(toes, MOST_PUSH_M));
            let out = out.unwrap_or_default();
            assert!((out.z + 0.03).abs() < 0.001 && out.x == 0.0, "{out}");
        }
        let within = before_riser(|scene| scene.way_out(Vec3::Z * 0.1, MOST_PUSH_M));
        assert_eq!(within, None);
    }
}
