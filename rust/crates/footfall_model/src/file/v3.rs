//! Format version 3: version 2 and the fine motion. Never edited after release: a later format gets a module of its own.

use super::v1::{narrow, widen};
use super::{ModelFileError, undecodable, v2};
use crate::fine_motion::{FINE_TAPS, FineChance, FineMotion, FineTable};
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
            kernel: narrow(&fine.chance.kernels.concat()),
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
                kernels: kernels(&fine.kernel, fine.directions.len()),
                directions: fine.directions.iter().map(|row| widen(row)).collect(),
                walker_strength: widen(&fine.walker_strength),
            },
            scale: widen(&fine.scale),
        }),
        ..v2::decode(&dto.trajectories, provenance)?
    })
}

/// Kernels one after the other. A file with a single one means it for every direction.
fn kernels(weights: &[f32], directions: usize) -> Vec<Vec<f64>> {
    if weights.len() == FINE_TAPS {
        return vec![widen(weights); directions];
    }
    weights.chunks(FINE_TAPS).map(widen).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_kernel_serves_every_direction() {
        let one: Vec<f32> = (0..FINE_TAPS).map(|tap| tap as f32).collect();
        assert_eq!(kernels(&one, 3), vec![widen(&one); 3]);
        let two: Vec<f32> = (0..2 * FINE_TAPS).map(|tap| tap as f32).collect();
        let found = kernels(&two, 2);
        assert_eq!(found.len(), 2);
        assert_eq!(found[1], widen(&two[FINE_TAPS..]));
    }
}
