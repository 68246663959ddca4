//! Format version 1 of a `.footimu` file's payload. Never edited after release.

use super::v1::{SkeletonV1, decode_skeleton, encode_skeleton};
use super::{ModelFileError, undecodable};
use crate::imu_model::{BODY_COUNT, ImuModel, MAX_FRAMES, SENSOR_COUNT, Segment};
use crate::provenance::Provenance;
use footfall_core::{Behaviour, PhaseKind, PhaseStart, Side, Site};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct ImuV1 {
    frame_rate_hz: f64,
    sites: Vec<String>,
    skeleton: SkeletonV1,
    /// Behaviour, event and side, as places in their lists.
    phases: Vec<[u8; 3]>,
    next: Vec<f32>,
    subjects: u16,
    /// Phase, subject, frames, and 1 where the segment follows the one before.
    segments: Vec<(u16, u16, u16, u8)>,
    sensor: TableV1,
    body: TableV1,
    deviations: Vec<f32>,
    regressions: Vec<Vec<f32>>,
}

/// Rows of numbers, each column in 16 bits between its least and its greatest number, as differences from the row before.
#[derive(Serialize, Deserialize)]
struct TableV1 {
    least: Vec<f32>,
    step: Vec<f32>,
    differences: Vec<i32>,
}

impl TableV1 {
    fn encode(values: &[f32], width: usize) -> Self {
        let column = |n: usize| values.iter().skip(n).step_by(width).copied();
        let least: Vec<f32> = (0..width)
            .map(|n| column(n).fold(f32::INFINITY, f32::min))
            .collect();
        let step: Vec<f32> = (0..width)
            .map(|n| (column(n).fold(f32::NEG_INFINITY, f32::max) - least[n]) / f32::from(u16::MAX))
            .collect();
        let mut before = vec![0; width];
        let mut differences = Vec::with_capacity(values.len());
        for row in values.chunks_exact(width) {
            for (n, value) in row.iter().enumerate() {
                let code = if step[n] > 0.0 {
                    ((value - least[n]) / step[n]).round() as i32
                } else {
                    0
                };
                differences.push(code - before[n]);
                before[n] = code;
            }
        }
        Self {
            least,
            step,
            differences,
        }
    }

    fn decode(&self, width: usize) -> Result<Vec<f32>, ModelFileError> {
        let fits = self.least.len() == width
            && self.step.len() == width
            && self.differences.len().is_multiple_of(width);
        if !fits {
            return Err(undecodable(
                "payload",
                &"a table of frames has no whole rows",
            ));
        }
        let mut code = vec![0_i32; width];
        let mut values = Vec::with_capacity(self.differences.len());
        for row in self.differences.chunks_exact(width) {
            for (n, difference) in row.iter().enumerate() {
                code[n] = code[n].wrapping_add(*difference);
                values.push(self.least[n] + code[n] as f32 * self.step[n]);
            }
        }
        Ok(values)
    }
}

pub(super) fn encode(model: &ImuModel) -> Result<Vec<u8>, ModelFileError> {
    let dto = ImuV1 {
        frame_rate_hz: model.frame_rate_hz,
        sites: model
            .sites
            .iter()
            .map(|site| site.name().to_owned())
            .collect(),
        skeleton: encode_skeleton(&model.skeleton),
        phases: model
            .phases
            .iter()
            .map(|kind| [kind.behaviour as u8, kind.start as u8, kind.side as u8])
            .collect(),
        next: model.next.clone(),
        subjects: model.subjects as u16,
        segments: model
            .segments
            .iter()
            .map(|s| (s.phase, s.subject, s.frames, u8::from(s.follows)))
            .collect(),
        sensor: TableV1::encode(&model.sensor, model.sensor_width()),
        body: TableV1::encode(&model.body, BODY_COUNT),
        deviations: model.deviations.clone(),
        regressions: model.regressions.clone(),
    };
    postcard::to_stdvec(&dto).map_err(|error| undecodable("payload", &error))
}

pub(super) fn decode(payload: &[u8], provenance: Provenance) -> Result<ImuModel, ModelFileError> {
    let dto: ImuV1 =
        postcard::from_bytes(payload).map_err(|error| undecodable("payload", &error))?;
    let sites: Vec<Site> = dto
        .sites
        .iter()
        .map(|name| {
            let reason = format!("no site of a sensor is called '{name}'");
            Site::from_name(name).ok_or_else(|| undecodable("payload", &reason))
        })
        .collect::<Result<_, _>>()?;
    if sites.is_empty() || dto.segments.len() > MAX_FRAMES {
        return Err(undecodable("payload", &"no sites, or too many segments"));
    }
    let phases = dto
        .phases
        .iter()
        .map(|&[behaviour, start, side]| {
            Some(PhaseKind {
                behaviour: *Behaviour::ALL.get(usize::from(behaviour))?,
                start: *PhaseStart::ALL.get(usize::from(start))?,
                side: *Side::BOTH.get(usize::from(side))?,
            })
        })
        .collect::<Option<_>>()
        .ok_or_else(|| undecodable("payload", &"an unknown phase"))?;
    Ok(ImuModel {
        frame_rate_hz: dto.frame_rate_hz,
        skeleton: decode_skeleton(&dto.skeleton)?,
        phases,
        next: dto.next,
        subjects: usize::from(dto.subjects),
        segments: dto
            .segments
            .iter()
            .map(|&(phase, subject, frames, follows)| Segment {
                phase,
                subject,
                frames,
                follows: follows != 0,
            })
            .collect(),
        sensor: dto.sensor.decode(SENSOR_COUNT * sites.len())?,
        body: dto.body.decode(BODY_COUNT)?,
        deviations: dto.deviations,
        regressions: dto.regressions,
        sites,
        provenance,
    })
}
