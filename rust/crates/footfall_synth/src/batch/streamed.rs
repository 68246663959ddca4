//! Recordings of the streaming generator.

use super::walk::{SynthesizedWalk, WalkConfig};
use crate::config::GeneratorConfig;
use crate::controls::Controls;
use crate::error::SynthError;
use crate::generator::GaitGenerator;
use crate::source::StyleSpace;
use footfall_core::rotation::from_heading;
use footfall_core::{Clip, FrameSpan, Joint, Pose, Skeleton};
use footfall_model::{DynamicsModel, GaitModel};
use std::sync::Arc;

/// Standing before and after the walk, seconds.
const STANDING_SECS: f64 = 0.6;

/// Maximum time per step, seconds.
const LONGEST_STEP_SECS: f64 = 4.0;

/// Walk that begins and ends standing.
pub(crate) fn from_standing(
    model: &Arc<GaitModel>,
    skeleton: &Skeleton,
    config: &WalkConfig,
) -> Result<SynthesizedWalk, SynthError> {
    let space = Arc::new(StyleSpace::new(model, &[])?);
    let walker = GeneratorConfig {
        seed: config.seed,
        phase: 0.0,
        variation: config.variation,
    };
    let mut generator = GaitGenerator::new(&space, &[], skeleton, &walker)?;
    generator.stand();
    let rate = config.frame_rate_hz.unwrap_or(model.frame_rate_hz);
    let mut recording = Recording::new(generator, rate);
    let frames = |secs: f64| (secs * recording.frame_rate_hz).round() as usize;
    let (rest, longest) = (frames(STANDING_SECS), frames(LONGEST_STEP_SECS));
    let walking = Controls {
        speed_mps: config.speed_mps.unwrap_or(model.speed.reference_mps as f32),
        turn_rate_radps: config.turn_rate_radps,
        direction_rad: config.direction_rad,
        gait: config.gait,
        ..Controls::STAND
    };
    for _ in 0..=rest {
        recording.step(Controls::STAND);
    }
    // Each landing begins a step; the first begins from standing.
    recording.step(walking);
    let mut taken = 1;
    let steps = config.steps.max(2);
    // The last step stops. The stop is requested in the second half of the previous step, which would itself stop if it were requested earlier.
    for _ in 0..steps * longest {
        if taken + 1 == steps && recording.generator.share_of_step() >= 0.5 {
            break;
        }
        taken += recording.step(walking);
    }
    for _ in 0..2 * longest {
        if taken >= steps && recording.generator.is_standing() {
            break;
        }
        taken += recording.step(Controls::STAND);
    }
    for _ in 0..rest {
        recording.step(Controls::STAND);
    }
    Ok(recording.into_walk(skeleton))
}

/// Controls of a walker from a time on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// Start time, seconds.
    pub time_secs: f64,
    /// The controls.
    pub controls: Controls,
    /// Rise of the hips in one jump requested at that time, metres, as of [`GaitGenerator::jump`]; 0 for none.
    pub jump_m: f32,
}

/// Generates a sequence of moves out of standing; the first begins at once, whatever its time. `config` sets the person and the
/// length.
///
/// # Errors
/// [`SynthError`] when the model or the skeleton cannot be used or a setting is not finite.
pub fn synthesize_moves(
    model: &Arc<GaitModel>,
    skeleton: &Skeleton,
    moves: &[Move],
    config: &StandConfig,
) -> Result<SynthesizedWalk, SynthError> {
    let (mut recording, rate) = standing_recording(model, skeleton, config)?;
    let mut next = 0;
    let mut controls = Controls::STAND;
    for frame in 0..=(config.seconds.max(0.0) * rate).round() as usize {
        let time = frame as f64 / rate;
        while let Some(begun) = moves.get(next).filter(|begun| begun.time_secs <= time) {
            controls = begun.controls;
            recording.generator.jump(begun.jump_m);
            next += 1;
        }
        recording.step(controls);
    }
    Ok(recording.into_walk(skeleton))
}

/// Settings of a recording of a standing person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandConfig {
    /// Length, seconds.
    pub seconds: f64,
    /// Seed of the person.
    pub seed: u64,
    /// Differences between people: 0 none, 1 as in the recordings.
    pub variation: f32,
    /// Amount of standing motion, as of [`GaitGenerator::set_standing_motion`].
    pub motion: f32,
    /// Frames per second of the clip; the model's when absent.
    pub frame_rate_hz: Option<f64>,
}

/// Generates a standing person.
///
/// # Errors
/// [`SynthError`] when the model or the skeleton cannot be used or a setting is not finite.
pub fn synthesize_standing(
    model: &Arc<GaitModel>,
    skeleton: &Skeleton,
    config: &StandConfig,
) -> Result<SynthesizedWalk, SynthError> {
    let (mut recording, rate) = standing_recording(model, skeleton, config)?;
    for _ in 0..=(config.seconds.max(0.0) * rate).round() as usize {
        recording.step(Controls::STAND);
    }
    Ok(recording.into_walk(skeleton))
}

/// Generator of a standing person, to be recorded at this frame rate.
fn standing_recording(
    model: &Arc<GaitModel>,
    skeleton: &Skeleton,
    config: &StandConfig,
) -> Result<(Recording, f64), SynthError> {
    let rate = config.frame_rate_hz.unwrap_or(model.frame_rate_hz);
    for (setting, value) in [
        ("seconds", config.seconds as f32),
        ("frame rate", rate as f32),
    ] {
        if !value.is_finite() {
            return Err(SynthError::Setting { setting, value });
        }
    }
    let space = Arc::new(StyleSpace::new(model, &[])?);
    let stander = GeneratorConfig {
        seed: config.seed,
        phase: 0.0,
        variation: config.variation,
    };
    let mut generator = GaitGenerator::new(&space, &[], skeleton, &stander)?;
    generator.set_standing_motion(config.motion);
    generator.stand();
    Ok((Recording::new(generator, rate), rate))
}

/// Settings of a walk of a switching model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchingWalkConfig {
    /// Length, seconds.
    pub seconds: f64,
    /// Seed of the walker and of its walk.
    pub seed: u64,
    /// Differences of steps from the average: 0 none, 1 as in the recordings.
    pub variation: f32,
    /// Speed over the ground, m/s; that of the recordings when absent.
    pub speed_mps: Option<f32>,
    /// Turn rate, rad/s, positive to the left.
    pub turn_rate_radps: f32,
    /// Direction of travel relative to the facing direction, as of [`Controls::direction_rad`].
    pub direction_rad: f32,
    /// Frames per second of the clip; the model's when absent.
    pub frame_rate_hz: Option<f64>,
}

/// Generates a walk of a switching model (*Gait as a switching dynamical system*, section 4), which begins with an initial contact
/// of the left foot.
///
/// # Errors
/// [`SynthError`] when the model or the skeleton cannot be used or a setting is not finite.
pub fn synthesize_switching(
    model: &Arc<DynamicsModel>,
    skeleton: &Skeleton,
    config: &SwitchingWalkConfig,
) -> Result<SynthesizedWalk, SynthError> {
    let rate = config.frame_rate_hz.unwrap_or(model.frame_rate_hz);
    let settings = [
        ("seconds", config.seconds as f32),
        ("frame rate", rate as f32),
        ("speed", config.speed_mps.unwrap_or(0.0)),
        ("turn rate", config.turn_rate_radps),
        ("direction", config.direction_rad),
    ];
    for (setting, value) in settings {
        if !value.is_finite() {
            return Err(SynthError::Setting { setting, value });
        }
    }
    let walker = GeneratorConfig {
        seed: config.seed,
        phase: 0.0,
        variation: config.variation,
    };
    let generator = GaitGenerator::switching(model, skeleton, &walker)?;
    let controls = Controls {
        speed_mps: config.speed_mps.unwrap_or(generator.usual_speed_mps()),
        turn_rate_radps: config.turn_rate_radps,
        direction_rad: config.direction_rad,
        ..Controls::STAND
    };
    let mut recording = Recording::new(generator, rate);
    for _ in 0..=(config.seconds.max(0.0) * rate).round() as usize {
        recording.step(controls);
    }
    Ok(recording.into_walk(skeleton))
}

struct Recording {
    generator: GaitGenerator,
    frame_rate_hz: f64,
    poses: Vec<Pose>,
    contact: [Vec<bool>; 2],
}

impl Recording {
    fn new(generator: GaitGenerator, frame_rate_hz: f64) -> Self {
        Self {
            generator,
            frame_rate_hz,
            poses: Vec::new(),
            contact: [Vec::new(), Vec::new()],
        }
    }

    /// Records a frame; returns the number of feet that landed.
    fn step(&mut self, controls: Controls) -> usize {
        // The first frame is where the walker stands.
        let dt = if self.poses.is_empty() {
            0.0
        } else {
            (1.0 / self.frame_rate_hz) as f32
        };
        let mut pose = Pose::default();
        self.generator.step(dt, &controls, &mut pose);
        let place = self.generator.start_from_character();
        let turn = from_heading(place.heading);
        pose.root_position = turn * pose.root_position + place.position;
        let hips = Joint::Hips.index();
        pose.rotations[hips] = (turn * pose.rotations[hips]).normalize();
        self.poses.push(pose);
        let feet = self.generator.feet_in_contact();
        for (contact, bears) in self.contact.iter_mut().zip(feet) {
            contact.push(bears);
        }
        self.generator.footsteps().len()
    }

    fn into_walk(self, skeleton: &Skeleton) -> SynthesizedWalk {
        SynthesizedWalk {
            contacts: self.contact.map(|contact| FrameSpan::runs(&contact)),
            clip: Clip {
                skeleton: skeleton.clone(),
                frame_rate_hz: self.frame_rate_hz,
                poses: self.poses,
            },
        }
    }
}
