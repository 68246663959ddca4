//! Format version 1 of a `.footdyn` file's payload. Never edited after release.

use super::v1::{SkeletonV1, decode_skeleton, encode_skeleton, narrow, widen};
use super::{ModelFileError, undecodable};
use crate::dynamics::{DynamicsModel, Regime};
use crate::provenance::Provenance;
use footfall_prob::subspace::AffineSystem;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct DynamicsV1 {
    frame_rate_hz: f64,
    skeleton: SkeletonV1,
    mean: Vec<f32>,
    components: Vec<Vec<f32>>,
    regimes: [RegimeV1; 2],
}

#[derive(Serialize, Deserialize)]
struct RegimeV1 {
    order: u32,
    /// Transition, drift, output matrix, offset, gain; matrices row by row.
    system: [Vec<f32>; 5],
    starts: Vec<Vec<f32>>,
    /// Of the segments that began so.
    frames: Vec<u32>,
    other_terminal: f32,
}

pub(super) fn encode(model: &DynamicsModel) -> Result<Vec<u8>, ModelFileError> {
    let dto = DynamicsV1 {
        frame_rate_hz: model.frame_rate_hz,
        skeleton: encode_skeleton(&model.skeleton),
        mean: narrow(&model.mean),
        components: narrow_all(&model.components),
        regimes: model.regimes.each_ref().map(|regime| RegimeV1 {
            order: regime.system.order() as u32,
            system: regime.system.to_rows().each_ref().map(|rows| narrow(rows)),
            starts: narrow_all(&regime.starts),
            frames: regime.frames.iter().map(|frames| *frames as u32).collect(),
            other_terminal: regime.other_terminal as f32,
        }),
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(
    payload: &[u8],
    provenance: Provenance,
) -> Result<DynamicsModel, ModelFileError> {
    let dto: DynamicsV1 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    let channels = dto.components.len();
    let [left, right] = dto.regimes;
    Ok(DynamicsModel {
        frame_rate_hz: dto.frame_rate_hz,
        skeleton: decode_skeleton(&dto.skeleton)?,
        mean: widen(&dto.mean),
        components: widen_all(&dto.components),
        regimes: [
            decode_regime(&left, channels)?,
            decode_regime(&right, channels)?,
        ],
        provenance,
    })
}

fn decode_regime(dto: &RegimeV1, channels: usize) -> Result<Regime, ModelFileError> {
    let rows = dto.system.each_ref().map(|rows| widen(rows));
    let rows = rows.each_ref().map(Vec::as_slice);
    // More than a million numbers in a system are no system of ours; the lengths are checked against them.
    let order = (dto.order as usize).min(1000);
    let system = AffineSystem::from_rows(order, channels.min(1000), rows)
        .map_err(|error| undecodable("payload", &error))?;
    Ok(Regime {
        system,
        starts: widen_all(&dto.starts),
        frames: dto.frames.iter().map(|frames| *frames as usize).collect(),
        other_terminal: f64::from(dto.other_terminal),
    })
}

fn narrow_all(rows: &[Vec<f64>]) -> Vec<Vec<f32>> {
    rows.iter().map(|row| narrow(row)).collect()
}

fn widen_all(rows: &[Vec<f32>]) -> Vec<Vec<f64>> {
    rows.iter().map(|row| widen(row)).collect()
}
