//! Puts generated rotations on the ground, one step at a time: root travel, planted feet, legs that reach them.
//!
//! The model generates rotations only; the travel of the body follows from the foot that stands (Tilmanne et al. 2012,
//! section 5.2.3). Here the standing foot rolls on its plant without sliding ([`footfall_ik::rocker`]), the hips follow from
//! it through the generated leg, and both legs are then solved so that each foot is exactly where it belongs. What
//! generated rotations and planted feet disagree about is spread over the swing.

mod support;
mod swing;

use crate::generator::GroundTransform;
use crate::raw::RawFrame;
use crate::strafe::{Strafe, Turner};
use footfall_core::ease::{hermite, smooth_step};
use footfall_core::rotation::from_heading;
use footfall_core::{Joint, Pose, Side, Skeleton};
use footfall_ik::{FootTarget, Leg, Plant, RockerFoot};
use glam::{Quat, Vec3};
use swing::Swing;

/// Time constant with which the hips settle onto the path of the foot that has just landed, seconds.
const SETTLE_SECS: f32 = 0.07;

/// Part of a step over which a new turn rate sets in.
const TURN_ONSET: f32 = 0.6;

/// Generated legs disagree by a few centimetres about the hips' height when a foot lands. This share of the gap is closed
/// before the landing, from this part of the step on, and the rest after it.
const MEETING_SHARE: f32 = 0.5;
const MEETING_FROM: f32 = 0.4;

/// Fraction of the straight leg with which a foot lands at most: what is left keeps the pelvis from dropping at once.
const MAX_LANDING_EXTENSION: f32 = 0.985;

/// Share of the straight leg by which a swinging leg can be stretched beyond that.
const SWING_ROOM: f32 = 0.0145;

/// One frame of a walk on the ground.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlantedFrame {
    /// The pose in the space where the walk began.
    pub(crate) pose: Pose,
    /// Place of the walker on the ground: its travel without sway.
    pub(crate) ground_position: Vec3,
    /// Heading under which the generated features are put, radians, and the rotation by it.
    pub(crate) heading: f32,
    pub(crate) level: Quat,
    /// Whether the left and the right foot bear on the ground.
    pub(crate) contact: [bool; 2],
}

/// One step in frames of the model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepTiming {
    /// The foot whose initial contact begins the step, at frame 0.
    pub(crate) leading: Side,
    /// Frames until the other foot's initial contact.
    pub(crate) frames: usize,
    /// The last frame in which the other foot is still on the ground from its step before.
    pub(crate) terminal: usize,
    /// Whether both feet bear the body from its end on.
    pub(crate) rests: bool,
}

/// Carries plants, hips and heading from step to step.
#[derive(Clone, Debug)]
pub(crate) struct Planter {
    feet: [RockerFoot; 2],
    legs: [Leg; 2],
    leg_lengths: [f32; 2],
    frame_secs: f32,
    state: PlanterState,
}

/// What goes from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlanterState {
    pub(crate) plants: [Plant; 2],
    pub(crate) hips: Vec3,
    /// Velocity of the hips in the last frame, m/s; none before the first step.
    pub(crate) hips_velocity: Option<Vec3>,
    pub(crate) heading: f32,
    pub(crate) turn_rate: f32,
    pub(crate) ground_position: Vec3,
    pub(crate) ground_velocity: Option<Vec3>,
    /// Factor on the legs' reach at the end of the last step.
    pub(crate) stride: f32,
    /// How the last step was turned under the body.
    pub(crate) strafe: Strafe,
}

impl PlanterState {
    /// The same feet and hips for a walker who is at `to` instead of at `from`.
    pub(crate) fn moved(&self, from: &GroundTransform, to: &GroundTransform) -> Self {
        let turn = to.heading - from.heading;
        let rotation = from_heading(turn);
        let point = |point: Vec3| to.position + rotation * (point - from.position);
        Self {
            plants: self.plants.map(|plant| Plant {
                flat_ankle: point(plant.flat_ankle),
                heading: plant.heading + turn,
            }),
            hips: point(self.hips),
            hips_velocity: self.hips_velocity.map(|velocity| rotation * velocity),
            heading: self.heading + turn,
            turn_rate: self.turn_rate,
            ground_position: point(self.ground_position),
            ground_velocity: self.ground_velocity.map(|velocity| rotation * velocity),
            stride: self.stride,
            strafe: self.strafe,
        }
    }
}

/// Where a step goes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Course {
    /// Turning at its end, rad/s.
    pub(crate) turn_rate: f32,
    /// By how much its features turn under the walker, radians.
    pub(crate) shift: f32,
}

impl Planter {
    /// Puts the first frame on the ground: both feet down, hips above the origin, under this heading.
    pub(crate) fn new(
        skeleton: &Skeleton,
        frame_secs: f32,
        first: &RawFrame,
        leading: Side,
        heading: f32,
    ) -> Self {
        let level = from_heading(heading);
        let feet = Side::BOTH.map(|side| RockerFoot::new(skeleton, side));
        let plants = Side::BOTH.map(|side| {
            let leg = &first.legs[side.index()];
            let foot = &feet[side.index()];
            foot.plant_under(level * leg.ankle, heading + leg.heading(), leg.pitch)
        });
        let state = PlanterState {
            plants,
            hips: Vec3::ZERO,
            hips_velocity: None,
            heading,
            turn_rate: 0.0,
            ground_position: Vec3::ZERO,
            ground_velocity: None,
            stride: 1.0,
            strafe: Strafe::NONE,
        };
        let mut planter = Self::resume(skeleton, frame_secs, state);
        let standing = leading.other();
        let foot = planter.feet[standing.index()]
            .stand(planter.plant(standing), first.legs[standing.index()].pitch);
        let hips = foot.ankle - level * first.legs[standing.index()].ankle;
        planter.state.hips = Vec3::new(0.0, hips.y, 0.0);
        planter
    }

    /// Goes on from a [`state`](Self::state).
    pub(crate) fn resume(skeleton: &Skeleton, frame_secs: f32, state: PlanterState) -> Self {
        Self {
            feet: Side::BOTH.map(|side| RockerFoot::new(skeleton, side)),
            legs: Side::BOTH.map(|side| Leg::new(skeleton, side)),
            leg_lengths: Side::BOTH.map(|side| skeleton.leg_length(side)),
            frame_secs,
            state,
        }
    }

    /// From here on frames are so far apart, seconds.
    pub(crate) fn set_frame_secs(&mut self, frame_secs: f32) {
        self.frame_secs = frame_secs;
    }

    /// At the end of the next step the legs' reach has this factor on it.
    pub(crate) fn set_stride(&mut self, stride: f32) {
        self.state.stride = stride;
    }

    /// What the next step begins with.
    pub(crate) fn state(&self) -> PlanterState {
        self.state
    }

    /// Turns a step that goes forwards to where it is to go; forwards it goes along +Z under the heading `own_facing`.
    pub(crate) fn turn_step(
        &mut self,
        raw: &mut [RawFrame],
        timing: &StepTiming,
        strafe: Strafe,
        own_facing: f32,
        out: &mut [PlantedFrame],
    ) {
        let before = self.state.strafe;
        if [before, strafe] != [Strafe::NONE; 2] {
            let leg_length = self.leg_lengths[timing.leading.index()];
            // A step that ends a walk brings the feet together.
            let strafe = if timing.rests {
                strafe
            } else {
                strafe.spread(raw, leg_length)
            };
            self.state.strafe = strafe;
            let turner = Turner {
                feet: &self.feet,
                leg_length,
                own_facing,
            };
            turner.turn_step(raw, out, timing, [&before, &strafe]);
        }
    }

    /// Where this foot was put last.
    pub(crate) fn plant(&self, side: Side) -> &Plant {
        &self.state.plants[side.index()]
    }

    /// Puts a step on the ground. `raw` and `out` have one frame more than the step: the next initial contact, which is the
    /// first frame of the next step. The poses in `out` hold the generated local rotations.
    ///
    /// The trailing foot leaves the ground at `timing.terminal`, or earlier when the generated leg takes it away; returns
    /// when it does.
    pub(crate) fn plant_step(
        &mut self,
        raw: &mut [RawFrame],
        timing: &StepTiming,
        course: Course,
        out: &mut [PlantedFrame],
    ) -> usize {
        self.fill_stances(raw, timing);
        let raw = &*raw;
        self.travel(raw, timing, course, out);
        let timing = &StepTiming {
            terminal: self.release(raw, timing, out),
            ..*timing
        };
        // The next step takes the hips over as they were before the legs' reach lowered them: it lowers them again.
        let [before, last] = [timing.frames - 1, timing.frames].map(|f| out[f].pose.root_position);
        self.state.hips = last;
        self.state.hips_velocity = Some((last - before) / self.frame_secs);
        self.bear(raw, timing, out);
        let timing = &StepTiming {
            terminal: self.let_go(raw, timing, out),
            ..*timing
        };
        let last = &out[timing.frames];
        let (hips, heading) = (last.pose.root_position, last.heading);
        let trailing = timing.leading.other();
        let next_plant = self.next_plant(raw, timing, hips, heading, course.turn_rate);
        let ends = self.swing_ends(raw, timing, out, &next_plant);
        let before = timing.frames - 1;
        let (hips, level) = (out[before].pose.root_position, out[before].level);
        let arrival = free_foot(&raw[before], trailing, hips, level).ankle;
        let swing = Swing::new(&ends, arrival, timing, self.frame_secs);
        for (index, (frame, raw)) in out.iter_mut().zip(raw).enumerate() {
            let level = frame.level;
            let hips = frame.pose.root_position;
            let hips_rotation = frame.pose.rotations[Joint::Hips.index()];
            for side in Side::BOTH {
                let foot = &self.feet[side.index()];
                let leg = &raw.legs[side.index()];
                let target = if side == timing.leading || index <= timing.terminal {
                    leg.stance
                } else if index == timing.frames {
                    foot.stand(&next_plant, leg.pitch)
                } else {
                    let free = free_foot(raw, side, hips, level);
                    let mut target = swing.guide(index, &free, foot);
                    let hip = hips + level * raw.legs[side.index()].hip;
                    let length = self.leg_lengths[side.index()];
                    let yielded = hip + yielding(target.ankle - hip, length);
                    target.ankle = target.ankle.lerp(yielded, swing.freed(index));
                    target
                };
                let leg = &self.legs[side.index()];
                leg.solve(hips, hips_rotation, &target, &mut frame.pose);
            }
        }
        self.state.plants[trailing.index()] = next_plant;
        timing.terminal
    }

    /// Fills hips, heading and ground position of every frame, and carries the latter two to the next step.
    fn travel(
        &mut self,
        raw: &[RawFrame],
        timing: &StepTiming,
        course: Course,
        out: &mut [PlantedFrame],
    ) {
        let start = hips_above(&raw[0], timing.leading, from_heading(self.state.heading));
        let next_level = from_heading(self.state.heading + self.state.turn_rate * self.frame_secs);
        let follow = hips_above(&raw[1], timing.leading, next_level);
        let offset = self.state.hips - start;
        let velocity = self.state.hips_velocity.map_or(Vec3::ZERO, |velocity| {
            velocity * self.frame_secs - (follow - start)
        });
        let decay = self.frame_secs / SETTLE_SECS;
        let meeting = MEETING_SHARE * self.landing_height_gap(raw, timing);
        let mut settled = self.state.hips;
        let from_rate = self.state.turn_rate;
        for (index, (raw, frame)) in raw.iter().zip(&mut *out).enumerate() {
            let time = index as f32;
            let heading = self.state.heading;
            let level = from_heading(heading);
            // A critically damped return from where the hips were to where the landed foot has them.
            let remains = (offset + (velocity + offset * decay) * time) * (-decay * time).exp();
            let approach =
                smooth_step((time / timing.frames as f32 - MEETING_FROM) / (1.0 - MEETING_FROM));
            let hips =
                hips_above(raw, timing.leading, level) + remains + Vec3::Y * (meeting * approach);
            settled = hips;
            if index < timing.frames {
                let onset = smooth_step(time / (TURN_ONSET * timing.frames as f32));
                self.state.turn_rate = from_rate + onset * (course.turn_rate - from_rate);
                let share = |index: f32| smooth_step(index / timing.frames as f32);
                self.state.heading += self.state.turn_rate * self.frame_secs
                    + course.shift * (share(time + 1.0) - share(time));
            }
            frame.heading = heading;
            frame.level = level;
            frame.pose.root_position = hips;
            frame.pose.rotations[Joint::Hips.index()] = (level * raw.hips).normalize();
        }
        self.glide(timing, settled, out);
    }

    /// How much higher the landing foot's leg would have the hips at the end of the step than the standing foot's has them.
    fn landing_height_gap(&self, raw: &[RawFrame], timing: &StepTiming) -> f32 {
        let last = &raw[timing.frames];
        let landing = timing.leading.other();
        let leg = &last.legs[landing.index()];
        let foot = &self.feet[landing.index()];
        let plant = foot.plant_under(Vec3::ZERO, 0.0, leg.pitch);
        let above_landing = foot.stand(&plant, leg.pitch).ankle.y - leg.ankle.y;
        above_landing - hips_above(last, timing.leading, Quat::IDENTITY).y
    }

    /// The walker's place on the ground: a cubic path through the hips' places at initial contacts.
    fn glide(&mut self, timing: &StepTiming, hips: Vec3, out: &mut [PlantedFrame]) {
        let from = self.state.ground_position;
        let to = Vec3::new(hips.x, 0.0, hips.z);
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

    /// Where this foot stands on its plant, under the plant's heading, at the generated pitch.
    fn stand(&self, side: Side, level: Quat, raw: &RawFrame) -> FootTarget {
        let pitch = raw.legs[side.index()].pitch;
        self.feet[side.index()].stand_level(self.plant(side), level, pitch)
    }

    /// Fills where each foot stands while it may.
    fn fill_stances(&self, raw: &mut [RawFrame], timing: &StepTiming) {
        let trailing = timing.leading.other();
        for (side, last) in [(timing.leading, timing.frames), (trailing, timing.terminal)] {
            let level = from_heading(self.plant(side).heading);
            for raw in &mut raw[..=last] {
                raw.legs[side.index()].stance = self.stand(side, level, raw);
            }
        }
    }

    /// Where the trailing foot lands at the end of the step.
    fn next_plant(
        &self,
        raw: &[RawFrame],
        timing: &StepTiming,
        hips: Vec3,
        heading: f32,
        turn_rate: f32,
    ) -> Plant {
        let side = timing.leading.other();
        let leg = &raw[timing.frames].legs[side.index()];
        let ankle = hips + from_heading(heading) * leg.ankle;
        // The foot points to where the body will have turned by the middle of its stance.
        let lead = 0.5 * turn_rate * self.frame_secs * timing.frames as f32;
        let foot = &self.feet[side.index()];
        let mut plant = foot.plant_under(ankle, heading + lead + leg.heading(), leg.pitch);
        let hip = hips + from_heading(heading) * leg.hip;
        let reach = MAX_LANDING_EXTENSION * self.leg_lengths[side.index()];
        plant.flat_ankle += within_reach(foot.stand(&plant, leg.pitch).ankle - hip, reach);
        plant
    }

    /// Where the trailing foot is planted and where it would be free, at the ends of its swing.
    fn swing_ends(
        &self,
        raw: &[RawFrame],
        timing: &StepTiming,
        frames: &[PlantedFrame],
        next_plant: &Plant,
    ) -> [(FootTarget, FootTarget); 3] {
        let side = timing.leading.other();
        let foot = &self.feet[side.index()];
        let before = timing.terminal.saturating_sub(1);
        [before, timing.terminal, timing.frames].map(|index| {
            let frame = &frames[index];
            let plant = if index == timing.frames {
                next_plant
            } else {
                self.plant(side)
            };
            let free = free_foot(&raw[index], side, frame.pose.root_position, frame.level);
            let pitch = raw[index].legs[side.index()].pitch;
            (foot.stand(plant, pitch), free)
        })
    }
}

/// Where the hips are when this foot stands on its plant and the leg is as generated.
fn hips_above(raw: &RawFrame, side: Side, level: Quat) -> Vec3 {
    let leg = &raw.legs[side.index()];
    leg.stance.ankle - level * leg.ankle
}

/// Where a foot is when the leg is as generated.
fn free_foot(raw: &RawFrame, side: Side, hips: Vec3, level: Quat) -> FootTarget {
    let leg = &raw.legs[side.index()];
    let foot = level * leg.foot;
    FootTarget {
        ankle: hips + level * leg.ankle,
        foot,
        toes: foot,
    }
}

/// A swinging leg that gets ever harder to stretch: one that is straightened all at once snaps its knee.
fn yielding(ankle_from_hip: Vec3, length: f32) -> Vec3 {
    let (from, room) = (MAX_LANDING_EXTENSION * length, SWING_ROOM * length);
    let reach = ankle_from_hip.length();
    if reach <= from {
        return ankle_from_hip;
    }
    let yielded = from + room * (1.0 - (-(reach - from) / room).exp());
    ankle_from_hip * (yielded / reach)
}

/// The shift over the ground that brings the end of a leg within reach of the hip.
fn within_reach(ankle_from_hip: Vec3, reach: f32) -> Vec3 {
    let level = Vec3::new(ankle_from_hip.x, 0.0, ankle_from_hip.z);
    let level_reach = (reach * reach - ankle_from_hip.y.powi(2)).max(0.0).sqrt();
    level.clamp_length_max(level_reach) - level
}
