//! The streaming generator: one walker, for as long as you like.

use crate::detail::Detail;
use crate::error::SynthError;
use crate::pace::PaceTable;
use crate::plan::{Manner, Planner};
use crate::planting::PlantedFrame;
use crate::space::{Blend, StyleSpace};
use crate::standing::Amplitude;
use crate::walker::{Request, Walker};
use footfall_core::rotation::{from_heading, wrap_angle};
use footfall_core::{Joint, Pose, Side, Skeleton, StepPosition};
use footfall_ik::RockerFoot;
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Initial contacts that one call of [`GaitGenerator::step`] reports at most.
const MAX_FOOTSTEPS: usize = 64;

/// A single call advances by this much at most, seconds.
const MAX_DT_SECS: f32 = 10.0;

/// Slower and turning less than this is standing.
const STANDING_SPEED_MPS: f32 = 0.1;
const STANDING_TURN_RATE_RADPS: f32 = 0.05;

/// Fastest speed and turning that are walked.
const MAX_SPEED_MPS: f32 = 3.0;
const MAX_TURN_RATE_RADPS: f32 = 2.0;

/// A step's speed differs by at most this much from the speed of the step before, m/s: nobody brakes faster.
const MAX_SPEED_CHANGE_MPS: f32 = 0.5;

/// Closer than this share of a frame counts as on it: time adds up with rounding.
const SAME_FRAME: f32 = 1e-2;

/// What makes one walker differ from another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneratorConfig {
    /// Seed of the walker's own way of walking and of the variation of its steps.
    pub seed: u64,
    /// Where in the stride to begin: 0 is the left foot's initial contact, 0.5 the right's.
    pub phase: f32,
    /// How far walkers and steps stray from the average: 0 not at all, 1 as in the recordings.
    pub variation: f32,
}

/// What the walker is asked to do. Takes effect with the next step.
///
/// A speed and turn rate near zero stop the walker within two steps; it stands until one of them rises. Turning without
/// speed turns in place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    /// Speed over the ground, m/s.
    pub speed_mps: f32,
    /// Turning, rad/s, positive to the left.
    pub turn_rate_radps: f32,
}

impl Controls {
    /// Whether this asks for neither travel nor turning, so that the walker stands.
    pub fn is_standing(self) -> bool {
        finite_or(self.speed_mps, 0.0) < STANDING_SPEED_MPS
            && finite_or(self.turn_rate_radps, 0.0).abs() < STANDING_TURN_RATE_RADPS
    }
}

/// A place on the ground with a heading: `start_from_character` and the like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroundTransform {
    /// Position with y = 0, metres.
    pub position: Vec3,
    /// Heading in radians, positive to the left.
    pub heading: f32,
}

/// An initial contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footstep {
    /// Which foot.
    pub side: Side,
    /// The ground under the ankle, in the space where the walk began, metres.
    pub position: Vec3,
    /// Heading of the foot in that space, radians.
    pub heading: f32,
}

/// Walks one body in real time.
///
/// All checks are in [`new`](Self::new); [`step`](Self::step) cannot fail and does not allocate. The same model, seed
/// and sequence of calls give the same poses, bit for bit on one machine.
#[derive(Debug)]
pub struct GaitGenerator {
    pub(crate) space: Arc<StyleSpace>,
    pub(crate) skeleton: Skeleton,
    pub(crate) config: GeneratorConfig,
    pub(crate) planner: Planner,
    pub(crate) walker: Walker,
    /// What the next step wears.
    pub(crate) worn: Worn,
    /// A mixture that the next step lets go of, kept so that it is not freed there.
    retired: Option<Arc<Blend>>,
    frame_rate_hz: f32,
    /// Of the next step.
    pub(crate) detail: Detail,
    /// Speed of the current step.
    pub(crate) speed_mps: f32,
    /// Frames since the current step began.
    pub(crate) position: f32,
    pub(crate) plan_from_start: GroundTransform,
    footsteps: Vec<Footstep>,
    start_from_character: GroundTransform,
    contact: [bool; 2],
}

/// A mixture of styles and how fast it walks on this body.
#[derive(Debug)]
pub(crate) struct Worn {
    pub(crate) blend: Arc<Blend>,
    pub(crate) paces: PaceTable,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "controls will hold more than speed and turning"
)]
impl GaitGenerator {
    /// A walker with the proportions of `skeleton`, at the origin and facing +Z, in a mixture of the space's styles:
    /// weights as of [`set_style_weights`](Self::set_style_weights), none for the plain walk.
    ///
    /// # Errors
    /// [`SynthError`] when the model or the skeleton cannot be used or a setting is not finite.
    pub fn new(
        space: &Arc<StyleSpace>,
        style_weights: &[f32],
        skeleton: &Skeleton,
        config: &GeneratorConfig,
    ) -> Result<Self, SynthError> {
        skeleton.check()?;
        for (setting, value) in [("phase", config.phase), ("variation", config.variation)] {
            if !value.is_finite() {
                return Err(SynthError::Setting { setting, value });
            }
        }
        let mut planner = walker_of(space, config);
        let blend = space.blend(style_weights);
        planner.wear(&blend.model);
        let paces = PaceTable::measure(&planner, skeleton, &blend)?;
        let mut walker = Walker::new(skeleton, &blend);
        let speed = blend.model.speed.reference_mps;
        let phase = config.phase.rem_euclid(1.0);
        let first = if phase < 0.5 { Side::Left } else { Side::Right };
        let request = Request {
            manner: Manner::inside(paces.pace(speed)),
            amplitude: Amplitude::WALK,
            turn_rate: 0.0,
            facing: paces.facing,
        };
        let draws = [first.other(), first, first.other()].map(|side| planner.draw(side));
        walker.start(&mut planner, &blend, draws, request)?;
        let position = (2.0 * phase).fract() * walker.step().timing.frames as f32;
        let mut generator = Self {
            space: Arc::clone(space),
            skeleton: skeleton.clone(),
            config: *config,
            planner,
            walker,
            worn: Worn { blend, paces },
            retired: None,
            frame_rate_hz: space.model().frame_rate_hz as f32,
            detail: Detail::Full,
            speed_mps: speed as f32,
            position,
            plan_from_start: GroundTransform::default(),
            footsteps: Vec::with_capacity(MAX_FOOTSTEPS),
            start_from_character: GroundTransform::default(),
            contact: [true; 2],
        };
        generator.plan_from_start = generator.plan_from_character();
        Ok(generator)
    }

    /// Starts over at the origin, standing still.
    pub fn stand(&mut self) {
        let first = self.walker.step().timing.leading;
        let request = Request {
            manner: Manner {
                detail: self.detail,
                ..Manner::inside(self.worn.paces.pace(f64::from(STANDING_SPEED_MPS)))
            },
            amplitude: Amplitude::STAND,
            turn_rate: 0.0,
            facing: self.worn.paces.facing,
        };
        let draws = [first.other(), first, first.other()].map(|side| self.planner.draw(side));
        self.planner.wear(&self.worn.blend.model);
        let started = self
            .walker
            .start(&mut self.planner, &self.worn.blend, draws, request);
        // The model gave a trajectory when the generator was made, so it gives one now.
        if started.is_ok() {
            self.speed_mps = 0.0;
            self.position = self.walker.step().timing.frames as f32;
            self.plan_from_start = self.plan_from_character();
        }
    }

    /// Wears a mixture of the space's styles, one weight each, from the next step on: weights as of
    /// [`GaitModel::styled`](footfall_model::GaitModel::styled). Missing weights and those that are not finite count as 0.
    ///
    /// Takes about a millisecond when weights change, and nothing when they do not. Someone who stands takes the new
    /// posture with the first step.
    pub fn set_style_weights(&mut self, weights: &[f32]) {
        let worn = self.worn.blend.weights.iter().copied();
        if self.space.weights(weights).eq(worn) {
            return;
        }
        let blend = self.space.blend(weights);
        // The planner of a checked model gives a trajectory; were it not to, the walker keeps its style.
        if let Ok(paces) = PaceTable::measure(&self.planner, &self.skeleton, &blend) {
            self.retired = Some(Arc::clone(self.walker.blends()[0]));
            self.worn = Worn { blend, paces };
        }
    }

    /// The weights of the styles that are worn from the next step on.
    pub fn style_weights(&self) -> &[f32] {
        &self.worn.blend.weights
    }

    /// How finely the walker is worked out, from the next step on.
    pub fn set_detail(&mut self, detail: Detail) {
        self.detail = detail;
    }

    /// Advances by `dt_secs` and writes the pose, in the character's own space: above the ground point that
    /// [`start_from_character`](Self::start_from_character) tells, facing +Z.
    ///
    /// A `dt_secs` of 0 gives the same pose again.
    pub fn step(&mut self, dt_secs: f32, controls: &Controls, out: &mut Pose) {
        self.footsteps.clear();
        if dt_secs > 0.0 {
            self.position += dt_secs.min(MAX_DT_SECS) * self.frame_rate_hz;
        }
        while self.position >= self.walker.step().timing.frames as f32 {
            let frames = self.walker.step().timing.frames as f32;
            if self.walker.step().amplitude.to < 1.0 && controls.is_standing() {
                self.position = frames;
                break;
            }
            self.position -= frames;
            self.next_step(controls);
        }
        let plan_from_character = self.plan_from_character();
        let character_from_plan = from_heading(-plan_from_character.heading);
        let (frame, next, weight) = self.frames();
        // Between two frames a foot stands only if it does in both.
        let contact = core::array::from_fn(|side| {
            (frame.contact[side] || weight > 1.0 - SAME_FRAME)
                && (next.contact[side] || weight < SAME_FRAME)
        });
        frame.pose.interpolate_near(&next.pose, weight, out);
        out.root_position =
            character_from_plan * (out.root_position - plan_from_character.position);
        let root = Joint::Hips.index();
        out.rotations[root] = (character_from_plan * out.rotations[root]).normalize();
        self.contact = contact;
        self.start_from_character = self.to_start(&plan_from_character);
    }

    /// Tells where the character is now, as after a step of no time.
    pub(crate) fn tell_place(&mut self) {
        self.footsteps.clear();
        self.start_from_character = self.to_start(&self.plan_from_character());
    }

    /// Where the character is and where it faces, from where it began.
    pub fn start_from_character(&self) -> GroundTransform {
        self.start_from_character
    }

    /// The initial contacts during the last [`step`](Self::step), oldest first.
    pub fn footsteps(&self) -> &[Footstep] {
        &self.footsteps
    }

    /// Whether the walker has come to a stand and rests.
    pub fn is_standing(&self) -> bool {
        let step = self.walker.step();
        step.amplitude.to < 1.0 && self.position >= step.timing.frames as f32
    }

    /// Whether the left and the right foot bear on the ground.
    pub fn feet_in_contact(&self) -> [bool; 2] {
        self.contact
    }

    fn next_step(&mut self, controls: &Controls) {
        let speed = finite_or(controls.speed_mps, 0.0).clamp(0.0, MAX_SPEED_MPS);
        let turn_rate = finite_or(controls.turn_rate_radps, 0.0)
            .clamp(-MAX_TURN_RATE_RADPS, MAX_TURN_RATE_RADPS);
        let amplitude = Amplitude {
            from: self.walker.step().amplitude.to,
            to: if controls.is_standing() { 0.0 } else { 1.0 },
        };
        let position = position_after(self.walker.origin().request.manner.position, amplitude);
        let side = self.walker.step().timing.leading.other();
        if self.space.model().context(position, side).is_some() {
            // The model knows how this step gets to the speed of the walk or away from it.
            self.speed_mps = if controls.is_standing() {
                self.speed_mps
            } else {
                speed
            };
        } else {
            self.speed_mps +=
                (speed - self.speed_mps).clamp(-MAX_SPEED_CHANGE_MPS, MAX_SPEED_CHANGE_MPS);
        }
        let request = Request {
            manner: Manner {
                pace: self.worn.paces.pace(f64::from(self.speed_mps)),
                position,
                detail: self.detail,
            },
            amplitude,
            turn_rate,
            facing: self.worn.paces.facing,
        };
        let draw = self.planner.draw(self.walker.step().timing.leading);
        self.planner.wear(&self.worn.blend.model);
        self.walker
            .advance(&mut self.planner, &self.worn.blend, draw, request);
        let side = self.walker.step().timing.leading;
        if let Some(planter) = self.walker.planter()
            && self.footsteps.len() < MAX_FOOTSTEPS
        {
            let plant = planter.plant(side);
            let place = self.to_start(&GroundTransform {
                position: RockerFoot::footprint(plant),
                heading: plant.heading,
            });
            self.footsteps.push(Footstep {
                side,
                position: place.position,
                heading: place.heading,
            });
        }
    }

    /// The frames on both sides of now, and the weight of the later one.
    fn frames(&self) -> (&PlantedFrame, &PlantedFrame, f32) {
        let frames = &self.walker.frames;
        let step = self.walker.step();
        let last = step.ground_timing().frames - 1;
        let position = self.position / step.detail.stride() as f32;
        let first = (position.floor() as usize).min(last);
        let weight = position - first as f32;
        (&frames[first], &frames[first + 1], weight)
    }

    pub(crate) fn plan_from_character(&self) -> GroundTransform {
        let (frame, next, weight) = self.frames();
        let share = self.position / self.walker.step().timing.frames as f32;
        let facing = self.walker.facing(share);
        GroundTransform {
            position: frame.ground_position.lerp(next.ground_position, weight),
            heading: frame.heading + weight * (next.heading - frame.heading) - facing,
        }
    }

    fn to_start(&self, plan: &GroundTransform) -> GroundTransform {
        let start_from_plan: Quat = from_heading(-self.plan_from_start.heading);
        GroundTransform {
            position: start_from_plan * (plan.position - self.plan_from_start.position),
            heading: wrap_angle(plan.heading - self.plan_from_start.heading),
        }
    }
}

/// The walker that a seed draws.
pub(crate) fn walker_of(space: &StyleSpace, config: &GeneratorConfig) -> Planner {
    let variation = f64::from(config.variation.clamp(0.0, 2.0));
    Planner::new(space.model(), config.seed, variation)
}

/// The place of a step in its walk. That a step is the last but one is known only when it is over.
fn position_after(before: StepPosition, amplitude: Amplitude) -> StepPosition {
    match (amplitude.from < 1.0, amplitude.to < 1.0) {
        (true, false) => StepPosition::First,
        (false, true) => StepPosition::Last,
        (false, false) if before == StepPosition::First => StepPosition::Second,
        _ => StepPosition::Inside,
    }
}

fn finite_or(value: f32, otherwise: f32) -> f32 {
    if value.is_finite() { value } else { otherwise }
}
