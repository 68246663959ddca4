//! Format version 2: a model of version 1 and how steps at the ends of a walk differ. Never edited after release.
//!
//! Written only for models that have such steps, so that older builds read the others.

use super::v1::{self, narrow, widen};
use super::{ModelFileError, undecodable};
use crate::gait_model::{GaitModel, StepContext, StepOffset};
use crate::provenance::Provenance;
use footfall_core::{Side, StepPosition};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct ModelV2 {
    /// The payload of version 1.
    inside: Vec<u8>,
    contexts: Vec<ContextV2>,
}

#[derive(Serialize, Deserialize)]
struct ContextV2 {
    /// 0 first, 1 second, 2 inside, 3 last but one, 4 last.
    position: u8,
    /// 0 left, 1 right.
    side: u8,
    offset: Vec<f32>,
}

pub(super) fn encode(model: &GaitModel) -> Result<Vec<u8>, ModelFileError> {
    let contexts = model.contexts.iter().map(|context| ContextV2 {
        position: context.position.index() as u8,
        side: context.side.index() as u8,
        offset: narrow(&context.offset.to_row()),
    });
    let dto = ModelV2 {
        inside: v1::encode(model)?,
        contexts: contexts.collect(),
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8], provenance: Provenance) -> Result<GaitModel, ModelFileError> {
    let dto: ModelV2 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    let contexts = dto.contexts.iter().map(decode_context);
    Ok(GaitModel {
        contexts: contexts.collect::<Result<_, _>>()?,
        ..v1::decode(&dto.inside, provenance)?
    })
}

fn decode_context(dto: &ContextV2) -> Result<StepContext, ModelFileError> {
    let position = StepPosition::ALL.get(usize::from(dto.position));
    let side = Side::BOTH.get(usize::from(dto.side));
    let offset = StepOffset::from_row(&widen(&dto.offset));
    match (position, side, offset) {
        (Some(&position), Some(&side), Some(offset)) => Ok(StepContext {
            position,
            side,
            offset,
        }),
        _ => Err(undecodable(
            "payload",
            &"a step at the end of a walk has a place, a foot or a number of values that does not exist",
        )),
    }
}
