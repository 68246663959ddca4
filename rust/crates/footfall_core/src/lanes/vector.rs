//! Eight vectors side by side.

use super::{LANES, f32x8};
use core::ops::{Add, Mul, Sub};
use glam::Vec3;

/// Eight vectors.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct Vec3x8 {
    /// To the left, where a character faces +Z.
    pub x: f32x8,
    /// Up.
    pub y: f32x8,
    /// Ahead.
    pub z: f32x8,
}

impl Vec3x8 {
    /// The same vector in every lane.
    #[inline]
    pub fn splat(vector: Vec3) -> Self {
        Self {
            x: f32x8::splat(vector.x),
            y: f32x8::splat(vector.y),
            z: f32x8::splat(vector.z),
        }
    }

    /// The vector of one lane.
    #[inline]
    pub fn lane(&self, lane: usize) -> Vec3 {
        let component = |values: &f32x8| values.as_array()[lane];
        Vec3::new(component(&self.x), component(&self.y), component(&self.z))
    }

    /// The vector of each lane.
    #[inline]
    pub fn gather(of_lane: impl Fn(usize) -> Vec3) -> Self {
        let [mut x, mut y, mut z] = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            [x[lane], y[lane], z[lane]] = of_lane(lane).to_array();
        }
        Self {
            x: f32x8::new(x),
            y: f32x8::new(y),
            z: f32x8::new(z),
        }
    }

    /// Scalar product.
    #[inline]
    pub fn dot(self, other: Self) -> f32x8 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    #[inline]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// Squared length.
    #[inline]
    pub fn length_squared(self) -> f32x8 {
        self.dot(self)
    }

    /// Length.
    #[inline]
    pub fn length(self) -> f32x8 {
        self.length_squared().sqrt()
    }

    /// Unit vectors in these directions, and `otherwise` where there is no direction.
    #[inline]
    pub fn normalize_or(self, otherwise: Self) -> Self {
        let length = self.length();
        let some = length.simd_gt(f32x8::splat(f32::MIN_POSITIVE));
        (self * (f32x8::ONE / length)).or(otherwise, some)
    }

    /// These vectors where the mask is set, the others where it is not.
    #[inline]
    pub fn or(self, other: Self, mask: f32x8) -> Self {
        Self {
            x: mask.bitselect(self.x, other.x),
            y: mask.bitselect(self.y, other.y),
            z: mask.bitselect(self.z, other.z),
        }
    }
}

impl Add for Vec3x8 {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }
}

impl Sub for Vec3x8 {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }
}

impl Mul<f32x8> for Vec3x8 {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f32x8) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
        }
    }
}
