//! A mixture of styles on one body, and its next step by the controls.

use super::pace::PaceTable;
use super::stand::Amplitude;
use super::{FASTEST_RUN_MPS, FASTEST_WALK_MPS, Gait, STOPPABLE_MPS};
use crate::controls::STANDING_SPEED_MPS;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::ground::strafe::pelvis_turn;
use crate::plan::{Manner, Planner};
use crate::source::buffers::Workbench;
use crate::source::step_source::Ask;
use crate::source::style_space::Blend;
use crate::source::window::Request;
use footfall_core::{Skeleton, StepPosition};
use glam::Vec2;
use std::sync::Arc;

/// Steps that start a walk and that end one take this long at most, seconds.
const FIRST_SECS: f64 = 0.45;
const LAST_SECS: f64 = 0.4;

/// The speed that a first step reaches at most, m/s.
const FIRST_MPS: f32 = 2.0;

/// The rest of a step is walked no faster than this, m/s.
const REST_MOST_MPS: f32 = 2.0;

/// A walked step of which less has passed can end a walk, for hips are still behind the foot that stands; and the hardest that hips brake for it, m/s².
const CLOSED_FROM: f64 = 0.45;
const HARDEST_BRAKING_MPS2: f64 = 6.0;
/// Steps that go to the side by more than this share of their way forwards do not.
const STRAIGHT: f32 = 0.2;

/// A mixture of styles, and how fast each of its gaits goes on this body.
#[derive(Clone, Debug)]
pub(crate) struct Worn {
    /// The walk; the run is in it.
    pub(crate) blend: Arc<Blend>,
    walk: PaceTable,
    /// Nothing where the model only walks.
    run: Option<PaceTable>,
    leg_length: f32,
}

impl Worn {
    /// Measures a walker in a mixture of styles.
    ///
    /// # Errors
    /// [`SynthError::Inference`] when the model gives no trajectory.
    pub(crate) fn measure(
        planner: &Planner,
        skeleton: &Skeleton,
        blend: Arc<Blend>,
        bench: &mut Workbench,
    ) -> Result<Self, SynthError> {
        let walk = PaceTable::measure(planner, skeleton, &blend, bench)?;
        let run = match &blend.running {
            Some(run) => Some(PaceTable::measure(planner, skeleton, run, bench)?),
            None => None,
        };
        Ok(Self {
            blend,
            walk,
            run,
            leg_length: skeleton.mean_leg_length(),
        })
    }

    /// Fastest speed that it goes at, m/s.
    pub(crate) const fn fastest_mps(&self) -> f32 {
        if self.run.is_some() {
            FASTEST_RUN_MPS
        } else {
            FASTEST_WALK_MPS
        }
    }

    /// The mixture that a step of this gait wears.
    pub(crate) fn dress(&self, gait: Gait) -> &Arc<Blend> {
        self.blend.of_gait(gait)
    }

    /// The next step, after one of this gait, and the gait that it is walked or run in. `velocity_mps` is the
    /// walk's and follows.
    pub(crate) fn request(
        &self,
        ask: &Ask,
        gait_before: Gait,
        velocity_mps: &mut Vec2,
    ) -> (Request, Gait) {
        let mut amplitude = ask.amplitude;
        let too_fast = velocity_mps.length() > self.first_mps();
        if amplitude.to < 1.0 && amplitude.from >= 1.0 && too_fast {
            // Who runs slows down before coming to a stand.
            amplitude.to = 1.0;
        }
        let sets_out = amplitude.from < 1.0 && amplitude.to >= 1.0;
        if sets_out {
            let most = if self.run.is_some() {
                FIRST_MPS
            } else {
                FASTEST_WALK_MPS
            };
            *velocity_mps = ask.velocity_mps.clamp_length_max(most);
        } else if amplitude.to >= 1.0 {
            *velocity_mps = ask.velocity_after(*velocity_mps, gait_before);
        }
        let gait = self.gait(ask, gait_before, amplitude, *velocity_mps);
        *velocity_mps = velocity_mps.clamp_length_max(gait.fastest_mps());
        let (mut pace, facing) = match (gait, &self.run) {
            (Gait::Run, Some(run)) => {
                let speed = velocity_mps.length();
                // The body turns to where it runs.
                let direction = velocity_mps.x.atan2(velocity_mps.y);
                let facing = run.facing + direction;
                (run.pace(f64::from(speed)), facing)
            }
            _ => (
                self.walk.pace_towards(*velocity_mps),
                self.walk.facing + pelvis_turn(*velocity_mps),
            ),
        };
        if gait == Gait::Walk && (sets_out || amplitude.to < 1.0) {
            let most = if sets_out { FIRST_SECS } else { LAST_SECS };
            pace = self.walk.within(pace, most);
        }
        let request = Request {
            manner: Manner {
                pace,
                position: StepPosition::Inside,
                detail: ask.detail,
            },
            amplitude,
            turn_rate: ask.turn_rate,
            velocity_mps: *velocity_mps,
            facing,
            leap_m: ask.leap_m,
        };
        (request, gait)
    }

    /// The rest of a walked step that came from `before` and would have so many frames in all, of which this share has passed, when something else is asked
    /// for in its middle. It takes no longer than it would have. Whoever is to stop closes it beside the standing foot, as long as the hips are behind that
    /// one and need not brake too hard; otherwise the next step does.
    pub(crate) fn rest_request(
        &self,
        ask: &Ask,
        before: &Request,
        frames: f64,
        passed: f64,
        velocity_mps: &mut Vec2,
    ) -> Request {
        let secs = frames / self.blend.model.frame_rate_hz;
        let left = (1.0 - passed) * secs;
        let braking = f64::from(velocity_mps.length()) / left;
        let forwards = velocity_mps.y > 0.0 && velocity_mps.x.abs() < STRAIGHT * velocity_mps.y;
        let closes = passed < CLOSED_FROM && braking < HARDEST_BRAKING_MPS2 && forwards;
        if ask.amplitude.to < 1.0 && closes {
            return Request {
                amplitude: Amplitude { from: 1.0, to: 0.0 },
                turn_rate: 0.0,
                ..*before
            };
        }
        let wanted = ask.velocity_after(*velocity_mps, Gait::Walk);
        *velocity_mps = wanted.clamp_length_max(REST_MOST_MPS.max(velocity_mps.length()));
        let pace = self.walk.pace_towards(*velocity_mps);
        Request {
            manner: Manner {
                pace: self.walk.within(pace, secs),
                ..before.manner
            },
            turn_rate: ask.turn_rate,
            velocity_mps: *velocity_mps,
            facing: self.walk.facing + pelvis_turn(*velocity_mps),
            ..*before
        }
    }

    /// The gait of a step.
    fn gait(&self, ask: &Ask, before: Gait, amplitude: Amplitude, velocity_mps: Vec2) -> Gait {
        if self.run.is_none() {
            return Gait::Walk;
        }
        if ask.leap_m.is_some() {
            return Gait::Run;
        }
        let ends = amplitude != Amplitude::WALK;
        ask.gait
            .of_step(before, velocity_mps, self.leg_length, ends)
    }

    /// The speed that a first step reaches at most, and from which one that stops can be taken, m/s.
    fn first_mps(&self) -> f32 {
        if self.run.is_some() {
            STOPPABLE_MPS
        } else {
            FASTEST_WALK_MPS
        }
    }

    /// A walk under way at the speed that suits it.
    pub(crate) fn first_request(&self, detail: Detail) -> Request {
        let speed = self.blend.model.speed.reference_mps;
        Request {
            manner: Manner {
                detail,
                ..Manner::inside(self.walk.pace(speed))
            },
            amplitude: Amplitude::WALK,
            turn_rate: 0.0,
            velocity_mps: speed as f32 * Vec2::Y,
            facing: self.walk.facing,
            leap_m: None,
        }
    }

    /// Someone who stands.
    pub(crate) fn standing_request(&self, detail: Detail) -> Request {
        Request {
            manner: Manner {
                detail,
                ..Manner::inside(self.walk.pace(f64::from(STANDING_SPEED_MPS)))
            },
            amplitude: Amplitude::STAND,
            velocity_mps: Vec2::ZERO,
            ..self.first_request(detail)
        }
    }
}
