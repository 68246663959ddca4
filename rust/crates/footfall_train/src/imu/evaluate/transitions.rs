//! Changes from one motion to another (Mousas 2017, section 7.2.4), where the paper asks people how natural they look: how suddenly bodies move there.
//!
//! The measurements of one person up to a moment are followed by those of another from a moment on. Bodies are shown by a model that has seen
//! neither: people are dealt into four groups, both come from one, and the model has seen the others.

use super::body::{Body, accelerations, body, pose_of_row};
use super::{Chain, Conditions, ImuClip, ImuTrainConfig, observe, train_imu};
use crate::error::TrainError;
use footfall_core::Behaviour;
use footfall_imu::{ImuRecording, ImuSample};
use footfall_model::Provenance;
use footfall_model::imu_model::SENSOR_COUNT;
use footfall_recon::{Blending, Prepared, Published, ReconConfig, reconstruct_recording};
use rand::seq::IndexedRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Kinds of changes that the paper studies.
pub const TRANSITIONS: [[Behaviour; 2]; 5] = [
    [Behaviour::Stand, Behaviour::Walk],
    [Behaviour::Walk, Behaviour::Stand],
    [Behaviour::Walk, Behaviour::Walk],
    [Behaviour::Walk, Behaviour::Run],
    [Behaviour::Run, Behaviour::Walk],
];

/// Changes of each kind.
const DRAWN: u64 = 8;

/// Groups that people are dealt into.
const GROUPS: usize = 4;

/// Pairs of moments of which the one is taken at which the sensor lies most alike.
const PAIRS: usize = 400;

/// Duration of either motion before and after the change, seconds.
const LEAST_SECS: f64 = 0.7;

/// Time round the change in which bodies are looked at, seconds: what is shown follows what is measured.
const BEFORE_SECS: f64 = 0.1;
const AFTER_SECS: f64 = 0.5;

/// Greatest acceleration of a body about a change: root mean square over its joints, relative to the hips, m/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransitionTrial {
    /// The two behaviours.
    pub kind: [Behaviour; 2],
    /// As a game shows it.
    pub shown: f64,
    /// The same without blending (section 6).
    pub unblended: f64,
    /// The recorded bodies in as long a time before and after the change, in the mean: what people do without a change.
    pub recorded: f64,
    /// The recorded bodies, one cut to the other.
    pub cut: f64,
}

/// A moment of a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Moment {
    clip: usize,
    frame: usize,
}

/// Shows eight changes of each of the [`TRANSITIONS`] for which there are recordings of two people, from clips that are `judged`, by their places among `clips`.
///
/// # Errors
/// [`TrainError`] when a model cannot be trained.
pub fn evaluate_transitions(
    clips: &[ImuClip<'_>],
    config: &ImuTrainConfig,
    conditions: &Conditions,
    judged: &(dyn Fn(usize) -> bool + Sync),
) -> Result<Vec<TransitionTrial>, TrainError> {
    config.check()?;
    let chains: Vec<Vec<Chain>> = clips.par_iter().map(|clip| observe(clip, config)).collect();
    let subjects: BTreeSet<&str> = clips.iter().map(|clip| clip.subject).collect();
    let group_of = |clip: &ImuClip<'_>| subjects.range(..clip.subject).count() % GROUPS;
    let study = Study {
        clips,
        chains: &chains,
        groups: clips.iter().map(group_of).collect(),
        config,
        conditions,
        judged,
    };
    let drawn: Vec<([Behaviour; 2], [Moment; 2])> = TRANSITIONS
        .into_iter()
        .flat_map(|kind| (0..DRAWN).map(move |seed| (kind, seed)))
        .filter_map(|(kind, seed)| Some((kind, study.draw(kind, seed)?)))
        .collect();
    let groups = (0..GROUPS).into_par_iter().map(|group| {
        let in_group = |(_, moments): &&(_, [Moment; 2])| study.groups[moments[0].clip] == group;
        let own: Vec<_> = drawn.iter().filter(in_group).collect();
        if own.is_empty() {
            return Ok(Vec::new());
        }
        let prepared = study.prepare(group)?;
        let trials = own.par_iter();
        let trials = trials.map(|(kind, moments)| study.show(*kind, *moments, &prepared));
        trials.collect()
    });
    let groups: Vec<Vec<TransitionTrial>> = groups.collect::<Result<_, TrainError>>()?;
    Ok(groups.concat())
}

struct Study<'a> {
    clips: &'a [ImuClip<'a>],
    chains: &'a [Vec<Chain>],
    /// Group of each clip's person.
    groups: Vec<usize>,
    config: &'a ImuTrainConfig,
    conditions: &'a Conditions,
    judged: &'a (dyn Fn(usize) -> bool + Sync),
}

impl Study<'_> {
    fn frames(&self, secs: f64) -> usize {
        (secs * self.config.frame_rate_hz).round() as usize
    }

    /// Two moments of different people of a group: the first ends a behaviour's time, the second begins the other's.
    fn draw(&self, [from, to]: [Behaviour; 2], seed: u64) -> Option<[Moment; 2]> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let (ends, starts) = (self.moments(from, true), self.moments(to, false));
        // Clips first, so that the long ones do not stand for all.
        let clips_of = |moments: &[Moment]| {
            let mut clips: Vec<usize> = moments.iter().map(|moment| moment.clip).collect();
            clips.dedup();
            clips
        };
        let pairs: Vec<[usize; 2]> = clips_of(&ends)
            .into_iter()
            .flat_map(|end| clips_of(&starts).into_iter().map(move |start| [end, start]))
            .filter(|[end, start]| {
                self.groups[*end] == self.groups[*start]
                    && self.clips[*end].subject != self.clips[*start].subject
            })
            .collect();
        let [first, second] = *pairs.choose(&mut random)?;
        let of = |moments: Vec<Moment>, clip: usize| -> Vec<Moment> {
            moments.into_iter().filter(|m| m.clip == clip).collect()
        };
        let (ends, starts) = (of(ends, first), of(starts, second));
        let pairs = (0..PAIRS).map(|_| {
            let pick = |moments: &[Moment], n: usize| moments[n % moments.len()];
            [
                pick(&ends, random.random_range(0..ends.len())),
                pick(&starts, random.random_range(0..starts.len())),
            ]
        });
        pairs.min_by(|a, b| self.tilt(*a).total_cmp(&self.tilt(*b)))
    }

    /// Frames before which a behaviour lasts long enough, or from which on.
    fn moments(&self, behaviour: Behaviour, before: bool) -> Vec<Moment> {
        let least = self.frames(LEAST_SECS);
        let mut moments = Vec::new();
        for (clip, chains) in self.chains.iter().enumerate() {
            let Some(chain) = chains.first().filter(|_| (self.judged)(clip)) else {
                continue;
            };
            let runs = chain
                .segments
                .chunk_by(|a, b| a.kind.behaviour == b.kind.behaviour);
            for run in runs.filter(|run| run[0].kind.behaviour == behaviour) {
                let (first, end) = (run[0].first, run[run.len() - 1].end);
                let frames = if before {
                    first + least..end
                } else {
                    first..(end + 1).saturating_sub(least)
                };
                moments.extend(frames.map(|frame| Moment { clip, frame }));
            }
        }
        moments
    }

    /// Square of how differently the sensors lie.
    fn tilt(&self, [a, b]: [Moment; 2]) -> f32 {
        let row = |moment: Moment| self.chains[moment.clip][0].sensor_row(moment.frame);
        let up = |row: &[f32]| -> Vec<f32> {
            let sensors = row.chunks_exact(SENSOR_COUNT);
            sensors.flat_map(|sensor| sensor[6..].to_vec()).collect()
        };
        let numbers = up(row(a)).into_iter().zip(up(row(b)));
        numbers.map(|(a, b)| (a - b).powi(2)).sum()
    }

    /// A model of the other groups.
    fn prepare(&self, group: usize) -> Result<Arc<Prepared>, TrainError> {
        let training: Vec<&Chain> = (0..self.clips.len())
            .filter(|clip| self.groups[*clip] != group)
            .flat_map(|clip| &self.chains[clip])
            .collect();
        let model = Arc::new(train_imu(&training, self.config, Provenance::default())?);
        let prepared = Prepared::new(model)?;
        Ok(Arc::new(Published::prepare(
            &self.conditions.published,
            prepared,
        )))
    }

    fn show(
        &self,
        kind: [Behaviour; 2],
        moments: [Moment; 2],
        prepared: &Arc<Prepared>,
    ) -> Result<TransitionTrial, TrainError> {
        let sites = self.config.sites.iter().enumerate();
        let recordings: Vec<ImuRecording> = sites
            .map(|(n, site)| {
                // One seed: the same sensor measures both.
                let measure = |moment: Moment| {
                    let clip = &self.clips[moment.clip];
                    self.conditions.device.measure(clip, *site, n as u64)
                };
                let rate_hz = self.config.frame_rate_hz;
                let secs = moments.map(|moment| moment.frame as f64 / rate_hz);
                join(&measure(moments[0]), &measure(moments[1]), secs)
            })
            .collect();
        let skeleton = &self.chains[moments[0].clip][0].skeleton;
        let mut config = ReconConfig::default();
        for part in &self.conditions.published {
            part.set(&mut config);
        }
        let reconstruct = |blending: Blending| -> Result<Vec<Body>, TrainError> {
            let config = ReconConfig { blending, ..config };
            let made = reconstruct_recording(prepared, &recordings, skeleton, &config, true)?;
            // The first pose is a frame before the first of the chain.
            let poses = made.clip.poses.iter().skip(1);
            Ok(poses.map(|pose| body(pose, skeleton)).collect())
        };
        let [first, second] = moments.map(|moment| self.bodies(moment.clip));
        let [end, start] = moments.map(|moment| moment.frame);
        let cut = [&first[..end], &second[start..]].concat();
        let (before, after) = (self.frames(BEFORE_SECS), self.frames(AFTER_SECS));
        let peak = |bodies: &[Body], from: usize| {
            let end = (from + before + after).min(bodies.len());
            let accelerations =
                accelerations(&bodies[from.min(end)..end], self.config.frame_rate_hz);
            accelerations.into_iter().fold(0.0, f64::max)
        };
        let change = end.saturating_sub(before);
        Ok(TransitionTrial {
            kind,
            shown: peak(&reconstruct(config.blending)?, change),
            unblended: peak(&reconstruct(Blending::Off)?, change),
            recorded: 0.5
                * (peak(&first[..end], end.saturating_sub(before + after)) + peak(&second, start)),
            cut: peak(&cut, change),
        })
    }

    fn bodies(&self, clip: usize) -> Vec<Body> {
        let chain = &self.chains[clip][0];
        (0..chain.frames())
            .map(|frame| body(&pose_of_row(chain.body_row(frame)), &chain.skeleton))
            .collect()
    }
}

/// A recording up to a time and, from there on, another from a time on; both times are seconds from their starts.
fn join(first: &ImuRecording, second: &ImuRecording, [end, start]: [f64; 2]) -> ImuRecording {
    let (end, start) = (first.start_secs() + end, second.start_secs() + start);
    let before = first.samples.iter().filter(|s| s.time_secs < end).copied();
    let after = second.samples.iter().filter(|s| s.time_secs >= start);
    let after = after.map(|sample| ImuSample {
        time_secs: sample.time_secs - start + end,
        ..*sample
    });
    ImuRecording {
        samples: before.chain(after).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn recording(start_secs: f64, rate: f32) -> ImuRecording {
        let sample = |n: usize| ImuSample {
            time_secs: start_secs + n as f64 * 0.01,
            force: Vec3::Y * 9.81,
            rate: Vec3::X * rate,
        };
        ImuRecording {
            samples: (0..100).map(sample).collect(),
        }
    }

    #[test]
    fn joined_recordings_go_on_without_a_gap() {
        let joined = join(&recording(3.0, 1.0), &recording(7.0, 2.0), [0.305, 0.605]);
        let samples = &joined.samples;
        assert_eq!(samples.len(), 31 + 39);
        assert!((samples[30].rate.x, samples[31].rate.x) == (1.0, 2.0));
        for pair in samples.windows(2) {
            let step = pair[1].time_secs - pair[0].time_secs;
            assert!((step - 0.01).abs() < 1e-9, "{step} s");
        }
    }
}
