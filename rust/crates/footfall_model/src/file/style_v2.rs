//! Format version 2 of a `.footstyle` file's payload: version 1 and how much the style's steps differ. Never edited after
//! release.

use super::style_v1;
use super::v1::{narrow, widen};
use super::{ModelFileError, undecodable};
use crate::provenance::Provenance;
use crate::style::{GaitStyle, StepSpread};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct StyleV2 {
    /// The payload of version 1.
    style: Vec<u8>,
    spread_features: Vec<f32>,
    spread_timing: f32,
}

pub(super) fn encode(style: &GaitStyle) -> Result<Vec<u8>, ModelFileError> {
    let dto = StyleV2 {
        style: style_v1::encode(style)?,
        spread_features: narrow(&style.step_spread.features),
        spread_timing: style.step_spread.timing as f32,
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8], provenance: Provenance) -> Result<GaitStyle, ModelFileError> {
    let dto: StyleV2 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    Ok(GaitStyle {
        step_spread: StepSpread {
            features: widen(&dto.spread_features),
            timing: f64::from(dto.spread_timing),
        },
        ..style_v1::decode(&dto.style, provenance)?
    })
}
