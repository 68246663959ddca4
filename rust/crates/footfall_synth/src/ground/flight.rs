//! Flight: the part of a running step in which no foot bears the body.
//!
//! Nothing but gravity acts then, so the hips go on at an even speed over the ground and on a parabola above it, from where the foot takes off to
//! where the generated leg of the other foot has them as it lands. The foot that took off is on its swing; the next step brings it down.

use super::bounce::{Bounce, Push};
use super::frame::PlantedFrame;
use super::generated::{GeneratedFrame, free_foot};
use super::planter::Planter;
use super::planter_state::Airborne;
use super::swing::Swing;
use crate::gait::GRAVITY_MPS2;
use crate::plan::StepTiming;
use footfall_core::Side;
use footfall_core::rotation::from_heading;
use footfall_ik::FootTarget;
use glam::Quat;

/// Bounds of the upward speed at take-off, m/s, relative to the one that returns the hips to the same height. Legs that
/// disagree more about the end of a short flight are bent or stretched.
const MOST_LIFT_MPS: f32 = 0.4;

/// Height of the hips at the landing of a run, as a share of the way from the height over the landing foot to that over the foot that takes
/// off.
const LEAVING_SHARE: f32 = 0.15;

/// Duration from which a flight counts as a leap, seconds, and the share of the initial speed over the ground that a leap keeps.
const LEAP_SECS: f32 = 0.22;
const LEAP_SPEED_SHARE: f32 = 0.85;

/// Share of a runner's stance in which the leg bears: as the toes leave the ground there is hardly any force on them.
const BEARING_SHARE: f32 = 0.9;

/// Fraction of the straight leg at which a foot that runs leaves the ground, a frame ahead, and one that leaps: hips go so fast then that a knee would snap straight.
const RUN_EXTENSION: f32 = 0.995;
const LEAP_EXTENSION: f32 = 0.98;

/// Greatest speed at which a knee gives way as its foot lands from a run and from a leap, rad/s, and the sine of half its greatest bend for that.
const GIVING_WAY: f32 = 8.0;
const LEAP_GIVING_WAY: f32 = 20.0;
const MOST_BENT: f32 = 0.5;

impl Planter {
    /// Moves the hips over the ground at constant velocity in the frames after the take-off; a leap keeps most of its initial
    /// speed.
    pub(super) fn drift(&self, timing: &StepTiming, out: &mut [PlantedFrame]) {
        let Some(take_off) = timing.take_off else {
            return;
        };
        let [begin, leaves] = [0, take_off].map(|frame| out[frame].pose.root_position);
        // In a turn the path of the stance is an arc, and the flight follows its tangent.
        let headings = out[..=take_off].iter().map(|frame| frame.heading);
        let ahead = out[take_off].heading - headings.sum::<f32>() / (take_off + 1) as f32;
        let mut pace = from_heading(ahead) * (leaves - begin) / take_off as f32;
        if self.leaps(timing) {
            let along = pace.with_y(0.0).normalize_or_zero();
            let entry = self.state.hips_velocity.unwrap_or_default().dot(along);
            let missing = (LEAP_SPEED_SHARE * entry * self.frame_secs - pace.dot(along)).max(0.0);
            for (frame, planted) in out[..=take_off].iter_mut().enumerate() {
                let s = frame as f32 / take_off as f32;
                let gained = s * s * s / 3.0 * take_off as f32;
                planted.pose.root_position += along * (missing * gained);
            }
            pace += along * missing;
        }
        let leaves = out[take_off].pose.root_position;
        for (passed, frame) in out[take_off..=timing.frames].iter_mut().enumerate() {
            frame.pose.root_position = leaves + passed as f32 * pace;
        }
    }

    /// Returns how much lower than over the generated leg the hips land when they fall at a speed, metres: a leg that is nearly straight would have to fold at once.
    fn give(&self, generated: &GeneratedFrame, timing: &StepTiming, fall_mps: f32) -> f32 {
        let giving_way = if self.leaps(timing) {
            LEAP_GIVING_WAY
        } else {
            GIVING_WAY
        };
        let side = timing.leading.other();
        let length = self.leg_lengths[side.index()];
        // Half a leg's length times the sine of half the bend is what the leg loses per radian of the knee.
        let half_bend = (fall_mps / (0.5 * length * giving_way)).clamp(0.0, MOST_BENT);
        let reach = length * (1.0 - half_bend * half_bend).sqrt();
        let leg = &generated.legs[side.index()];
        let down = leg.ankle - leg.hip;
        let most = (reach * reach - down.with_y(0.0).length_squared())
            .max(0.0)
            .sqrt();
        (-down.y - most).max(0.0)
    }

    /// Time from the take-off to the end of the step, seconds.
    fn flight_secs(&self, timing: &StepTiming) -> f32 {
        let frames = timing.take_off.map_or(0, |last| timing.frames - last);
        frames as f32 * self.frame_secs
    }

    /// Returns true when the step goes from flight to flight, as those of a steady run do.
    pub(super) fn runs_on(&self, timing: &StepTiming) -> bool {
        let flown = timing.airborne && !timing.sets_off;
        flown && timing.take_off.is_some() && !self.leaps(timing)
    }

    /// Returns true when the flight that ends the step is that of a leap.
    pub(super) fn leaps(&self, timing: &StepTiming) -> bool {
        self.flight_secs(timing) > LEAP_SECS
    }

    /// Moves the hips onto their parabola, with a push-off of the standing leg at its initial speed. Between two flights the leg acts as a spring; in the first
    /// step of a run and before a leap it follows the generated one and pushes harder.
    pub(super) fn fly(
        &self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        out: &mut [PlantedFrame],
    ) {
        let Some(take_off) = timing.take_off else {
            return;
        };
        let take_off = if self.runs_on(timing) {
            let bears = BEARING_SHARE * (timing.borne + take_off) as f32;
            (bears.round() as usize).saturating_sub(timing.borne).max(1)
        } else {
            take_off
        };
        let flight_secs = (timing.frames - take_off) as f32 * self.frame_secs;
        let even = 0.5 * GRAVITY_MPS2 * flight_secs;
        let lands = timing.leading.other();
        let landing = self.landing_height(&generated[timing.frames], lands)
            - self.give(&generated[timing.frames], timing, even);
        let stance_secs = take_off as f32 * self.frame_secs;
        let limited = |lift: f32| even + lift.clamp(-MOST_LIFT_MPS, MOST_LIFT_MPS);
        let rise = match self.state.hips_velocity {
            Some(velocity) if self.runs_on(timing) => {
                // In flight a frame's velocity is that of half a frame earlier.
                let fall = match timing.borne {
                    0 => velocity.y - 0.5 * GRAVITY_MPS2 * self.frame_secs,
                    _ => velocity.y,
                };
                let begin = self.state.hips.y;
                let leaving = &generated[take_off].legs[timing.leading.index()];
                let leaving = leaving.target.ankle.y - leaving.ankle.y;
                let end = landing + LEAVING_SHARE * (leaving - landing);
                let push = Push {
                    borne: timing.borne as f32 * self.frame_secs,
                    left: stance_secs,
                    // A stance that is replanned knows only the fall that is left.
                    early: Push::early_for(fall),
                };
                // The displacement per unit of a speed that is gained, and its excess over that of an even push.
                let gained = push.whole();
                let early = gained - 0.5 * stance_secs;
                let risen =
                    (fall + even) * gained + (GRAVITY_MPS2 * stance_secs - 2.0 * fall) * early;
                let rise = limited((end - begin - risen) / (gained + flight_secs));
                let bounce = Bounce::new(begin, [fall, rise], push);
                for (index, frame) in out[..=take_off].iter_mut().enumerate() {
                    frame.pose.root_position.y = bounce.height(index as f32 * self.frame_secs);
                }
                rise
            }
            _ => {
                let height = |frame: usize| out[frame].pose.root_position.y;
                let rise = limited((landing - height(take_off)) / flight_secs);
                // The generated leg pushes off nearly as fast; what is missing is added over the stance.
                let pushed = (height(take_off) - height(take_off - 1)) / self.frame_secs;
                // Between two frames the leg's speed is that of half a frame earlier.
                let missing = rise + 0.5 * GRAVITY_MPS2 * self.frame_secs * 0.5 - pushed;
                for (index, frame) in out[..=take_off].iter_mut().enumerate() {
                    let s = index as f32 / take_off as f32;
                    frame.pose.root_position.y += missing * stance_secs * s * s * (s - 1.0);
                }
                rise
            }
        };
        let begin = out[take_off].pose.root_position.y;
        for (passed, frame) in out[take_off..=timing.frames].iter_mut().enumerate() {
            let t = passed as f32 * self.frame_secs;
            frame.pose.root_position.y = begin + rise * t - 0.5 * GRAVITY_MPS2 * t * t;
        }
    }

    /// Lets the foot take off earlier where its leg, stretched, does not reach any more; returns its last frame on the ground.
    pub(super) fn leave(
        &self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        frames: &mut [PlantedFrame],
    ) -> Option<usize> {
        let take_off = timing.take_off?;
        let extension = if self.leaps(timing) {
            LEAP_EXTENSION
        } else {
            RUN_EXTENSION
        };
        let last = self.last_within(extension, generated, timing, frames)?;
        for frame in &mut frames[last + 1..=take_off] {
            frame.contact[timing.leading.index()] = false;
        }
        Some(last)
    }

    /// Returns the last frame of the stance from which the leg will not be longer than this share of its length a frame later: hips fly on, and draw the foot with them.
    fn last_within(
        &self,
        extension: f32,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        frames: &[PlantedFrame],
    ) -> Option<usize> {
        let take_off = timing.take_off?;
        let side = timing.leading.index();
        let reach = extension * self.leg_lengths[side];
        let length = |index: usize| {
            let frame = &frames[index];
            let leg = &generated[index].legs[side];
            let hip = frame.pose.root_position + frame.level * leg.hip;
            hip.distance(leg.target.ankle)
        };
        let beyond = (2..=take_off).find(|index| 2.0 * length(*index) - length(index - 1) > reach);
        Some(beyond.map_or(take_off, |beyond| beyond - 1))
    }

    /// Fills the targets of the foot that took off until the end of the step, and keeps them for the next one.
    pub(super) fn depart(
        &mut self,
        generated: &mut [GeneratedFrame],
        timing: &StepTiming,
        frames: &[PlantedFrame],
    ) {
        let side = timing.leading;
        self.state.airborne = timing.take_off.map(|take_off| {
            let ends = [take_off - 1, take_off].map(|index| {
                let frame = &frames[index];
                let hips = frame.pose.root_position;
                let free = free_foot(&generated[index], side, hips, frame.level);
                (generated[index].legs[side.index()].target, free)
            });
            let leaps = self.leaps(timing);
            let swing = Swing::departing(&ends, timing, take_off, leaps, self.frame_secs);
            self.fill_swing(
                generated,
                side,
                take_off + 1..timing.frames + 1,
                &swing,
                frames,
            );
            let at = |frame: usize| generated[frame].legs[side.index()].target;
            Airborne {
                now: at(timing.frames),
                before: at(timing.frames - 1),
                frame_secs: self.frame_secs,
            }
        });
    }

    /// Returns planned and free places of a foot that is in the air as the step begins, a frame earlier and then.
    pub(super) fn airborne_ends(
        &self,
        airborne: &Airborne,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        frames: &[PlantedFrame],
    ) -> [(FootTarget, FootTarget); 2] {
        let side = timing.leading.other();
        let [now, next] = [0, 1].map(|index: usize| {
            let frame = &frames[index];
            free_foot(
                &generated[index],
                side,
                frame.pose.root_position,
                frame.level,
            )
        });
        let back = |now: Quat, next: Quat| (now * next.inverse() * now).normalize();
        let earlier = FootTarget {
            ankle: 2.0 * now.ankle - next.ankle,
            foot: back(now.foot, next.foot),
            toes: back(now.toes, next.toes),
        };
        [
            (airborne.earlier(self.frame_secs), earlier),
            (airborne.now, now),
        ]
    }

    /// Height of the hips over the leg of a landing foot, metres.
    pub(super) fn landing_height(&self, generated: &GeneratedFrame, side: Side) -> f32 {
        let leg = &generated.legs[side.index()];
        let foot = &self.feet[side.index()];
        foot.ankle_height() + foot.roll(leg.pitch).y - leg.ankle.y
    }
}
