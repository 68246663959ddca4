//! Vectors and rotations between Godot and glam. Both are right-handed with Y up, so only the types differ.

pub(crate) use footfall_core::rotation::of_transform as rotation;
use footfall_ik::placement::Frame;
use glam::{Affine3A, Quat, Vec3};
use godot::builtin::{Basis, Color, Quaternion, Transform3D, Vector3};

/// A point or direction, Godot to glam.
pub(crate) fn vec3(vector: Vector3) -> Vec3 {
    Vec3::new(vector.x, vector.y, vector.z)
}

/// A point or direction, glam to Godot.
pub(crate) fn vector3(vector: Vec3) -> Vector3 {
    Vector3::new(vector.x, vector.y, vector.z)
}

/// A rotation, glam to Godot.
pub(crate) fn quaternion(rotation: Quat) -> Quaternion {
    Quaternion::new(rotation.x, rotation.y, rotation.z, rotation.w)
}

/// A rotation, Godot to glam.
pub(crate) fn quat(rotation: Quaternion) -> Quat {
    Quat::from_xyzw(rotation.x, rotation.y, rotation.z, rotation.w).normalize()
}

/// A transform with its scale, Godot to glam.
pub(crate) fn affine(transform: Transform3D) -> Affine3A {
    let [x, y, z] = [
        transform.basis.col_a(),
        transform.basis.col_b(),
        transform.basis.col_c(),
    ]
    .map(vec3);
    Affine3A::from_mat3_translation(glam::Mat3::from_cols(x, y, z), vec3(transform.origin))
}

/// A rotation and translation, glam to Godot.
pub(crate) fn transform(rotation: Quat, translation: Vec3) -> Transform3D {
    Transform3D::new(
        Basis::from_quaternion(quaternion(rotation)),
        vector3(translation),
    )
}

/// A transform with its scale, glam to Godot.
#[cfg(feature = "editor")]
pub(crate) fn scaled(transform: &Affine3A) -> Transform3D {
    let [x, y, z] = [
        transform.matrix3.x_axis,
        transform.matrix3.y_axis,
        transform.matrix3.z_axis,
    ]
    .map(|axis| vector3(axis.into()));
    Transform3D::new(
        Basis::from_cols(x, y, z),
        vector3(transform.translation.into()),
    )
}

/// A transform without its scale. Unlike Godot's own, it is content with a scale of 0.
pub(crate) fn unscaled(with_scale: Transform3D) -> Transform3D {
    transform(rotation(&affine(with_scale)), vec3(with_scale.origin))
}

/// Returns whether nothing can be seen of what a transform places: it is squashed flat, or not a place at all.
pub(crate) fn is_flat(transform: Transform3D) -> bool {
    const LEAST: f32 = 1e-5;
    let [x, y, z] = [
        transform.basis.col_a(),
        transform.basis.col_b(),
        transform.basis.col_c(),
    ]
    .map(vec3);
    let volume = x.cross(y).dot(z).abs();
    !transform.is_finite() || volume.cbrt() < LEAST
}

/// A transform without its scale, Godot to glam.
pub(crate) fn frame(transform: Transform3D) -> Frame {
    Frame {
        position: vec3(transform.origin),
        rotation: rotation(&affine(transform)),
    }
}

/// A frame, glam to Godot.
pub(crate) fn frame_transform(frame: &Frame) -> Transform3D {
    transform(frame.rotation, frame.position)
}

/// A count as the engine counts.
pub(crate) fn count(count: usize) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX)
}

/// A number, or another where it is none.
pub(crate) const fn finite_or(value: f64, otherwise: f64) -> f64 {
    if value.is_finite() { value } else { otherwise }
}

/// A colour as instances have it.
pub(crate) fn linear(colour: Color) -> [f32; 4] {
    let colour = colour.srgb_to_linear();
    [colour.r, colour.g, colour.b, colour.a]
}
