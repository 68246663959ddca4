//! Walkers by the thousand: each keeps a step in a few kilobytes, and shares with all others what works steps out.
//!
//! A [`GaitGenerator`](crate::GaitGenerator) owns the buffers in which its steps are solved, some hundred kilobytes. A
//! [`CrowdWalker`] borrows them from a [`Workshop`], one a thread, for a moment about twice a second, and keeps the result: where every
//! joint is in each frame of its step. In between it costs an interpolation.

mod frames;

use crate::detail::Detail;
use crate::error::SynthError;
use crate::generator::{
    Controls, Footstep, GeneratorConfig, GroundTransform, MAX_DT_SECS, MAX_SPEED_MPS,
    MAX_TURN_RATE_RADPS, check, finite_or,
};
use crate::pace::PaceTable;
use crate::plan::{MAX_COMPONENTS, Planner, StepDraw, StepShape};
use crate::space::{Blend, StyleSpace};
use crate::standing::Amplitude;
use crate::steps::Ask;
use crate::styled::Worn;
use crate::walker::{Origin, WINDOW, Walker};
use footfall_core::rotation::{from_heading, wrap_angle};
use footfall_core::{ModelPose, Pose, Skeleton};
use footfall_ik::RockerFoot;
use frames::CrowdFrame;
pub use frames::JointPlace;
use std::sync::Arc;

/// A mixture of styles on a body, measured once for all walkers of a crowd that share it.
#[derive(Clone, Debug)]
pub struct StyledBody {
    space: Arc<StyleSpace>,
    skeleton: Skeleton,
    worn: Arc<Worn>,
}

impl StyledBody {
    /// Mixes the space's styles, weights as of [`GaitGenerator::set_style_weights`](crate::GaitGenerator::set_style_weights), and
    /// measures how fast they walk on this body: about two milliseconds.
    ///
    /// # Errors
    /// [`SynthError`] when the model or the skeleton cannot be used.
    pub fn new(
        space: &Arc<StyleSpace>,
        style_weights: &[f32],
        skeleton: &Skeleton,
    ) -> Result<Self, SynthError> {
        skeleton.check()?;
        let blend = space.blend(style_weights);
        let average = Planner::new(&blend.model, 0, 0.0);
        let paces = PaceTable::measure(&average, skeleton, &blend)?;
        Ok(Self {
            space: Arc::clone(space),
            skeleton: skeleton.clone(),
            worn: Arc::new(Worn { blend, paces }),
        })
    }

    /// The body.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// The weights of the styles, as they are used.
    pub fn style_weights(&self) -> &[f32] {
        &self.worn.blend.weights
    }

    /// The speed that suits it best, m/s.
    pub fn usual_speed_mps(&self) -> f32 {
        self.worn.blend.model.speed.reference_mps as f32
    }
}

/// Where steps are worked out, for walkers of one model on one body; one a thread.
#[derive(Debug)]
pub struct Workshop {
    planner: Planner,
    walker: Walker,
    pose: Pose,
    model_pose: ModelPose,
}

impl Workshop {
    /// For walkers like this one.
    pub fn new(styled: &StyledBody) -> Self {
        let blend = &styled.worn.blend;
        Self {
            planner: Planner::new(&blend.model, 0, 0.0),
            walker: Walker::new(&styled.skeleton, blend),
            pose: Pose::default(),
            model_pose: ModelPose::default(),
        }
    }
}

/// One walker of a crowd: walks as a [`GaitGenerator`](crate::GaitGenerator) of its seed would, in a hundredth of the memory.
///
/// Its speed is that of the average walker of its styles: people of the same crowd who are asked for the same speed differ by a few
/// percent.
#[derive(Debug)]
pub struct CrowdWalker {
    config: GeneratorConfig,
    styled: StyledBody,
    /// The mixture of the current step.
    blend: Arc<Blend>,
    /// Who it is: weights of the model's walker components.
    walker: [f64; MAX_COMPONENTS],
    chance_position: u64,
    draws: [StepDraw; WINDOW],
    /// Where the next step comes from, all but its request.
    next: Origin,
    shape: StepShape,
    /// Headings under which the walk goes along +Z, before the current step and after it.
    facing: [f32; 2],
    speed_mps: f32,
    detail: Detail,
    /// Frames since the step began.
    position: f32,
    frames: Vec<CrowdFrame>,
    plan_from_start: GroundTransform,
    start_from_character: GroundTransform,
    footstep: Option<Footstep>,
}

impl CrowdWalker {
    /// A walker at the origin, facing +Z, walking already at the speed that suits it; or standing.
    ///
    /// # Errors
    /// [`SynthError`] when a setting is not finite or the model gives no trajectory.
    pub fn new(
        styled: &StyledBody,
        config: &GeneratorConfig,
        standing: bool,
        workshop: &mut Workshop,
    ) -> Result<Self, SynthError> {
        let first = check(&styled.skeleton, config)?;
        let worn = &styled.worn;
        let Workshop {
            planner, walker, ..
        } = &mut *workshop;
        *planner = Planner::new(&worn.blend.model, config.seed, variation(config));
        let request = if standing {
            worn.standing_request(Detail::Full)
        } else {
            worn.first_request(Detail::Full)
        };
        let draws = [first.other(), first, first.other()].map(|side| planner.draw(side));
        walker.start(planner, &worn.blend, draws, request)?;
        let shape = *walker.step();
        let mut made = Self {
            config: *config,
            styled: styled.clone(),
            blend: Arc::clone(&worn.blend),
            walker: *planner.walker(),
            chance_position: 0,
            draws: walker.draws().clone(),
            next: walker.next_origin(request),
            shape,
            facing: [worn.paces.facing; 2],
            speed_mps: if standing {
                0.0
            } else {
                styled.usual_speed_mps()
            },
            detail: Detail::Full,
            position: 0.0,
            frames: Vec::with_capacity(shape.timing.frames + shape.timing.frames / 2),
            plan_from_start: GroundTransform::default(),
            start_from_character: GroundTransform::default(),
            footstep: None,
        };
        made.take_over(workshop);
        let frames = made.shape.timing.frames as f32;
        made.position = if standing {
            frames
        } else {
            (2.0 * config.phase.rem_euclid(1.0)).fract() * frames
        };
        made.plan_from_start = made.plan_from_character();
        Ok(made)
    }

    /// Wears other styles from the next step on. They must be of the same model and body.
    pub fn wear(&mut self, styled: &StyledBody) {
        self.styled = styled.clone();
    }

    /// How finely it is worked out, from the next step on.
    pub fn set_detail(&mut self, detail: Detail) {
        self.detail = detail;
    }

    /// Advances by `dt_secs`. Allocates nothing, but for a step that is longer than any before.
    pub fn step(&mut self, dt_secs: f32, controls: Controls, workshop: &mut Workshop) {
        self.footstep = None;
        let rate = self.styled.space.model().frame_rate_hz as f32;
        if dt_secs > 0.0 {
            self.position += dt_secs.min(MAX_DT_SECS) * rate;
        }
        while self.position >= self.shape.timing.frames as f32 {
            let frames = self.shape.timing.frames as f32;
            if self.shape.amplitude.to < 1.0 && controls.is_standing() {
                self.position = frames;
                break;
            }
            self.position -= frames;
            self.next_step(controls, workshop);
        }
        self.start_from_character = self.to_start(&self.plan_from_character());
    }

    /// Where it is and where it faces, from where it began.
    pub fn start_from_character(&self) -> GroundTransform {
        self.start_from_character
    }

    /// The initial contact of the last [`step`](Self::step), from where the walk began.
    pub fn footstep(&self) -> Option<&Footstep> {
        self.footstep.as_ref()
    }

    /// Whether the left and the right foot bear on the ground.
    pub fn feet_in_contact(&self) -> [bool; 2] {
        let (frame, next, weight) = self.around();
        core::array::from_fn(|side| {
            if weight < 0.5 {
                frame.contact[side]
            } else {
                next.contact[side]
            }
        })
    }

    /// Whether it has come to a stand and rests.
    pub fn is_standing(&self) -> bool {
        self.shape.amplitude.to < 1.0 && self.position >= self.shape.timing.frames as f32
    }

    /// How much of its stride is behind it: 0 when the left foot lands, 0.5 when the right one does.
    pub fn phase(&self) -> f32 {
        let share = (self.position / self.shape.timing.frames as f32).min(1.0);
        let half = self.shape.timing.leading.index() as f32;
        (0.5 * (half + share)).fract()
    }

    /// Writes where every joint is, in the character's own space, in the order of [`Joint::ALL`](footfall_core::Joint::ALL).
    pub fn pose(&self, out: &mut [JointPlace; footfall_core::JOINT_COUNT]) {
        let (frame, next, weight) = self.around();
        frame.blend(next, weight, out);
    }

    fn next_step(&mut self, controls: Controls, workshop: &mut Workshop) {
        let worn = Arc::clone(&self.styled.worn);
        let ask = Ask {
            speed_mps: finite_or(controls.speed_mps, 0.0).clamp(0.0, MAX_SPEED_MPS),
            turn_rate: finite_or(controls.turn_rate_radps, 0.0)
                .clamp(-MAX_TURN_RATE_RADPS, MAX_TURN_RATE_RADPS),
            amplitude: Amplitude {
                from: self.shape.amplitude.to,
                to: if controls.is_standing() { 0.0 } else { 1.0 },
            },
            detail: self.detail,
        };
        let leading = self.shape.timing.leading;
        let before = self.next.request.manner.position;
        let model = self.styled.space.model();
        let request = worn.request(&ask, model, before, leading.other(), &mut self.speed_mps);
        let origin = Origin {
            request,
            ..self.next.clone()
        };
        let Workshop {
            planner, walker, ..
        } = &mut *workshop;
        planner.become_walker(self.config.seed, variation(&self.config), self.walker);
        planner.resume(self.chance_position, &self.draws);
        let mut draws = self.draws.clone();
        draws.rotate_left(1);
        draws[WINDOW - 1] = planner.draw(leading);
        let blends = [&self.blend, &worn.blend];
        // The model gave a trajectory when the walker was made, so it gives one now.
        if walker.restore(planner, blends, draws, origin).is_err() {
            return;
        }
        self.facing = [self.next.facing_before, request.facing];
        self.blend = Arc::clone(&worn.blend);
        self.draws = walker.draws().clone();
        self.next = walker.next_origin(request);
        self.shape = *walker.step();
        self.take_over(workshop);
        let side = self.shape.timing.leading;
        if let Some(plant) = self
            .next
            .planter
            .as_ref()
            .map(|feet| feet.plants[side.index()])
        {
            let place = self.to_start(&GroundTransform {
                position: RockerFoot::footprint(&plant),
                heading: plant.heading,
            });
            self.footstep = Some(Footstep {
                side,
                position: place.position,
                heading: place.heading,
            });
        }
    }

    /// Keeps the step that was just worked out.
    fn take_over(&mut self, workshop: &mut Workshop) {
        self.chance_position = workshop.planner.chance_position();
        let timing = self.shape.ground_timing();
        let stage = &workshop.walker.stage().frames[..=timing.frames];
        self.frames.resize_with(stage.len(), CrowdFrame::default);
        let [before, now] = self.facing;
        for (index, (kept, frame)) in self.frames.iter_mut().zip(stage).enumerate() {
            let share = index as f32 / timing.frames as f32;
            let facing = before + footfall_core::ease::smooth_step(share) * (now - before);
            let (pose, model_pose) = (&mut workshop.pose, &mut workshop.model_pose);
            kept.set(frame, facing, &self.styled.skeleton, pose, model_pose);
        }
    }

    /// The frames on both sides of now, and the weight of the later one.
    fn around(&self) -> (&CrowdFrame, &CrowdFrame, f32) {
        let last = self.frames.len() - 2;
        let position = self.position / self.shape.detail.stride() as f32;
        let first = (position.floor() as usize).min(last);
        let weight = position - first as f32;
        (&self.frames[first], &self.frames[first + 1], weight)
    }

    fn plan_from_character(&self) -> GroundTransform {
        let (frame, next, weight) = self.around();
        GroundTransform {
            position: frame.place.position.lerp(next.place.position, weight),
            heading: frame.place.heading + weight * (next.place.heading - frame.place.heading),
        }
    }

    fn to_start(&self, plan: &GroundTransform) -> GroundTransform {
        let start_from_plan = from_heading(-self.plan_from_start.heading);
        GroundTransform {
            position: start_from_plan * (plan.position - self.plan_from_start.position),
            heading: wrap_angle(plan.heading - self.plan_from_start.heading),
        }
    }
}

fn variation(config: &GeneratorConfig) -> f64 {
    f64::from(config.variation.clamp(0.0, 2.0))
}
