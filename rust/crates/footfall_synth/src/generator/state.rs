//! Saved states: a walker continues from the middle of a step, bit for bit.
//!
//! A state holds everything that cannot be derived: the seed, the progress of chance, the requests to the current step,
//! and the input from the step before (the places of the feet and the last frames of the trajectory). The rest is
//! generated again from the model.

mod climbing;
mod feet;
mod led;
mod moving;
mod quick;
mod running;
mod source;
mod version;

use super::GaitGenerator;
use crate::config::GeneratorConfig;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::gait::Amplitude;
use crate::moves::Moves;
use crate::source::Steps;
use crate::standing::{Moment, Righting};
use climbing::Climbing;
use feet::{Feet, Midway, Stance};
use footfall_core::{GroundTransform, StepPosition};
use glam::Vec3;
use led::Led;
use moving::Moving;
use quick::Quick;
use running::Running;
use serde::{Deserialize, Serialize};
use version::{OLDEST, Parts, VERSION, since};

/// Limit of all numbers of a state: metres, radians, frames and factors.
const MAX_VALUE: f64 = 1e7;

/// Smallest factor on the tempo of a step.
const LEAST_TEMPO: f64 = 1e-3;

/// Errors of restoring a state.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// Its bytes cannot be decoded.
    #[error("not a walker's state: {0}; save it again")]
    Undecodable(#[from] postcard::Error),
    /// Another version of Footfall wrote it.
    #[error("the state has format {0}, this build reads {VERSION}; save it again")]
    Version(u8),
    /// A number or a shape in it is invalid.
    #[error("the state was damaged; save it again")]
    Damaged,
    /// Its numbers are each within their limits, but no body can make the step from them.
    #[error("the state was damaged: its step leads nowhere; save it again")]
    Nowhere,
    /// The model generates no walk from it.
    #[error("the state was damaged: {0}; save it again")]
    NoWalk(#[from] SynthError),
    /// It belongs to another model.
    #[error("the state was saved with another model; use that model")]
    OtherModel,
    /// It belongs to another set of styles.
    #[error(
        "the state was saved with {expected} styles, the walker has {found}; use the same styles"
    )]
    OtherStyles {
        /// Number of styles in the state.
        expected: usize,
        /// Number of styles of the walker.
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
    chance_position: u64,
    position: f32,
    velocity_mps: [f32; 2],
    plan_from_start: [f32; 4],
    amplitude: [f32; 2],
    turn_rate: f32,
    facing: [f32; 2],
    feet: Option<Feet>,
    /// Of the next step.
    detail: u8,
    steps: Source,
}

#[derive(Serialize, Deserialize)]
enum Source {
    Styled {
        /// Weights of the step before, of this one and of the next.
        weights: [Vec<f32>; 3],
        /// True when the first step of the window is a left one; then the weights of its components.
        left_first: bool,
        draws: Vec<f64>,
        /// Covariate, tempo and stride of the step before and of this one.
        paces: [[f64; 3]; 2],
        /// Places of the step before and of this one, as [`StepPosition::index`].
        positions: [u8; 2],
        /// Details of the step before and of this one, finest first.
        details: [u8; 2],
        /// The last frames of the step before; empty for the first.
        tie: Vec<f32>,
    },
    Switching {
        left: bool,
        /// Tempo and stride.
        pace: [f64; 2],
        detail: u8,
        expected: Vec<f32>,
    },
}

/// Progress of a walker's life, behind a [`State`].
#[derive(Default, Serialize, Deserialize)]
struct Alive {
    secs: f64,
    share: f32,
    speed: f32,
}

impl GaitGenerator {
    /// Returns everything that [`restore`](Self::restore) needs to continue: about 1.5 kB and four bytes per style; some 200 bytes
    /// for a walker of a switching model.
    pub fn state(&self) -> Vec<u8> {
        let place = &self.plan_from_start;
        let [facing_before, facing] = self.steps.source().facing();
        let (model, chance_position, velocity_mps, amplitude, turn_rate, planter) =
            match &self.steps {
                Steps::Styled(steps) => {
                    let origin = steps.window.origin();
                    let request = &origin.request;
                    (
                        steps.space.fingerprint(),
                        steps.planner.chance_position(),
                        steps.velocity_mps,
                        request.amplitude,
                        request.turn_rate,
                        origin.planter,
                    )
                }
                Steps::Switching(steps) => {
                    let origin = &steps.origin;
                    (
                        steps.fingerprint,
                        origin.chance_position,
                        steps.velocity_mps,
                        origin.amplitude,
                        origin.turn_rate,
                        origin.planter,
                    )
                }
            };
        let moment = self
            .life
            .as_ref()
            .map(|life| life.moment)
            .unwrap_or_default();
        // Few walkers need this part, and without it earlier builds read the state.
        let righting = Some(moment.righting).filter(|righting| *righting != Righting::default());
        let state = State {
            version: righting.map_or(since::HEADS_TURN, |_| VERSION),
            model,
            seed: self.config.seed,
            phase: self.config.phase,
            variation: self.config.variation,
            chance_position,
            position: self.position,
            velocity_mps: velocity_mps.to_array(),
            plan_from_start: [
                place.position.x,
                place.position.y,
                place.position.z,
                place.heading,
            ],
            amplitude: [amplitude.from, amplitude.to],
            turn_rate,
            facing: [facing_before, facing],
            feet: planter.as_ref().map(Feet::of),
            detail: self.detail as u8,
            steps: match &self.steps {
                Steps::Styled(steps) => Source::of_styled(steps),
                Steps::Switching(steps) => Source::of_switching(steps),
            },
        };
        let alive = Alive {
            secs: moment.secs,
            share: moment.share,
            speed: moment.speed,
        };
        // Writing to memory does not fail; an empty state is refused like any other that is not one.
        let balance = planter.map_or([0.0; 2], |feet| feet.balance.to_array());
        let more = (
            Running::of(self),
            Quick::of(self),
            Moving::of(self),
            balance,
            Climbing::of(self),
            Led::of(self),
            planter.map_or(0.0, |feet| feet.lean.leg),
            self.moves.as_ref().and_then(Moves::coming),
            planter.as_ref().and_then(Midway::of),
        );
        let bytes = postcard::to_stdvec(&(state, alive, more)).unwrap_or_default();
        match righting {
            Some(righting) => postcard::to_extend(&righting, bytes).unwrap_or_default(),
            None => bytes,
        }
    }

    /// Restores a [`state`](Self::state) of a walker with the same model, styles and body; the seed becomes the state's.
    ///
    /// # Errors
    /// [`StateError`]; the walker then continues as before.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), StateError> {
        let (state, rest): (State, _) = postcard::take_from_bytes(bytes)?;
        if !(OLDEST..=VERSION).contains(&state.version) {
            return Err(StateError::Version(state.version));
        }
        let mut parts = Parts::new(state.version, rest);
        let alive: Alive = parts.next(since::STANDING, Alive::default())?;
        let running: Running = parts.next(since::RUNNING, Running::default())?;
        let quick = parts.next(since::MOVING, Quick::of_slow(&state))?;
        let moving: Moving = parts.next(since::MOVING, Moving::default())?;
        let balance: [f32; 2] = parts.next(since::BALANCE, [0.0; 2])?;
        let climbing: Climbing = parts.next(since::CLIMBING, Climbing::default())?;
        let led: Led = parts.next(since::LED, Led::default())?;
        let leg: f32 = parts.next(since::LEGS_LEAN, 0.0)?;
        let coming: Option<[f32; 2]> = parts.next(since::PUSHES_BUILD_UP, None)?;
        let midway = Midway::read(&mut parts)?;
        let righting: Righting = parts.next(since::BODIES_RIGHT, Righting::default())?;
        let sensible = [
            state.is_sensible(),
            alive.is_sensible(),
            running.is_sensible(),
            quick.is_sensible(),
            moving.is_sensible(),
            climbing.is_sensible(),
            led.is_sensible(),
            balance
                .into_iter()
                .chain([leg])
                .chain(midway.iter().flat_map(Midway::numbers))
                .chain(coming.into_iter().flatten())
                .chain(righting.numbers())
                .map(f64::from)
                .all(is_reasonable),
        ];
        if sensible.contains(&false) {
            return Err(StateError::Damaged);
        }
        let config = GeneratorConfig {
            seed: state.seed,
            phase: state.phase,
            variation: state.variation,
        };
        let stance = Stance {
            lean: quick.lean(leg),
            balance: balance.into(),
            midway,
        };
        match &mut self.steps {
            Steps::Styled(steps) => {
                let more = (&running, &quick, moving.leap_m, &stance, &led);
                state.take_up(steps, more, &self.skeleton, &config)?;
            }
            Steps::Switching(steps) => {
                state.resume(steps, &stance, &config)?;
            }
        }
        self.config = config;
        if let Some(life) = &mut self.life {
            life.become_walker(&config);
            life.moment = Moment {
                secs: alive.secs,
                share: alive.share,
                speed: alive.speed,
                righting,
            };
        }
        self.detail = detail_of(state.detail);
        self.answered = None;
        let [x, y, z, heading] = state.plan_from_start;
        self.plan_from_start = GroundTransform {
            position: Vec3::new(x, y, z),
            heading,
        };
        let frames = self.steps.source().shape().timing.frames as f32;
        self.position = state.position.clamp(0.0, frames);
        climbing.resume(self);
        self.tell_place();
        moving.resume(
            self,
            coming.unwrap_or_default().into(),
            state.version < since::JUMPS_FROM_START,
        );
        Ok(())
    }
}

impl State {
    fn amplitude(&self) -> Amplitude {
        Amplitude {
            from: self.amplitude[0],
            to: self.amplitude[1],
        }
    }

    /// Returns true when all numbers are within limits.
    fn is_sensible(&self) -> bool {
        let singles = [self.phase, self.variation, self.position, self.turn_rate];
        let feet = self.feet.iter().flat_map(Feet::numbers);
        let narrow = singles
            .into_iter()
            .chain(self.plan_from_start)
            .chain(self.amplitude)
            .chain(self.facing)
            .chain(self.velocity_mps)
            .chain(feet);
        narrow.map(f64::from).all(is_reasonable) && self.steps.is_sensible()
    }
}

impl Alive {
    fn is_sensible(&self) -> bool {
        let narrow = [self.share, self.speed].map(f64::from);
        narrow.into_iter().chain([self.secs]).all(is_reasonable)
    }
}

impl Source {
    fn is_sensible(&self) -> bool {
        match self {
            Self::Styled {
                draws,
                paces,
                positions,
                tie,
                ..
            } => {
                let places = positions
                    .iter()
                    .all(|place| usize::from(*place) < StepPosition::ALL.len());
                let positive = paces.iter().all(|[_, tempo, _]| *tempo > LEAST_TEMPO);
                let wide = draws.iter().chain(paces.iter().flatten()).copied();
                let tie = tie.iter().map(|value| f64::from(*value));
                places && positive && wide.chain(tie).all(is_reasonable)
            }
            Self::Switching { pace, expected, .. } => {
                let expected = expected.iter().map(|value| f64::from(*value));
                pace[0] > LEAST_TEMPO && pace.iter().copied().chain(expected).all(is_reasonable)
            }
        }
    }
}

fn is_reasonable(value: f64) -> bool {
    value.abs() < MAX_VALUE
}

fn detail_of(index: u8) -> Detail {
    let detail = Detail::ALL.get(usize::from(index));
    detail.copied().unwrap_or_default()
}
