//! Rotations: exponential map, heading, and the shortest turn between directions.
//!
//! The exponential map writes a rotation as axis times angle (Tilmanne et al. 2012, equation 1). It is locally linear
//! and has no singularity below a full turn, so statistics over it mean something.

use core::f32::consts::{PI, TAU};
use glam::{Quat, Vec3};

/// The rotation about `axis_angle`'s direction by its length in radians.
pub fn exp_map(axis_angle: Vec3) -> Quat {
    // Up to half a turn and a little more, cosine and sine over the angle are short polynomials of its square, exact to
    // the last digit of f32; the generator does this for every joint of every frame.
    let x = 0.25 * axis_angle.length_squared();
    if x > 2.6 {
        return Quat::from_scaled_axis(axis_angle);
    }
    let horner = |coefficients: [f32; 7]| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let cosine = horner([
        1.0,
        -1.0 / 2.0,
        1.0 / 24.0,
        -1.0 / 720.0,
        1.0 / 40_320.0,
        -1.0 / 3_628_800.0,
        1.0 / 479_001_600.0,
    ]);
    let sine_over_angle = horner([
        1.0,
        -1.0 / 6.0,
        1.0 / 120.0,
        -1.0 / 5_040.0,
        1.0 / 362_880.0,
        -1.0 / 39_916_800.0,
        1.605_904_4e-10, // 1 / 13!
    ]);
    Quat::from_vec4((axis_angle * (0.5 * sine_over_angle)).extend(cosine))
}

/// Axis times angle of a rotation, with the angle in [0, π].
pub fn log_map(rotation: Quat) -> Vec3 {
    let shortest = if rotation.w < 0.0 {
        -rotation
    } else {
        rotation
    };
    shortest.to_scaled_axis()
}

/// Axis times angle of a rotation, among all that mean the same rotation the one nearest to `reference`.
///
/// Keeps a series continuous where the angle crosses π.
pub fn log_map_near(rotation: Quat, reference: Vec3) -> Vec3 {
    let base = log_map(rotation);
    let angle = base.length();
    if angle < 1e-6 {
        return base;
    }
    let axis = base / angle;
    [-1.0, 0.0, 1.0]
        .map(|turns| axis * (angle + turns * TAU))
        .into_iter()
        .min_by(|a, b| {
            a.distance_squared(reference)
                .total_cmp(&b.distance_squared(reference))
        })
        .unwrap_or(base)
}

/// Heading of a rotation: its twist about +Y in radians, positive from +Z towards +X (to the character's left).
pub fn heading(world_from_body: Quat) -> f32 {
    wrap_angle(2.0 * world_from_body.y.atan2(world_from_body.w))
}

/// The rotation about +Y by `heading` radians.
pub fn from_heading(heading: f32) -> Quat {
    Quat::from_rotation_y(heading)
}

/// The same angle in (-π, π].
pub fn wrap_angle(angle: f32) -> f32 {
    let wrapped = angle - TAU * (angle / TAU).round();
    if wrapped <= -PI {
        wrapped + TAU
    } else {
        wrapped
    }
}

/// The shortest rotation that turns the direction `from` into the direction `to`; neither need be a unit vector.
pub fn shortest_arc(from: Vec3, to: Vec3) -> Quat {
    let (Some(from), Some(to)) = (from.try_normalize(), to.try_normalize()) else {
        return Quat::IDENTITY;
    };
    // glam's own takes angles below 0.7 mrad for none, which at the end of a leg is half a millimetre.
    let w = 1.0 + from.dot(to);
    if w < 1e-6 {
        return Quat::from_axis_angle(from.any_orthonormal_vector(), PI);
    }
    let axis = from.cross(to);
    Quat::from_xyzw(axis.x, axis.y, axis.z, w).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn log_undoes_exp(x in -1.8_f32..1.8, y in -1.8_f32..1.8, z in -1.8_f32..1.8) {
            let vector = Vec3::new(x, y, z);
            prop_assume!(vector.length() < PI - 1e-2);
            prop_assert!(log_map(exp_map(vector)).distance(vector) < 1e-3);
        }

        #[test]
        fn unwrapping_stays_near_the_reference(x in -3.0_f32..3.0, y in -3.0_f32..3.0, z in -3.0_f32..3.0) {
            let vector = Vec3::new(x, y, z);
            let near = log_map_near(exp_map(vector), vector);
            prop_assert!(near.distance(vector) < 5e-3, "{near} is not {vector}");
        }

        #[test]
        fn heading_survives_the_round_trip(angle in -3.1_f32..3.1) {
            prop_assert!((heading(from_heading(angle)) - angle).abs() < 1e-4);
        }
    }

    #[test]
    fn the_exponential_map_is_exact_at_every_angle() {
        for step in 0..2000 {
            let vector = Vec3::new(0.6, -0.64, 0.48) * (step as f32 * 0.003);
            let (fast, exact) = (exp_map(vector), Quat::from_scaled_axis(vector));
            let apart = (fast - exact).length().min((fast + exact).length());
            assert!(apart < 5e-7, "{vector}: {fast} is not {exact}");
        }
    }

    #[test]
    fn shortest_arcs_are_exact_for_small_and_for_opposite_directions() {
        for angle in [1e-5_f32, 1e-4, 0.3, 3.0] {
            let to = Quat::from_rotation_x(angle) * Vec3::Y;
            let turned = shortest_arc(Vec3::Y, to) * Vec3::Y;
            assert!(turned.distance(to) < 2e-7, "{angle}: {turned} is not {to}");
        }
        let back = shortest_arc(Vec3::Z, Vec3::NEG_Z * 2.0) * Vec3::Z;
        assert!(back.distance(Vec3::NEG_Z) < 1e-6);
        assert_eq!(shortest_arc(Vec3::ZERO, Vec3::X), Quat::IDENTITY);
    }

    #[test]
    fn heading_is_positive_to_the_left() {
        let forward = from_heading(0.5) * Vec3::Z;
        assert!(forward.x > 0.0);
        assert!((wrap_angle(3.0 * PI) - PI).abs() < 1e-5);
    }
}
