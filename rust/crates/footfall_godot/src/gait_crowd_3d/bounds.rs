//! A box around walkers, for the engine to cull by.

use crate::convert;
use glam::Vec3;
use godot::builtin::Aabb;

/// A box around places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Default for Bounds {
    fn default() -> Self {
        Self {
            low: Vec3::MAX,
            high: Vec3::MIN,
        }
    }
}

impl Bounds {
    pub(super) fn add(&mut self, place: Vec3) {
        self.low = self.low.min(place);
        self.high = self.high.max(place);
    }

    /// Takes in what another one is around.
    pub(super) fn join(&mut self, other: &Self) {
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
    }

    /// Around the bodies of who stands there.
    pub(super) fn aabb(&self) -> Aabb {
        let (low, high) = (
            self.low - Vec3::new(1.5, 0.5, 1.5),
            self.high + Vec3::new(1.5, 3.0, 1.5),
        );
        if low.x > high.x {
            return Aabb::default();
        }
        Aabb::new(convert::vector3(low), convert::vector3(high - low))
    }
}
