//! The backward algorithm: evidence of later frames, for whole recordings.

use super::{Measurement, Tracker};
use crate::kernels::{scale, weigh};
use footfall_model::imu_model::MAX_PHASES;
use std::sync::Arc;

impl Tracker {
    /// Takes how strange the wearer is from the tracker that goes forward.
    pub(crate) const fn take_strangeness(&mut self, forward: &Self) {
        self.strangeness = forward.strangeness;
    }

    /// Takes probabilities from outside, for which [`body`](Self::body) then stands.
    pub(crate) fn set_probabilities(&mut self, probabilities: &[f32]) {
        self.probability.copy_from_slice(probabilities);
        self.look_at_probable();
    }

    /// Goes back by a frame of the backward algorithm. `later` holds a likelihood for each frame of the model, up to a factor: before the call, of all
    /// measurements after `sensor`, given its frame; after the call, of `sensor` and all later ones, given the frame before. No frame is pruned.
    pub fn step_back(&mut self, sensor: Option<&Measurement>, later: &mut [f32]) {
        let prepared = Arc::clone(&self.prepared);
        if let Some(sensor) = sensor {
            self.predicted[..later.len()].copy_from_slice(later);
            let nearest = self.measure(sensor, f32::NEG_INFINITY);
            let factor = self.factor(sensor);
            weigh(
                &self.predicted,
                &self.distance,
                factor,
                [nearest, self.farthest()],
                &mut self.weighed,
            );
            later.copy_from_slice(&self.weighed[..later.len()]);
        }
        self.value_phases(later);
        let config = &self.config;
        let model = &*prepared.model;
        let kinds = model.phases.len();
        let [stay, next, skip] = self.moves();
        let anywhere = config.exit * later.iter().sum::<f32>() / prepared.frames as f32;
        for (n, segment) in model.segments.iter().enumerate() {
            let frames = prepared.frames_of(n);
            let place = usize::from(segment.subject) * kinds + usize::from(segment.phase);
            let leave = self.entering[place];
            let followed = prepared.is_followed(n);
            let keep = if followed { config.keep_recording } else { 0.0 };
            let following = if followed {
                &later[prepared.frames_of(n + 1)]
            } else {
                &[]
            };
            let beyond = |steps: usize| {
                // As forwards, a skip beyond the last frame of the following segment leads nowhere.
                let over = following.get(steps).copied().unwrap_or(0.0);
                keep * over + (1.0 - keep) * leave
            };
            for frame in frames.clone() {
                let at = |steps: usize| {
                    let there = frame + steps;
                    if there < frames.end {
                        later[there]
                    } else {
                        beyond(there - frames.end)
                    }
                };
                self.predicted[frame] =
                    stay * later[frame] + next * at(1) + skip * at(2) + anywhere;
            }
        }
        later.copy_from_slice(&self.predicted[..later.len()]);
        let sum: f32 = later.iter().sum();
        scale(later, later.len() as f32 / sum.max(f32::MIN_POSITIVE));
    }

    /// Values, for what comes later, of leaving each phase of each subject at its end: into `entering`.
    fn value_phases(&mut self, later: &[f32]) {
        let prepared = &*self.prepared;
        let config = &self.config;
        let model = &*prepared.model;
        let kinds = model.phases.len();
        self.entering.fill(0.0);
        self.entering_any.fill(0.0);
        for (n, segment) in model.segments.iter().enumerate() {
            let (phase, subject) = (usize::from(segment.phase), usize::from(segment.subject));
            let first = later[prepared.starts[n]];
            self.entering[subject * kinds + phase] += first;
            self.entering_any[phase] += first;
        }
        let subjects = self.entering.chunks_exact_mut(kinds);
        for (own, counts) in subjects.zip(prepared.counts.chunks_exact(kinds)) {
            let mut entered = [0.0_f32; MAX_PHASES];
            for (phase, (own, count)) in own.iter().zip(counts).enumerate() {
                let any = self.entering_any[phase] / prepared.of_phase[phase].len().max(1) as f32;
                entered[phase] =
                    config.keep_subject * own / count.max(1.0) + (1.0 - config.keep_subject) * any;
            }
            for (phase, own) in own.iter_mut().enumerate() {
                let row = &model.next[phase * kinds..(phase + 1) * kinds];
                *own = row
                    .iter()
                    .zip(&entered)
                    .map(|(share, entered)| share * entered)
                    .sum();
            }
        }
    }
}
