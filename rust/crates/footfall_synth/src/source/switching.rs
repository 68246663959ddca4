//! Steps of a switching model: two linear systems alternate, each from a state in which a recorded segment began (*Gait as a
//! switching dynamical system*, section 4).

mod source;
mod system;

use super::step_source::StepSource as _;
use crate::config::GeneratorConfig;
use crate::controls::GaitChoice;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::gait::{Amplitude, Posture, StepControls, overstep, standing_posture, tempo_and_stride};
use crate::ground::{Displacement, GeneratedFrame, Placing, PlantedStep, PlanterState};
use crate::plan::{MAX_STEP_SECS, StepShape};
use footfall_core::{Side, Skeleton};
use footfall_model::{DynamicsModel, FEATURE_COUNT, SEGMENT_SLACK};
use glam::{Vec2, Vec3};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use std::sync::Arc;
use system::{FeatureLanes, Pose, RunningSystem};

/// Number of nearest recorded starts from which a segment's start is drawn: the pose continues, and still varies.
const NEAREST: usize = 4;

/// Time constant with which the jump of the pose at a switch fades, seconds.
const SETTLE_SECS: f64 = 0.06;

/// Maximum number of frames between the end of a segment and the recorded one, chosen for the best match with the next segment.
const SWITCH_REACH: usize = 2;

// Two frames beyond the end are looked at.
const _: () = assert!(SWITCH_REACH + 2 <= SEGMENT_SLACK);

/// Ratios of the recorded speed at which the direction is measured, the recorded speed last.
const FACING_RATIOS: [f64; 2] = [0.4, 1.0];

/// Number of steps for the measurement of the speed, enough to average out chance.
const MEASURED_STEPS: usize = 80;

/// Maximum ratio of the speed to the recorded one.
const MAX_SPEED_RATIO: f64 = 1.4;

/// Largest factor between the tempo of steps to the side or backwards and of forward steps of the same speed.
const MAX_HASTE: f64 = 1.6;

/// Steps of two alternating systems.
#[derive(Debug)]
pub(crate) struct SwitchingSteps {
    pub(crate) model: Arc<DynamicsModel>,
    /// [`DynamicsModel::fingerprint`].
    pub(crate) fingerprint: u32,
    systems: [RunningSystem; 2],
    pose: Pose,
    standing: Posture,
    planted: PlantedStep,
    generated: Vec<GeneratedFrame>,
    rng: ChaCha8Rng,
    variation: f64,
    shape: StepShape,
    pub(crate) origin: SwitchingOrigin,
    /// Component weights of the current segment, frame by frame, two frames beyond its end.
    weights: Vec<f32>,
    features: Vec<FeatureLanes>,
    /// Speed of the recorded walk on this body, m/s.
    pub(crate) own_speed_mps: f64,
    /// Mean duration of its steps, seconds.
    own_step_secs: f32,
    leg_length: f32,
    /// Headings under which the walk goes along +Z at each of [`FACING_RATIOS`], radians.
    facings: [f32; 2],
    /// Velocity of the current step, to the left and forwards relative to the facing direction.
    pub(crate) velocity_mps: Vec2,
}

/// Origin of the current step: with the model, all data needed to generate it again.
#[derive(Clone, Debug)]
pub(crate) struct SwitchingOrigin {
    pub(crate) leading: Side,
    pub(crate) tempo: f64,
    pub(crate) stride: f64,
    pub(crate) detail: Detail,
    pub(crate) amplitude: Amplitude,
    pub(crate) turn_rate: f32,
    pub(crate) facing: [f32; 2],
    /// Position in the sequence of random numbers.
    pub(crate) chance_position: u64,
    /// The two frames with which the previous segment would continue; empty for the first.
    pub(crate) expected: Vec<f32>,
    /// Feet before the step; `None` for the first.
    pub(crate) planter: Option<PlanterState>,
}

impl SwitchingSteps {
    /// Starts in the middle of a walk, with the initial contact of the foot `first`.
    ///
    /// # Errors
    /// [`SynthError::Model`] when the model cannot be used.
    pub(crate) fn new(
        model: &Arc<DynamicsModel>,
        skeleton: &Skeleton,
        config: &GeneratorConfig,
        first: Side,
    ) -> Result<Self, SynthError> {
        model.check()?;
        let mut steps = Self::prepare(model, skeleton, model.fingerprint()?);
        steps.draw_by(&GeneratorConfig { seed: 0, ..*config });
        steps.measure();
        steps.draw_by(config);
        steps.begin(first, Amplitude::WALK, steps.own_speed_mps, Detail::Full);
        Ok(steps)
    }

    fn prepare(model: &Arc<DynamicsModel>, skeleton: &Skeleton, fingerprint: u32) -> Self {
        let longest = (MAX_STEP_SECS * model.frame_rate_hz).ceil() as usize;
        let longest = Detail::Quarter.whole_frames(longest);
        let channels = model.components.len();
        Self {
            systems: Side::BOTH.map(|side| RunningSystem::new(model.regime(side))),
            standing: standing_of(&model.mean),
            pose: Pose::new(model),
            planted: PlantedStep::new(skeleton, model.frame_rate_hz, longest),
            generated: PlantedStep::generated(longest),
            rng: ChaCha8Rng::seed_from_u64(0),
            variation: 0.0,
            shape: StepShape::of_walk(Side::Left, 1, 0.0, 1.0, Detail::Full),
            origin: SwitchingOrigin {
                leading: Side::Left,
                tempo: 1.0,
                stride: 1.0,
                detail: Detail::Full,
                amplitude: Amplitude::WALK,
                turn_rate: 0.0,
                facing: [0.0; 2],
                chance_position: 0,
                expected: Vec::with_capacity(2 * channels),
                planter: None,
            },
            weights: Vec::with_capacity((longest + SWITCH_REACH + 2) * channels),
            features: Vec::with_capacity(longest + 1),
            own_speed_mps: 1.0,
            own_step_secs: 0.5,
            leg_length: skeleton.mean_leg_length(),
            facings: [0.0; 2],
            velocity_mps: Vec2::ZERO,
            model: Arc::clone(model),
            fingerprint,
        }
    }

    /// Sets the seed and the variation.
    fn draw_by(&mut self, config: &GeneratorConfig) {
        self.rng = ChaCha8Rng::seed_from_u64(config.seed);
        self.variation = f64::from(config.variation.clamp(0.0, 2.0));
    }

    /// Measures direction and speed on some steps: first the directions, under which the speed is then measured.
    fn measure(&mut self) {
        let mut own = 1.0;
        for _ in 0..2 {
            for (index, ratio) in FACING_RATIOS.into_iter().enumerate() {
                let (travel, frames) = self.travel(ratio);
                self.facings[index] -= travel.x.atan2(travel.z);
                let secs = frames as f64 / self.model.frame_rate_hz;
                own = f64::from(travel.length()) / secs;
                self.own_step_secs = secs as f32 / MEASURED_STEPS as f32;
            }
        }
        self.own_speed_mps = own.max(0.05);
    }

    /// Returns the travel over the ground and the frames of some steps at this ratio of the own speed.
    fn travel(&mut self, ratio: f64) -> (Vec3, usize) {
        let speed = ratio * self.own_speed_mps;
        let controls = StepControls {
            leap_m: None,
            brakes: None,
            gait: GaitChoice::Walk,
            velocity_mps: speed as f32 * Vec2::Y,
            turn_rate: 0.0,
            amplitude: Amplitude::WALK,
            detail: Detail::Full,
        };
        self.begin(Side::Left, controls.amplitude, speed, controls.detail);
        let (mut travel, mut frames) = (Vec3::ZERO, 0);
        for step in 0..2 + MEASURED_STEPS {
            self.advance(&controls);
            if step >= 2 {
                travel += self.planted.travel(&self.shape);
                frames += self.shape.timing.frames;
            }
        }
        (travel, frames)
    }

    /// Returns the heading under which the walk goes along +Z at the current stride.
    fn facing(&self) -> f32 {
        let [low, high] = FACING_RATIOS.map(|ratio| pace_of(ratio).1);
        let share = ((self.origin.stride - low) / (high - low)).clamp(0.0, 1.0);
        self.facings[0] + share as f32 * (self.facings[1] - self.facings[0])
    }

    /// Restarts with a hidden step, then the first.
    fn begin(&mut self, first: Side, amplitude: Amplitude, speed_mps: f64, detail: Detail) {
        self.planted.clear();
        self.weights.clear();
        self.origin.turn_rate = 0.0;
        self.origin.amplitude = amplitude;
        self.origin.detail = detail;
        self.velocity_mps = speed_mps as f32 * Vec2::Y;
        self.set_pace();
        self.origin.facing = [self.facing(); 2];
        for side in [first.other(), first] {
            self.take_over(side);
            self.generate_and_plant();
        }
    }

    /// Restores an [`origin`](SwitchingOrigin) and generates its step again.
    pub(crate) fn resume(
        &mut self,
        config: &GeneratorConfig,
        origin: SwitchingOrigin,
        velocity_mps: Vec2,
    ) {
        self.draw_by(config);
        self.rng.set_word_pos(u128::from(origin.chance_position));
        match origin.planter {
            Some(state) => self.planted.resume(&state),
            None => self.planted.clear(),
        }
        self.origin = origin;
        // Steps allocate nothing.
        self.origin
            .expected
            .reserve(2 * self.model.components.len());
        self.velocity_mps = velocity_mps;
        self.generate_and_plant();
    }

    /// Sets tempo and stride for the current velocity.
    fn set_pace(&mut self) {
        let ratio = f64::from(self.velocity_mps.length()) / self.own_speed_mps;
        let (tempo, stride) = pace_of(ratio);
        let secs = self.own_step_secs / tempo as f32;
        let over = overstep(self.velocity_mps, secs, self.leg_length);
        let haste = f64::from(over).clamp(1.0, MAX_HASTE);
        (self.origin.tempo, self.origin.stride) = (tempo * haste, stride / haste);
    }

    /// Makes the end of the current step the origin of the next.
    fn take_over(&mut self, leading: Side) {
        self.origin.leading = leading;
        self.origin.chance_position = self.rng.get_word_pos() as u64;
        self.origin.planter = self.planted.planter_state();
        let channels = self.model.components.len();
        self.origin.expected.clear();
        let end = self.weights.len().saturating_sub(2 * channels);
        self.origin.expected.extend_from_slice(&self.weights[end..]);
    }

    /// Generates the step of the [`origin`](SwitchingOrigin) and plants it.
    fn generate_and_plant(&mut self) {
        self.generate();
        self.plant();
    }

    fn plant(&mut self) {
        let rows = self.features.iter();
        let rows = rows.map(|row| &row.as_flattened()[..FEATURE_COUNT]);
        self.planted.put(
            rows,
            &Placing {
                shape: &self.shape,
                standing: [&self.standing; 2],
                walking: [&self.standing; 2],
                turn_rate: self.origin.turn_rate,
                facing: self.origin.facing,
                velocity_mps: self.velocity_mps,
                velocity_before_mps: self.velocity_mps,
                passed: 0.0,
                displacement: Displacement::NONE,
                direction: None,
                rights_itself: false,
                keeps_lengths: false,
            },
            &mut self.generated,
        );
    }

    /// Generates the features of the next step without planting it; returns its number of frames.
    pub(crate) fn generate_next(&mut self) -> usize {
        self.take_over(self.origin.leading.other());
        self.generate();
        self.shape.timing.frames
    }

    fn generate(&mut self) {
        let side = self.origin.leading;
        let start = self.draw_start(side);
        let longest = (MAX_STEP_SECS * self.model.frame_rate_hz) as usize;
        let drawn = self.model.regime(side).frames[start].min(longest);
        let settle = SETTLE_SECS * self.model.frame_rate_hz;
        let reach = SWITCH_REACH.min(drawn - 1);
        let system = &mut self.systems[side.index()];
        system.run(
            start,
            drawn + reach + 2,
            &self.origin.expected,
            settle as f32,
            &mut self.weights,
        );
        let length = self.switch_near(drawn, reach);

        let frames = (length as f64 / self.origin.tempo).round() as usize;
        let terminal = self.model.regime(side).other_terminal;
        let frames = frames.min(longest);
        self.shape = StepShape::of_walk(
            side,
            frames,
            terminal,
            self.origin.stride,
            self.origin.detail,
        );
        self.shape.set_amplitude(self.origin.amplitude);
        self.write_features(length);
    }

    /// Returns the end of the segment: the frame within `reach` of the recorded end from which the other system continues best.
    fn switch_near(&mut self, drawn: usize, reach: usize) -> usize {
        let channels = self.model.components.len();
        let other = &self.systems[self.origin.leading.other().index()];
        let mut best = (f32::INFINITY, drawn);
        for end in drawn - reach..=drawn + reach {
            let after = &self.weights[end * channels..][..2 * channels];
            let gap = other.least_distance(after);
            if gap < best.0 {
                best = (gap, end);
            }
        }
        let length = best.1;
        self.weights.truncate((length + 2) * channels);
        length
    }

    /// Draws one of the recorded starts that continue best from the current pose.
    fn draw_start(&mut self, side: Side) -> usize {
        let system = &self.systems[side.index()];
        let nearest = system.nearest::<NEAREST>(&self.origin.expected);
        let among = if self.variation > 0.0 {
            nearest.len()
        } else {
            1
        };
        // Always drawn, so that chance advances equally.
        let drawn = self.rng.random_range(0..nearest.len());
        nearest.get(drawn.min(among - 1))
    }

    /// Writes the features of the step's frames and of the next one, at the step's tempo.
    fn write_features(&mut self, length: usize) {
        let frames = self.shape.timing.frames;
        self.features.resize(frames + 1, FeatureLanes::default());
        let frames_per_row = length as f32 / frames as f32;
        self.pose
            .write(&self.weights, frames_per_row, &mut self.features);
    }
}

/// Tempo and stride at a ratio of the recorded speed.
fn pace_of(ratio: f64) -> (f64, f64) {
    tempo_and_stride(ratio.clamp(0.0, MAX_SPEED_RATIO))
}

fn standing_of(mean: &[f64]) -> Posture {
    let mut wide = [0.0; FEATURE_COUNT];
    wide.copy_from_slice(mean);
    standing_posture(wide)
}
