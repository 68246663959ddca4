//! Probabilities of the frames of the model, given everything measured so far: the forward algorithm (Mousas 2017, section 6 and
//! appendix A), linear in the number of frames.

mod backward;
mod evidence;
mod interpolation;

use crate::kernels::add;
use crate::prepared::Prepared;
use crate::strangeness::Strangeness;
use crate::stride_phase::StridePhase;
use footfall_core::Behaviour;
use footfall_model::imu_model::{MAX_PHASES, MAX_WIDTH};
use std::sync::Arc;

/// Settings of the forward algorithm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackerConfig {
    /// Probabilities to stay in a frame, to go on to the next, and to skip one (section 5.2; there 1/3 each).
    pub stay_next_skip: [f32; 3],
    /// Probability, at the end of a segment, to go on with the segment that followed it in the recording.
    pub keep_recording: f32,
    /// Probability to stay with a subject where the recording is left.
    pub keep_subject: f32,
    /// Probability of a frame to leave for anywhere else: the paper's exit.
    pub exit: f32,
    /// Weight of a frame of the sensors: successive frames are alike, and would count several times over, and so would two sensors on one body.
    pub evidence: f32,
    /// Weight of the phase of a stranger's stride beside the numbers of the sensors; 0 ignores it.
    pub stride: f32,
    /// Share of the evidence that counts while strides repeat: what a stranger's sensor measures differently is then the same over and over.
    pub repeated: f32,
    /// Squared distance a sensor, in deviations of the model, from which on a frame explains nothing of what was measured: all such frames are alike, so that
    /// where none explains it the body goes on as it did.
    pub farthest: f32,
    /// Frames within which every segment is entered from anywhere once: what exits is handed to one part of the segments after the other.
    pub round_frames: usize,
    /// Number of segments that are interpolated (section 5.3; there 5).
    pub interpolated: usize,
    /// Interpolates segments of the most probable phase only, as section 5.3 does.
    pub one_phase: bool,
    /// Share of the regression on the sensor that is applied (equation 6), 0 to 1.
    pub regression: f32,
}

impl Default for TrackerConfig {
    fn default() -> Self {
        Self {
            stay_next_skip: [0.15, 0.7, 0.15],
            keep_recording: 0.7,
            keep_subject: 0.7,
            exit: 0.01,
            evidence: 0.5,
            stride: 1.0,
            repeated: 0.3,
            farthest: 25.0,
            round_frames: 24,
            interpolated: 20,
            one_phase: false,
            // On recordings that a model has not seen it makes walks worse by half a centimetre.
            regression: 0.0,
        }
    }
}

/// A frame of all sensors, in the model's order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// The numbers; the first [`ImuModel::sensor_width`](footfall_model::ImuModel::sensor_width) count.
    pub values: [f32; MAX_WIDTH],
    /// Weights of the numbers, 0 to 1.
    pub weights: [f32; MAX_WIDTH],
    /// Phase of the stride of the first foot with a sensor.
    pub stride: StridePhase,
}

/// Probabilities after a frame.
///
/// Most frames are as good as impossible at any time. Only segments that hold some probability, those that can follow them, and a share of all
/// others in turn are looked at.
#[derive(Clone, Debug)]
pub struct Tracker {
    prepared: Arc<Prepared>,
    config: TrackerConfig,
    /// Probability of each frame; sums to one.
    probability: Vec<f32>,
    /// Segments that hold some of it.
    active: Vec<u32>,
    /// Probability of each of these.
    masses: Vec<f32>,
    /// Segments that are looked at, and whether each is among them.
    candidates: Vec<u32>,
    listed: Vec<bool>,
    /// The next of the others whose turn it is.
    turn: usize,
    /// Value of each frame, in whole blocks.
    predicted: Vec<f32>,
    distance: Vec<f32>,
    weighed: Vec<f32>,
    /// Probability that leaves for each phase, subject by subject.
    entering: Vec<f32>,
    entering_any: Vec<f32>,
    /// The segments that are interpolated, and their weights.
    chosen: Vec<(u32, f32)>,
    behaviours: [f32; Behaviour::ALL.len()],
    log_likelihood: f64,
    /// The part of it that the last measured frame added.
    log_density: f64,
    strangeness: Strangeness,
}

/// Segments that held less than this are dropped.
const LEAST_MASS: f32 = 2e-5;

/// With less than this probability of standing it is not known how somebody stands.
const LEAST_STANDING: f32 = 1e-3;

impl Tracker {
    /// Every frame is as probable as any other.
    pub fn new(prepared: &Arc<Prepared>, config: TrackerConfig) -> Self {
        let frames = prepared.frames;
        let segments = prepared.model.segments.len();
        let kinds = prepared.model.phases.len();
        let mut tracker = Self {
            config,
            probability: vec![0.0; frames],
            active: Vec::with_capacity(segments),
            masses: Vec::with_capacity(segments),
            candidates: Vec::with_capacity(segments),
            listed: vec![false; segments],
            turn: 0,
            predicted: vec![0.0; prepared.padded],
            distance: vec![0.0; prepared.padded],
            weighed: vec![0.0; prepared.padded],
            entering: vec![0.0; prepared.model.subjects * kinds],
            entering_any: vec![0.0; kinds],
            chosen: Vec::with_capacity(config.interpolated.max(1)),
            behaviours: [0.0; Behaviour::ALL.len()],
            log_likelihood: 0.0,
            log_density: 0.0,
            strangeness: Strangeness::UNKNOWN,
            prepared: Arc::clone(prepared),
        };
        tracker.reset();
        tracker
    }

    /// Forgets everything measured.
    pub fn reset(&mut self) {
        self.probability.fill(1.0 / self.prepared.frames as f32);
        self.active.clear();
        self.active
            .extend(0..self.prepared.model.segments.len() as u32);
        self.turn = 0;
        (self.log_likelihood, self.log_density) = (0.0, 0.0);
        self.strangeness = Strangeness::UNKNOWN;
        self.weigh_segments();
    }

    /// Takes the person to stand: as they probably do, or in whichever way people do. Nothing changes for a model of people who never stand.
    pub(crate) fn stand(&mut self) {
        let prepared = Arc::clone(&self.prepared);
        let model = &prepared.model;
        let stands = |n: usize| model.behaviour_of(model.segments[n]) == Behaviour::Stand;
        let segments = 0..model.segments.len();
        let frames = |n: usize| prepared.frames_of(n);
        let standing = segments.clone().filter(|&n| stands(n));
        let standing: usize = standing.map(|n| frames(n).len()).sum();
        if standing == 0 {
            return;
        }
        let is_known = self.behaviours[Behaviour::Stand.index()] > LEAST_STANDING;
        for n in segments {
            if !stands(n) {
                self.probability[frames(n)].fill(0.0);
            } else if !is_known {
                self.probability[frames(n)].fill(1.0 / standing as f32);
            }
        }
        let sum: f32 = self.probability.iter().sum();
        self.probability.iter_mut().for_each(|p| *p /= sum);
        self.look_at_probable();
    }

    /// Makes the segments that hold some probability the active ones, and weighs them.
    fn look_at_probable(&mut self) {
        self.active.clear();
        for n in 0..self.prepared.model.segments.len() {
            let own = &self.probability[self.prepared.frames_of(n)];
            if own.iter().any(|p| *p > 0.0) {
                self.active.push(n as u32);
            }
        }
        self.weigh_segments();
    }

    /// Probability of each frame of the model.
    pub fn probabilities(&self) -> &[f32] {
        &self.probability
    }

    /// Probability of each behaviour, in the order of [`Behaviour::ALL`].
    pub const fn behaviours(&self) -> &[f32; Behaviour::ALL.len()] {
        &self.behaviours
    }

    /// Logarithm of the density of all that was measured, up to a constant.
    pub const fn log_likelihood(&self) -> f64 {
        self.log_likelihood
    }

    /// Logarithm of the density of what was measured last, given all before it, up to a constant; 0 before anything was.
    pub const fn log_density(&self) -> f64 {
        self.log_density
    }

    /// Goes on by a frame. `sensor` holds what was measured in it; `None` when nothing was.
    pub fn step(&mut self, sensor: Option<&Measurement>) {
        self.leave();
        self.list_candidates();
        self.predict();
        let weighed = if let Some(sensor) = sensor {
            self.update(sensor)
        } else {
            self.weighed.copy_from_slice(&self.predicted);
            self.weighed.iter().sum()
        };
        self.keep(weighed);
        self.weigh_segments();
        if let Some(sensor) = sensor {
            self.compare(sensor);
        }
    }

    /// Moves probability that leaves the segments at their ends to the phases it enters.
    fn leave(&mut self) {
        let prepared = &*self.prepared;
        let model = &*prepared.model;
        let kinds = model.phases.len();
        let [_, next, skip] = self.moves();
        self.entering.fill(0.0);
        for &n in &self.active {
            let segment = &model.segments[n as usize];
            let old = &self.probability[prepared.frames_of(n as usize)];
            let last_but_one = old.len().checked_sub(2).map_or(0.0, |n| old[n]);
            let leaving = (next + skip) * old[old.len() - 1] + skip * last_but_one;
            let share = if prepared.is_followed(n as usize) {
                1.0 - self.config.keep_recording
            } else {
                1.0
            };
            let row = usize::from(segment.subject) * kinds;
            self.entering[row + usize::from(segment.phase)] += leaving * share;
        }
        self.entering_any.fill(0.0);
        for left in self.entering.chunks_exact_mut(kinds) {
            let mut entered = [0.0_f32; MAX_PHASES];
            for (phase, mass) in left.iter().enumerate().filter(|(_, mass)| **mass > 0.0) {
                add(
                    *mass,
                    &model.next[phase * kinds..(phase + 1) * kinds],
                    &mut entered,
                );
            }
            left.copy_from_slice(&entered[..kinds]);
            add(1.0, &entered[..kinds], &mut self.entering_any);
        }
    }

    /// Probabilities to stay, to go on and to skip, without those of an exit.
    fn moves(&self) -> [f32; 3] {
        self.config
            .stay_next_skip
            .map(|p| p * (1.0 - self.config.exit))
    }

    /// Segments that may hold some probability after this frame, and those whose turn it is.
    fn list_candidates(&mut self) {
        let turn = self.turn();
        let prepared = &*self.prepared;
        let listed = &mut self.listed;
        let candidates = &mut self.candidates;
        candidates.clear();
        let mut list = |n: u32| {
            if !listed[n as usize] {
                listed[n as usize] = true;
                candidates.push(n);
            }
        };
        for &n in &self.active {
            list(n);
            if prepared.is_followed(n as usize) {
                list(n + 1);
            }
        }
        for (phase, mass) in self.entering_any.iter().enumerate() {
            let segments = &prepared.of_phase[phase];
            if *mass > LEAST_MASS * segments.len() as f32 {
                segments.iter().copied().for_each(&mut list);
            }
        }
        turn.for_each(|n| list(n as u32));
        for n in &self.candidates {
            self.listed[*n as usize] = false;
        }
    }

    fn round_frames(&self) -> usize {
        self.config.round_frames.max(1)
    }

    /// The segments whose turn it is to be entered from anywhere.
    fn turn(&self) -> core::ops::Range<usize> {
        let all = self.prepared.model.segments.len();
        let size = all.div_ceil(self.round_frames());
        let first = (self.turn * size).min(all);
        first..(first + size).min(all)
    }

    /// Predicts the frames a step later (appendix A, "prediction") from each frame of the candidates.
    fn predict(&mut self) {
        self.predicted.fill(0.0);
        let prepared = &*self.prepared;
        let config = &self.config;
        let model = &*prepared.model;
        let kinds = model.phases.len();
        let [stay, next, skip] = self.moves();
        let turn = self.turn();
        // What exits goes anywhere; with each turn as much as all of its frames would have had in the round.
        let anywhere = config.exit * self.round_frames() as f32 / prepared.frames as f32;
        for &n in &self.candidates {
            let segment = &model.segments[n as usize];
            let frames = prepared.frames_of(n as usize);
            let old = &self.probability[frames.clone()];
            let new = &mut self.predicted[frames];
            let mut back = if segment.follows {
                let last = &self.probability[prepared.frames_of(n as usize - 1)];
                let last_but_one = last.len().checked_sub(2).map_or(0.0, |n| last[n]);
                [last_but_one, last[last.len() - 1]].map(|p| p * config.keep_recording)
            } else {
                [0.0; 2]
            };
            let exits = if turn.contains(&(n as usize)) {
                anywhere
            } else {
                0.0
            };
            for (new, old) in new.iter_mut().zip(old) {
                *new = stay * old + next * back[1] + skip * back[0] + exits;
                back = [back[1], *old];
            }
            let (phase, subject) = (usize::from(segment.phase), usize::from(segment.subject));
            let place = subject * kinds + phase;
            let own = self.entering[place] / prepared.counts[place].max(1.0);
            let any = self.entering_any[phase] / prepared.of_phase[phase].len().max(1) as f32;
            new[0] += config.keep_subject * own + (1.0 - config.keep_subject) * any;
        }
        self.turn = (self.turn + 1) % self.round_frames();
    }

    /// Brings the weighed candidates to a sum of one, and drops those that hold next to nothing.
    fn keep(&mut self, sum: f32) {
        let prepared = &*self.prepared;
        for &n in &self.active {
            self.probability[prepared.frames_of(n as usize)].fill(0.0);
        }
        self.active.clear();
        let norm = 1.0 / sum.max(f32::MIN_POSITIVE);
        for &n in &self.candidates {
            let frames = prepared.frames_of(n as usize);
            let own = &self.weighed[frames.clone()];
            let mass: f32 = own.iter().sum();
            if mass * norm > LEAST_MASS {
                self.active.push(n);
                for (probability, weighed) in self.probability[frames].iter_mut().zip(own) {
                    *probability = weighed * norm;
                }
            }
        }
        if self.active.is_empty() {
            // Nothing explains what was measured: start anew.
            let known = (self.log_likelihood, self.log_density, self.strangeness);
            self.reset();
            (self.log_likelihood, self.log_density, self.strangeness) = known;
        }
    }
}
