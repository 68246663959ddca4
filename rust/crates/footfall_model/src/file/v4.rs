//! Format version 4: a model of an earlier version, and how people stand. Never edited after release: a later format gets a module of its own.

use super::v1::{narrow, widen};
use super::{ModelFileError, undecodable};
use crate::gait_model::GaitModel;
use crate::provenance::Provenance;
use crate::standing::{Breath, Looks, StandingModel, SwayOctave};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct ModelV4 {
    /// The version of the payload that holds all but this.
    walk_version: u32,
    walk: Vec<u8>,
    standing: StandingV4,
}

#[derive(Serialize, Deserialize)]
struct StandingV4 {
    posture: Vec<f32>,
    hips_ahead: f32,
    stance: OctaveV4,
    octaves: Vec<OctaveV4>,
    look_rate_hz: f32,
    look_shift_secs: f32,
    looks: Vec<Vec<f32>>,
    breath_rate_hz: f32,
    breath: Vec<f32>,
    strength_spread: f32,
}

#[derive(Serialize, Deserialize)]
struct OctaveV4 {
    knot_secs: f32,
    directions: Vec<Vec<f32>>,
}

/// `walk` is the payload of the earlier version.
pub(super) fn encode(
    (walk_version, walk): (u32, Vec<u8>),
    standing: &StandingModel,
) -> Result<Vec<u8>, ModelFileError> {
    let rows = |rows: &[Vec<f64>]| rows.iter().map(|row| narrow(row)).collect();
    let octave = |octave: &SwayOctave| OctaveV4 {
        knot_secs: octave.knot_secs as f32,
        directions: rows(&octave.directions),
    };
    let dto = ModelV4 {
        walk_version,
        walk,
        standing: StandingV4 {
            posture: narrow(&standing.posture),
            hips_ahead: standing.hips_ahead as f32,
            stance: octave(&standing.stance),
            octaves: standing.octaves.iter().map(octave).collect(),
            look_rate_hz: standing.looks.rate_hz as f32,
            look_shift_secs: standing.looks.shift_secs as f32,
            looks: rows(&standing.looks.directions),
            breath_rate_hz: standing.breath.rate_hz as f32,
            breath: narrow(&standing.breath.direction),
            strength_spread: standing.strength_spread as f32,
        },
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8], provenance: Provenance) -> Result<GaitModel, ModelFileError> {
    let dto: ModelV4 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    let rows = |rows: &[Vec<f32>]| rows.iter().map(|row| widen(row)).collect();
    let standing = dto.standing;
    let octave = |octave: &OctaveV4| SwayOctave {
        knot_secs: f64::from(octave.knot_secs),
        directions: rows(&octave.directions),
    };
    Ok(GaitModel {
        standing: Some(StandingModel {
            posture: widen(&standing.posture),
            hips_ahead: f64::from(standing.hips_ahead),
            stance: octave(&standing.stance),
            octaves: standing.octaves.iter().map(octave).collect(),
            looks: Looks {
                rate_hz: f64::from(standing.look_rate_hz),
                shift_secs: f64::from(standing.look_shift_secs),
                directions: rows(&standing.looks),
            },
            breath: Breath {
                rate_hz: f64::from(standing.breath_rate_hz),
                direction: widen(&standing.breath),
            },
            strength_spread: f64::from(standing.strength_spread),
        }),
        ..super::decode_walk(dto.walk_version, &dto.walk, provenance)?
    })
}
