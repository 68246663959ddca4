//! Format version 6: a model of an earlier version, and how its people jump and crouch. Never edited after release: a later format gets a module of
//! its own.

use super::v1::{narrow, widen};
use super::{ModelFileError, undecodable};
use crate::crouching::CrouchModel;
use crate::gait_model::GaitModel;
use crate::jumping::{JumpModel, JumpPhase};
use crate::provenance::Provenance;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct ModelV6 {
    /// The version of the payload that holds all but these.
    model_version: u32,
    model: Vec<u8>,
    jump: Option<JumpV6>,
    crouch: Option<CrouchV6>,
}

#[derive(Serialize, Deserialize)]
struct JumpV6 {
    phases: [PhaseV6; 5],
    rise: [f32; 3],
    way: [f32; 3],
}

#[derive(Serialize, Deserialize)]
struct PhaseV6 {
    secs: [f32; 3],
    knots: Vec<[Vec<f32>; 3]>,
}

#[derive(Serialize, Deserialize)]
struct CrouchV6 {
    beside: Vec<f32>,
    fastest: f32,
}

/// `model` is the payload of the earlier version.
pub(super) fn encode(
    (model_version, model): (u32, Vec<u8>),
    jump: Option<&JumpModel>,
    crouch: Option<&CrouchModel>,
) -> Result<Vec<u8>, ModelFileError> {
    let three = |values: &[f64; 3]| values.map(|value| value as f32);
    let phase = |phase: &JumpPhase| PhaseV6 {
        secs: three(&phase.secs),
        knots: phase
            .knots
            .iter()
            .map(|knot| knot.each_ref().map(|row| narrow(row)))
            .collect(),
    };
    let dto = ModelV6 {
        model_version,
        model,
        jump: jump.map(|jump| JumpV6 {
            phases: jump.phases.each_ref().map(phase),
            rise: three(&jump.rise),
            way: three(&jump.way),
        }),
        crouch: crouch.map(|crouch| CrouchV6 {
            beside: narrow(&crouch.beside),
            fastest: crouch.fastest as f32,
        }),
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8], provenance: Provenance) -> Result<GaitModel, ModelFileError> {
    let dto: ModelV6 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    let three = |values: &[f32; 3]| values.map(f64::from);
    let phase = |phase: &PhaseV6| JumpPhase {
        secs: three(&phase.secs),
        knots: phase
            .knots
            .iter()
            .map(|knot| knot.each_ref().map(|row| widen(row)))
            .collect(),
    };
    Ok(GaitModel {
        jump: dto.jump.as_ref().map(|jump| JumpModel {
            phases: jump.phases.each_ref().map(phase),
            rise: three(&jump.rise),
            way: three(&jump.way),
        }),
        crouch: dto.crouch.as_ref().map(|crouch| CrouchModel {
            beside: widen(&crouch.beside),
            fastest: f64::from(crouch.fastest),
        }),
        ..super::decode_running(dto.model_version, &dto.model, provenance)?
    })
}
