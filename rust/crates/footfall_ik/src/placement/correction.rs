//! Correction of a foot from the flat floor of the animation to the real ground.

use crate::leg::FootTarget;
use crate::placement::frame::Frame;
use glam::{Quat, Vec3};

/// A change of place and tilt, both relative to the sole's place on the animation's floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Correction {
    /// Displacement of the sole, metres.
    pub(crate) shift: Vec3,
    /// Tilt of its floor.
    pub(crate) tilt: Quat,
}

impl Correction {
    pub(crate) const NONE: Self = Self {
        shift: Vec3::ZERO,
        tilt: Quat::IDENTITY,
    };

    /// The one that carries a flat sole to where it lies.
    pub(crate) fn between(flat: &Frame, sole: &Frame) -> Self {
        Self {
            shift: sole.position - flat.position,
            tilt: (sole.rotation * flat.rotation.conjugate()).normalize(),
        }
    }

    /// Moves a foot that belongs over `flat`.
    pub(crate) fn apply(&self, flat: &Frame, foot: &FootTarget) -> FootTarget {
        FootTarget {
            ankle: flat.position + self.shift + self.tilt * (foot.ankle - flat.position),
            foot: (self.tilt * foot.foot).normalize(),
            toes: (self.tilt * foot.toes).normalize(),
        }
    }

    /// Part of the way to another; heights go their own part of it.
    pub(crate) fn toward(&self, other: &Self, share: f32, share_up: f32) -> Self {
        let shares = Vec3::new(share, share_up, share);
        Self {
            shift: self.shift + (other.shift - self.shift) * shares,
            tilt: self.tilt.slerp(other.tilt, share),
        }
    }
}

/// Remainder of a jump, which fades so that nothing pops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Residual {
    pub(crate) ankle: Vec3,
    foot: Quat,
    toes: Quat,
}

impl Residual {
    pub(crate) const NONE: Self = Self {
        ankle: Vec3::ZERO,
        foot: Quat::IDENTITY,
        toes: Quat::IDENTITY,
    };

    /// Remainder that leads from `now` to where the foot was.
    pub(crate) fn of(was: &FootTarget, now: &FootTarget) -> Self {
        Self {
            ankle: was.ankle - now.ankle,
            foot: (was.foot * now.foot.conjugate()).normalize(),
            toes: (was.toes * now.toes.conjugate()).normalize(),
        }
    }

    /// Fades it to this share.
    pub(crate) fn fade(&mut self, share: f32) {
        self.ankle *= share;
        self.foot = Quat::IDENTITY.slerp(self.foot, share);
        self.toes = Quat::IDENTITY.slerp(self.toes, share);
    }

    pub(crate) fn apply(&self, foot: &FootTarget) -> FootTarget {
        FootTarget {
            ankle: foot.ankle + self.ankle,
            foot: (self.foot * foot.foot).normalize(),
            toes: (self.toes * foot.toes).normalize(),
        }
    }
}
