//! Pushes: the body yields over its feet, and follows a hard push with steps.

use super::body::Body;
use footfall_core::ease::settled;
use footfall_core::{Joint, Pose, Side};
use glam::{Quat, Vec2, Vec3};

/// Rate at which a push fades, 1/s; the rest of it is walked off.
const FADING: f32 = 1.6;

/// Push up to which a body keeps standing, m/s, and largest push, beyond which nobody stays on the feet.
const STEPPED_MPS: f32 = 0.3;
const MOST_MPS: f32 = 2.0;

/// Rate at which a push reaches the hips, 1/s: a shove lasts about a tenth of a second.
const BUILD_UP: f32 = 15.0;

/// Rate of the critically damped spring by which the body comes back over its feet, or its steps catch up with it, 1/s. A body that stands sways as far as an
/// inverted pendulum of its height that its ankles brake: 8 cm for 1 m/s.
const RETURN: f32 = 4.0;

/// Largest displacement of the hips, leg lengths.
const FARTHEST: f32 = 0.28;

/// Fraction of the straight leg to which a push stretches a leg, and softness of that limit: metres of height for each of displacement, and at most.
const STRETCHED: f32 = 0.9985;
const SOFTNESS: f32 = 0.3;
const SOFTEST_M: f32 = 0.03;

/// Lean of the trunk ahead of the hips, radians for 1 m/s of their speed and for 1 m of their displacement, and share of it that the neck takes back.
const LEAN_OF_SPEED: f32 = 0.15;
const LEAN_OF_WAY: f32 = 1.5;
const HELD_HEAD: f32 = 0.6;

/// Lag of the arms behind the hips and rise of both arms for balance, radians for 1 m of displacement, and largest lag.
const ARM_LAG: f32 = 5.0;
const ARM_RISE: f32 = 2.0;
const MOST_LAG: f32 = 2.0;

/// Lag at which an arm that lags towards the trunk comes to rest beside it, radians.
const BESIDE_TRUNK: f32 = 0.1;

/// Push under way; vectors are to the left and forwards.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PushMoment {
    /// Velocity that remains to be walked off, m/s, and its part that has not reached the hips yet.
    pub(crate) velocity: Vec2,
    pub(crate) coming: Vec2,
    /// Displacement of the hips, metres, and its rate, m/s.
    pub(crate) away: Vec2,
    pub(crate) speed: Vec2,
}

impl PushMoment {
    /// Adds a push by a change of velocity.
    pub(super) fn push(&mut self, velocity: Vec2) {
        let before = self.velocity;
        self.velocity = (before + velocity).clamp_length_max(MOST_MPS);
        self.coming += self.velocity - before;
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
        // The solution for a force that fades: a part in proportion to it, and a free spring about that part.
        let part = BUILD_UP / (RETURN - BUILD_UP).powi(2);
        let led = self.coming * part;
        let (away, speed) = settled(self.away - led, self.speed + led * BUILD_UP, RETURN, secs);
        self.velocity *= (-FADING * secs).exp();
        self.coming *= (-BUILD_UP * secs).exp();
        let led = self.coming * part;
        (self.away, self.speed) = (away + led, speed - led * BUILD_UP);
        if self.velocity.length() < 0.1 * STEPPED_MPS {
            (self.velocity, self.coming) = (Vec2::ZERO, Vec2::ZERO);
        }
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
        let softness = (SOFTNESS * away.length()).min(SOFTEST_M);
        body.lower_to(
            pose,
            &feet,
            stretched.map(|leg| leg.max(STRETCHED)),
            softness,
        );
        let lean = self.speed * LEAN_OF_SPEED + away * LEAN_OF_WAY;
        let turn = Quat::from_rotation_x(lean.y) * Quat::from_rotation_z(-lean.x);
        pose.rotations[Joint::Spine.index()] *= turn;
        pose.rotations[Joint::Neck.index()] *= Quat::IDENTITY.slerp(turn.inverse(), HELD_HEAD);
        self.swing_arms(pose);
        body.stand(&feet, pose);
    }

    /// Lets the arms lag behind the hips and rise; the trunk stops the arm that lags towards it.
    fn swing_arms(&self, pose: &mut Pose) {
        let lag = self.away * ARM_LAG;
        let lag = lag * (MOST_LAG / (MOST_LAG + lag.length()));
        let rise = self.away.length() * ARM_RISE;
        for (side, outwards) in [(Side::Left, 1.0), (Side::Right, -1.0)] {
            let aside = -outwards * lag.x;
            let free = 0.5 * (aside + aside.hypot(BESIDE_TRUNK) - BESIDE_TRUNK);
            let turn =
                Quat::from_rotation_z(outwards * (free + rise)) * Quat::from_rotation_x(lag.y);
            let arm = &mut pose.rotations[side.upper_arm().index()];
            *arm = turn * *arm;
        }
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
        assert!((whole.speed - halves.speed).length() < 1e-5);
        assert!(whole.away.x > 0.03 && whole.away.y < -0.02);
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
