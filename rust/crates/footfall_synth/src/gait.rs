//! Walking and running, and the choice between them.

mod applied;
mod chooser;
mod direction;
mod kinds;
mod pace;
mod request;
mod stand;

pub(crate) use applied::AppliedControls;
pub(crate) use chooser::StepChooser;
pub(crate) use direction::{overstep, pelvis_turn, seen_from_pelvis};
pub use kinds::Gait;
pub(crate) use kinds::{FASTEST_WALK_MPS, GRAVITY_MPS2, STOPPABLE_MPS, WIDEST_RUN_RAD};
pub(crate) use pace::{Pace, PaceTable, SAMPLES, tempo_and_stride};
pub(crate) use request::{Manner, StepControls, StepRequest};
pub(crate) use stand::{Amplitude, Posture, standing_features, standing_posture};
