//! Pushes: the body yields over its feet, and follows a hard push with steps.

use super::body::Body;
use footfall_core::ease::settled;
use footfall_core::{Joint, Pose};
use glam::{Quat, Vec2, Vec3};

/// Rate at which a push fades, 1/s; the rest of it is walked off.
const FADING: f32 = 1.6;

/// Push up to which a body keeps standing, m/s, and largest push, beyond which nobody stays on the feet.
const STEPPED_MPS: f32 = 0.3;
const MOST_MPS: f32 = 2.0;

/// Rate of the critically damped spring by which the body comes back over its feet, 1/s.
const RETURN: f32 = 6.5;

/// Share of a push with which the hips start.
const GIVEN_WAY: f32 = 0.45;

/// Largest displacement of the hips, leg lengths.
const FARTHEST: f32 = 0.12;

/// Largest fraction of the straight leg to which a push stretches a leg.
const STRETCHED: f32 = 0.9985;

/// Lag of the trunk behind the pushed hips, radians per leg length.
const TRUNK_LAG: f32 = 0.9;

/// Push under way; vectors are to the left and forwards.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PushMoment {
    /// Velocity that remains to be walked off, m/s.
    pub(crate) velocity: Vec2,
    /// Displacement of the hips, metres, and its rate, m/s.
    pub(crate) away: Vec2,
    pub(crate) speed: Vec2,
}

impl PushMoment {
    /// Adds a push by a change of velocity.
    pub(super) fn push(&mut self, velocity: Vec2) {
        self.velocity = (self.velocity + velocity).clamp_length_max(MOST_MPS);
        self.speed += GIVEN_WAY * velocity.clamp_length_max(MOST_MPS);
    }

    /// Returns the velocity to be followed with steps.
    pub(super) fn stepped(&self) -> Vec2 {
        if self.velocity.length() > STEPPED_MPS {
            self.velocity
        } else {
            Vec2::ZERO
        }
    }

    pub(super) fn step(&mut self, secs: f32) {
        if *self == Self::default() {
            return;
        }
        self.velocity *= (-FADING * secs).exp();
        if self.velocity.length() < 0.1 * STEPPED_MPS {
            self.velocity = Vec2::ZERO;
        }
        (self.away, self.speed) = settled(self.away, self.speed, RETURN, secs);
        if self.away.length() < 1e-5 && self.speed.length() < 1e-4 {
            (self.away, self.speed) = (Vec2::ZERO, Vec2::ZERO);
        }
    }

    /// Displaces a pose that faces +Z over its feet.
    pub(super) fn give_way(&self, body: &Body, pose: &mut Pose) {
        if self.away == Vec2::ZERO {
            return;
        }
        let feet = body.feet(pose);
        let stretched = body.stretched(pose, &feet);
        let most = FARTHEST * body.leg_length;
        let away = self.away * (most / (most + self.away.length()));
        // Hips over leaning legs go down like a pendulum.
        let down = -0.5 * away.length_squared() / body.leg_length;
        pose.root_position += Vec3::new(away.x, down, away.y);
        body.lower_to(pose, &feet, stretched.map(|leg| leg.max(STRETCHED)));
        let lag = away * (TRUNK_LAG / body.leg_length);
        let turn = Quat::from_rotation_x(-lag.y) * Quat::from_rotation_z(lag.x);
        pose.rotations[Joint::Spine.index()] *= turn;
        body.stand(&feet, pose);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_comes_back_however_time_is_cut() {
        let mut pushed = PushMoment::default();
        pushed.push(Vec2::new(0.4, -0.3));
        let (mut whole, mut halves) = (pushed, pushed);
        whole.step(0.3);
        halves.step(0.15);
        halves.step(0.15);
        assert!((whole.away - halves.away).length() < 1e-5);
        assert!((whole.velocity - halves.velocity).length() < 1e-5);
        assert!(whole.away.x > 0.005 && whole.away.y < -0.003);
        for _ in 0..600 {
            pushed.step(1.0 / 60.0);
        }
        assert_eq!(pushed, PushMoment::default());
    }

    #[test]
    fn only_hard_pushes_are_stepped_off() {
        let mut pushed = PushMoment::default();
        pushed.push(Vec2::new(0.2, 0.0));
        assert_eq!(pushed.stepped(), Vec2::ZERO);
        pushed.push(Vec2::new(9.0, 0.0));
        assert!((pushed.stepped().length() - MOST_MPS).abs() < 1e-5);
    }
}
