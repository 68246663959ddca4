//! Styles on a body, measured and recorded once for all walkers of a crowd that share them.

use super::frames::CrowdPose;
use super::shared::SharedSteps;
use crate::source::{MeasuredBlend, StyleSpace};
use footfall_core::Skeleton;
use std::sync::{Arc, OnceLock};

/// A mixture of styles on a body, measured once for all walkers of a crowd that share it.
#[derive(Clone, Debug)]
pub struct StyledBody(pub(super) Arc<Styled>, pub(super) u32);

/// The parts of a [`StyledBody`].
#[derive(Debug)]
pub(super) struct Styled {
    pub(super) space: Arc<StyleSpace>,
    pub(super) skeleton: Skeleton,
    pub(super) measured: MeasuredBlend,
    pub(super) shared: OnceLock<SharedSteps>,
}

impl StyledBody {
    /// Sets a number, by which walkers identify the body whose [poses](Self::shared_pose) they share.
    #[must_use]
    pub fn numbered(self, number: u32) -> Self {
        Self(self.0, number)
    }

    /// Returns the number that was set.
    pub const fn number(&self) -> u32 {
        self.1
    }

    /// Returns the number of poses that distant walkers share.
    pub fn shared_poses(&self) -> usize {
        self.0.shared().poses().len()
    }

    /// Writes a shared pose.
    pub fn shared_pose(&self, pose: usize, out: &mut CrowdPose) {
        let pose = &self.0.shared().poses()[pose];
        out.blend(pose, pose, 0.0);
    }

    /// Returns the body.
    pub fn skeleton(&self) -> &Skeleton {
        &self.0.skeleton
    }

    /// Returns the usual speed, that of the recordings, m/s.
    pub fn usual_speed_mps(&self) -> f32 {
        self.0.measured.blend.model.speed.reference_mps as f32
    }
}

impl Styled {
    /// Returns the steps that distant walkers share.
    pub(super) fn shared(&self) -> &SharedSteps {
        self.shared.get_or_init(SharedSteps::default)
    }
}
