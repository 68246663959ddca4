//! Travel of the body over feet that stay where they were put.
//!
//! The body travels as the recordings do, and is then moved so that a standing foot keeps its place: the way comes from the legs. What is left
//! when both stand is the legs' to take up, and no leg is thrown. A standing foot is a rocker ([`footfall_ik::rocker`]): it cannot slide or sink.

mod foot;
mod limit;

use crate::body::{BodyFrame, pose_of};
use crate::half_life::follow_share;
use foot::StandingFoot;
use footfall_core::rotation::{from_heading, wrap_angle};
use footfall_core::{ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_ik::{FootTarget, Leg, RockerFoot};
use footfall_imu::SensorContact;
use footfall_model::imu_model::{CONTACT, TURN, WAY};
use glam::{Quat, Vec3};
use limit::Limit;

/// The height of the pelvis follows the standing feet with this half-life, seconds.
const HEIGHT_HALF_LIFE_SECS: f32 = 0.05;

/// Standing feet move the body so fast at most, m/s: what they want beyond, their legs take up.
const MOST_SHIFT_MPS: f32 = 4.0;

/// Greatest reach from below the hip of a leg whose steps are lengthened, as a share of its length.
const MOST_SPREAD: f32 = 0.6;

/// Added to the bend of a knee before legs are weighed by it, radians.
const KNEE_SLACK: f32 = 0.1;

/// The heading follows the sensor's with this half-life, seconds.
const HEADING_HALF_LIFE_SECS: f32 = 0.2;

/// Time for which the heading of the sensor is compared with the body's before the body follows it, seconds: probabilities take time to settle.
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
    limit: Limit,
    model: ModelPose,
}

/// Input of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundInput {
    /// Heading that the sensor gives the body, from an unknown direction on, radians; `None` if it is unknown.
    pub heading: Option<f32>,
    /// Number of the model's frames that have passed.
    pub frames: f32,
    /// The same in seconds.
    pub dt_secs: f32,
    /// Factor on the length of the recordings' steps.
    pub stride: f32,
    /// Contacts of the left and the right foot where a sensor on the foot reports them; the body has those of the others.
    pub contacts: [Option<SensorContact>; 2],
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
            limit: Limit::NEW,
            model: ModelPose::default(),
            skeleton: skeleton.clone(),
        }
    }

    /// Back to the origin, facing +Z.
    pub fn reset(&mut self) {
        (self.place, self.heading, self.height_m) = (Vec3::ZERO, 0.0, 0.0);
        self.forget_sensor_heading();
        self.feet = [StandingFoot::FREE; 2];
        self.limit = Limit::NEW;
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
        self.bear(body, input, pose);
        self.follow_height(input.dt_secs, pose);
        forward_kinematics(&self.skeleton, pose, &mut self.model);
        for side in Side::BOTH {
            self.solve(side, body, input, pose);
        }
        self.limit.hold(self.heading, input.dt_secs, pose);
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
    fn bear(&mut self, body: &BodyFrame, input: &GroundInput, pose: &mut Pose) {
        let measured = input.contacts;
        let (mut shift, mut weights) = (Vec3::ZERO, 0.0);
        for side in Side::BOTH {
            if let Some(plant) = self.feet[side.index()].plant {
                let target = self.standing(side, &plant);
                let weight = match measured[side.index()] {
                    Some(measured) if measured.stands => 1.0,
                    _ => body[CONTACT + side.index()].clamp(0.05, 1.0),
                };
                shift += (target.ankle - self.ankle(side)).with_y(0.0) * weight;
                weights += weight;
            }
        }
        if weights > 0.0 {
            let shift = (shift / weights).clamp_length_max(MOST_SHIFT_MPS * input.dt_secs);
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
}
