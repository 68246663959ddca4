//! A strap or a pocket that gives: the sensor lags behind the body, and swings.

use super::Track;
use core::f32::consts::TAU;
use glam::{Quat, Vec3};

/// Least steps in which the swinging is worked out, a second.
const LEAST_STEPS_HZ: f64 = 1000.0;

/// Way in which a sensor is worn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wear {
    /// Greatest distance from the site, metres; direction and distance are drawn.
    pub off_m: f32,
    /// Natural frequency of the sensor on its strap, hertz.
    pub natural_hz: f32,
    /// Damping ratio: 1 returns without swinging.
    pub damping: f32,
}

impl Wear {
    /// A strap over clothes, times a factor on how loose it is: up to 5 cm off, swinging at 8 Hz and less.
    ///
    /// An assumption, on the softer side: 8 Hz let a sensor give by 4 mm for every 10 m/s².
    pub fn strapped(looseness: f32) -> Self {
        Self {
            off_m: 0.05 * looseness,
            natural_hz: 8.0 / looseness.max(0.01).sqrt(),
            damping: 0.3,
        }
    }

    /// Moves a sensor that lags behind the site and swings: a damped mass on a spring, for position and rotation.
    pub(super) fn swing(&self, track: &mut Track, fps: f64) {
        // Along the world's axes, and about the sensor's own.
        let (mut shift, mut tilt) = (Swing::default(), Swing::default());
        let mut turned = track.rates.first().copied().unwrap_or_default();
        let frames = track.turns.iter_mut().zip(&mut track.rates);
        for ((turn, rate), acceleration) in frames.zip(&mut track.accelerations) {
            let turned_faster = (*rate - turned) * fps as f32;
            turned = *rate;
            let before = shift.speed;
            shift.pass(self, -*acceleration, fps);
            tilt.pass(self, -turned_faster, fps);
            *acceleration += (shift.speed - before) * fps as f32;
            *turn *= Quat::from_scaled_axis(tilt.offset);
            *rate += tilt.speed;
        }
    }
}

/// Offset from the site, and its change a second.
#[derive(Clone, Copy, Debug, Default)]
struct Swing {
    offset: Vec3,
    speed: Vec3,
}

impl Swing {
    /// Integrates a frame under a force, in small steps.
    fn pass(&mut self, wear: &Wear, pull: Vec3, fps: f64) {
        let steps = (LEAST_STEPS_HZ / fps).ceil().max(1.0);
        let dt = (1.0 / (fps * steps)) as f32;
        let omega = TAU * wear.natural_hz;
        for _ in 0..steps as usize {
            let back = self.offset * omega + self.speed * (2.0 * wear.damping);
            self.speed += (pull - back * omega) * dt;
            self.offset += self.speed * dt;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A site that swings to and fro along x by 1 m/s² and about y by 1 rad/s².
    fn track(hz: f32, fps: f32) -> Track {
        let phases: Vec<f32> = (0..1200).map(|n| TAU * hz * n as f32 / fps).collect();
        let speed = |phase: f32| Vec3::Y * -phase.cos() / (TAU * hz);
        Track {
            turns: vec![Quat::IDENTITY; phases.len()],
            accelerations: phases.iter().map(|phase| Vec3::X * phase.sin()).collect(),
            rates: phases.iter().map(|phase| speed(*phase)).collect(),
        }
    }

    #[test]
    fn a_mass_on_a_spring_swings_as_the_formula_says() {
        for hz in [1.0, 4.0, 8.0] {
            let wear = Wear::strapped(1.0);
            let firm = track(hz, 120.0);
            let mut loose = track(hz, 120.0);
            wear.swing(&mut loose, 120.0);
            // Amplitude of the whole against that of what pulls, once it has settled.
            let r = hz / wear.natural_hz;
            let damped = 2.0 * wear.damping * r;
            let expected = (1.0 + damped * damped).sqrt() / (1.0 - r * r).hypot(damped);
            let most =
                |values: &[Vec3]| values[600..].iter().map(|v| v.length()).fold(0.0, f32::max);
            for (name, firm, loose) in [
                ("pulled", &firm.accelerations, &loose.accelerations),
                ("turned", &firm.rates, &loose.rates),
            ] {
                let found = most(loose) / most(firm);
                assert!(
                    (found / expected - 1.0).abs() < 0.1,
                    "{name} at {hz} Hz: {found} for {expected}"
                );
            }
        }
    }

    #[test]
    fn a_sensor_at_rest_hangs_still() {
        let mut still = Track {
            turns: vec![Quat::IDENTITY; 50],
            accelerations: vec![Vec3::ZERO; 50],
            rates: vec![Vec3::ZERO; 50],
        };
        Wear::strapped(2.0).swing(&mut still, 30.0);
        assert!(
            still
                .accelerations
                .iter()
                .chain(&still.rates)
                .all(|v| *v == Vec3::ZERO)
        );
    }
}
