//! Walking or running, as a property.

use footfall_synth::{Gait, GaitChoice};
use godot::prelude::*;

/// Gait of a character.
#[derive(GodotConvert, Var, Export, Default, Clone, Copy, Debug)]
#[godot(via = i64)]
pub(crate) enum GaitMode {
    #[default]
    Auto = 0,
    Walk = 1,
    Run = 2,
}

impl From<GaitMode> for GaitChoice {
    fn from(mode: GaitMode) -> Self {
        match mode {
            GaitMode::Auto => Self::Auto,
            GaitMode::Walk => Self::Walk,
            GaitMode::Run => Self::Run,
        }
    }
}

/// The name by which scripts know a gait.
pub(super) fn name_of(gait: Gait) -> StringName {
    StringName::from(match gait {
        Gait::Walk => "walk",
        Gait::Run => "run",
    })
}
