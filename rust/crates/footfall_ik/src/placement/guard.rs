//! Clearance of a swinging foot from the ground below it.

use crate::leg::FootTarget;
use crate::placement::foot::{Animated, Foot, Scene};
use crate::placement::terrain::{Terrain, rise_along};
use crate::placement::wall::SUNK_M;
use crate::placement::way::LATE_RISE_M;
use crate::rocker::RockerFoot;
use footfall_core::ease::smooth_step;
use glam::Vec3;

/// Clearance to which a foot is lifted above an obstacle, metres.
const GUARD_M: f32 = 0.01;
/// Half-life of the lift over an obstacle, seconds.
const GUARD_HALF_LIFE_SECS: f32 = 0.032;
/// Greatest depth of a point of the sole in an obstacle, even during the lift, metres.
const TOUCH_M: f32 = 0.015;
/// Depth by which a rising foot may graze the risers before its toes, and a descending one those behind its heel, without being lifted over them, metres.
const GRAZE_M: f32 = 0.01;
/// Time before its landing from which a foot is no longer held up, seconds: it comes down at its foothold.
const COMING_DOWN_SECS: f32 = 0.05;
/// Points of a sole's rim.
pub(super) const RIM: usize = 6;
/// Time of the foot's path ahead for which the ground is queried, seconds.
const LOOK_AHEAD_SECS: f32 = 0.07;

impl Foot {
    /// Lifts a foot that would pass through the ground now or a moment later.
    pub(super) fn guard<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        animated: &Animated,
        secs_left: Option<f32>,
        target: &mut FootTarget,
    ) {
        let place = scene.world_from_floor.point(target.ankle);
        let way = self.passed.map_or(Vec3::ZERO, |before| {
            scene.world_from_floor.rotation.conjugate() * (place - before)
        });
        self.passed = Some(place);
        let left = secs_left.unwrap_or(LOOK_AHEAD_SECS).min(LOOK_AHEAD_SECS) * (1.0 - self.held);
        let mut ahead = way * Vec3::new(1.0, 0.0, 1.0) * (left / scene.dt_secs.max(1e-3));
        let mut back = Vec3::ZERO;
        if let Some(lands) = self.lands {
            // It goes no farther than to its foothold: the riser behind that is no edge on its way.
            let place = animated.flat.position + self.correction.shift;
            let to_go = (lands - place) * Vec3::new(1.0, 0.0, 1.0);
            ahead = ahead.clamp_length_max(to_go.dot(ahead.normalize_or_zero()).max(0.0));
            let rise = lands.y - self.lifted(scene).shift.y;
            let [up, down] = [rise, -rise].map(|way| smooth_step(way / LATE_RISE_M));
            back = animated.flat.forward() * (GRAZE_M * (up - down));
        }
        let share = secs_left.map_or(1.0, |secs| smooth_step(secs / COMING_DOWN_SECS));
        let rim = |foot: &FootTarget| -> [Vec3; RIM] {
            let rim = rocker.rim(foot);
            core::array::from_fn(|index| rim.as_flattened()[index])
        };
        // Left and right by turns.
        let mut points = rim(target);
        let mut under = points.map(|point| scene.ground(point));
        self.push_out(scene, &points, &under, TOUCH_M);
        let aside = share * self.pushed;
        if aside != Vec3::ZERO {
            target.ankle += aside;
            points = points.map(|point| point + aside);
            under = points.map(|point| scene.ground(point));
        }
        let middle = points.iter().sum::<Vec3>() / RIM as f32;
        let mut short = 0.0_f32;
        let mut touched = 0.0_f32;
        let rest = rim(&animated.foot);
        for (index, (point, under)) in points.iter().zip(under).enumerate() {
            // No more room than the animation leaves over its own floor.
            let room = rest[index].y.clamp(0.0, GUARD_M);
            let Some((height, normal)) = under else {
                continue;
            };
            let mut over = height - point.y - TOUCH_M;
            if over > 0.0 {
                // A wall that it touches from the side is not above it.
                over = over
                    .min(scene.depth_beside(*point, [middle, points[index ^ 1]], TOUCH_M) - SUNK_M);
            }
            touched = touched.max(over);
            let before = if back == Vec3::ZERO {
                Some(height)
            } else {
                scene.ground(*point - back).map(|(height, _)| height)
            };
            if let Some(before) = before {
                short = short.max(before + room - point.y);
            }
            // An edge ahead, as far as it is not the slope on which the foot goes anyway.
            let slope = rise_along(normal, ahead);
            if let Some((edge, _)) = scene.ground(*point + ahead - back) {
                // Where it falls less than at this point, as behind an edge, it counts as it is.
                let edge = (edge - slope).min(edge.max(height));
                short = short.max(edge + room - point.y);
            }
        }
        let short = short
            // What is a step's height below is a wall and not ground.
            .min(scene.config.max_step_m);
        self.guard
            .follow(short, GUARD_HALF_LIFE_SECS, scene.dt_secs);
        let touched = touched.min(scene.config.max_step_m);
        self.guard.lift_to(touched);
        target.ankle.y += (share * self.guard.value).max(touched);
    }
}
