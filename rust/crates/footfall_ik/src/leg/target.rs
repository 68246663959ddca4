//! Targets of feet.

use footfall_core::lanes::{LANES, Quatx8, Vec3x8};
use glam::{Quat, Vec3};

/// Target of a foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootTarget {
    /// Position of the ankle (the `Foot` joint) in model space, metres.
    pub ankle: Vec3,
    /// `model_from_foot` rotation.
    pub foot: Quat,
    /// `model_from_toes` rotation.
    pub toes: Quat,
}

/// Targets of a foot in [eight frames](footfall_core::lanes).
#[derive(Clone, Copy, Debug)]
pub struct FootTargetx8 {
    /// Positions of the ankle, metres.
    pub ankle: Vec3x8,
    /// `model_from_foot` rotations.
    pub foot: Quatx8,
    /// `model_from_toes` rotations.
    pub toes: Quatx8,
}

impl FootTargetx8 {
    /// The same target in every frame.
    pub fn splat(target: &FootTarget) -> Self {
        Self {
            ankle: Vec3x8::splat(target.ankle),
            foot: Quatx8::splat(target.foot),
            toes: Quatx8::splat(target.toes),
        }
    }

    /// The targets of all frames.
    #[inline]
    pub fn lanes(&self) -> [FootTarget; LANES] {
        let (foot, toes) = (self.foot.lanes(), self.toes.lanes());
        core::array::from_fn(|lane| FootTarget {
            ankle: self.ankle.lane(lane),
            foot: foot[lane],
            toes: toes[lane],
        })
    }

    /// The target of one frame.
    #[inline]
    pub fn lane(&self, lane: usize) -> FootTarget {
        FootTarget {
            ankle: self.ankle.lane(lane),
            foot: self.foot.lane(lane),
            toes: self.toes.lane(lane),
        }
    }
}
