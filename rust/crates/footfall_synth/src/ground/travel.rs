//! Travel of the body in a step: hips above the standing foot, heading, and the walker's place on the ground.

use super::course::Course;
use super::frame::PlantedFrame;
use super::generated::GeneratedFrame;
use super::planter::Planter;
use super::strafe::Strafe;
use crate::plan::StepTiming;
use footfall_core::ease::{hermite, smooth_step};
use footfall_core::lanes::{self, COUNTING, LANES, Quatx8, Vec3x8, f32x8};
use footfall_core::rotation::from_heading;
use footfall_core::{Joint, Side};
use glam::{Quat, Vec3};

/// Time constant with which the hips settle onto the path of the foot that has just landed, seconds.
const SETTLE_SECS: f32 = 0.06;

/// Relative increase of that time for a step of no length: shortened steps, as on stairs, still lift and lower the hips as long ones
/// do.
const SHORT_SETTLE_SHARE: f32 = 1.8;

/// Speed of a fall, m/s, above that of any runner, beyond which settling takes longer, and the increase, seconds per m/s.
const SOFT_FALL_MPS: f32 = 1.3;
const SETTLE_BY_FALL: f32 = 0.04;

/// Part of a step over which a new turn rate sets in.
pub(super) const TURN_ONSET: f32 = 0.6;

/// Generated legs disagree by a few centimetres about the hips' height when a foot lands beside the other or behind it. This share of the gap is closed
/// before the landing, from this part of the step on, and the rest after it.
const MEETING_SHARE: f32 = 0.5;
const MEETING_FROM: f32 = 0.4;

impl Planter {
    /// Fills hips, heading and ground position of every frame, and carries the last two on to the next step.
    pub(super) fn travel(
        &mut self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        course: Course,
        out: &mut [PlantedFrame],
    ) {
        let settling = self.settling(generated, timing);
        let from = self.turn(timing, course, out);
        let level_from = Quatx8::splat(from_heading(from));
        let [facing_before, facing] = course.facing;
        let side = timing.leading.index();
        let blocks = generated.chunks(LANES).zip(out.chunks_mut(LANES));
        for (block, (generated, frames)) in blocks.enumerate() {
            let at = |lane: usize| lane.min(generated.len() - 1);
            let leg = |lane: usize| &generated[at(lane)].legs[side];
            // Not wrapped: rotations of frames in a row must not change their sign.
            let turned = core::array::from_fn(|lane| frames[at(lane)].heading - from);
            let level = level_from * Quatx8::from_rotation_y(f32x8::new(turned));
            let above = Vec3x8::gather(|lane| leg(lane).target.ankle)
                - level * Vec3x8::gather(|lane| leg(lane).ankle);
            let time = COUNTING + f32x8::splat((block * LANES) as f32);
            let hips = above + settling.at(time);
            let part = lanes::smooth_step(time * (timing.frames as f32).recip());
            let facing = f32x8::splat(facing_before) + part * (facing - facing_before);
            let plan_from_ground = level * Quatx8::from_rotation_y(-facing);
            let hips_rotation =
                (level * Quatx8::gather(|lane| generated[at(lane)].hips)).normalize();
            let rotations = [level, plan_from_ground, hips_rotation].map(|all| all.lanes());
            for (lane, frame) in frames.iter_mut().enumerate() {
                let [level, plan_from_ground, hips_rotation] =
                    rotations.each_ref().map(|all| all[lane]);
                frame.level = level;
                frame.ground_heading = frame.heading - facing.as_array()[lane];
                frame.plan_from_ground = plan_from_ground;
                frame.pose.root_position = hips.lane(lane);
                frame.pose.rotations[Joint::Hips.index()] = hips_rotation;
            }
        }
        self.drift(timing, out);
        self.brake(timing, course, out);
        self.even(timing, course, out);
        self.thrust(timing, course, out);
        course.displacement.lead(timing, self.leaps(timing), out);
        if course.keeps_lengths {
            self.keep_lengths(generated, timing, out);
        }
        self.glide(timing, out);
    }

    /// Returns the settling of the hips onto the path above the landed foot.
    fn settling(&self, generated: &[GeneratedFrame], timing: &StepTiming) -> Settling {
        let start = hips_above(
            &generated[0],
            timing.leading,
            from_heading(self.state.heading),
        );
        let next_level = from_heading(self.state.heading + self.state.turn_rate * self.frame_secs);
        let follow = hips_above(&generated[1], timing.leading, next_level);
        Settling {
            offset: self.state.hips - start,
            velocity: self.state.hips_velocity.map_or(Vec3::ZERO, |velocity| {
                velocity * self.frame_secs - (follow - start)
            }),
            decay: self.frame_secs / self.settle_secs(),
            // After a flight the body falls onto the landing foot.
            meeting: match timing.take_off {
                Some(_) => 0.0,
                None => MEETING_SHARE * self.landing_height_gap(generated, timing),
            },
            frames: timing.frames as f32,
        }
    }

    /// Time constant of the settling in a step with this reach of the legs, seconds.
    pub(super) fn settle_secs(&self) -> f32 {
        let forwards = self.state.strafe == Strafe::NONE;
        let stride = self.state.stride.clamp(0.0, 1.0);
        let short = if forwards { 1.0 - stride } else { 0.0 };
        let fall = self.state.hips_velocity.map_or(0.0, |speed| -speed.y);
        SETTLE_SECS * (1.0 + SHORT_SETTLE_SHARE * short)
            + SETTLE_BY_FALL * (fall - SOFT_FALL_MPS).max(0.0)
    }

    /// Fills the heading of every frame; returns that of the first.
    fn turn(&mut self, timing: &StepTiming, course: Course, out: &mut [PlantedFrame]) -> f32 {
        let from = self.state.heading;
        let from_rate = self.state.turn_rate;
        let [facing_before, facing] = course.facing;
        let share = |index: f32| smooth_step(index / timing.frames as f32);
        for (index, frame) in out.iter_mut().enumerate() {
            frame.heading = self.state.heading;
            if index < timing.frames {
                let time = index as f32;
                let onset = smooth_step(time / (TURN_ONSET * timing.frames as f32));
                self.state.turn_rate = from_rate + onset * (course.turn_rate - from_rate);
                self.state.heading += self.state.turn_rate * self.frame_secs
                    + (facing - facing_before + course.displacement.turn)
                        * (share(time + 1.0) - share(time));
            }
        }
        from
    }

    /// Difference between the heights that the landing leg and the standing leg would give the hips at the end of the step.
    fn landing_height_gap(&self, generated: &[GeneratedFrame], timing: &StepTiming) -> f32 {
        let last = &generated[timing.frames];
        let landing = timing.leading.other();
        self.landing_height(last, landing) - hips_above(last, timing.leading, Quat::IDENTITY).y
    }

    /// The walker's place on the ground: a cubic path through the hips' places at initial contacts, or through those beside them where the hips of a body that leans
    /// into a turn would be if it were upright. They are above the feet's path, which goes as fast as asked.
    fn glide(&mut self, timing: &StepTiming, out: &mut [PlantedFrame]) {
        let from = self.state.ground_position;
        let last = &out[timing.frames];
        let aside = self.state.lean.aside() * self.leg_lengths[timing.leading.index()];
        let upright = last.pose.root_position - last.level * (aside * Vec3::X);
        let to = upright.with_y(0.0);
        let arrival = to - from;
        let secs = timing.frames as f32 * self.frame_secs;
        let departure = self
            .state
            .ground_velocity
            .map_or(arrival, |velocity| velocity * secs);
        for (index, frame) in out.iter_mut().enumerate() {
            let s = index as f32 / timing.frames as f32;
            frame.ground_position = hermite(from, departure, to, arrival, s);
        }
        self.state.ground_position = to;
        self.state.ground_velocity = Some(arrival / secs);
    }
}

/// Settling of the hips onto another path, in frames of a step.
struct Settling {
    /// Offset and velocity in the first frame, relative to the new path.
    offset: Vec3,
    velocity: Vec3,
    decay: f32,
    /// Rise of the hips by the end, towards the height of the landing foot.
    meeting: f32,
    frames: f32,
}

impl Settling {
    /// Returns the offsets of the hips from the new path at eight times.
    fn at(&self, time: f32x8) -> Vec3x8 {
        // A critically damped return from where the hips were to where the landed foot has them.
        let pace = Vec3x8::splat(self.velocity + self.offset * self.decay);
        let left = (time * -self.decay).exp();
        let mut remains = (Vec3x8::splat(self.offset) + pace * time) * left;
        let part = time * self.frames.recip() - f32x8::splat(MEETING_FROM);
        remains.y += lanes::smooth_step(part * (1.0 - MEETING_FROM).recip()) * self.meeting;
        remains
    }
}

/// Position of the hips over a foot on its plant, with the leg as generated.
fn hips_above(generated: &GeneratedFrame, side: Side, level: Quat) -> Vec3 {
    let leg = &generated.legs[side.index()];
    leg.target.ankle - level * leg.ankle
}
