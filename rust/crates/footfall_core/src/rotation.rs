//! Rotations: exponential map, heading, and the shortest turn between directions.
//!
//! The exponential map writes a rotation as axis times angle (Tilmanne et al. 2012, equation 1). It is locally linear
//! and has no singularity below a full turn, so statistics over it mean something.

use crate::joint::JOINT_COUNT;
use core::f32::consts::{PI, TAU};
use core::ops::{Add, Mul};
use glam::{Affine3A, Mat3, Quat, Vec3};
use multiversion::multiversion;

/// Largest square of half an angle for which the polynomials below are exact to the last digit of f32: a little more than
/// half a turn.
pub(crate) const MAX_SQUARED_HALF_ANGLE: f32 = 2.6;

/// The rotation about `axis_angle`'s direction by its length in radians.
pub fn exp_map(axis_angle: Vec3) -> Quat {
    let squared = 0.25 * axis_angle.length_squared();
    if squared > MAX_SQUARED_HALF_ANGLE {
        return Quat::from_scaled_axis(axis_angle);
    }
    let (half_sine_over_angle, cosine) = half_angle(squared);
    Quat::from_vec4((axis_angle * half_sine_over_angle).extend(cosine))
}

/// [`exp_map`] of many vectors, three numbers each: what the generator does for every joint of every frame.
///
/// Writes as many rotations as both slices have room for.
pub fn exp_maps(axis_angles: &[f32], out: &mut [Quat]) {
    let vectors = axis_angles.as_chunks::<3>().0;
    for (vectors, rotations) in vectors.chunks(LANES).zip(out.chunks_mut(LANES)) {
        if exp_block(vectors, rotations) {
            continue;
        }
        for (rotation, vector) in rotations.iter_mut().zip(vectors) {
            *rotation = exp_map(Vec3::from_array(*vector));
        }
    }
}

/// Vectors that are turned into rotations side by side: all joints of a body.
const LANES: usize = JOINT_COUNT.next_multiple_of(8);

/// The polynomials for a block of vectors, in a form that compilers turn into vector instructions; returns whether they are exact for all.
#[multiversion(targets("x86_64+avx2+fma", "aarch64+neon"))]
fn exp_block(vectors: &[[f32; 3]], out: &mut [Quat]) -> bool {
    let [mut half_sines, mut cosines, mut squares] = [[0.0_f32; LANES]; 3];
    for (square, [x, y, z]) in squares.iter_mut().zip(vectors) {
        *square = 0.25 * (x * x + y * y + z * z);
    }
    let mut exact = true;
    for lane in 0..LANES {
        exact &= squares[lane] <= MAX_SQUARED_HALF_ANGLE;
        (half_sines[lane], cosines[lane]) = half_angle(squares[lane]);
    }
    let scales = half_sines.iter().zip(&cosines);
    for ((rotation, [x, y, z]), (scale, cosine)) in out.iter_mut().zip(vectors).zip(scales) {
        *rotation = Quat::from_xyzw(x * scale, y * scale, z * scale, *cosine);
    }
    exact
}

/// Half of sine over angle, and cosine, of half an angle whose square is given: short polynomials in that square, for one number or for the
/// [eight](crate::lanes) of a vector register.
#[inline(always)]
#[expect(
    clippy::inline_always,
    reason = "only what is inlined into the dispatched function is compiled for its instruction set"
)]
pub(crate) fn half_angle<T>(squared: T) -> (T, T)
where
    T: Copy + From<f32> + Add<Output = T> + Mul<Output = T>,
{
    let horner = |coefficients: [f32; 7]| {
        let [lower @ .., last] = coefficients;
        let terms = lower.into_iter().rev().map(T::from);
        terms.fold(T::from(last), |sum, coefficient| {
            sum * squared + coefficient
        })
    };
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
    (T::from(0.5) * sine_over_angle, cosine)
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
#[inline]
pub fn from_heading(heading: f32) -> Quat {
    Quat::from_rotation_y(heading)
}

/// Angles that are nearer to 0 are in (-π, π], however they are rounded.
const NEARLY_PI: f32 = 0.999 * PI;

/// The same angle in (-π, π].
#[inline]
pub fn wrap_angle(angle: f32) -> f32 {
    if angle.abs() < NEARLY_PI {
        return angle;
    }
    let wrapped = angle - TAU * (angle / TAU).round();
    if wrapped <= -PI {
        wrapped + TAU
    } else {
        wrapped
    }
}

/// The blend of a rotation towards one that is near and written with the same sign, and its squared length before it was made a unit
/// quaternion.
#[inline]
pub fn blend_near(from: Quat, to: Quat, weight: f32) -> (Quat, f32) {
    let sum = from * (1.0 - weight) + to * weight;
    let squared = sum.length_squared();
    // One step of Newton's method towards unit length, which a blend of neighbours nearly has.
    (sum * (1.5 - 0.5 * squared), squared)
}

/// The shortest rotation that turns the direction `from` into the direction `to`; neither need be a unit vector.
pub fn shortest_arc(from: Vec3, to: Vec3) -> Quat {
    // Everything is multiplied by the product of both lengths. glam's own takes angles below 0.7 mrad for none, which at
    // the end of a leg is half a millimetre.
    let lengths = (from.length_squared() * to.length_squared()).sqrt();
    if lengths < f32::MIN_POSITIVE || !lengths.is_finite() {
        return Quat::IDENTITY;
    }
    let w = lengths + from.dot(to);
    if w < 1e-6 * lengths {
        return Quat::from_axis_angle(from.normalize().any_orthonormal_vector(), PI);
    }
    Quat::from_vec4(from.cross(to).extend(w)).normalize()
}

/// The rotation of a transform, its scale removed.
pub fn of_transform(transform: &Affine3A) -> Quat {
    let columns = Mat3::from(transform.matrix3);
    // Gram-Schmidt in Godot's own order, so that the frame is the one that `Basis.orthonormalized()` gives.
    let x = columns.x_axis.normalize_or(Vec3::X);
    let y = (columns.y_axis - x * x.dot(columns.y_axis)).normalize_or(x.any_orthonormal_vector());
    Quat::from_mat3(&Mat3::from_cols(x, y, x.cross(y))).normalize()
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
    fn many_exponential_maps_are_those_of_each() {
        for count in [0, 1, 8, 22] {
            let vectors: Vec<f32> = (0..3 * count)
                .map(|i| (i as f32 * 1.7).sin() * 2.5)
                .collect();
            let mut rotations = vec![Quat::IDENTITY; count];
            exp_maps(&vectors, &mut rotations);
            for (rotation, vector) in rotations.iter().zip(vectors.chunks_exact(3)) {
                let apart = (*rotation - exp_map(Vec3::from_slice(vector))).length();
                assert!(apart < 1e-6, "{vector:?}");
            }
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

    #[test]
    fn a_scale_does_not_change_the_rotation_of_a_transform() {
        let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.4, -1.1, 2.0);
        for scale in [
            Vec3::ONE,
            Vec3::splat(0.01),
            Vec3::new(2.0, 0.5, 3.0),
            Vec3::new(1.0, 1.0, -1.0),
        ] {
            let transform = Affine3A::from_scale_rotation_translation(scale, turn, Vec3::X);
            let found = of_transform(&transform);
            assert!(found.angle_between(turn) < 1e-3, "{scale}: {found}");
        }
        let flat = Affine3A::from_scale(Vec3::ZERO);
        assert!(of_transform(&flat).is_normalized());
    }
}
