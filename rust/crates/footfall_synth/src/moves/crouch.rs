//! Crouch: hips low over the same feet, with trunk and arms of crouching people.

use super::body::{Beside, Body};
use crate::gait::Posture;
use footfall_core::ease::settled;
use footfall_core::{JOINT_COUNT, Joint};
use footfall_model::layout::decode;
use footfall_model::{CrouchModel, FEATURE_COUNT};
use glam::{Quat, Vec3};

/// Rate of the critically damped spring that moves the depth, 1/s.
const RATE: f32 = 9.0;

/// Share of the difference from standing arms that the arms of the deepest crouch do without: arms that swing close to an upright trunk would swing through a low one.
const ARMS_HELD: f32 = 0.35;

/// Depth that counts as upright.
const LEAST: f32 = 1e-4;

/// Depth of a crouch at a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CrouchMoment {
    /// From 0, upright, to 1, and its rate, 1/s.
    pub(crate) amount: f32,
    pub(crate) speed: f32,
}

/// The crouch of one walker.
#[derive(Clone, Debug)]
pub(super) struct Crouch {
    beside: Option<Beside>,
    /// Rotations of standing people's joints; those of the arms count.
    standing: [Quat; JOINT_COUNT],
    /// Maximum speed in the deepest crouch, m/s on this body.
    fastest_mps: f32,
    pub(super) moment: CrouchMoment,
}

impl CrouchMoment {
    /// Returns the depth after this time, for a requested amount.
    fn after(self, secs: f32, asked: f32) -> Self {
        if asked <= 0.0 && self == Self::default() {
            return self;
        }
        let (away, speed) = settled(self.amount - asked, self.speed, RATE, secs);
        let later = Self {
            amount: asked + away,
            speed,
        };
        if asked <= 0.0 && later.amount.abs() < LEAST && later.speed.abs() < LEAST {
            return Self::default();
        }
        later
    }
}

impl Crouch {
    /// Creates the crouch of a body with legs of this length, from a standing posture; without a model it stays upright.
    pub(super) fn new(model: Option<&CrouchModel>, standing: &Posture, leg_length: f32) -> Self {
        let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
        decode(standing, &mut rotations);
        let row = |model: &CrouchModel| core::array::from_fn(|index| model.beside[index] as f32);
        Self {
            beside: model.map(row),
            standing: rotations,
            fastest_mps: model.map_or(f32::INFINITY, |model| model.fastest as f32 * leg_length),
            moment: CrouchMoment::default(),
        }
    }

    /// Returns the maximum speed at this depth, given the maximum upright, m/s.
    pub(super) fn fastest_mps(&self, amount: f32, upright_mps: f32) -> f32 {
        let low = self.fastest_mps.min(upright_mps);
        upright_mps + share(amount) * (low - upright_mps)
    }

    /// Advances by a time towards a requested amount.
    pub(super) fn step(&mut self, secs: f32, asked: f32) {
        if self.beside.is_some() {
            self.moment = self.moment.after(secs, share(asked));
        }
    }

    /// Lowers a pose that faces +Z over its feet.
    pub(super) fn lower(&self, body: &Body, pose: &mut footfall_core::Pose) {
        let (Some(beside), amount) = (&self.beside, self.moment.amount) else {
            return;
        };
        if amount <= 0.0 {
            return;
        }
        let feet = body.feet(pose);
        for joint in Joint::ALL.into_iter().filter(|joint| joint.is_of_arm()) {
            let index = joint.index();
            let own = &mut pose.rotations[index];
            *own = own.slerp(self.standing[index], ARMS_HELD * amount);
        }
        let beside = beside.map(|value| amount * value);
        Body::turn(&beside, pose);
        let [up, ahead] = [beside[FEATURE_COUNT], beside[FEATURE_COUNT + 1]];
        pose.root_position += body.leg_length * Vec3::new(0.0, up, ahead);
        body.stand(&feet, pose);
    }
}

/// Returns the amount within bounds; 0 if it is not finite.
fn share(amount: f32) -> f32 {
    if amount.is_finite() {
        amount.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{ModelPose, Pose, Side, Skeleton, forward_kinematics};
    use footfall_model::BESIDE_COUNT;

    fn model() -> CrouchModel {
        let mut beside = vec![0.0; BESIDE_COUNT];
        beside[footfall_model::layout::feature_offset(Joint::Spine)] = 0.3;
        beside[FEATURE_COUNT] = -0.25;
        CrouchModel {
            beside,
            fastest: 1.5,
        }
    }

    #[test]
    fn hips_go_down_and_feet_stay() {
        let skeleton = Skeleton::standard();
        let body = Body::new(&skeleton);
        let mut crouch = Crouch::new(Some(&model()), &[0.0; FEATURE_COUNT], body.leg_length);
        for _ in 0..120 {
            crouch.step(1.0 / 60.0, 1.0);
        }
        let mut pose = Pose::rest(&skeleton);
        pose.root_position.y -= 0.01;
        for side in Side::BOTH {
            let target = body.feet(&Pose::rest(&skeleton));
            body.stand(&target, &mut pose);
            assert!(pose.rotation(side.lower_leg()).to_scaled_axis().x > 0.0);
        }
        let [mut before, mut after] = [ModelPose::default(), ModelPose::default()];
        forward_kinematics(&skeleton, &pose, &mut before);
        crouch.lower(&body, &mut pose);
        forward_kinematics(&skeleton, &pose, &mut after);
        let sunk = before.position(Joint::Hips).y - after.position(Joint::Hips).y;
        assert!((sunk - 0.25 * body.leg_length).abs() < 1e-3, "{sunk}");
        for side in Side::BOTH {
            for joint in [side.foot(), side.toes()] {
                assert!(after.position(joint).distance(before.position(joint)) < 1e-4);
            }
        }
    }

    #[test]
    fn going_down_is_smooth_however_time_is_cut_and_ends() {
        let mut moment = CrouchMoment::default();
        let mut before = 0.0_f32;
        for frame in 0..120 {
            moment = moment.after(1.0 / 60.0, 1.0);
            let change = (moment.speed - before) * 60.0;
            before = moment.speed;
            // Of 20 cm this is at most 17 m/s².
            assert!(change.abs() < RATE * RATE + 1.0, "{change} in {frame}");
            assert!((0.0..=1.0).contains(&moment.amount));
        }
        assert!(moment.amount > 0.99);
        let whole = CrouchMoment::default().after(0.4, 1.0);
        let halves = CrouchMoment::default().after(0.2, 1.0).after(0.2, 1.0);
        assert!((whole.amount - halves.amount).abs() < 1e-5);
        for _ in 0..300 {
            moment = moment.after(1.0 / 60.0, 0.0);
        }
        assert_eq!(moment, CrouchMoment::default());
    }

    #[test]
    fn who_crouches_goes_slower_and_amounts_stay_within_bounds() {
        let crouch = Crouch::new(Some(&model()), &[0.0; FEATURE_COUNT], 0.8);
        assert!((crouch.fastest_mps(0.0, 6.0) - 6.0).abs() < 1e-6);
        assert!((crouch.fastest_mps(7.0, 6.0) - 1.2).abs() < 1e-6);
        assert!((crouch.fastest_mps(f32::NAN, 6.0) - 6.0).abs() < 1e-6);
        let upright = Crouch::new(None, &[0.0; FEATURE_COUNT], 0.8);
        assert!((upright.fastest_mps(1.0, 6.0) - 6.0).abs() < 1e-6);
    }
}
