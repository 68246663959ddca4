//! Contacts of a step in frames of the model.

use footfall_core::Side;

/// One step in frames of the model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepTiming {
    /// The foot whose initial contact begins the step, at frame 0.
    pub(crate) leading: Side,
    /// Frames until the other foot's initial contact.
    pub(crate) frames: usize,
    /// The last frame in which the other foot is still on the ground from its step before.
    pub(crate) terminal: usize,
    /// Last frame in which the leading foot of a run bears; from then until the end of the step both feet are in the air.
    pub(crate) take_off: Option<usize>,
    /// True in the first step of a run.
    pub(crate) sets_off: bool,
    /// Frames of the leading foot's stance that had passed when the step was replanned; 0 for whole steps.
    pub(crate) borne: usize,
    /// True when the other foot is in the air as the step begins, after it took off in the previous step.
    pub(crate) airborne: bool,
    /// True when both feet bear the body from the end of the step on.
    pub(crate) rests: bool,
}

impl StepTiming {
    /// Returns true when the foot that begins the step bears in a frame of it.
    pub(crate) fn leading_bears(&self, frame: usize) -> bool {
        self.take_off.is_none_or(|last| frame <= last)
    }

    /// Returns true when the other foot still bears in a frame of it.
    pub(crate) fn trailing_bears(&self, frame: usize) -> bool {
        !self.airborne && frame <= self.terminal
    }
}
