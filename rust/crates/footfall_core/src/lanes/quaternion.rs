//! Eight rotations side by side.

use super::{LANES, Vec3x8, f32x8};
use crate::rotation::{self, MAX_SQUARED_HALF_ANGLE, half_angle};
use core::f32::consts::PI;
use core::ops::Mul;
use glam::Quat;
use wide::f32x4;

/// Eight rotations: unit quaternions.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct Quatx8 {
    /// First component of the vector part.
    pub x: f32x8,
    /// Second component of the vector part.
    pub y: f32x8,
    /// Third component of the vector part.
    pub z: f32x8,
    /// Real part.
    pub w: f32x8,
}

impl Quatx8 {
    /// The same rotation in every lane.
    #[inline]
    pub fn splat(rotation: Quat) -> Self {
        Self {
            x: f32x8::splat(rotation.x),
            y: f32x8::splat(rotation.y),
            z: f32x8::splat(rotation.z),
            w: f32x8::splat(rotation.w),
        }
    }

    /// The rotation of one lane.
    #[inline]
    pub fn lane(&self, lane: usize) -> Quat {
        let component = |values: &f32x8| values.as_array()[lane];
        Quat::from_xyzw(
            component(&self.x),
            component(&self.y),
            component(&self.z),
            component(&self.w),
        )
    }

    /// The rotation of each lane.
    #[inline]
    pub fn gather(of_lane: impl Fn(usize) -> Quat) -> Self {
        let four = |first: usize| {
            let rotation = |lane: usize| f32x4::new(of_lane(first + lane).to_array());
            f32x4::transpose(core::array::from_fn(rotation)).map(f32x4::to_array)
        };
        let (low, high) = (four(0), four(LANES / 2));
        let component = |index: usize| {
            let [[a, b, c, d], [e, f, g, h]] = [low[index], high[index]];
            f32x8::new([a, b, c, d, e, f, g, h])
        };
        Self {
            x: component(0),
            y: component(1),
            z: component(2),
            w: component(3),
        }
    }

    /// The rotations of all lanes.
    #[inline]
    pub fn lanes(&self) -> [Quat; LANES] {
        let components = [&self.x, &self.y, &self.z, &self.w].map(f32x8::as_array);
        let four = |first: usize| {
            let component = |values: &[f32; LANES]| {
                f32x4::new(core::array::from_fn(|lane| values[first + lane]))
            };
            let rows = f32x4::transpose(components.map(component));
            rows.map(|rotation| Quat::from_array(rotation.to_array()))
        };
        let [[a, b, c, d], [e, f, g, h]] = [four(0), four(LANES / 2)];
        [a, b, c, d, e, f, g, h]
    }

    /// A quaternion of a vector part and a real part.
    #[inline]
    pub const fn from_parts(vector: Vec3x8, w: f32x8) -> Self {
        let Vec3x8 { x, y, z } = vector;
        Self { x, y, z, w }
    }

    /// The vector part.
    #[inline]
    pub const fn vector(self) -> Vec3x8 {
        let Self { x, y, z, .. } = self;
        Vec3x8 { x, y, z }
    }

    /// These rotations where the mask is set, the others where it is not.
    #[inline]
    pub fn or(self, other: Self, mask: f32x8) -> Self {
        let w = mask.bitselect(self.w, other.w);
        Self::from_parts(self.vector().or(other.vector(), mask), w)
    }

    /// The inverse rotations.
    #[inline]
    pub fn conjugate(self) -> Self {
        Self {
            x: -self.x,
            y: -self.y,
            z: -self.z,
            w: self.w,
        }
    }

    /// Unit quaternions again.
    #[inline]
    pub fn normalize(self) -> Self {
        let squared = self.vector().length_squared() + self.w * self.w;
        let factor = f32x8::ONE / squared.sqrt();
        Self::from_parts(self.vector() * factor, self.w * factor)
    }

    /// The shortest rotations that turn `from` into the direction `to`, as [`shortest_arc`](crate::rotation::shortest_arc).
    #[inline]
    pub fn shortest_arc(from: Vec3x8, to: Vec3x8) -> Self {
        let lengths = (from.length_squared() * to.length_squared()).sqrt();
        let w = lengths + from.dot(to);
        // Also where something is not finite.
        let plain = w.simd_gt(lengths * 1e-6) & lengths.simd_lt(f32x8::splat(f32::MAX));
        let arc = Self::from_parts(from.cross(to), w).normalize();
        arc.mend(plain, |lane| {
            rotation::shortest_arc(from.lane(lane), to.lane(lane))
        })
    }

    /// The rotations about these vectors by their lengths in radians, as [`exp_map`](rotation::exp_map).
    #[inline]
    pub fn exp_map(axis_angles: Vec3x8) -> Self {
        let squared = axis_angles.length_squared() * 0.25;
        let (half_sine_over_angle, cosine) = half_angle(squared);
        let exact = Self::from_parts(axis_angles * half_sine_over_angle, cosine);
        exact.mend(
            squared.simd_lt(f32x8::splat(MAX_SQUARED_HALF_ANGLE)),
            |lane| rotation::exp_map(axis_angles.lane(lane)),
        )
    }

    /// The rotations about +X by angles in radians: exact up to half a turn and beyond a whole one, and to a ten-thousandth at that.
    #[inline]
    pub fn from_rotation_x(angles: f32x8) -> Self {
        let squared = angles * angles * 0.25;
        let (half_sine_over_angle, w) = half_angle(squared);
        let short = Self {
            x: angles * half_sine_over_angle,
            y: f32x8::ZERO,
            z: f32x8::ZERO,
            w,
        };
        short.mend(squared.simd_le(f32x8::splat(PI * PI)), |lane| {
            Quat::from_rotation_x(angles.as_array()[lane])
        })
    }

    /// The rotations about +Y by angles in radians: exact up to half a turn and beyond a whole one, and to a ten-thousandth at that.
    #[inline]
    pub fn from_rotation_y(angles: f32x8) -> Self {
        let squared = angles * angles * 0.25;
        let (half_sine_over_angle, w) = half_angle(squared);
        let short = Self {
            x: f32x8::ZERO,
            y: angles * half_sine_over_angle,
            z: f32x8::ZERO,
            w,
        };
        short.mend(squared.simd_le(f32x8::splat(PI * PI)), |lane| {
            Quat::from_rotation_y(angles.as_array()[lane])
        })
    }

    /// The same rotations where the mask is set, and others where it is not, which is seldom.
    #[inline]
    fn mend(self, mask: f32x8, other: impl Fn(usize) -> Quat) -> Self {
        if mask.all() {
            return self;
        }
        let mask = mask.to_bitmask();
        Self::gather(|lane| {
            if mask & (1 << lane) == 0 {
                other(lane)
            } else {
                self.lane(lane)
            }
        })
    }
}

impl Mul for Quatx8 {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.vector(), other.vector());
        Self::from_parts(
            a.cross(b) + b * self.w + a * other.w,
            self.w * other.w - a.dot(b),
        )
    }
}

impl Mul<Vec3x8> for Quatx8 {
    type Output = Vec3x8;

    #[inline]
    fn mul(self, vector: Vec3x8) -> Vec3x8 {
        let axis = self.vector();
        let turned = axis.cross(vector);
        let twice = turned + turned;
        vector + twice * self.w + axis.cross(twice)
    }
}
