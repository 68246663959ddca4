//! Sources of a walker's steps.

use super::styled::StyledSteps;
use super::switching::SwitchingSteps;
use crate::controls::Controls;
use crate::detail::Detail;
use crate::gait::stand::Amplitude;
use crate::gait::{Gait, GaitChoice};
use crate::ground::step::Stage;
use crate::plan::StepShape;
use glam::Vec2;

/// Requirements of the next step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ask {
    /// Travel to the left and forwards from where the walker faces.
    pub(crate) velocity_mps: Vec2,
    pub(crate) turn_rate: f32,
    pub(crate) amplitude: Amplitude,
    pub(crate) gait: GaitChoice,
    /// Rise of the hips in a leap, if it is one, metres.
    pub(crate) leap_m: Option<f32>,
    pub(crate) detail: Detail,
}

impl Ask {
    /// Derives the requirements of the step after one like this from the controls.
    pub(crate) fn after(
        shape: &StepShape,
        controls: Controls,
        fastest_mps: f32,
        detail: Detail,
    ) -> Self {
        Self {
            velocity_mps: controls.velocity().clamp_length_max(fastest_mps),
            turn_rate: controls.turn_rate(),
            amplitude: Amplitude {
                from: shape.amplitude.to,
                to: if controls.is_standing() { 0.0 } else { 1.0 },
            },
            gait: controls.gait,
            leap_m: None,
            detail,
        }
    }

    /// The velocity of the next step, after one of this velocity and gait.
    pub(crate) fn velocity_after(&self, velocity_mps: Vec2, gait: Gait) -> Vec2 {
        self.velocity_within(velocity_mps, gait.most_change_mps())
    }

    /// The velocity of the next step, which differs by so much at most from that of this one.
    pub(crate) fn velocity_within(&self, velocity_mps: Vec2, most_mps: f32) -> Vec2 {
        velocity_mps + (self.velocity_mps - velocity_mps).clamp_length_max(most_mps)
    }
}

/// The next factor on the legs' reach, made of a step and the ground that it is on; `None` when it lies well.
pub(crate) type Stretches<'a> = dyn FnMut(&StepShape, &Stage) -> Option<f32> + 'a;

/// One walker's steps, put on the ground one after the other.
pub(crate) trait StepSource {
    /// The step that is on the ground now.
    fn shape(&self) -> &StepShape;

    /// The ground that it is on.
    fn stage(&self) -> &Stage;

    /// Headings under which the walk goes along +Z, before the current step and after it, radians.
    fn facing(&self) -> [f32; 2];

    /// Fastest speed that it goes at, m/s.
    fn fastest_mps(&self) -> f32;

    /// The gait of the step that is on the ground now.
    fn gait(&self) -> Gait;

    /// Starts over, standing; whether it could.
    fn stand(&mut self, detail: Detail) -> bool;

    /// Goes on to the next step.
    fn advance(&mut self, ask: &Ask);

    /// Has the rest of the current step obey something new from a frame of it on; whether it does. The step then begins with that frame.
    fn replan(&mut self, _ask: &Ask, _frame: usize) -> bool {
        false
    }

    /// Leaves the current step as it is, whatever else is asked for.
    fn keep(&mut self) {}

    /// Returns whether so much else is asked for that the current step would obey it where it can.
    fn is_news(&self, _ask: &Ask) -> bool {
        false
    }

    /// Puts the current step on the ground anew, again and again, with the factors on the legs' reach that `next` makes of where it
    /// lies; the walk goes on from the speed that this gives. Before, it becomes quicker by the factor
    /// `haste` and shorter by as much, which is the same speed. The first step of all stays as it is.
    fn stretch(&mut self, haste: f32, next: &mut Stretches<'_>);
}

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
