//! Format version 3: version 2 and the fine motion. Never edited after release: a later format gets a module of its own.

use super::v1::{narrow, widen};
use super::{ModelFileError, undecodable, v2};
use crate::fine_motion::{FineChance, FineMotion, FineTable};
use crate::gait_model::GaitModel;
use crate::provenance::Provenance;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct ModelV3 {
    /// The payload of version 2.
    trajectories: Vec<u8>,
    fine: FineV3,
}

#[derive(Serialize, Deserialize)]
struct FineV3 {
    /// Left and right step: point by point.
    shared: [Vec<f32>; 2],
    walker: Vec<[Vec<f32>; 2]>,
    kernel: Vec<f32>,
    directions: Vec<Vec<f32>>,
    walker_strength: Vec<f32>,
    scale: Vec<f32>,
}

pub(super) fn encode(model: &GaitModel, fine: &FineMotion) -> Result<Vec<u8>, ModelFileError> {
    let table = |table: &FineTable| table.each_ref().map(|side| narrow(side));
    let dto = ModelV3 {
        trajectories: v2::encode(model)?,
        fine: FineV3 {
            shared: table(&fine.shared),
            walker: fine.walker.iter().map(table).collect(),
            kernel: narrow(&fine.chance.kernel),
            directions: fine
                .chance
                .directions
                .iter()
                .map(|row| narrow(row))
                .collect(),
            walker_strength: narrow(&fine.chance.walker_strength),
            scale: narrow(&fine.scale),
        },
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8], provenance: Provenance) -> Result<GaitModel, ModelFileError> {
    let dto: ModelV3 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    let table = |table: &[Vec<f32>; 2]| table.each_ref().map(|side| widen(side));
    let fine = &dto.fine;
    Ok(GaitModel {
        fine: Some(FineMotion {
            shared: table(&fine.shared),
            walker: fine.walker.iter().map(table).collect(),
            chance: FineChance {
                kernel: widen(&fine.kernel),
                directions: fine.directions.iter().map(|row| widen(row)).collect(),
                walker_strength: widen(&fine.walker_strength),
            },
            scale: widen(&fine.scale),
        }),
        ..v2::decode(&dto.trajectories, provenance)?
    })
}
