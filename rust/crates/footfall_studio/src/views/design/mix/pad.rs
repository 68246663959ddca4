//! Geometry of the mixing pad: places of styles, and the weights that a place stands for.

use eframe::egui::{Vec2, vec2};

/// Places of the styles around the pad, the first on top.
pub(super) fn places(count: usize) -> Vec<Vec2> {
    (0..count)
        .map(|place| {
            let angle = core::f32::consts::TAU * place as f32 / count as f32;
            vec2(angle.sin(), -angle.cos())
        })
        .collect()
}

/// Keeps the puck within its reach from the middle: a style at 1.35 times itself.
pub(super) fn within_reach(puck: Vec2) -> Vec2 {
    puck / (puck.length() / 1.35).max(1.0)
}

/// Returns the position at which the puck shows weights best.
pub(super) fn puck_of(weights: &[f32]) -> Vec2 {
    let places = places(weights.len()).into_iter().zip(weights);
    within_reach(places.fold(Vec2::ZERO, |sum, (place, weight)| sum + place * *weight))
}

/// Weights of the styles for a place on the pad: each style has 1 at its own place, 0 at the plain walk in the middle and at every other
/// style; between two neighbours they go over into each other.
pub(super) fn pad_weights(at: Vec2, count: usize) -> Vec<f32> {
    let places = places(count);
    if count < 3 {
        return places.iter().map(|place| place.dot(at).max(0.0)).collect();
    }
    let mut weights = vec![0.0; count];
    for first in 0..count {
        let second = (first + 1) % count;
        let (a, b) = (places[first], places[second]);
        let area = a.x * b.y - a.y * b.x;
        let (u, v) = (
            (at.x * b.y - at.y * b.x) / area,
            (a.x * at.y - a.y * at.x) / area,
        );
        if u >= 0.0 && v >= 0.0 {
            weights[first] = u;
            weights[second] = v;
            break;
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_style_is_itself_at_its_place_and_nothing_in_the_middle() {
        for count in 1..7 {
            assert!(
                pad_weights(Vec2::ZERO, count)
                    .iter()
                    .all(|w| w.abs() < 1e-6)
            );
            for (own, place) in places(count).into_iter().enumerate() {
                for (style, weight) in pad_weights(place, count).into_iter().enumerate() {
                    let wanted = if style == own { 1.0 } else { 0.0 };
                    assert!(
                        (weight - wanted).abs() < 1e-5,
                        "{count} {own} {style}: {weight}"
                    );
                }
            }
        }
    }

    #[test]
    fn weights_go_over_without_a_jump() {
        let mut last = pad_weights(vec2(0.0, -0.8), 5);
        for step in 1..=720 {
            let angle = core::f32::consts::TAU * step as f32 / 720.0;
            let now = pad_weights(vec2(0.8 * angle.sin(), -0.8 * angle.cos()), 5);
            let jump = now
                .iter()
                .zip(&last)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f32::max);
            assert!(jump < 0.02, "{step}: {jump}");
            last = now;
        }
    }
}
