//! Curves between two values.

use core::ops::{Add, Mul, Sub};

/// From 0 at 0 to 1 at 1, level at both ends and beyond.
#[inline]
pub fn smooth_step(s: f32) -> f32 {
    let s = s.clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}

/// From 0 at 0 over 1 at a half to 0 at 1, level at all three and beyond.
#[inline]
pub fn hump(s: f32) -> f32 {
    let s = s.clamp(0.0, 1.0);
    let both = 4.0 * s * (1.0 - s);
    both * both
}

/// The smaller of two numbers, rounded off where they are nearer than a few times `softness`.
#[inline]
#[expect(
    clippy::imprecise_flops,
    reason = "a nanometre is exact enough, and ln_1p takes three times as long"
)]
pub fn soft_min(value: f32, limit: f32, softness: f32) -> f32 {
    let excess = (value - limit) / softness;
    if excess > 10.0 {
        return limit;
    }
    if excess < -10.0 {
        return value;
    }
    value - softness * (1.0 + excess.exp()).ln()
}

/// Cubic Hermite curve at `s` in 0..1; the tangents `departure` and `arrival` are per unit of `s`.
pub fn hermite<T>(from: T, departure: T, to: T, arrival: T, s: f32) -> T
where
    T: Mul<f32, Output = T> + Add<Output = T>,
{
    let (s2, s3) = (s * s, s * s * s);
    from * (2.0 * s3 - 3.0 * s2 + 1.0)
        + departure * (s3 - 2.0 * s2 + s)
        + to * (3.0 * s2 - 2.0 * s3)
        + arrival * (s3 - s2)
}

/// Weights of four values in a row on the curve between the two in the middle, at `s` in 0..1 (Catmull-Rom).
pub fn catmull_rom(s: f32) -> [f32; 4] {
    let (s2, s3) = (s * s, s * s * s);
    [
        0.5 * (-s3 + 2.0 * s2 - s),
        0.5 * (3.0 * s3 - 5.0 * s2 + 2.0),
        0.5 * (-3.0 * s3 + 4.0 * s2 + s),
        0.5 * (s3 - s2),
    ]
}

/// Offset and velocity of a critically damped spring of this rate (1/s) after a time, on its way back to rest. However time is
/// cut into steps, it comes to the same.
pub fn settled<T>(away: T, speed: T, rate: f32, secs: f32) -> (T, T)
where
    T: Copy + Mul<f32, Output = T> + Add<Output = T> + Sub<Output = T>,
{
    let impulse = speed + away * rate;
    let fade = (-rate * secs).exp();
    (
        (away + impulse * secs) * fade,
        (speed - impulse * rate * secs) * fade,
    )
}
