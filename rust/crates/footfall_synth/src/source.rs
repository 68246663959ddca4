//! Sources of steps: styles or two linear systems, each from controls to a step on the ground.

mod buffers;
mod measured;
mod step_source;
mod style_space;
mod styled;
mod switching;
mod window;

pub(crate) use buffers::StepBuffers;
pub(crate) use measured::{MeasuredBlend, measure_paces};
pub(crate) use step_source::StepSource;
pub(crate) use style_space::Blend;
pub use style_space::StyleSpace;
pub(crate) use styled::{StyledSteps, planner_of};
pub(crate) use switching::{SwitchingOrigin, SwitchingSteps};
pub(crate) use window::{Aim, Origin, StepWindow};

/// The kinds of models that walk.
#[derive(Debug)]
pub(crate) enum Steps {
    /// A hidden semi-Markov model in styles.
    Styled(Box<StyledSteps>),
    /// Two linear systems that take turns.
    Switching(Box<SwitchingSteps>),
}

impl Steps {
    pub(crate) fn source(&self) -> &dyn StepSource {
        match self {
            Self::Styled(steps) => &**steps,
            Self::Switching(steps) => &**steps,
        }
    }

    pub(crate) fn source_mut(&mut self) -> &mut dyn StepSource {
        match self {
            Self::Styled(steps) => &mut **steps,
            Self::Switching(steps) => &mut **steps,
        }
    }
}
