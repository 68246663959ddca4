//! The average walk: two step models of five states each, how they follow speed, and how walkers and steps differ.

use crate::check::{ModelError, check_finite, check_len, check_positive};
use crate::crouching::CrouchModel;
use crate::fine_motion::FineMotion;
use crate::jumping::JumpModel;
use crate::layout::{FEATURE_COUNT, OBSERVATION_COUNT};
use crate::provenance::Provenance;
use crate::standing::StandingModel;
use footfall_core::{Side, Skeleton, StepPosition};
use footfall_prob::windows::Windows;

/// States of a step's left-to-right hidden semi-Markov model (Tilmanne et al. 2012, section 5.1.1).
pub const STATES_PER_STEP: usize = 5;

/// A walk as a hidden semi-Markov model.
///
/// A step runs from one foot's initial contact to the other foot's. It has [`STATES_PER_STEP`] states in a row without
/// skips; each has one Gaussian with a diagonal covariance over the observation ([`OBSERVATION_COUNT`] numbers) and one
/// over its duration.
#[derive(Clone, Debug, PartialEq)]
pub struct GaitModel {
    /// Frames per second of features and durations.
    pub frame_rate_hz: f64,
    /// The body that it was trained on.
    pub skeleton: Skeleton,
    /// Time differences that the observations hold.
    pub windows: Windows,
    /// The step that begins with the left foot's initial contact, then the one with the right's.
    pub steps: [StepModel; 2],
    /// Total variance of the features of one walk.
    pub global_variance: GlobalVarianceModel,
    /// Change of a step with speed.
    pub speed: SpeedResponse,
    /// Variation between walkers, and between the steps of one walker.
    pub variation: Variation,
    /// Differences of steps at the ends of a walk from those inside it; none where they do not differ.
    pub contexts: Vec<StepContext>,
    /// Detail of steps beyond the trajectories of their states; nothing in models of earlier versions.
    pub fine: Option<FineMotion>,
    /// Standing; nothing in models of earlier versions, which stand still.
    pub standing: Option<StandingModel>,
    /// Running: steps of the same features and frame rate that end with a flight ([`StepModel::other_terminal`] is negative), and with no
    /// standing, running, jumping and crouching of their own. Nothing in models of earlier versions, which only walk.
    pub running: Option<Box<Self>>,
    /// Jumps off both feet; nothing in models of earlier versions.
    pub jump: Option<JumpModel>,
    /// Crouching; nothing in models of earlier versions.
    pub crouch: Option<CrouchModel>,
    /// Provenance of the model.
    pub provenance: Provenance,
}

/// Difference of the steps at one place of a walk from those inside it: the same foot's step plus an offset.
///
/// The means of the leaf of a decision tree over the ten contexts (five places, two feet; section 5.2.1), taken from those
/// of the steps inside a walk of the same speed. Variances are those of the steps inside.
#[derive(Clone, Debug, PartialEq)]
pub struct StepContext {
    /// The place.
    pub position: StepPosition,
    /// The foot whose initial contact begins the step.
    pub side: Side,
    /// Offset to add.
    pub offset: StepOffset,
}

/// One step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepModel {
    /// The states in order.
    pub states: Vec<StateModel>,
    /// When the other foot's terminal contact falls, as a fraction of the step's duration; negative in a run: the step ends with a flight of
    /// this share, as did the one before.
    pub other_terminal: f64,
}

/// One state of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct StateModel {
    /// Mean of the observation: statics, Δ, Δ².
    pub mean: Vec<f64>,
    /// Variance of the observation, all positive.
    pub variance: Vec<f64>,
    /// Mean duration in frames.
    pub duration_mean: f64,
    /// Variance of the duration in frames².
    pub duration_variance: f64,
}

/// Gaussian over the variance that one walk's static features have over time (equations 12 to 14).
#[derive(Clone, Debug, PartialEq)]
pub struct GlobalVarianceModel {
    /// Mean over walks.
    pub mean: Vec<f64>,
    /// Variance over walks.
    pub variance: Vec<f64>,
}

/// Difference between one step and the mean step: an offset to every state's mean, to the logarithm of its
/// duration, and to the time of the other foot's terminal contact.
#[derive(Clone, Debug, PartialEq)]
pub struct StepOffset {
    /// [`STATES_PER_STEP`] × [`OBSERVATION_COUNT`] offsets of the means, state by state.
    pub means: Vec<f64>,
    /// One offset a state to the logarithm of its duration.
    pub log_durations: Vec<f64>,
    /// Offset of [`StepModel::other_terminal`].
    pub other_terminal: f64,
}

impl StepOffset {
    /// Number of an offset's values.
    pub const LEN: usize = STATES_PER_STEP * OBSERVATION_COUNT + STATES_PER_STEP + 1;

    /// The parts of a [row](Self::to_row), each in units of its own: means, log-durations, terminal contact.
    pub const fn parts() -> [core::ops::Range<usize>; 3] {
        let means = STATES_PER_STEP * OBSERVATION_COUNT;
        let durations = means + STATES_PER_STEP;
        [0..means, means..durations, durations..Self::LEN]
    }

    /// No offset.
    pub fn zero() -> Self {
        Self {
            means: vec![0.0; STATES_PER_STEP * OBSERVATION_COUNT],
            log_durations: vec![0.0; STATES_PER_STEP],
            other_terminal: 0.0,
        }
    }

    /// Adds `weight` times another offset.
    pub fn add_scaled(&mut self, other: &Self, weight: f64) {
        for (value, addend) in self.means.iter_mut().zip(&other.means) {
            *value += weight * addend;
        }
        for (value, addend) in self.log_durations.iter_mut().zip(&other.log_durations) {
            *value += weight * addend;
        }
        self.other_terminal += weight * other.other_terminal;
    }

    /// All numbers in one row: means, log-durations, terminal contact.
    pub fn to_row(&self) -> Vec<f64> {
        let mut row = self.means.clone();
        row.extend_from_slice(&self.log_durations);
        row.push(self.other_terminal);
        row
    }

    /// The offset whose [`to_row`](Self::to_row) is `row`; `None` when the length differs from [`Self::LEN`].
    pub fn from_row(row: &[f64]) -> Option<Self> {
        (row.len() == Self::LEN).then(|| {
            let (means, rest) = row.split_at(STATES_PER_STEP * OBSERVATION_COUNT);
            let (log_durations, last) = rest.split_at(STATES_PER_STEP);
            Self {
                means: means.to_vec(),
                log_durations: log_durations.to_vec(),
                other_terminal: last[0],
            }
        })
    }
}

/// Change of a step with the speed of the walk: a linear regression over the steps of the corpus.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedResponse {
    /// The speed at which the offset is zero, m/s.
    pub reference_mps: f64,
    /// Slowest walk of the corpus, m/s.
    pub min_mps: f64,
    /// Fastest walk of the corpus, m/s.
    pub max_mps: f64,
    /// Slowest and fastest cadence of the corpus, steps per second.
    pub cadence_range_hz: [f64; 2],
    /// Offset per m/s, for the left and for the right step.
    pub slopes: [StepOffset; 2],
}

/// Variation between walkers and between the steps of one walker: principal components, each scaled so
/// that its weight is a standard normal number.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// Components that belong to a walker: one offset for the left and one for the right step.
    pub walker: Vec<[StepOffset; 2]>,
    /// Components that belong to a single step.
    pub step: Vec<[StepOffset; 2]>,
    /// Correlation of a step component's weight from one step to the next of the same foot.
    pub step_correlation: f64,
}

impl GaitModel {
    /// The step that begins with this foot's initial contact.
    pub fn step(&self, side: Side) -> &StepModel {
        &self.steps[side.index()]
    }

    /// Index of the context that applies at a place of the walk; `None` where the step is as inside.
    pub fn context(&self, position: StepPosition, side: Side) -> Option<usize> {
        let mut contexts = self.contexts.iter();
        contexts.position(|context| context.position == position && context.side == side)
    }

    /// Mean features of a whole stride ([`FEATURE_COUNT`]).
    pub fn mean_features(&self) -> Vec<f64> {
        let states = self.steps.iter().flat_map(|step| &step.states);
        let total: f64 = states.clone().map(|state| state.duration_mean).sum();
        let mut mean = vec![0.0; FEATURE_COUNT];
        for state in states {
            for (mean, value) in mean.iter_mut().zip(&state.mean) {
                *mean += value * state.duration_mean / total;
            }
        }
        mean
    }

    /// Slowest and fastest walk of the corpus, m/s on the model's body.
    pub fn speed_range(&self) -> [f64; 2] {
        [self.speed.min_mps, self.speed.max_mps]
    }

    /// Checks every shape and value, so that whatever uses the model afterwards cannot fail on it.
    ///
    /// # Errors
    /// [`ModelError`] names the first part at fault.
    pub fn check(&self) -> Result<(), ModelError> {
        check_positive("frame rate", &[self.frame_rate_hz])?;
        let soles = self
            .skeleton
            .feet
            .iter()
            .flat_map(|foot| [foot.heel, foot.ball, foot.toe_tip]);
        for offset in self.skeleton.offsets.iter().copied().chain(soles) {
            check_finite("skeleton", &offset.as_dvec3().to_array())?;
        }
        if self.skeleton.check().is_err() {
            return Err(ModelError::Value {
                part: "skeleton".to_owned(),
            });
        }
        for side in Side::BOTH {
            self.step(side).check(side.name())?;
        }
        self.global_variance.check()?;
        check_positive(
            "speeds",
            &[
                self.speed.reference_mps,
                self.speed.min_mps,
                self.speed.max_mps,
            ],
        )?;
        check_positive("cadences", &self.speed.cadence_range_hz)?;
        check_finite("step correlation", &[self.variation.step_correlation])?;
        let components = self.variation.walker.iter().chain(&self.variation.step);
        let contexts = self.contexts.iter().map(|context| &context.offset);
        for offset in self
            .speed
            .slopes
            .iter()
            .chain(components.flatten())
            .chain(contexts)
        {
            check_len(
                "step offset",
                &offset.means,
                STATES_PER_STEP * OBSERVATION_COUNT,
            )?;
            check_len(
                "step offset durations",
                &offset.log_durations,
                STATES_PER_STEP,
            )?;
            check_finite("step offset", &offset.to_row())?;
        }
        if let Some(fine) = &self.fine {
            fine.check(self.variation.walker.len())?;
        }
        if let Some(standing) = &self.standing {
            standing.check()?;
        }
        if let Some(jump) = &self.jump {
            jump.check()?;
        }
        if let Some(crouch) = &self.crouch {
            crouch.check()?;
        }
        match &self.running {
            Some(running) => running.check_running(self.frame_rate_hz),
            None => Ok(()),
        }
    }

    /// Checks this as the running of a model of this frame rate.
    fn check_running(&self, frame_rate_hz: f64) -> Result<(), ModelError> {
        let bad = |part: &str| {
            Err(ModelError::Value {
                part: format!("{part} of the run"),
            })
        };
        if (self.frame_rate_hz - frame_rate_hz).abs() > f64::EPSILON * frame_rate_hz {
            return bad("frame rate");
        }
        let more = [
            self.running.is_some(),
            self.standing.is_some(),
            self.jump.is_some(),
            self.crouch.is_some(),
        ];
        if more.contains(&true) {
            return bad("running, standing, jumping or crouching");
        }
        self.check()
    }
}

impl StepModel {
    /// Mean duration in frames.
    pub fn mean_frames(&self) -> f64 {
        self.states.iter().map(|state| state.duration_mean).sum()
    }

    /// Checks every shape and value; `name` says which step it is.
    pub(crate) fn check(&self, name: &str) -> Result<(), ModelError> {
        if self.states.len() != STATES_PER_STEP {
            return Err(ModelError::Shape {
                part: format!("states of the {name} step"),
                expected: STATES_PER_STEP,
                found: self.states.len(),
            });
        }
        check_finite(
            &format!("terminal contact of the {name} step"),
            &[self.other_terminal],
        )?;
        for (index, state) in self.states.iter().enumerate() {
            let part = format!("state {index} of the {name} step");
            check_len(&part, &state.mean, OBSERVATION_COUNT)?;
            check_len(&part, &state.variance, OBSERVATION_COUNT)?;
            check_finite(&part, &state.mean)?;
            check_positive(&part, &state.variance)?;
            check_positive(&part, &[state.duration_mean, state.duration_variance])?;
        }
        Ok(())
    }
}

impl GlobalVarianceModel {
    /// Checks every shape and value.
    pub(crate) fn check(&self) -> Result<(), ModelError> {
        check_len("global variance mean", &self.mean, FEATURE_COUNT)?;
        check_len("global variance variance", &self.variance, FEATURE_COUNT)?;
        check_positive("global variance mean", &self.mean)?;
        check_positive("global variance variance", &self.variance)
    }
}
