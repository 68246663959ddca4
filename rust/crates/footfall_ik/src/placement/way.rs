//! Way of a swinging foot from one foothold to the next: over even ground it goes as over a level floor, over edges it is lifted.

use crate::placement::correction::Correction;
use crate::placement::foot::Scene;
use crate::placement::frame::Frame;
use crate::placement::terrain::{Terrain, rise_along};
use footfall_core::ease::smooth_step;
use glam::Vec3;

/// Parts of the swing in which a foot rises, or descends, over uneven ground: it clears the edge before that, or after it.
const RISE_SHARE: f32 = 0.5;
const FALL_SHARE: f32 = 0.65;
/// Clearance of a swinging foot from the ground, metres.
const CLEARANCE_M: f32 = 0.04;
/// Typical lift on flat ground in the middle of the swing, metres.
const USUAL_LIFT_M: f32 = 0.05;
/// Height above the sole's path up to which ground is no obstacle, metres.
const FLAT_WAY_M: f32 = 0.01;
/// Number of places of the path at which the ground is queried.
const WAY_POINTS: usize = 6;
/// Distance by which the toes meet an edge before the ankle is there, metres.
const TOES_M: f32 = 0.1;
/// Parts of the swing until which a rising foot stays over its last place, and at which it has caught up: its toes come over the edge
/// before it and not through it; and the rise from which this applies, metres.
const LATE_SHARES: [f32; 2] = [0.1, 0.6];
pub(super) const LATE_RISE_M: f32 = 0.08;
/// Number of halvings that find when a foot is at a place.
const HALVINGS: usize = 8;
/// Heights of the ground above the line between the footholds up to which the way is even, and from which it is not, metres.
const EVEN_M: [f32; 2] = [0.01, 0.03];
/// The same for slopes of that line beyond those of both footholds.
const EVEN_SLOPE: [f32; 2] = [0.03, 0.1];
/// Shortest way between footholds that has a slope, metres.
const SHORT_WAY_M: f32 = 0.2;
/// Limits of the part of the way that is passed, for a foot that swings back before it goes, or beyond its foothold.
const PASSED: [f32; 2] = [-0.1, 1.2];

/// Ground on the way of a foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Way {
    /// Height by which the foot has to be lifted more than usual in the middle of the way, metres.
    lift_m: f32,
    /// 1 where the ground bends from one foothold to the other without rising above the line between them, as on a slope; 0 where it has an edge.
    pub(super) even: f32,
}

impl Way {
    /// Looks at the ground between two soles, the first of which lies on ground with this normal. A foot that `stood` there is held back before
    /// edges.
    pub(super) fn look<T: Terrain>(
        scene: &mut Scene<'_, T>,
        (from, normal): (Vec3, Vec3),
        sole: &Frame,
        stood: bool,
    ) -> Self {
        let rise = sole.position.y - from.y;
        let way = (sole.position - from).with_y(0.0);
        let length = way.length().max(SHORT_WAY_M);
        let slope = rise / length;
        let slopes = [normal, sole.up()].map(|up| rise_along(up, way) / length);
        let step = rise - rise_along(normal, way);
        let (mut lift, mut edge) = (0.0_f32, 0.0_f32);
        for point in 1..=WAY_POINTS {
            let share = point as f32 / (WAY_POINTS + 1) as f32;
            let at = from.lerp(sole.position, smooth_step(share));
            let Some((height, _)) = scene.ground(at + sole.forward() * TOES_M) else {
                continue;
            };
            edge = edge.max(height - (at.y + TOES_M * slope));
            let share = if stood { there(share, step) } else { share };
            let foot = from.y + rise * smooth_step(rising(share, rise > 0.0));
            let usual = USUAL_LIFT_M * 4.0 * share * (1.0 - share);
            let short = height + CLEARANCE_M - foot - usual;
            // What lies no higher than the way from one foothold to the other is cleared by any walk.
            if height > foot + FLAT_WAY_M {
                lift = lift.max(short);
            }
        }
        let [least, most] = [slopes[0].min(slopes[1]), slopes[0].max(slopes[1])];
        let beyond = (slope - most).max(least - slope);
        let share =
            |value: f32, [even, uneven]: [f32; 2]| smooth_step((uneven - value) / (uneven - even));
        let even = if way.length() < SHORT_WAY_M {
            0.0
        } else {
            share(edge, EVEN_M) * share(beyond, EVEN_SLOPE)
        };
        Self {
            // What stands near an end of the way is no reason to kick higher in its middle: there the guard lifts the foot.
            lift_m: (1.0 - even) * lift,
            even,
        }
    }

    /// The correction at this part of the swing, and how much the foot is lifted there. Over even ground the foot rises and sinks as it goes.
    pub(super) fn at(
        self,
        from: &Correction,
        toward: &Correction,
        share: f32,
        passed: f32,
    ) -> (Correction, f32) {
        let up = smooth_step(rising(share, toward.shift.y > from.shift.y));
        let up = up + self.even * (passed - up);
        let correction = from.toward(toward, smooth_step(share), up);
        let lift = self.lift_m * (share * (1.0 - share) * 4.0).powi(2);
        (correction, lift)
    }
}

/// Part of the way from `left` to `lands` that a foot at `now` has behind it.
pub(super) fn passed(left: Vec3, lands: Vec3, now: Vec3) -> f32 {
    let way = (lands - left).with_y(0.0);
    let length = way.length().max(SHORT_WAY_M);
    let passed = (now - left).dot(way) / (length * length);
    passed.clamp(PASSED[0], PASSED[1])
}

/// Share of its way by which a foot that rises over an edge, of so many metres, is held back at this part of the swing: 1 over the place where it stood.
pub(super) fn held_back(share: f32, rise_m: f32) -> f32 {
    let [from, until] = LATE_SHARES;
    smooth_step((until - share) / (until - from)) * smooth_step(rise_m / LATE_RISE_M)
}

/// Part of the swing at which a foot that is held back is where it would be at `share` otherwise.
fn there(share: f32, rise_m: f32) -> f32 {
    let place = smooth_step(share);
    let [mut before, mut after] = [share, 1.0];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + after);
        if smooth_step(middle) * (1.0 - held_back(middle, rise_m)) < place {
            before = middle;
        } else {
            after = middle;
        }
    }
    after
}

/// Share of its rise that a foot has behind it: one that goes up rises early, one that goes down sinks late.
fn rising(share: f32, rises: bool) -> f32 {
    if rises {
        share / RISE_SHARE
    } else {
        (share - 1.0 + FALL_SHARE) / FALL_SHARE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::config::PlacementConfig;
    use crate::placement::terrain::{Ground, SupportId};
    use glam::Quat;

    struct Relief(fn(f32) -> f32);

    /// Normal of the ground, which is level beside an edge.
    fn normal(height: fn(f32) -> f32, z: f32) -> Vec3 {
        let slope = 1e3 * (height(z + 1e-3) - height(z));
        let slope = if slope.abs() > 1.0 { 0.0 } else { slope };
        Vec3::new(0.0, 1.0, -slope).normalize()
    }

    impl Terrain for Relief {
        fn cast(&mut self, from: Vec3, _way: Vec3) -> Option<Ground> {
            Some(Ground {
                position: from.with_y((self.0)(from.z)),
                normal: normal(self.0, from.z),
                support: 1,
            })
        }

        fn support(&mut self, _support: SupportId) -> Option<Frame> {
            Some(Frame::IDENTITY)
        }
    }

    /// The way over 1.2 m of this ground, from where the foot stood.
    fn over(height: fn(f32) -> f32) -> Way {
        along(height, true)
    }

    fn along(height: fn(f32) -> f32, stood: bool) -> Way {
        let config = PlacementConfig::default();
        let mut scene = Scene {
            terrain: &mut Relief(height),
            world_from_floor: Frame::IDENTITY,
            config: &config,
            soles_m: [0.0; 2],
            dt_secs: 1.0 / 60.0,
        };
        let sole = Frame {
            position: Vec3::new(0.0, height(1.2), 1.2),
            rotation: Quat::from_rotation_arc(Vec3::Y, normal(height, 1.2)),
        };
        Way::look(
            &mut scene,
            (Vec3::Y * height(0.0), normal(height, 0.0)),
            &sole,
            stood,
        )
    }

    #[test]
    fn slopes_and_hollows_are_even() {
        let slopes: [fn(f32) -> f32; 5] = [
            |_| 0.3,
            |z| 0.36 * z,
            |z| -0.36 * z,
            |z| 0.36 * (z - 0.6).max(0.0),
            |z| -0.36 * z.min(0.6),
        ];
        for slope in slopes {
            let way = over(slope);
            assert!(way.even > 0.999 && way.lift_m < 1e-4, "{way:?}");
        }
    }

    #[test]
    fn stairs_and_kerbs_are_cleared() {
        let edges: [fn(f32) -> f32; 5] = [
            |z| 0.15 * (z / 0.3 + 0.1).floor(),
            |z| -0.15 * (z / 0.3 - 0.1).ceil(),
            |z| if z > 0.5 { 0.15 } else { 0.0 },
            |z| if z < 0.5 { 0.15 } else { 0.0 },
            |z| if (z - 0.6).abs() < 0.2 { 0.1 } else { 0.0 },
        ];
        for edge in edges {
            let way = over(edge);
            assert!(way.even < 1e-3, "{way:?}");
        }
        assert!(over(edges[4]).lift_m > 0.05);
    }

    /// Steps of 0.17 m, the first of them at the toes.
    #[test]
    fn a_foot_that_is_held_back_is_not_lifted_over_the_first_edge() {
        let stairs = |z: f32| 0.17 * (z / 0.4 + 0.7).floor();
        let [held, swung] = [true, false].map(|stood| along(stairs, stood).lift_m);
        assert!(held < 0.01 && swung > 0.05, "{held} {swung}");
        for place in [0.1_f32, 0.3, 0.6] {
            let share = there(place, 0.5);
            let moved = smooth_step(share) * (1.0 - held_back(share, 0.5));
            assert!((moved - smooth_step(place)).abs() < 0.01, "{share} {moved}");
            assert!((there(place, 0.0) - place).abs() < 0.01);
        }
    }

    #[test]
    fn a_foot_over_even_ground_rises_as_it_goes() {
        let way = Way {
            lift_m: 0.0,
            even: 1.0,
        };
        let toward = Correction {
            shift: Vec3::Y * 0.4,
            ..Correction::NONE
        };
        let passed = passed(Vec3::ZERO, Vec3::Z * 1.2, Vec3::new(0.1, 0.3, 0.3));
        let (correction, lift) = way.at(&Correction::NONE, &toward, 0.6, passed);
        assert!((correction.shift.y - 0.1).abs() < 1e-6, "{correction:?}");
        assert!(lift.abs() < 1e-6);
    }
}
