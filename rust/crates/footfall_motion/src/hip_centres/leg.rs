//! A leg of two segments: its knee's flexion for a given distance from hip joint to ankle.

/// Below this flexion the law of cosines is continued in a straight line: there distance says nothing, and beyond the leg's
/// reach nothing at all. What comes out below zero is a leg that would have to be longer.
const STRAIGHT: f64 = 0.1;

/// Flexion of the knee, radians, and its derivative by the distance.
pub(super) fn flexion(distance: f64, [thigh, shank]: [f64; 2]) -> (f64, f64) {
    let product = thigh * shank;
    let cosine = (distance * distance - thigh * thigh - shank * shank) / (2.0 * product);
    let by_distance = distance / product;
    if cosine < STRAIGHT.cos() {
        let angle = cosine.max(-1.0).acos();
        (angle, -by_distance / angle.sin().max(STRAIGHT.sin()))
    } else {
        let slope = 1.0 / STRAIGHT.sin();
        (
            STRAIGHT - slope * (cosine - STRAIGHT.cos()),
            -slope * by_distance,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flexion_is_that_of_the_triangle_and_smooth() {
        let segments = [0.48, 0.52];
        for degrees in [8.0_f64, 20.0, 60.0, 120.0] {
            let angle = degrees.to_radians();
            let squares = segments[0] * segments[0] + segments[1] * segments[1];
            let distance = (squares + 2.0 * segments[0] * segments[1] * angle.cos()).sqrt();
            let (found, slope) = flexion(distance, segments);
            assert!((found - angle).abs() < 1e-9, "{degrees}");
            let (near, _) = flexion(distance + 1e-7, segments);
            assert!(((near - found) / 1e-7 - slope).abs() < 1e-2 * slope.abs());
        }
        assert!(flexion(1.0, segments).0 > 0.0 && flexion(1.01, segments).0 < 0.0);
    }
}
