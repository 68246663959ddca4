//! Detail of a walk.

use footfall_synth::Detail;
use godot::prelude::*;

/// Share of a walk's frames that are computed.
#[derive(GodotConvert, Var, Export, Default, Clone, Copy, Debug)]
#[godot(via = i64)]
pub(crate) enum GaitDetail {
    #[default]
    Full = 0,
    Half = 1,
    Quarter = 2,
}

impl From<GaitDetail> for Detail {
    fn from(detail: GaitDetail) -> Self {
        match detail {
            GaitDetail::Full => Self::Full,
            GaitDetail::Half => Self::Half,
            GaitDetail::Quarter => Self::Quarter,
        }
    }
}
