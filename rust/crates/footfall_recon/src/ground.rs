//! Travel of the body over feet that stay where they were put.
//!
//! The body travels as the recordings do, and is then moved so that a standing foot keeps its place: the way comes from the legs. What is left
//! when both stand is the legs' to take up. A standing foot is a rocker ([`footfall_ik::rocker`]): it cannot slide or sink.

use crate::body::{BodyFrame, pose_of};
use footfall_core::ease::smooth_step;
use footfall_core::rotation::{from_heading, wrap_angle};
use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_ik::{FootTarget, Leg, Plant, RockerFoot, foot_heading, foot_pitch, settled_pitch};
use footfall_imu::ToldContact;
use footfall_model::imu_model::{CONTACT, TURN, WAY};
use glam::{Quat, Vec3};

/// A foot comes to stand above the first of these probabilities and leaves the ground below the second.
const STANDS: [f32; 2] = [0.55, 0.4];

/// A foot whose leg would have to stretch so far to where it stands is put anew, metres.
const MAX_DRIFT_M: f32 = 0.15;

/// A foot whose own sensor says that it is in the air is held so far off the ground, as a share of the leg's length, where the body moves it as slowly
/// as a foot that stands: less than the first of these speeds, leg lengths a second, and not at all above the second.
const CLEARANCE: f32 = 0.08;
const CLEARED_SPEEDS: [f32; 2] = [1.5, 3.5];

/// It is raised so far within this time from when it left the ground, seconds.
const CLEARED_AFTER_SECS: f32 = 0.05;

/// A foot whose own sensor says that it stands may drift so much further.
const TOLD_DRIFT: f32 = 2.0;

/// Half-life of what remains of a correction when a foot lands, seconds.
const SETTLE_HALF_LIFE_SECS: f32 = 0.01;

/// Rate of the critically damped spring by which the correction of a foot that leaves the ground dies away, 1/s.
const RELEASE_RATE: f32 = 60.0;

/// The height of the pelvis follows the standing feet with this half-life, seconds.
const HEIGHT_HALF_LIFE_SECS: f32 = 0.05;

/// A leg that steps are lengthened for reaches at most so far from below the hip, as a share of its length.
const MOST_SPREAD: f32 = 0.6;

/// Added to the bend of a knee before legs are weighed by it, radians.
const KNEE_SLACK: f32 = 0.1;

/// The heading follows the sensor's with this half-life, seconds.
const HEADING_HALF_LIFE_SECS: f32 = 0.2;

/// For so long the heading of the sensor is compared with the body's before the body follows it, seconds: what is probable is not settled at first.
const HEADING_ANCHOR_SECS: f32 = 2.0;

/// Travel, heading and feet of one body.
#[derive(Clone, Debug)]
pub struct Ground {
    skeleton: Skeleton,
    legs: [Leg; 2],
    rockers: [RockerFoot; 2],
    leg_length_m: f32,
    /// Metres of this body for one of the model's.
    scale: f32,
    place: Vec3,
    heading: f32,
    /// The body's heading less the sensor's, and for how long both were compared.
    heading_offset: f32,
    compared_secs: f32,
    height_m: f32,
    feet: [StandingFoot; 2],
    stride: f32,
    model: ModelPose,
}

/// One foot.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StandingFoot {
    plant: Option<Plant>,
    /// Remainder that settles: how far the ankle is from where it should be, how fast that changes (m/s), and how the foot is turned against it.
    ankle: Vec3,
    drift: Vec3,
    turn: Quat,
    /// Offset of the ankle and turn of the foot against the recordings, in the last frame.
    last: (Vec3, Quat),
    landed: bool,
    /// Time since it left the ground, seconds.
    free_secs: f32,
    /// Position that the recordings gave the ankle in the last frame.
    free: Vec3,
}

impl StandingFoot {
    const FREE: Self = Self {
        plant: None,
        ankle: Vec3::ZERO,
        drift: Vec3::ZERO,
        turn: Quat::IDENTITY,
        last: (Vec3::ZERO, Quat::IDENTITY),
        landed: false,
        free_secs: CLEARED_AFTER_SECS,
        free: Vec3::ZERO,
    };

    /// Lets what remains of a correction die away for some time.
    fn settle(&mut self, dt_secs: f32) {
        let left = if self.plant.is_some() {
            let left = 1.0 - follow_share(SETTLE_HALF_LIFE_SECS, dt_secs);
            self.ankle *= left;
            left
        } else {
            let left = (-RELEASE_RATE * dt_secs).exp();
            let toward = self.drift + RELEASE_RATE * self.ankle;
            self.ankle = left * (self.ankle + dt_secs * toward);
            self.drift = left * (self.drift - RELEASE_RATE * dt_secs * toward);
            left
        };
        self.turn = Quat::IDENTITY.slerp(self.turn, left);
    }
}

/// Input of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundInput {
    /// Heading that the sensor gives the body, from an unknown direction on, radians; `None` where it tells nothing.
    pub heading: Option<f32>,
    /// Number of the model's frames that have passed.
    pub frames: f32,
    /// The same in seconds.
    pub dt_secs: f32,
    /// Factor on the length of the recordings' steps.
    pub stride: f32,
    /// Contacts of the left and the right foot where a sensor on the foot reports them; the body has those of the others.
    pub contacts: [Option<ToldContact>; 2],
}

impl Ground {
    /// For a body with these proportions; the model's body gives the scale.
    pub fn new(skeleton: &Skeleton, model_skeleton: &Skeleton) -> Self {
        Self {
            legs: Side::BOTH.map(|side| Leg::new(skeleton, side)),
            rockers: Side::BOTH.map(|side| RockerFoot::new(skeleton, side)),
            leg_length_m: skeleton.mean_leg_length(),
            scale: skeleton.mean_leg_length() / model_skeleton.mean_leg_length(),
            place: Vec3::ZERO,
            heading: 0.0,
            heading_offset: 0.0,
            compared_secs: 0.0,
            height_m: 0.0,
            feet: [StandingFoot::FREE; 2],
            stride: 1.0,
            model: ModelPose::default(),
            skeleton: skeleton.clone(),
        }
    }

    /// Back to the origin, facing +Z.
    pub fn reset(&mut self) {
        (self.place, self.heading, self.height_m) = (Vec3::ZERO, 0.0, 0.0);
        self.forget_sensor_heading();
        self.feet = [StandingFoot::FREE; 2];
    }

    /// The body's proportions.
    pub const fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Metres of this body for one of the model's.
    pub const fn scale(&self) -> f32 {
        self.scale
    }

    /// Place of the body on the floor, metres.
    pub const fn place(&self) -> Vec3 {
        self.place
    }

    /// Heading of the body, radians.
    pub const fn heading(&self) -> f32 {
        self.heading
    }

    /// Faces another way from now on; feet are put anew.
    pub fn set_heading(&mut self, heading: f32) {
        self.heading = wrap_angle(heading);
        self.forget_sensor_heading();
        for foot in &mut self.feet {
            foot.plant = None;
        }
    }

    /// Begins anew with the sensor's heading: the sensor may have been turned or exchanged.
    pub const fn forget_sensor_heading(&mut self) {
        self.compared_secs = 0.0;
    }

    /// Footprints of the feet that came to stand in the last step.
    pub fn landings(&self) -> [Option<Vec3>; 2] {
        self.feet.map(|foot| {
            let plant = foot.plant.filter(|_| foot.landed)?;
            Some(RockerFoot::footprint(&plant))
        })
    }

    /// Returns true for the left and the right foot while it stands.
    pub fn stands(&self) -> [bool; 2] {
        self.feet.map(|foot| foot.plant.is_some())
    }

    /// Goes on to a body and writes its pose.
    pub fn step(&mut self, body: &BodyFrame, input: &GroundInput, pose: &mut Pose) {
        pose_of(body, self.scale, pose);
        self.turn(body, input);
        let level = from_heading(self.heading);
        pose.rotations[0] = level * pose.rotations[0];
        self.stride = input.stride;
        let metres = self.scale * self.stride * input.frames;
        let way = Vec3::new(body[WAY], 0.0, body[WAY + 1]) * metres;
        self.place += level * way;
        pose.root_position += self.place;
        forward_kinematics(&self.skeleton, pose, &mut self.model);
        self.bear(body, input.contacts, pose);
        self.follow_height(input.dt_secs, pose);
        forward_kinematics(&self.skeleton, pose, &mut self.model);
        for side in Side::BOTH {
            self.solve(side, body, input, pose);
        }
    }

    /// Position of an ankle, its leg swung from the hip as much further as steps are longer: knees keep their bend, and the pelvis comes down over
    /// feet that are further apart.
    fn ankle(&self, side: Side) -> Vec3 {
        let hip = self.model.position(side.upper_leg());
        let own = self.model.position(side.foot()) - hip;
        let along = own.with_y(0.0);
        let longest = MOST_SPREAD * own.length();
        let wanted = (along * self.stride).clamp_length_max(longest.max(along.length()));
        let down = (own.length_squared() - wanted.length_squared())
            .max(0.0)
            .sqrt();
        hip + wanted + Vec3::Y * down.copysign(own.y)
    }

    /// Position at which the ankle of a foot is shown after the last step, metres.
    pub fn shown_ankle(&self, side: Side) -> Vec3 {
        self.ankle(side) + self.feet[side.index()].last.0
    }

    fn turn(&mut self, body: &BodyFrame, input: &GroundInput) {
        self.heading += body[TURN] * input.frames;
        if let Some(sensor) = input.heading {
            let apart = wrap_angle(self.heading - sensor - self.heading_offset);
            if self.compared_secs < HEADING_ANCHOR_SECS {
                self.compared_secs += input.dt_secs;
                let share = (input.dt_secs / self.compared_secs.max(f32::MIN_POSITIVE)).min(1.0);
                self.heading_offset += apart * share;
            } else {
                self.heading -= apart * follow_share(HEADING_HALF_LIFE_SECS, input.dt_secs);
            }
        }
        self.heading = wrap_angle(self.heading);
    }

    /// Moves the body along the ground so that standing feet keep their places.
    fn bear(&mut self, body: &BodyFrame, told: [Option<ToldContact>; 2], pose: &mut Pose) {
        let (mut shift, mut weights) = (Vec3::ZERO, 0.0);
        for side in Side::BOTH {
            if let Some(plant) = self.feet[side.index()].plant {
                let target = self.standing(side, &plant);
                let weight = match told[side.index()] {
                    Some(told) if told.stands => 1.0,
                    _ => body[CONTACT + side.index()].clamp(0.05, 1.0),
                };
                shift += (target.ankle - self.ankle(side)).with_y(0.0) * weight;
                weights += weight;
            }
        }
        if weights > 0.0 {
            let shift = shift / weights;
            self.place += shift;
            pose.root_position += shift;
        }
    }

    /// Raises or lowers the body so that feet that stand meet the floor, and none is below it.
    ///
    /// Legs that are nearly straight have the say: a centimetre more or less bends their knees by twenty degrees, and those of bent legs
    /// hardly at all.
    fn follow_height(&mut self, dt_secs: f32, pose: &mut Pose) {
        let (mut wanted, mut weights) = (0.0, 0.0);
        for side in Side::BOTH {
            let ankle = self.ankle(side);
            let lift = if let Some(plant) = self.feet[side.index()].plant {
                self.standing(side, &plant).ankle.y - ankle.y
            } else {
                let target = FootTarget {
                    ankle,
                    foot: self.model.rotation(side.foot()),
                    toes: self.model.rotation(side.toes()),
                };
                -self.rockers[side.index()].lowest_point(&target)
            };
            if self.feet[side.index()].plant.is_some() || lift > 0.0 {
                let bend = pose
                    .rotation(side.lower_leg())
                    .angle_between(Quat::IDENTITY);
                let weight = (KNEE_SLACK + bend).powi(-2);
                wanted += weight * lift;
                weights += weight;
            }
        }
        let wanted = if weights > 0.0 { wanted / weights } else { 0.0 };
        let share = follow_share(HEIGHT_HALF_LIFE_SECS, dt_secs);
        self.height_m += share * (wanted - self.height_m);
        pose.root_position.y += self.height_m;
    }

    /// A planted foot as the recordings pitch it.
    fn standing(&self, side: Side, plant: &Plant) -> FootTarget {
        let pitch = settled_pitch(foot_pitch(self.model.rotation(side.foot())));
        self.rockers[side.index()].stand(plant, pitch)
    }

    /// Height at which a foot that is known to be in the air is held, when the body moves its ankle so far in a step, metres.
    fn clearance_m(&self, moved: Vec3, dt_secs: f32) -> f32 {
        let [least, most] = CLEARED_SPEEDS.map(|speed| speed * self.leg_length_m * dt_secs);
        let slow = (most - moved.with_y(0.0).length()) / (most - least).max(f32::MIN_POSITIVE);
        CLEARANCE * self.leg_length_m * slow.clamp(0.0, 1.0)
    }

    /// Puts one foot where it belongs.
    fn solve(&mut self, side: Side, body: &BodyFrame, input: &GroundInput, pose: &mut Pose) {
        let index = side.index();
        let ankle = self.ankle(side);
        let (foot, toes) = (
            self.model.rotation(side.foot()),
            self.model.rotation(side.toes()),
        );
        let mut own = self.feet[index];
        own.landed = false;
        let stood = own.plant.is_some();
        if let Some(plant) = own.plant {
            let drift = self.standing(side, &plant).ankle.distance(ankle);
            let leaves = match input.contacts[index] {
                Some(told) => !told.stands || drift > TOLD_DRIFT * MAX_DRIFT_M,
                None => body[CONTACT + index] < STANDS[1] || drift > MAX_DRIFT_M,
            };
            if leaves {
                own.plant = None;
                // The frame in which it left counts from when it did.
                own.free_secs = match input.contacts[index] {
                    Some(told) if !told.stands => told.for_secs.min(input.dt_secs) - input.dt_secs,
                    _ => 0.0,
                };
            }
        } else if input.contacts[index]
            .map_or(body[CONTACT + index] > STANDS[0], |told| told.stands)
        {
            let pitch = settled_pitch(foot_pitch(foot));
            let settled = own.last.0.with_y(0.0);
            let heading = foot_heading(foot);
            own.plant = Some(self.rockers[index].plant_under(ankle + settled, heading, pitch));
            own.landed = true;
        }
        let target = if let Some(plant) = own.plant {
            self.standing(side, &plant)
        } else {
            let mut free = FootTarget { ankle, foot, toes };
            own.free_secs += input.dt_secs;
            if input.contacts[index].is_some_and(|told| !told.stands) {
                let clearance = self.clearance_m(ankle - own.free, input.dt_secs)
                    * smooth_step(own.free_secs / CLEARED_AFTER_SECS);
                free.ankle.y += (clearance - self.rockers[index].lowest_point(&free)).max(0.0);
            }
            free
        };
        own.free = ankle;
        let wanted = (target.ankle - ankle, target.foot * foot.inverse());
        if stood != own.plant.is_some() {
            own.ankle = own.last.0 - wanted.0;
            own.drift = Vec3::ZERO;
            own.turn = own.last.1 * wanted.1.inverse();
        }
        let settles_secs = match input.contacts[index] {
            Some(told) if own.landed => told.for_secs.min(input.dt_secs),
            _ => input.dt_secs,
        };
        own.settle(settles_secs);
        own.last = (wanted.0 + own.ankle, own.turn * wanted.1);
        let mut target = FootTarget {
            ankle: ankle + own.last.0,
            foot: own.last.1 * foot,
            toes: own.turn * target.toes,
        };
        // Whatever settles, no sole goes below the floor.
        let lowest = self.rockers[index].lowest_point(&target);
        target.ankle.y += (-lowest).max(0.0);
        let hips = (
            self.model.position(Joint::Hips),
            self.model.rotation(Joint::Hips),
        );
        self.legs[index].solve(hips.0, hips.1, &target, pose);
        self.feet[index] = own;
    }
}

/// The share of a way that is gone in a time, when half of it is gone in a half-life.
fn follow_share(half_life_secs: f32, dt_secs: f32) -> f32 {
    1.0 - (-core::f32::consts::LN_2 * dt_secs / half_life_secs).exp()
}
