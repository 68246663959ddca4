//! Format version 1. Never edited after release: a later format gets a module of its own.

use super::{ModelFileError, undecodable};
use crate::gait_model::{
    GaitModel, GlobalVarianceModel, SpeedResponse, StateModel, StepModel, StepOffset, Variation,
};
use crate::layout::OBSERVATION_COUNT;
use crate::provenance::Provenance;
use footfall_core::{FootShape, JOINT_COUNT, Skeleton};
use footfall_prob::windows::Windows;
use glam::Vec3;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct ModelV1 {
    frame_rate_hz: f64,
    skeleton: SkeletonV1,
    compact_windows: bool,
    steps: [StepV1; 2],
    global_variance_mean: Vec<f32>,
    global_variance_variance: Vec<f32>,
    speed: SpeedV1,
    walker: Vec<[Vec<f32>; 2]>,
    step: Vec<[Vec<f32>; 2]>,
    step_correlation: f32,
}

#[derive(Serialize, Deserialize)]
pub(super) struct SkeletonV1 {
    offsets: Vec<[f32; 3]>,
    /// Heel, ball, toe tip; left, then right.
    feet: [[[f32; 3]; 3]; 2],
    head_top: [f32; 3],
}

#[derive(Serialize, Deserialize)]
pub(super) struct StepV1 {
    states: Vec<StateV1>,
    other_terminal: f32,
}

#[derive(Serialize, Deserialize)]
struct StateV1 {
    mean: Vec<f32>,
    variance: Vec<f32>,
    duration: [f32; 2],
}

#[derive(Serialize, Deserialize)]
struct SpeedV1 {
    reference_mps: f32,
    min_mps: f32,
    max_mps: f32,
    cadence_range_hz: [f32; 2],
    slopes: [Vec<f32>; 2],
}

pub(super) fn encode(model: &GaitModel) -> Result<Vec<u8>, ModelFileError> {
    let offsets = |pairs: &[[StepOffset; 2]]| {
        pairs
            .iter()
            .map(|pair| pair.each_ref().map(|offset| narrow(&offset.to_row())))
            .collect()
    };
    let dto = ModelV1 {
        frame_rate_hz: model.frame_rate_hz,
        skeleton: encode_skeleton(&model.skeleton),
        compact_windows: model.windows == Windows::Compact,
        steps: model.steps.each_ref().map(encode_step),
        global_variance_mean: narrow(&model.global_variance.mean),
        global_variance_variance: narrow(&model.global_variance.variance),
        speed: SpeedV1 {
            reference_mps: model.speed.reference_mps as f32,
            min_mps: model.speed.min_mps as f32,
            max_mps: model.speed.max_mps as f32,
            cadence_range_hz: model.speed.cadence_range_hz.map(|cadence| cadence as f32),
            slopes: model
                .speed
                .slopes
                .each_ref()
                .map(|slope| narrow(&slope.to_row())),
        },
        walker: offsets(&model.variation.walker),
        step: offsets(&model.variation.step),
        step_correlation: model.variation.step_correlation as f32,
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8], provenance: Provenance) -> Result<GaitModel, ModelFileError> {
    let dto: ModelV1 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    Ok(GaitModel {
        frame_rate_hz: dto.frame_rate_hz,
        skeleton: decode_skeleton(&dto.skeleton)?,
        windows: if dto.compact_windows {
            Windows::Compact
        } else {
            Windows::Paper
        },
        steps: dto.steps.each_ref().map(decode_step),
        global_variance: GlobalVarianceModel {
            mean: widen(&dto.global_variance_mean),
            variance: widen(&dto.global_variance_variance),
        },
        speed: SpeedResponse {
            reference_mps: f64::from(dto.speed.reference_mps),
            min_mps: f64::from(dto.speed.min_mps),
            max_mps: f64::from(dto.speed.max_mps),
            cadence_range_hz: dto.speed.cadence_range_hz.map(f64::from),
            slopes: decode_pair(&dto.speed.slopes)?,
        },
        variation: Variation {
            walker: dto
                .walker
                .iter()
                .map(decode_pair)
                .collect::<Result<_, _>>()?,
            step: dto.step.iter().map(decode_pair).collect::<Result<_, _>>()?,
            step_correlation: f64::from(dto.step_correlation),
        },
        contexts: Vec::new(),
        fine: None,
        standing: None,
        running: None,
        jump: None,
        crouch: None,
        provenance,
    })
}

pub(super) fn encode_skeleton(skeleton: &Skeleton) -> SkeletonV1 {
    SkeletonV1 {
        offsets: skeleton.offsets.iter().map(Vec3::to_array).collect(),
        feet: skeleton
            .feet
            .each_ref()
            .map(|foot| [foot.heel, foot.ball, foot.toe_tip].map(|point| point.to_array())),
        head_top: skeleton.head_top.to_array(),
    }
}

pub(super) fn decode_skeleton(dto: &SkeletonV1) -> Result<Skeleton, ModelFileError> {
    let Ok(offsets) = <[[f32; 3]; JOINT_COUNT]>::try_from(dto.offsets.as_slice()) else {
        let found = dto.offsets.len();
        let reason = format!("{found} joints where {JOINT_COUNT} belong");
        return Err(undecodable("payload", &reason));
    };
    Ok(Skeleton {
        offsets: offsets.map(Vec3::from_array),
        feet: dto.feet.map(|[heel, ball, toe_tip]| FootShape {
            heel: Vec3::from_array(heel),
            ball: Vec3::from_array(ball),
            toe_tip: Vec3::from_array(toe_tip),
        }),
        head_top: Vec3::from_array(dto.head_top),
    })
}

pub(super) fn encode_step(step: &StepModel) -> StepV1 {
    StepV1 {
        states: step
            .states
            .iter()
            .map(|state| StateV1 {
                mean: narrow(&state.mean),
                variance: narrow(&state.variance),
                duration: [state.duration_mean as f32, state.duration_variance as f32],
            })
            .collect(),
        other_terminal: step.other_terminal as f32,
    }
}

pub(super) fn decode_step(dto: &StepV1) -> StepModel {
    StepModel {
        states: dto
            .states
            .iter()
            .map(|state| StateModel {
                mean: widen(&state.mean),
                variance: widen(&state.variance),
                duration_mean: f64::from(state.duration[0]),
                duration_variance: f64::from(state.duration[1]),
            })
            .collect(),
        other_terminal: f64::from(dto.other_terminal),
    }
}

fn decode_pair(rows: &[Vec<f32>; 2]) -> Result<[StepOffset; 2], ModelFileError> {
    let decode = |row: &[f32]| {
        StepOffset::from_row(&widen(row)).ok_or_else(|| {
            let (found, expected) = (row.len(), StepOffset::LEN);
            let states = found / OBSERVATION_COUNT;
            undecodable(
                "payload",
                &format!(
                    "a step offset has {found} numbers ({states} states) where {expected} belong"
                ),
            )
        })
    };
    Ok([decode(&rows[0])?, decode(&rows[1])?])
}

pub(super) fn narrow(values: &[f64]) -> Vec<f32> {
    values.iter().map(|value| *value as f32).collect()
}

pub(super) fn widen(values: &[f32]) -> Vec<f64> {
    values.iter().copied().map(f64::from).collect()
}
