//! Displacement of a foot between two rests (zero-velocity updates).
//!
//! Velocity that integration leaves at the second rest is subtracted in proportion to time.

use footfall_core::rotation::{exp_map, shortest_arc};
use glam::{Quat, Vec3};

/// Duration of the rest of a foot at each end, seconds.
pub(crate) const REST_SECS: f64 = 0.08;

/// Displacement between two rests.
pub(crate) struct Displacement {
    /// From the first rest to the second, metres; Y is up.
    pub(crate) way: Vec3,
    /// Turns the sensor's axes at the first rest into those of `way`.
    pub(crate) level_from_sensor: Quat,
}

/// Integrates evenly spaced samples from the first to the last, at rest at both: specific force, m/s², and angular velocity, rad/s.
///
/// # Panics
/// Without samples, or with fewer rates than forces.
pub(crate) fn displacement(forces: &[Vec3], rates: &[Vec3], rate_hz: f32) -> Displacement {
    let dt = 1.0 / rate_hz;
    let last = forces.len() - 1;
    let turns = turns(forces, rates, dt);
    let reach = rest_samples(rate_hz, last);
    // What the sensor reads for gravity at rest, not what gravity is.
    let [begin, end] = [&forces[..=reach], &forces[last - reach..]]
        .map(|rest| rest.iter().sum::<Vec3>().length() / rest.len() as f32);
    let gravity = |n: usize| begin + (end - begin) * (n as f32 / last.max(1) as f32);
    let acceleration = |n: usize| turns[n] * forces[n] - Vec3::Y * gravity(n);
    let mut velocities = Vec::with_capacity(forces.len());
    let mut velocity = Vec3::ZERO;
    velocities.push(velocity);
    for n in 0..last {
        velocity += 0.5 * (acceleration(n) + acceleration(n + 1)) * dt;
        velocities.push(velocity);
    }
    let mut way = Vec3::ZERO;
    for n in 0..last {
        let middle = 0.5 * (velocities[n] + velocities[n + 1]);
        way += (middle - velocity * ((n as f32 + 0.5) / last as f32)) * dt;
    }
    Displacement {
        way,
        level_from_sensor: turns[0],
    }
}

/// Samples in which a foot rests at each end.
fn rest_samples(rate_hz: f32, last: usize) -> usize {
    ((REST_SECS * f64::from(rate_hz)).round() as usize).min(last)
}

/// `level_from_sensor` rotations, level where the gravities of both ends point on the average: a gyroscope turns less wrongly in a second than a
/// foot rests.
fn turns(forces: &[Vec3], rates: &[Vec3], dt: f32) -> Vec<Quat> {
    let last = forces.len() - 1;
    let reach = rest_samples(1.0 / dt, last);
    let up = |rest: &[Vec3]| rest.iter().sum::<Vec3>().normalize_or(Vec3::Y);
    let mut turn = shortest_arc(up(&forces[..=reach]), Vec3::Y);
    let mut turns = Vec::with_capacity(forces.len());
    turns.push(turn);
    for pair in rates.windows(2) {
        turn = (turn * exp_map(0.5 * (pair[0] + pair[1]) * dt)).normalize();
        turns.push(turn);
    }
    let tilt = shortest_arc(turn * up(&forces[last - reach..]), Vec3::Y);
    let level = Quat::IDENTITY.slerp(tilt, 0.5);
    for turn in &mut turns {
        *turn = level * *turn;
    }
    turns
}
