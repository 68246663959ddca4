//! Training of switching models on labelled clips (*Gait as a switching dynamical system*, sections 3 and 4).
//!
//! Hip and knee angles show when the legs change roles. The poses between two switches are a segment; every other segment
//! belongs to the same system. Poses are reduced to their principal components, and each system is identified in closed form over
//! all of its segments, then refined.

mod comparison;
mod pose_space;

pub use comparison::{DynamicsComparison, ErrorCurve, compare_dynamics};

use crate::dataset::{EncodeConfig, EncodedRecording};
use crate::encoded::number_of;
use crate::error::TrainError;
use crate::sequence::Sequence;
use crate::train::mean_terminal;
use footfall_core::Side;
use footfall_model::{DynamicsModel, FEATURE_COUNT, OBSERVATION_COUNT, Provenance, Regime};
use footfall_motion::recording::Recording;
use footfall_motion::steps::Walk;
use footfall_motion::switches::{Landing, SwitchConfig, detect_switches_by, walks};
use footfall_prob::subspace::{
    AffineSystem, IdentifyConfig, Refinement, identify, initial_states, refine,
};
use footfall_prob::windows::Windows;
use nalgebra::DVector;
use pose_space::PoseSpace;

/// Kinematic and switching contacts this close are one, seconds.
const SAME_CONTACT_SECS: f64 = 0.12;

/// Frames of a column in identification: tried in turn, up to half of the longest segment.
pub const WINDOWS: [usize; 10] = [2, 3, 4, 5, 6, 8, 11, 15, 20, 30];

/// Settings of the fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicsConfig {
    /// Frames per second of the systems.
    pub frame_rate_hz: f64,
    /// Principal components of the pose; the paper found 8 to be enough.
    pub components: usize,
    /// Order of each system; 12 in the paper.
    pub order: usize,
    /// Steps of refinement at most.
    pub refine_steps: usize,
}

impl Default for DynamicsConfig {
    /// Returns the paper's settings.
    fn default() -> Self {
        Self {
            frame_rate_hz: 60.0,
            components: 8,
            order: 12,
            refine_steps: 400,
        }
    }
}

/// A fitted model, and its fit to its clips.
#[derive(Clone, Debug)]
pub struct FittedDynamics {
    /// The model.
    pub model: DynamicsModel,
    /// Segments of the left and of the right foot.
    pub segments: [usize; 2],
    /// Share of the features' variance that the components hold.
    pub explained: f64,
    /// Root mean square one-step error of each system over the spread of the component weights.
    pub one_step_error: [f64; 2],
}

/// Fits both systems. `provenance` gets the counts of clips, subjects and steps filled in.
///
/// # Errors
/// [`TrainError`] when the clips show too few steps, or they do not determine the systems.
pub fn fit_dynamics(
    clips: &[Recording],
    config: &DynamicsConfig,
    provenance: Provenance,
) -> Result<FittedDynamics, TrainError> {
    let skeleton = clips
        .first()
        .ok_or(TrainError::NoSteps)?
        .clip()
        .skeleton
        .clone();
    let walks = SwitchWalks::read(clips, config)?;
    let pose = PoseSpace::of(&walks.sequences, &skeleton, config.components)?;
    let outputs = Outputs::of(&walks.sequences, &pose);
    let mut segments = [0; 2];
    let mut one_step_error = [0.0; 2];
    let mut regimes = Vec::with_capacity(2);
    for side in Side::BOTH {
        let own = outputs.segments(side);
        if own.is_empty() {
            return Err(TrainError::MissingSide { side });
        }
        let system = fit_segments(&own, config)?;
        segments[side.index()] = own.len();
        one_step_error[side.index()] = system.error / outputs.spread;
        regimes.push(regime(&system.system, &own, &walks.sequences, side)?);
    }
    let Ok(regimes) = <[Regime; 2]>::try_from(regimes) else {
        return Err(TrainError::NoSteps);
    };
    let model = DynamicsModel {
        frame_rate_hz: config.frame_rate_hz,
        skeleton,
        mean: pose.mean,
        components: pose.components,
        regimes,
        provenance: Provenance {
            clips: walks.clips,
            subjects: walks.subjects,
            steps: segments.iter().sum(),
            ..provenance
        },
    };
    model.check()?;
    Ok(FittedDynamics {
        model,
        segments,
        explained: pose.explained,
        one_step_error,
    })
}

/// Statistics of a system's segments.
fn regime(
    system: &AffineSystem,
    segments: &[&[f64]],
    sequences: &[Sequence],
    side: Side,
) -> Result<Regime, TrainError> {
    let starts = initial_states(system, segments)?
        .iter()
        .map(|start| start.as_slice().to_vec())
        .collect();
    Ok(Regime {
        system: system.clone(),
        starts,
        frames: segments
            .iter()
            .map(|segment| segment.len() / system.channels())
            .collect(),
        other_terminal: mean_terminal(sequences, side),
    })
}

/// One fitted system.
#[derive(Clone, Debug)]
pub struct FittedSystem {
    /// The system.
    pub system: AffineSystem,
    /// Its root mean square one-step error.
    pub error: f64,
    /// The state in which each segment begins.
    pub starts: Vec<DVector<f64>>,
}

/// Fits one system to segments of component weights, each T × [`components`](DynamicsConfig::components) frame by frame: identified
/// in closed form, then refined, first left to itself, then the gain alone.
///
/// # Errors
/// [`TrainError`] when the segments do not determine the system.
pub fn fit_segments(
    segments: &[&[f64]],
    config: &DynamicsConfig,
) -> Result<FittedSystem, TrainError> {
    let identified = identify_best(segments, config)?;
    let alone = refine(
        &identified,
        segments,
        Refinement::Simulation,
        config.refine_steps,
    )?;
    let system = AffineSystem {
        gain: identified.gain,
        ..alone.system
    };
    let predicting = refine(&system, segments, Refinement::Gain, config.refine_steps)?;
    let last = predicting.errors.last().copied().unwrap_or_default();
    Ok(FittedSystem {
        error: (2.0 * last).sqrt(),
        system: predicting.system,
        starts: predicting.starts,
    })
}

/// Of the systems estimated with windows of different lengths, the one whose free simulation comes closest to the segments: short
/// windows take noise for the system, long ones leave few columns.
fn identify_best(segments: &[&[f64]], config: &DynamicsConfig) -> Result<AffineSystem, TrainError> {
    let mut best: Option<(f64, AffineSystem)> = None;
    let mut failed = None;
    let longest = segments.iter().map(|segment| segment.len()).max();
    let most = longest.unwrap_or(0) / (2 * config.components.max(1));
    for window in WINDOWS
        .into_iter()
        .filter(|window| *window <= most.max(WINDOWS[0]))
    {
        let size = IdentifyConfig {
            order: config.order,
            window,
        };
        let tried = identify(segments, config.components, &size).and_then(|system| {
            let alone = refine(&system, segments, Refinement::Simulation, 0)?;
            Ok((alone.errors[0], system))
        });
        match tried {
            Ok(tried) => {
                if best.as_ref().is_none_or(|(least, _)| tried.0 < *least) {
                    best = Some(tried);
                }
            }
            Err(error) => failed = Some(error),
        }
    }
    match (best, failed) {
        (Some((_, system)), _) => Ok(system),
        (None, Some(error)) => Err(error.into()),
        (None, None) => Err(TrainError::NoSteps),
    }
}

/// Walks as their switches cut them.
struct SwitchWalks {
    sequences: Vec<Sequence>,
    clips: usize,
    subjects: usize,
}

impl SwitchWalks {
    fn read(clips: &[Recording], config: &DynamicsConfig) -> Result<Self, TrainError> {
        let encoding = EncodeConfig {
            frame_rate_hz: config.frame_rate_hz,
            windows: Windows::Compact,
        };
        let mut read = Self {
            sequences: Vec::new(),
            clips: 0,
            subjects: 0,
        };
        let mut subjects: Vec<&str> = Vec::new();
        for clip in clips {
            let walks = switch_walks(clip)?;
            let found = EncodedRecording::of(clip, &encoding)?.walks(&walks, 0);
            if found.is_empty() {
                continue;
            }
            read.clips += 1;
            number_of(clip.subject(), &mut subjects);
            read.sequences.extend(found);
        }
        read.subjects = subjects.len();
        if read.sequences.is_empty() {
            return Err(TrainError::NoSteps);
        }
        Ok(read)
    }
}

/// The steps of a recording as its switches cut them; when the other foot leaves the ground is taken from the kinematic steps.
fn switch_walks(recording: &Recording) -> Result<Vec<Walk>, TrainError> {
    let (clip, first) = (recording.clip(), recording.first_frame());
    let rate = clip.frame_rate_hz;
    // A model is cut where the dynamics change, within a frame of the landing.
    let switches = detect_switches_by(clip, first, &SwitchConfig::by(Landing::LegsAndResidual))?;
    let mut walks = walks(&switches, rate);
    for step in walks.iter_mut().flat_map(|walk| &mut walk.steps) {
        let mut kinematic = recording.walks.iter().flat_map(|walk| &walk.steps);
        let same = kinematic.find(|known| {
            known.side == step.side
                && known.first.abs_diff(step.first) as f64 <= SAME_CONTACT_SECS * rate
        });
        step.other_terminal = same
            .and_then(|known| known.other_terminal)
            .filter(|frame| (step.first..step.end).contains(frame));
    }
    Ok(walks)
}

/// The component weights of all sequences, and where their segments are.
struct Outputs {
    channels: usize,
    sequences: Vec<Vec<f64>>,
    /// Sequence, side, first frame and end.
    cuts: Vec<(usize, Side, usize, usize)>,
    /// Root mean square of all weights.
    spread: f64,
}

impl Outputs {
    fn of(sequences: &[Sequence], pose: &PoseSpace) -> Self {
        let mut outputs = Self {
            channels: pose.components.len(),
            sequences: Vec::with_capacity(sequences.len()),
            cuts: Vec::new(),
            spread: 0.0,
        };
        let (mut squares, mut count) = (0.0, 0.0);
        for (index, sequence) in sequences.iter().enumerate() {
            let mut weights = Vec::with_capacity(sequence.frames() * outputs.channels);
            for row in sequence.observations.chunks_exact(OBSERVATION_COUNT) {
                pose.project(&row[..FEATURE_COUNT], &mut weights);
            }
            squares += weights.iter().map(|weight| weight * weight).sum::<f64>();
            count += weights.len() as f64;
            outputs.sequences.push(weights);
            for step in &sequence.steps {
                outputs.cuts.push((index, step.side, step.first, step.end));
            }
        }
        outputs.spread = (squares / f64::max(count, 1.0))
            .sqrt()
            .max(f64::MIN_POSITIVE);
        outputs
    }

    fn segments(&self, side: Side) -> Vec<&[f64]> {
        let own = self.cuts.iter().filter(|cut| cut.1 == side);
        own.map(|(sequence, _, first, end)| {
            &self.sequences[*sequence][first * self.channels..end * self.channels]
        })
        .collect()
    }
}
