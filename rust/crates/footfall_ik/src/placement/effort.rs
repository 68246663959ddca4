//! Speed of a walker on a grade.

/// Share of a walker's speed that is left on a grade: Tobler's hiking function (1993) relative to level ground, and no less than
/// people keep on stairs.
pub(super) fn slowed_by(grade: f32) -> f32 {
    const STEEPNESS: f32 = 3.5;
    const EASIEST: f32 = -0.05;
    let speed = |grade: f32| (-STEEPNESS * (grade - EASIEST).abs()).exp();
    (speed(grade) / speed(0.0)).clamp(0.45, 1.0)
}
