//! Gaits: from controls to the request for the next step.
//!
//! [`StepControls`] are the controls that one step can follow. [`StepChooser`] makes a [`StepRequest`] of them: standing or walking on ([`stand`]), walking or running
//! ([`kinds`]), the velocity that the step reaches, and the pace for it ([`pace`], measured once for each body; [`gaining`], [`slowing`]). A jump off one foot is a request too ([`StepRequest::leap_m`]).

mod applied;
mod chooser;
mod direction;
mod first_foot;
mod gaining;
mod kinds;
mod pace;
mod request;
mod slowing;
mod stand;

pub(crate) use applied::AppliedControls;
pub(crate) use chooser::StepChooser;
pub(crate) use direction::{overstep, pelvis_turn, seen_from_pelvis};
pub(crate) use first_foot::lifts_other_foot;
pub use kinds::Gait;
pub(crate) use kinds::{FASTEST_WALK_MPS, GRAVITY_MPS2, STOPPABLE_MPS, WIDEST_RUN_RAD};
pub(crate) use pace::{Pace, PaceTable, SAMPLES, tempo_and_stride};
pub(crate) use request::{Manner, Passed, StepControls, StepRequest};
pub(crate) use stand::{Amplitude, Posture, mean_posture, standing_features, standing_posture};
