//! Correlation of the courses of two bodies.

use super::body::Body;
use footfall_core::JOINT_COUNT;

/// Coordinates that vary by less have no course, metres (standard deviation).
const LEAST_DEVIATION_M: f64 = 0.01;

/// Mean correlation of the joints' coordinates, over the frames that count; `None` where no coordinate of the truth varies. One that is not moved at all
/// has a correlation of 0.
pub(super) fn correlation(
    truth: &[Body],
    shown: &[Body],
    counts: impl Fn(usize) -> bool,
) -> Option<f64> {
    let frames = truth.iter().zip(shown).enumerate();
    let pairs: Vec<(&Body, &Body)> = frames
        .filter(|(frame, _)| counts(*frame))
        .map(|(_, pair)| pair)
        .collect();
    let places = (0..JOINT_COUNT).flat_map(|joint| (0..3).map(move |axis| (joint, axis)));
    let found = places.filter_map(|(joint, axis)| {
        let course = pairs
            .iter()
            .map(|(truth, shown)| [truth, shown].map(|body| f64::from(body[joint][axis])));
        of_course(&course.collect::<Vec<_>>())
    });
    let found: Vec<f64> = found.collect();
    (!found.is_empty()).then(|| super::mean(&found))
}

/// Correlation of the second numbers with the first; `None` where these do not vary.
fn of_course(pairs: &[[f64; 2]]) -> Option<f64> {
    let count = pairs.len().max(1) as f64;
    let means = [0, 1].map(|n| pairs.iter().map(|pair| pair[n]).sum::<f64>() / count);
    let product = |a: usize, b: usize| -> f64 {
        let products = pairs.iter().map(|p| (p[a] - means[a]) * (p[b] - means[b]));
        products.sum::<f64>() / count
    };
    let (truth, shown) = (product(0, 0).sqrt(), product(1, 1).sqrt());
    (truth > LEAST_DEVIATION_M).then(|| product(0, 1) / (truth * shown).max(1e-12))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn courses_that_go_together_correlate() {
        let course = |size: f32, late: f32| -> Vec<Body> {
            let at = |n: usize| [Vec3::X * size * (0.3 * n as f32 - late).sin(); JOINT_COUNT];
            (0..210).map(at).collect()
        };
        let of =
            |size: f32, late: f32| correlation(&course(0.1, 0.0), &course(size, late), |_| true);
        assert!((of(0.2, 0.0).unwrap() - 1.0).abs() < 1e-6);
        assert!((of(0.2, 1.0).unwrap() - f64::cos(1.0)).abs() < 0.02);
        assert!(of(0.0, 0.0).unwrap().abs() < 1e-6);
        assert_eq!(
            correlation(&course(0.001, 0.0), &course(0.1, 0.0), |_| true),
            None
        );
    }
}
