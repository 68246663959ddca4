//! One foot of the body: where it stands, what settles when it lands, and how far it is held off the ground in the air.

use super::{Ground, GroundInput};
use crate::body::BodyFrame;
use crate::half_life::follow_share;
use footfall_core::ease::smooth_step;
use footfall_core::{Joint, Pose, Side};
use footfall_ik::{FootTarget, Plant, foot_heading, foot_pitch, settled_pitch};
use footfall_model::imu_model::CONTACT;
use glam::{Quat, Vec3};

/// A foot comes to stand above the first of these probabilities and leaves the ground below the second.
const STANDS: [f32; 2] = [0.55, 0.4];

/// Stretch of a leg to its standing foot beyond which the foot is planted again, metres.
const MAX_DRIFT_M: f32 = 0.15;

/// A foot whose own sensor says that it is in the air is held so far off the ground, as a share of the leg's length, where the body moves it as slowly
/// as a foot that stands: less than the first of these speeds, leg lengths a second, and not at all above the second.
const CLEARANCE: f32 = 0.08;
const CLEARED_SPEEDS: [f32; 2] = [1.5, 3.5];

/// Time within which it is raised that far after it has left the ground, seconds.
const CLEARED_AFTER_SECS: f32 = 0.05;

/// Factor on the drift that is allowed to a foot whose own sensor reports contact.
const MEASURED_DRIFT: f32 = 2.0;

/// Half-life of what remains of a correction when a foot lands, seconds.
const SETTLE_HALF_LIFE_SECS: f32 = 0.01;

/// Rate of the critically damped spring by which the correction of a foot that leaves the ground dies away, 1/s.
const RELEASE_RATE: f32 = 60.0;

/// Half-life of what the ground bent toes by when their foot leaves it, seconds: toes do not snap.
const TOES_HALF_LIFE_SECS: f32 = 0.04;

/// One foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StandingFoot {
    pub(super) plant: Option<Plant>,
    /// Remainder that settles: how far the ankle is from where it should be, how fast that changes (m/s), and how foot and toes are turned against it.
    ankle: Vec3,
    drift: Vec3,
    turn: Quat,
    toes: Quat,
    /// Offset of the ankle and turns of the foot and of the toes against the recordings, in the last frame.
    pub(super) last: (Vec3, Quat, Quat),
    pub(super) landed: bool,
    /// Time since it left the ground, seconds.
    free_secs: f32,
    /// Position that the recordings gave the ankle in the last frame.
    free: Vec3,
}

impl StandingFoot {
    pub(super) const FREE: Self = Self {
        plant: None,
        ankle: Vec3::ZERO,
        drift: Vec3::ZERO,
        turn: Quat::IDENTITY,
        toes: Quat::IDENTITY,
        last: (Vec3::ZERO, Quat::IDENTITY, Quat::IDENTITY),
        landed: false,
        free_secs: CLEARED_AFTER_SECS,
        free: Vec3::ZERO,
    };

    /// Fades the rest of a correction.
    fn settle(&mut self, dt_secs: f32) {
        let (left, of_toes) = if self.plant.is_some() {
            let left = 1.0 - follow_share(SETTLE_HALF_LIFE_SECS, dt_secs);
            self.ankle *= left;
            (left, left)
        } else {
            let left = (-RELEASE_RATE * dt_secs).exp();
            let toward = self.drift + RELEASE_RATE * self.ankle;
            self.ankle = left * (self.ankle + dt_secs * toward);
            self.drift = left * (self.drift - RELEASE_RATE * dt_secs * toward);
            (left, 1.0 - follow_share(TOES_HALF_LIFE_SECS, dt_secs))
        };
        self.turn = Quat::IDENTITY.slerp(self.turn, left);
        self.toes = Quat::IDENTITY.slerp(self.toes, of_toes);
    }
}

impl Ground {
    /// A planted foot as the recordings pitch it.
    pub(super) fn standing(&self, side: Side, plant: &Plant) -> FootTarget {
        let pitch = settled_pitch(foot_pitch(self.model.rotation(side.foot())));
        self.rockers[side.index()].stand(plant, pitch)
    }

    /// Height at which a foot that is known to be in the air is held, for a motion of its ankle in a frame, metres.
    fn clearance_m(&self, moved: Vec3, dt_secs: f32) -> f32 {
        let [least, most] = CLEARED_SPEEDS.map(|speed| speed * self.leg_length_m * dt_secs);
        let slow = (most - moved.with_y(0.0).length()) / (most - least).max(f32::MIN_POSITIVE);
        CLEARANCE * self.leg_length_m * slow.clamp(0.0, 1.0)
    }

    /// Puts one foot where it belongs.
    pub(super) fn solve(
        &mut self,
        side: Side,
        body: &BodyFrame,
        input: &GroundInput,
        pose: &mut Pose,
    ) {
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
                Some(measured) => !measured.stands || drift > MEASURED_DRIFT * MAX_DRIFT_M,
                None => body[CONTACT + index] < STANDS[1] || drift > MAX_DRIFT_M,
            };
            if leaves {
                own.plant = None;
                // The frame in which it left counts from when it did.
                own.free_secs = match input.contacts[index] {
                    Some(measured) if !measured.stands => {
                        measured.for_secs.min(input.dt_secs) - input.dt_secs
                    }
                    _ => 0.0,
                };
            }
        } else if input.contacts[index].map_or(body[CONTACT + index] > STANDS[0], |measured| {
            measured.stands
        }) {
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
            if input.contacts[index].is_some_and(|measured| !measured.stands) {
                let clearance = self.clearance_m(ankle - own.free, input.dt_secs)
                    * smooth_step(own.free_secs / CLEARED_AFTER_SECS);
                free.ankle.y += (clearance - self.rockers[index].lowest_point(&free)).max(0.0);
            }
            free
        };
        own.free = ankle;
        let wanted = (
            target.ankle - ankle,
            target.foot * foot.inverse(),
            target.toes * toes.inverse(),
        );
        if stood != own.plant.is_some() {
            own.ankle = own.last.0 - wanted.0;
            own.drift = Vec3::ZERO;
            own.turn = own.last.1 * wanted.1.inverse();
            own.toes = own.last.2 * wanted.2.inverse();
        }
        let settles_secs = match input.contacts[index] {
            Some(measured) if own.landed => measured.for_secs.min(input.dt_secs),
            _ => input.dt_secs,
        };
        own.settle(settles_secs);
        own.last = (
            wanted.0 + own.ankle,
            own.turn * wanted.1,
            own.toes * wanted.2,
        );
        let mut target = FootTarget {
            ankle: ankle + own.last.0,
            foot: own.last.1 * foot,
            toes: own.last.2 * toes,
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
