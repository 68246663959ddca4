//! Trivial answers, beside which a reconstruction has to stand.

use super::body::{Body, body, distance_cm, nearest_cm, pose_of_row};
use super::{Chain, mean};
use footfall_core::{PhaseKind, Skeleton};
use footfall_model::ImuModel;
use footfall_model::imu_model::BODY_COUNT;
use std::collections::BTreeMap;

/// Times of a phase at which its average is taken.
const TIMES: usize = 20;

/// Errors of the trivial answers over some frames of a recording, centimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrivialErrors {
    /// One pose for all: the mean of the training data.
    pub constant: f64,
    /// The average course of the phase that the body truly is in, at its true time: what a perfect tracker of nothing but the phase would show.
    pub average: f64,
    /// The nearest of all poses that the model holds: what a perfect tracker would show at best.
    pub nearest: f64,
}

/// Trivial answers from what a model was trained on.
pub(super) struct Trivial<'a> {
    mean: Vec<f32>,
    averages: BTreeMap<PhaseKind, Vec<Vec<f32>>>,
    model: &'a ImuModel,
}

impl<'a> Trivial<'a> {
    /// From all recordings that a model was trained on.
    pub(super) fn of_chains(training: &[&Chain], model: &'a ImuModel) -> Self {
        Self::of(training.iter().flat_map(|chain| frames_of(chain)), model)
    }

    /// From what a model holds.
    pub(super) fn of_model(model: &'a ImuModel) -> Self {
        let mut rows = model.body.chunks_exact(BODY_COUNT);
        let rows = model.segments.iter().flat_map(|segment| {
            let frames = usize::from(segment.frames);
            let kind = model.phases[usize::from(segment.phase)];
            let own: Vec<&[f32]> = rows.by_ref().take(frames).collect();
            own.into_iter()
                .enumerate()
                .map(move |(n, row)| (kind, n * TIMES / frames, row))
        });
        Self::of(rows, model)
    }

    fn of<'b>(
        rows: impl Iterator<Item = (PhaseKind, usize, &'b [f32])>,
        model: &'a ImuModel,
    ) -> Self {
        let mut all = Sum::default();
        let mut phases: BTreeMap<PhaseKind, Vec<Sum>> = BTreeMap::new();
        for (kind, time, row) in rows {
            all.add(row);
            let times = phases
                .entry(kind)
                .or_insert_with(|| vec![Sum::default(); TIMES]);
            times[time].add(row);
        }
        let averages = phases.into_iter().map(|(kind, times)| {
            // A phase that lasts a few frames has not all times: those before stand in.
            let mut last = times
                .iter()
                .find(|sum| sum.frames > 0)
                .map_or_else(Vec::new, Sum::mean);
            let courses = times.iter().map(|sum| {
                if sum.frames > 0 {
                    last = sum.mean();
                }
                last.clone()
            });
            (kind, courses.collect())
        });
        Self {
            mean: all.mean(),
            averages: averages.collect(),
            model,
        }
    }

    /// Errors over the frames of a recording that count.
    pub(super) fn errors(
        &self,
        truth: &Chain,
        bodies: &[Body],
        counts: impl Fn(usize) -> bool,
    ) -> TrivialErrors {
        let skeleton = &truth.skeleton;
        let constant = body(&pose_of_row(&self.mean), skeleton);
        let averages = self.averages.iter().map(|(kind, times)| {
            let times = times.iter().map(|row| body(&pose_of_row(row), skeleton));
            (*kind, times.collect::<Vec<Body>>())
        });
        let averages: BTreeMap<PhaseKind, Vec<Body>> = averages.collect();
        let held = self.held(skeleton);
        let mut errors: [Vec<f64>; 3] = Default::default();
        for (frame, ((kind, time, _), truth)) in frames_of(truth).zip(bodies).enumerate() {
            if !counts(frame) {
                continue;
            }
            let average = averages.get(&kind).map_or(&constant, |times| &times[time]);
            errors[0].push(distance_cm(&constant, truth));
            errors[1].push(distance_cm(average, truth));
            errors[2].push(nearest_cm(&held, truth));
        }
        let [constant, average, nearest] = errors.map(|errors| mean(&errors));
        TrivialErrors {
            constant,
            average,
            nearest,
        }
    }

    /// Every pose of the model on a skeleton.
    fn held(&self, skeleton: &Skeleton) -> Vec<Body> {
        let rows = self.model.body.chunks_exact(BODY_COUNT);
        rows.map(|row| body(&pose_of_row(row), skeleton)).collect()
    }
}

/// Phase of each frame of a chain, its time in that phase from 0 to [`TIMES`], and its row.
fn frames_of(chain: &Chain) -> impl Iterator<Item = (PhaseKind, usize, &[f32])> {
    chain.segments.iter().flat_map(move |segment| {
        let frames = segment.end - segment.first;
        (0..frames).map(move |n| {
            let row = chain.body_row(segment.first + n);
            (segment.kind, n * TIMES / frames, row)
        })
    })
}

/// Sum of rows.
#[derive(Clone)]
struct Sum {
    values: [f64; BODY_COUNT],
    frames: usize,
}

impl Default for Sum {
    fn default() -> Self {
        Self {
            values: [0.0; BODY_COUNT],
            frames: 0,
        }
    }
}

impl Sum {
    fn add(&mut self, row: &[f32]) {
        for (sum, value) in self.values.iter_mut().zip(row) {
            *sum += f64::from(*value);
        }
        self.frames += 1;
    }

    fn mean(&self) -> Vec<f32> {
        let frames = self.frames.max(1) as f64;
        self.values
            .iter()
            .map(|sum| (sum / frames) as f32)
            .collect()
    }
}
