//! Sources of steps: each takes the controls of a step through gait, plan and trajectory to the ground.
//!
//! [`StyledSteps`] are those of a hidden semi-Markov model in a mixture of styles ([`style_space`], [`measured`]); [`window`] plans, solves and plants three steps at a time.
//! [`SwitchingSteps`] are those of two linear systems, which have no plan: a system generates the features directly.

mod buffers;
mod measured;
mod numbered;
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

/// Steps of a walker, by the kind of its model.
#[derive(Debug)]
pub(crate) enum Steps {
    /// A hidden semi-Markov model in styles.
    Styled(Box<StyledSteps>),
    /// Two alternating linear systems.
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
