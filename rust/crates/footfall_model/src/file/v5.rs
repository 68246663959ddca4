//! Format version 5: a model of an earlier version, and how its people run. Never edited after release: a later format gets a module of its own.

use super::{ModelFileError, undecodable};
use crate::gait_model::GaitModel;
use crate::provenance::Provenance;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct ModelV5 {
    /// The version of the payload that holds all but the run.
    model_version: u32,
    model: Vec<u8>,
    /// The version of the payload that holds the steps of the run.
    running_version: u32,
    running: Vec<u8>,
    /// Provenance of the run, as JSON like the header's.
    running_provenance: String,
}

/// Both are payloads of earlier versions.
pub(super) fn encode(
    (model_version, model): (u32, Vec<u8>),
    (running_version, running): (u32, Vec<u8>),
    running_provenance: &Provenance,
) -> Result<Vec<u8>, ModelFileError> {
    let running_provenance = serde_json::to_string(running_provenance)
        .map_err(|error| undecodable("payload", &error))?;
    let dto = ModelV5 {
        model_version,
        model,
        running_version,
        running,
        running_provenance,
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8], provenance: Provenance) -> Result<GaitModel, ModelFileError> {
    let dto: ModelV5 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    let of_running = serde_json::from_str(&dto.running_provenance)
        .map_err(|error| undecodable("payload", &error))?;
    let running = super::decode_walk(dto.running_version, &dto.running, of_running)?;
    Ok(GaitModel {
        running: Some(Box::new(running)),
        ..super::decode_standing(dto.model_version, &dto.model, provenance)?
    })
}
