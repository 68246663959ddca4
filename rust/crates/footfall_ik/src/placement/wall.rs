//! A swinging foot comes out of walls sideways, where that is shorter than over them.

use crate::placement::foot::{Foot, Scene};
use crate::placement::guard::RIM;
use crate::placement::terrain::Terrain;
use glam::Vec3;

/// A foot is pushed out of a wall by so much at most, metres.
const MOST_PUSH_M: f32 = 0.06;
/// The way out is looked for in steps of this length, metres, the last of which is halved so often.
const STEP_M: f32 = 0.01;
const HALVINGS: usize = 4;
/// Time constant with which the foot goes it, seconds.
const PUSH_SECS: f32 = 0.02;
/// Shorter remainders of it count as none, metres.
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
    /// Returns true when a point that is below the ground is no farther than this from a wall that it could leave it through.
    pub(super) fn beside(&mut self, point: Vec3, distance_m: f32) -> bool {
        WAYS.into_iter()
            .any(|way| self.is_free(point + way * distance_m))
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

    /// Returns true when a point is above the ground, or there is none.
    fn is_free(&mut self, point: Vec3) -> bool {
        self.ground(point)
            .is_none_or(|(height, _)| height <= point.y)
    }
}
