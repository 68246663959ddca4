//! Saving a walker in the middle of a step and going on from there, bit for bit.
//!
//! A state holds what cannot be worked out again: the seed, how far chance has come, what the current step was asked to be,
//! and what it took over from the step before (where the feet stood and the last frames of the trajectory). The rest is
//! made again from the model.

use crate::detail::Detail;
use crate::error::SynthError;
use crate::generator::{GaitGenerator, GeneratorConfig, GroundTransform, Worn, walker_of};
use crate::pace::PaceTable;
use crate::plan::{MAX_COMPONENTS, Manner, Pace, StepDraw};
use crate::planting::PlanterState;
use crate::standing::Amplitude;
use crate::walker::{Origin, Request, TIE_LEN, WINDOW, Walker};
use footfall_core::{Side, StepPosition};
use footfall_ik::Plant;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The version of the layout that this build writes and reads.
const VERSION: u8 = 2;

/// Nothing that a state holds is larger than this: metres, radians, frames and factors are not.
const MAX_VALUE: f64 = 1e7;

/// Why a state cannot be taken up.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// Its bytes cannot be decoded.
    #[error("not a walker's state: {0}; save it again")]
    Undecodable(#[from] postcard::Error),
    /// Another version of Footfall wrote it.
    #[error("the state has format {0}, this build reads {VERSION}; save it again")]
    Version(u8),
    /// A number or a shape in it makes no sense.
    #[error("the state was damaged; save it again")]
    Damaged,
    /// The model gives no walk from it.
    #[error("the state was damaged: {0}; save it again")]
    NoWalk(#[from] SynthError),
    /// It belongs to another model.
    #[error(
        "the state was saved with another model; give the walker the model that it was saved with"
    )]
    OtherModel,
    /// It belongs to another set of styles.
    #[error(
        "the state was saved with {expected} styles, the walker has {found}; give it the same styles"
    )]
    OtherStyles {
        /// How many styles the state knows.
        expected: usize,
        /// How many the walker has.
        found: usize,
    },
}

#[derive(Serialize, Deserialize)]
struct State {
    version: u8,
    model: u32,
    seed: u64,
    phase: f32,
    variation: f32,
    /// Weights of the step before, of this one and of the next.
    weights: [Vec<f32>; 3],
    chance_position: u64,
    position: f32,
    speed_mps: f32,
    plan_from_start: [f32; 4],
    /// Whether the first step of the window is a left one; then the weights of its components.
    left_first: bool,
    draws: Vec<f64>,
    /// Covariate, tempo and stride of the step before and of this one.
    paces: [[f64; 3]; 2],
    amplitude: [f32; 2],
    /// Places of the step before and of this one, as [`StepPosition::index`].
    positions: [u8; 2],
    /// Details of the step before, of this one and of the next, finest first.
    details: [u8; 3],
    turn_rate: f32,
    facing: [f32; 2],
    feet: Option<Feet>,
}

/// What a step takes over from the one before.
#[derive(Serialize, Deserialize)]
struct Feet {
    /// Flat ankle and heading, left and right.
    plants: [[f32; 4]; 2],
    hips: [f32; 3],
    hips_velocity: Option<[f32; 3]>,
    heading: f32,
    turn_rate: f32,
    ground_position: [f32; 3],
    ground_velocity: Option<[f32; 3]>,
    tie: Vec<f32>,
}

impl GaitGenerator {
    /// Everything that [`restore`](Self::restore) needs to go on from here: about 1.5 kB and four bytes per style.
    pub fn state(&self) -> Vec<u8> {
        let origin = self.walker.origin();
        let components = self.space.model().variation.step.len();
        let draws = self.walker.draws();
        let used = draws.iter().flat_map(|draw| {
            let used = draw.weights.len().min(components);
            draw.weights[..used].iter().copied()
        });
        let manners = [origin.manner_before, origin.request.manner];
        let blends = self.walker.blends();
        let place = &self.plan_from_start;
        let state = State {
            version: VERSION,
            model: self.space.fingerprint(),
            seed: self.config.seed,
            phase: self.config.phase,
            variation: self.config.variation,
            weights: [blends[0], blends[1], &self.worn.blend].map(|blend| blend.weights.clone()),
            chance_position: self.planner.chance_position(),
            position: self.position,
            speed_mps: self.speed_mps,
            plan_from_start: [
                place.position.x,
                place.position.y,
                place.position.z,
                place.heading,
            ],
            left_first: draws[0].side == Side::Left,
            draws: used.collect(),
            paces: manners
                .map(|manner| manner.pace)
                .map(|pace| [pace.covariate_mps, pace.tempo, pace.stride]),
            amplitude: [origin.request.amplitude.from, origin.request.amplitude.to],
            positions: manners.map(|manner| manner.position.index() as u8),
            details: [manners[0].detail, manners[1].detail, self.detail].map(|detail| detail as u8),
            turn_rate: origin.request.turn_rate,
            facing: [origin.facing_before, origin.request.facing],
            feet: origin.planter.map(|planter| Feet::of(&planter, origin)),
        };
        // Writing to memory does not fail; an empty state is refused like any other that is not one.
        postcard::to_stdvec(&state).unwrap_or_default()
    }

    /// Goes on from a [`state`](Self::state) of a walker with the same model, styles and body; the seed is the state's.
    ///
    /// # Errors
    /// [`StateError`]; the walker then walks on as before.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), StateError> {
        let state: State = postcard::from_bytes(bytes)?;
        if state.version != VERSION {
            return Err(StateError::Version(state.version));
        }
        if state.model != self.space.fingerprint() {
            return Err(StateError::OtherModel);
        }
        let found = self.space.styles().len();
        if let Some(weights) = state.weights.iter().find(|w| w.len() != found) {
            let expected = weights.len();
            return Err(StateError::OtherStyles { expected, found });
        }
        if !state.is_sensible(self.space.model().variation.step.len()) {
            return Err(StateError::Damaged);
        }
        let config = GeneratorConfig {
            seed: state.seed,
            phase: state.phase,
            variation: state.variation,
        };
        let mut planner = walker_of(&self.space, &config);
        let [before, now, next] = state.weights.each_ref().map(|w| self.space.blend(w));
        // The same mixture must be one and the same: a walker tells changes by it.
        let now = if state.weights[1] == state.weights[2] {
            Arc::clone(&next)
        } else {
            now
        };
        let draws = state.draws();
        planner.resume(state.chance_position, &draws);
        let paces = PaceTable::measure(&planner, &self.skeleton, &next)?;
        let mut walker = Walker::new(&self.skeleton, &now);
        walker.restore(&mut planner, [&before, &now], draws, state.origin())?;
        self.planner = planner;
        self.walker = walker;
        self.config = config;
        self.worn = Worn { blend: next, paces };
        self.detail = state.detail(2);
        self.speed_mps = state.speed_mps;
        let [x, y, z, heading] = state.plan_from_start;
        self.plan_from_start = GroundTransform {
            position: Vec3::new(x, y, z),
            heading,
        };
        self.position = state
            .position
            .clamp(0.0, self.walker.step().timing.frames as f32);
        self.tell_place();
        Ok(())
    }
}

impl State {
    fn draws(&self) -> [StepDraw; WINDOW] {
        let components = self.draws.len() / WINDOW;
        let mut side = if self.left_first {
            Side::Right
        } else {
            Side::Left
        };
        core::array::from_fn(|step| {
            side = side.other();
            let mut weights = [0.0; MAX_COMPONENTS];
            weights[..components].copy_from_slice(&self.draws[step * components..][..components]);
            StepDraw { side, weights }
        })
    }

    fn origin(&self) -> Origin {
        let manner = |step: usize| {
            let [covariate_mps, tempo, stride] = self.paces[step];
            let position = StepPosition::ALL.get(usize::from(self.positions[step]));
            Manner {
                pace: Pace {
                    covariate_mps,
                    tempo,
                    stride,
                },
                position: position.copied().unwrap_or_default(),
                detail: self.detail(step),
            }
        };
        let mut tie = [0.0; TIE_LEN];
        if let Some(feet) = &self.feet {
            tie.copy_from_slice(&feet.tie);
        }
        Origin {
            request: Request {
                manner: manner(1),
                amplitude: Amplitude {
                    from: self.amplitude[0],
                    to: self.amplitude[1],
                },
                turn_rate: self.turn_rate,
                facing: self.facing[1],
            },
            manner_before: manner(0),
            facing_before: self.facing[0],
            planter: self.feet.as_ref().map(Feet::planter),
            tie,
        }
    }

    fn detail(&self, step: usize) -> Detail {
        let detail = Detail::ALL.get(usize::from(self.details[step]));
        detail.copied().unwrap_or_default()
    }

    /// Whether shapes fit and no number is beyond reason.
    fn is_sensible(&self, components: usize) -> bool {
        let shapes = self.draws.len() == WINDOW * components.min(MAX_COMPONENTS)
            && self
                .feet
                .as_ref()
                .is_none_or(|feet| feet.tie.len() == TIE_LEN);
        let singles = [
            self.phase,
            self.variation,
            self.position,
            self.speed_mps,
            self.turn_rate,
        ];
        let feet = self.feet.iter().flat_map(Feet::numbers);
        let narrow = singles
            .into_iter()
            .chain(self.plan_from_start)
            .chain(self.amplitude)
            .chain(self.facing)
            .chain(feet)
            .map(f64::from);
        let wide = self
            .draws
            .iter()
            .copied()
            .chain(self.paces.into_iter().flatten());
        let places =
            usize::from(self.positions[0].max(self.positions[1])) < StepPosition::ALL.len();
        let positive = self.paces.iter().all(|[_, tempo, _]| *tempo > 1e-3);
        shapes && places && positive && narrow.chain(wide).all(|value| value.abs() < MAX_VALUE)
    }
}

impl Feet {
    fn of(planter: &PlanterState, origin: &Origin) -> Self {
        Self {
            plants: planter.plants.map(|plant| {
                let [x, y, z] = plant.flat_ankle.to_array();
                [x, y, z, plant.heading]
            }),
            hips: planter.hips.to_array(),
            hips_velocity: planter.hips_velocity.map(|v| v.to_array()),
            heading: planter.heading,
            turn_rate: planter.turn_rate,
            ground_position: planter.ground_position.to_array(),
            ground_velocity: planter.ground_velocity.map(|v| v.to_array()),
            tie: origin.tie.to_vec(),
        }
    }

    fn planter(&self) -> PlanterState {
        PlanterState {
            plants: self.plants.map(|[x, y, z, heading]| Plant {
                flat_ankle: Vec3::new(x, y, z),
                heading,
            }),
            hips: self.hips.into(),
            hips_velocity: self.hips_velocity.map(Vec3::from),
            heading: self.heading,
            turn_rate: self.turn_rate,
            ground_position: self.ground_position.into(),
            ground_velocity: self.ground_velocity.map(Vec3::from),
        }
    }

    fn numbers(&self) -> impl Iterator<Item = f32> {
        let velocities = [self.hips_velocity, self.ground_velocity];
        self.plants
            .into_iter()
            .flatten()
            .chain(self.hips)
            .chain(self.ground_position)
            .chain([self.heading, self.turn_rate])
            .chain(velocities.into_iter().flatten().flatten())
            .chain(self.tie.iter().copied())
    }
}
