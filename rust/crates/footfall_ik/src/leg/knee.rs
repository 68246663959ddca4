//! The knee: the axis that it bends about, and by how much, of eight legs.

use footfall_core::lanes::{Quatx8, Vec3x8, f32x8};
use glam::Vec3;

/// The axis about which the shank turns backwards from the thigh, a unit vector.
///
/// `thigh` is the thigh's direction and `bent` its cross product with the shank's. A nearly straight leg has no plane of
/// its own; the thigh's own x axis (the left of a leg in the T-pose) takes over smoothly.
pub(super) fn knee_hinge(thigh: Vec3x8, bent: Vec3x8, thigh_rotation: Quatx8) -> Vec3x8 {
    let anatomical = thigh_rotation * Vec3x8::splat(Vec3::X);
    // A hyperextended knee must not be taken for one that bends forwards.
    let bent = bent - anatomical * bent.dot(anatomical).fast_min(f32x8::ZERO);
    // Below about 6 degrees of bend the plane is mostly noise.
    let share = f32x8::splat(0.1) - bent.length();
    let blended = bent + anatomical * share.fast_max(f32x8::ZERO);
    let across = blended - thigh * blended.dot(thigh);
    across.normalize_or(anatomical)
}

/// Eight angles, by cosine and sine.
#[derive(Clone, Copy)]
pub(super) struct Angle {
    pub(super) cosine: f32x8,
    pub(super) sine: f32x8,
}

impl Angle {
    /// The knee's bend (0 when straight) in a triangle with these two sides and the opposite third.
    pub(super) fn between(thigh: f32, shank: f32, opposite: f32x8) -> Self {
        let squares = f32x8::splat(thigh * thigh + shank * shank);
        let cosine = (opposite * opposite - squares) * f32x8::splat((2.0 * thigh * shank).recip());
        let cosine = cosine.fast_max(-f32x8::ONE).fast_min(f32x8::ONE);
        Self {
            cosine,
            sine: (f32x8::ONE - cosine * cosine).sqrt(),
        }
    }

    /// The same angle of cosine and sine that are too long or too short alike.
    pub(super) fn normalize(self) -> Self {
        let squared = self.cosine * self.cosine + self.sine * self.sine;
        let some = squared.simd_gt(f32x8::splat(f32::MIN_POSITIVE));
        let factor = f32x8::ONE / squared.sqrt();
        Self {
            cosine: some.bitselect(self.cosine * factor, f32x8::ONE),
            sine: some.bitselect(self.sine * factor, f32x8::ZERO),
        }
    }

    /// This angle less another.
    pub(super) fn less(self, other: Self) -> Self {
        Self {
            cosine: self.cosine * other.cosine + self.sine * other.sine,
            sine: self.sine * other.cosine - self.cosine * other.sine,
        }
    }

    /// The rotation by it about a unit axis.
    pub(super) fn about(self, axis: Vec3x8) -> Quatx8 {
        let half = f32x8::splat(0.5);
        let cosine = (half + half * self.cosine).fast_max(f32x8::ZERO).sqrt();
        // The sine of half an angle from its own side of the formula that keeps its digits.
        let from_sine = half * self.sine / cosine;
        let from_cosine = (half - half * self.cosine).fast_max(f32x8::ZERO).sqrt();
        let sine = cosine
            .simd_gt(half)
            .bitselect(from_sine, from_cosine.copysign(self.sine));
        Quatx8::from_parts(axis * sine, cosine)
    }
}
