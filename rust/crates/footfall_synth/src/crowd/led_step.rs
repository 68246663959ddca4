//! A step to repeat: its number, controls and aim.

use crate::controls::Controls;
use crate::source::{Aim, StepBuffers, StepWindow};
use footfall_core::GroundTransform;

/// Aim of a led step. A place is that of the landing foot, under the walker's heading at the end of the step, relative to the start of the walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LedAim {
    /// The step keeps its own end.
    None,
    /// The foot lands at this place.
    Place(GroundTransform),
    /// The walker comes to rest at this place.
    Rest(GroundTransform),
    /// The end of the step is moved by this transform, by which the previous one ended elsewhere.
    Moved(GroundTransform),
}

/// A step to repeat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedStep {
    /// [Number](crate::CrowdWalker::number) of the step.
    pub number: u16,
    /// Controls of the step.
    pub controls: Controls,
    /// Aim of the step. One step deviates by at most 0.2 m and 20°.
    pub aim: LedAim,
}

/// Moment of a walk at which to begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedBeginning {
    /// [Number](crate::CrowdWalker::number) of the step.
    pub number: u16,
    /// Share of the step that has passed, from 0 to 1.
    pub share: f32,
    /// Controls of the step. Their gait is used unchanged.
    pub controls: Controls,
    /// True for a resting walker.
    pub rests: bool,
}

impl LedAim {
    /// Displaces a step that was just generated towards the aim.
    pub(super) fn take(
        &self,
        plan_from_start: &GroundTransform,
        window: &mut StepWindow,
        buffers: &mut StepBuffers,
    ) {
        let place = match self {
            Self::None => return,
            Self::Place(place) | Self::Rest(place) => *place,
            Self::Moved(by) => {
                by.global(&window.planted().aim(plan_from_start, window.step(), false))
            }
        };
        let aim = Aim {
            place,
            rests: matches!(self, Self::Rest(_)),
        };
        window.aim_at(&aim, plan_from_start, buffers);
    }
}
