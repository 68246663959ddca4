//! Vectors and rotations of eight frames side by side, each component in one vector register or two.
//!
//! Arithmetic that is the same for every frame of a step works on eight frames at once. The types have the operations that this takes and follow
//! the conventions of `glam`, which serves for single values.

mod quaternion;
mod vector;

pub use quaternion::Quatx8;
pub use vector::Vec3x8;
pub use wide::f32x8;

/// Number of frames that are worked on side by side.
pub const LANES: usize = 8;

/// The number of each lane.
pub const COUNTING: f32x8 = f32x8::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);

/// [`smooth_step`](crate::ease::smooth_step) of eight numbers.
#[inline]
pub fn smooth_step(s: f32x8) -> f32x8 {
    let s = s.fast_max(f32x8::ZERO).fast_min(f32x8::ONE);
    s * s * (f32x8::splat(3.0) - (s + s))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation;
    use glam::{Quat, Vec3};
    use proptest::prelude::*;

    fn eight() -> impl Strategy<Value = [Vec3; LANES]> {
        let vector = (-1.5_f32..1.5, -1.5_f32..1.5, -1.5_f32..1.5);
        proptest::array::uniform8(vector.prop_map(Vec3::from))
    }

    /// Returns true when every lane is what `glam` makes of it.
    fn agree(found: Quatx8, expected: impl Fn(usize) -> Quat) -> bool {
        (0..LANES).all(|lane| (found.lane(lane) - expected(lane)).length() < 2e-6)
    }

    proptest! {
        #[test]
        fn eight_rotations_are_those_of_each(a in eight(), b in eight()) {
            let exp = |vectors: [Vec3; LANES]| vectors.map(rotation::exp_map);
            let (p, q) = (exp(a), exp(b));
            let [px, qx] = [p, q].map(|all| Quatx8::gather(|lane| all[lane]));
            let [ax, bx] = [a, b].map(|all| Vec3x8::gather(|lane| all[lane]));
            prop_assert!(agree(Quatx8::exp_map(ax), |lane| p[lane]));
            prop_assert!(agree(px * qx, |lane| p[lane] * q[lane]));
            prop_assert!(agree(px.conjugate(), |lane| p[lane].conjugate()));
            prop_assert!(agree(Quatx8::from_rotation_x(ax.x), |lane| Quat::from_rotation_x(a[lane].x)));
            prop_assert!(agree(Quatx8::from_rotation_y(ax.y), |lane| Quat::from_rotation_y(a[lane].y)));
            let arcs = Quatx8::shortest_arc(ax, bx);
            prop_assert!(agree(arcs, |lane| rotation::shortest_arc(a[lane], b[lane])));
            for lane in 0..LANES {
                let (turned, across) = ((px * bx).lane(lane), ax.cross(bx).lane(lane));
                prop_assert!(turned.distance(p[lane] * b[lane]) < 2e-6);
                prop_assert!(across.distance(a[lane].cross(b[lane])) < 2e-6);
            }
        }
    }

    #[test]
    fn rotations_by_up_to_a_whole_turn_are_continuous() {
        let angles = COUNTING * (core::f32::consts::TAU / 7.0);
        let all = Quatx8::from_rotation_y(angles);
        for lane in 0..LANES {
            let turned = all.lane(lane);
            let exact = Quat::from_rotation_y(angles.as_array()[lane]);
            assert!((turned - exact).length() < 3e-4, "{turned} is not {exact}");
        }
    }

    #[test]
    fn rotations_by_any_number_of_turns_are_rotations() {
        let angles = COUNTING * COUNTING * 500.0 - f32x8::splat(9.0);
        let [x, y] = [Quatx8::from_rotation_x, Quatx8::from_rotation_y].map(|all| all(angles));
        assert!(agree(x, |lane| Quat::from_rotation_x(
            angles.as_array()[lane]
        )));
        assert!(agree(y, |lane| Quat::from_rotation_y(
            angles.as_array()[lane]
        )));
    }

    #[test]
    fn lanes_in_which_the_short_way_fails_are_mended_alone() {
        let long = [
            Vec3::X * 3.5,
            Vec3::ZERO,
            Vec3::Y,
            Vec3::new(4.0, -4.0, 1.0),
        ];
        let turned = Quatx8::exp_map(Vec3x8::gather(|lane| long[lane % 4]));
        assert!(agree(turned, |lane| rotation::exp_map(long[lane % 4])));
        let to = [Vec3::NEG_X, Vec3::X, Vec3::ZERO, Vec3::X * f32::INFINITY];
        let arcs =
            Quatx8::shortest_arc(Vec3x8::splat(Vec3::X), Vec3x8::gather(|lane| to[lane % 4]));
        assert!(agree(arcs, |lane| rotation::shortest_arc(
            Vec3::X,
            to[lane % 4]
        )));
        let flat = Vec3x8::gather(|lane| if lane == 5 { Vec3::ZERO } else { Vec3::Z * 2.0 });
        let units = flat.normalize_or(Vec3x8::splat(Vec3::Y));
        for lane in 0..LANES {
            let expected = if lane == 5 { Vec3::Y } else { Vec3::Z };
            assert_eq!(units.lane(lane), expected);
        }
    }
}
