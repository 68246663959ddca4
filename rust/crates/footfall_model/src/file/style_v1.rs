//! Format version 1 of a `.footstyle` file's payload. Never edited after release.

use super::v1::{StepV1, decode_step, encode_step, narrow, widen};
use super::{ModelFileError, undecodable};
use crate::gait_model::GlobalVarianceModel;
use crate::provenance::Provenance;
use crate::style::{GaitStyle, StepSpread};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct StyleV1 {
    name: String,
    base_fingerprint: u32,
    steps: [StepV1; 2],
    global_variance_mean: Vec<f32>,
    global_variance_variance: Vec<f32>,
    speed_mps: f32,
    cadence_hz: f32,
}

pub(super) fn encode(style: &GaitStyle) -> Result<Vec<u8>, ModelFileError> {
    let dto = StyleV1 {
        name: style.name.clone(),
        base_fingerprint: style.base_fingerprint,
        steps: style.steps.each_ref().map(encode_step),
        global_variance_mean: narrow(&style.global_variance.mean),
        global_variance_variance: narrow(&style.global_variance.variance),
        speed_mps: style.speed_mps as f32,
        cadence_hz: style.cadence_hz as f32,
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8], provenance: Provenance) -> Result<GaitStyle, ModelFileError> {
    let dto: StyleV1 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    Ok(GaitStyle {
        name: dto.name,
        base_fingerprint: dto.base_fingerprint,
        steps: dto.steps.each_ref().map(decode_step),
        global_variance: GlobalVarianceModel {
            mean: widen(&dto.global_variance_mean),
            variance: widen(&dto.global_variance_variance),
        },
        step_spread: StepSpread::default(),
        speed_mps: f64::from(dto.speed_mps),
        cadence_hz: f64::from(dto.cadence_hz),
        provenance,
    })
}
