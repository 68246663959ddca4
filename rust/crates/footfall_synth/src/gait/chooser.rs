//! Choice of the next step: its gait, velocity and pace by the controls.

use super::direction::{is_forwards, pelvis_turn, sidles};
use super::kinds::{FASTEST_WALK_MPS, Gait, STOPPABLE_MPS};
use super::pace::{Pace, PaceTable};
use super::request::{Manner, Passed, StepControls, StepRequest};
use super::stand::Amplitude;
use crate::controls::{FASTEST_RUN_MPS, GaitChoice, STANDING_SPEED_MPS, sent_turn_rate};
use crate::detail::Detail;
use footfall_core::StepPosition;
use footfall_core::ease::smooth_step;
use glam::Vec2;

/// Maximum durations of the steps that start and end a walk, seconds.
const FIRST_SECS: f64 = 0.45;
const LAST_SECS: f64 = 0.39;

/// Turn rates from which steps get quicker, and at which a walker plants a foot and turns about it, rad/s; and the maximum duration of such a step, seconds. In between the tempo changes
/// evenly.
const PIVOT_RADPS: [f32; 2] = [1.5, 2.5];
const PIVOT_SECS: f64 = 0.45;

/// Turn of a step on the spot, radians, and its least duration, seconds: quicker turns take quicker steps. From this requested speed on, in m/s, steps are not on the spot.
const SPOT_RAD: f64 = 0.7;
const SPOT_LEAST_SECS: f64 = 0.35;
const SPOT_MPS: f32 = 0.5;

/// Differences between the velocity of a step and the requested one from which steps get quicker, and at which they last this long at most, m/s and seconds. Who turns back the way they
/// came passes through a step that hardly travels, and does not dwell on it.
const REVERSAL_MPS: [f32; 2] = [0.3, 0.8];
const REVERSAL_SECS: f64 = 0.55;

/// Maximum speeds at the end of a first step forwards, and of one to the side or backwards, m/s. People reach no speed within 0.2 s, and who is carried that fast aside or
/// backwards has the other foot too far behind to follow.
const FIRST_MPS: f32 = 2.0;
const FIRST_ASIDE_MPS: f32 = 1.1;

/// Maximum speed of the remainder of a replanned step, m/s.
const REST_MOST_MPS: f32 = 2.0;

/// Hardest change of the velocity in the remainder of a replanned step that does not go straight ahead before and after it, m/s²: as hard as people brake.
const ASIDE_MPS2: f32 = 4.0;

/// Least duration of a replanned walked step, as a share of the planned one: a foot on its way needs its time.
const LEAST_SHARE: f64 = 0.75;

/// Share of a walked step until which it can still end the walk, and the hardest braking of the hips for it, m/s²; and the share of its speed that a walker
/// keeps for the step that ends the walk otherwise. It does so above the first of two speeds, and fully from the second on, m/s.
const CLOSED_FROM: f64 = 0.45;
const HARDEST_BRAKING_MPS2: f32 = 13.0;
const KEPT_SHARE: f32 = 0.6;
const BRISK_MPS: [f32; 2] = [0.7, 1.1];
/// The hardest braking in a step to the side that [gathers](Passed::gathers) the feet, m/s², along a cubic that is harder than the hips' way; and the distance of a standing foot from the
/// middle of the body, as a share of the leg, by which those hips stop before they are above it.
const HARDEST_GATHERING_MPS2: f32 = 18.0;
const BESIDE_SHARE: f32 = 0.1;

/// Gaits of one body, each with its paces.
#[derive(Clone, Debug)]
pub(crate) struct StepChooser {
    pub(crate) walk: PaceTable,
    /// `None` where the model only walks.
    pub(crate) run: Option<PaceTable>,
    pub(crate) leg_length: f32,
    pub(crate) frame_rate_hz: f64,
    /// Speed that suits the walk best, m/s.
    pub(crate) usual_mps: f64,
}

impl StepChooser {
    /// Maximum speed, m/s.
    pub(crate) const fn fastest_mps(&self) -> f32 {
        if self.run.is_some() {
            FASTEST_RUN_MPS
        } else {
            FASTEST_WALK_MPS
        }
    }

    /// Returns the request for the next step, after one of this gait, and its gait. `velocity_mps` is the velocity of the walk and is
    /// updated.
    pub(crate) fn request(
        &self,
        controls: &StepControls,
        gait_before: Gait,
        velocity_mps: &mut Vec2,
    ) -> (StepRequest, Gait) {
        let mut amplitude = controls.amplitude;
        let too_fast = velocity_mps.length() > self.first_mps();
        let slows = amplitude.to < 1.0 && amplitude.from >= 1.0 && too_fast;
        if slows {
            // A runner slows down before stopping.
            amplitude.to = 1.0;
        }
        let slows = slows || controls.slows_to_walk(gait_before, *velocity_mps, self.leg_length);
        let sets_out = amplitude.from < 1.0 && amplitude.to >= 1.0;
        if sets_out {
            let asked = controls.velocity_mps;
            *velocity_mps = asked.clamp_length_max(self.first_step_mps(asked));
        } else if amplitude.to >= 1.0 {
            let most = gait_before.most_change_mps(slows);
            *velocity_mps = controls.velocity_within(*velocity_mps, most);
        }
        let gait = self.gait(controls, gait_before, amplitude, *velocity_mps);
        *velocity_mps = velocity_mps.clamp_length_max(gait.fastest_mps());
        let (mut pace, facing) = self.towards(gait, *velocity_mps);
        if gait == Gait::Walk {
            pace = if sets_out {
                self.walk.within(pace, FIRST_SECS)
            } else if amplitude.to < 1.0 {
                self.walk.within(pace, LAST_SECS)
            } else {
                self.agile(pace, controls, *velocity_mps)
            };
        }
        let request = StepRequest {
            manner: Manner {
                pace,
                position: StepPosition::Inside,
                detail: controls.detail,
            },
            amplitude,
            turn_rate: controls.turn_rate,
            velocity_mps: *velocity_mps,
            // A pelvis that is turned to the way comes back as the walker stops.
            facing: if amplitude.to < 1.0 {
                self.walk.facing
            } else {
                facing
            },
            leap_m: controls.leap_m,
        };
        (self.changing(request, controls, gait, slows), gait)
    }

    /// Returns the maximum speed at the end of a first step in the direction of a velocity, m/s.
    fn first_step_mps(&self, velocity_mps: Vec2) -> f32 {
        let forwards = if self.run.is_some() {
            FIRST_MPS
        } else {
            FASTEST_WALK_MPS
        };
        let aside = smooth_step(1.0 - velocity_mps.normalize_or(Vec2::Y).y);
        forwards + aside * (FIRST_ASIDE_MPS - forwards)
    }

    /// Returns the request for the remainder of a step when the controls change within it. `before` is its request. The remainder takes no longer than planned.
    /// A walker that is to stop brings the feet together, provided that the hips need not brake too hard to come to rest above the standing foot; otherwise it
    /// slows down, and the next step does so. A runner that is to stop or to walk slows down within the stance.
    pub(crate) fn remainder_request(
        &self,
        controls: &StepControls,
        gait: Gait,
        before: &StepRequest,
        passed: &Passed,
        velocity_mps: &mut Vec2,
    ) -> StepRequest {
        let secs = passed.whole_frames / self.frame_rate_hz;
        let left = (1.0 - passed.share) * secs;
        let forwards = is_forwards(*velocity_mps);
        let gathers = passed.gathers(*velocity_mps);
        let (beside_m, hardest) = if gathers {
            (BESIDE_SHARE * self.leg_length, HARDEST_GATHERING_MPS2)
        } else {
            (0.0, HARDEST_BRAKING_MPS2)
        };
        let gently = passed.braking_mps2(left as f32, beside_m) < hardest;
        let early = passed.share < CLOSED_FROM;
        let closes = controls
            .brakes
            .unwrap_or(early && gently && (forwards || gathers));
        let inside = before.amplitude == Amplitude::WALK;
        let stands = controls.amplitude.to < 1.0;
        let stops = gait == Gait::Walk && inside && stands;
        let slows = if stands {
            gait == Gait::Run
        } else {
            // A follower that has begun to run where the sender walks does not hurry the more.
            let may_run = controls.gait != GaitChoice::Walk;
            may_run && controls.slows_to_walk(gait, *velocity_mps, self.leg_length)
        };
        if stops && closes {
            return StepRequest {
                amplitude: Amplitude { from: 1.0, to: 0.0 },
                turn_rate: 0.0,
                facing: self.walk.facing,
                ..*before
            };
        }
        if stops && (gathers || sidles(*velocity_mps) && !early) {
            // The foot comes to the other one, or is too far out to come down sooner. The next step stops.
            return StepRequest {
                turn_rate: controls.turn_rate,
                ..*before
            };
        }
        let most = gait.most_change_mps(slows);
        *velocity_mps = match gait {
            Gait::Walk => {
                let most = if forwards && (stands || is_forwards(controls.velocity_mps)) {
                    most
                } else {
                    most.min(ASIDE_MPS2 * left as f32)
                };
                let wanted = controls.velocity_within(*velocity_mps, most);
                wanted.clamp_length_max(REST_MOST_MPS.max(velocity_mps.length()))
            }
            Gait::Run => controls.velocity_within(passed.velocity_mps, most * (1.0 - passed.borne)),
        };
        let mut mean_mps = *velocity_mps;
        if stops && forwards {
            // A shorter step would have the hips brake before it lands.
            let before_mps = before.velocity_mps;
            let brisk = between(BRISK_MPS, before_mps.length());
            *velocity_mps = velocity_mps.lerp(KEPT_SHARE * before_mps, brisk);
            mean_mps = velocity_mps.lerp(before_mps, 0.5 * brisk);
        }
        let (mut pace, facing) = self.towards(gait, mean_mps);
        if gait == Gait::Walk {
            pace = self.agile(self.walk.within(pace, secs), controls, *velocity_mps);
            pace = self.walk.lasting(pace, LEAST_SHARE * secs);
        }
        let request = StepRequest {
            manner: Manner {
                pace,
                ..before.manner
            },
            turn_rate: controls.turn_rate,
            velocity_mps: *velocity_mps,
            facing,
            ..*before
        };
        self.changing(request, controls, gait, slows)
    }

    /// Returns the pace and the facing for a velocity to the left and forwards, m/s. A runner faces the direction of travel.
    fn towards(&self, gait: Gait, velocity_mps: Vec2) -> (Pace, f32) {
        match (gait, &self.run) {
            (Gait::Run, Some(run)) => (
                run.pace(f64::from(velocity_mps.length())),
                run.facing + velocity_mps.x.atan2(velocity_mps.y),
            ),
            _ => (
                self.walk.pace_towards(velocity_mps),
                self.walk.facing + pelvis_turn(velocity_mps),
            ),
        }
    }

    /// Returns the pace of a walked step of this velocity: quicker where it turns, most of all on the spot, or where its velocity is far from the requested one. Peers over a network choose
    /// the same: turn rates count as they are sent, and a step is on the spot by the requested speed.
    fn agile(&self, mut pace: Pace, controls: &StepControls, velocity_mps: Vec2) -> Pace {
        let missing_mps = controls.velocity_mps.distance(velocity_mps);
        let turn_rate = sent_turn_rate(controls.turn_rate).abs();
        let spot_secs = (SPOT_RAD / f64::from(turn_rate)).max(SPOT_LEAST_SECS);
        let spot = f64::from(1.0 - smooth_step(controls.velocity_mps.length() / SPOT_MPS));
        let quicker = self.walk.within(pace, spot_secs).tempo / pace.tempo;
        pace = pace.quicker(1.0 + spot * (quicker - 1.0));
        for (share, most_secs) in [
            (between(PIVOT_RADPS, turn_rate), PIVOT_SECS),
            (between(REVERSAL_MPS, missing_mps), REVERSAL_SECS),
        ] {
            let quicker = self.walk.within(pace, most_secs);
            pace.tempo += f64::from(share) * (quicker.tempo - pace.tempo);
        }
        pace
    }

    /// The gait of a step.
    fn gait(
        &self,
        controls: &StepControls,
        before: Gait,
        amplitude: Amplitude,
        velocity_mps: Vec2,
    ) -> Gait {
        if self.run.is_none() {
            return Gait::Walk;
        }
        if controls.leap_m.is_some() {
            return Gait::Run;
        }
        let ends = amplitude != Amplitude::WALK;
        controls
            .gait
            .of_step(before, velocity_mps, self.leg_length, ends)
    }

    /// Returns the request for a step of this gait, slowing down or, if it is walked and the controls ask for a run, gaining speed. The step with which a runner begins to walk is as long as
    /// others.
    fn changing(
        &self,
        request: StepRequest,
        controls: &StepControls,
        gait: Gait,
        slows: bool,
    ) -> StepRequest {
        let walks = gait == Gait::Walk && controls.amplitude.to >= 1.0;
        if slows && !walks {
            return request.slowing(gait);
        }
        let wanted = controls
            .gait
            .of_step(gait, controls.velocity_mps, self.leg_length, false);
        if self.run.is_some() && (gait, wanted) == (Gait::Walk, Gait::Run) {
            request.gaining(controls)
        } else {
            request
        }
    }

    /// Maximum speed of a first step, and maximum speed from which a step can stop, m/s.
    fn first_mps(&self) -> f32 {
        if self.run.is_some() {
            STOPPABLE_MPS
        } else {
            FASTEST_WALK_MPS
        }
    }

    /// Request for a step inside a walk at the usual speed.
    pub(crate) fn walking_request(&self, detail: Detail) -> StepRequest {
        let speed = self.usual_mps;
        StepRequest {
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

    /// Request for standing.
    pub(crate) fn standing_request(&self, detail: Detail) -> StepRequest {
        StepRequest {
            manner: Manner {
                detail,
                ..Manner::inside(self.walk.pace(f64::from(STANDING_SPEED_MPS)))
            },
            amplitude: Amplitude::STAND,
            velocity_mps: Vec2::ZERO,
            ..self.walking_request(detail)
        }
    }
}

/// Returns the place of a value between two others, from 0 to 1, smoothed.
fn between([from, to]: [f32; 2], value: f32) -> f32 {
    smooth_step((value - from) / (to - from))
}
