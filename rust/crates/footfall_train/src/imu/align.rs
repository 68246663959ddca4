//! Registration: dynamic time warping of a phase's segments to a reference (Mousas 2017, section 4.3).

use footfall_model::FEATURE_COUNT;
use footfall_model::imu_model::BODY_COUNT;

/// For each frame of `segment` the frame of `reference` that it is aligned with. Both are rows of the body; ends meet ends.
pub(super) fn warp(reference: &[f32], segment: &[f32]) -> Vec<usize> {
    let rows = |values: &[f32]| values.len() / BODY_COUNT;
    let (width, height) = (rows(reference), rows(segment));
    if width == 0 || height == 0 {
        return Vec::new();
    }
    let row = |values: &[f32], n: usize| values[n * BODY_COUNT..][..FEATURE_COUNT].to_vec();
    let reference: Vec<Vec<f32>> = (0..width).map(|n| row(reference, n)).collect();
    let mut cost = vec![f32::INFINITY; width * height];
    for y in 0..height {
        let own = row(segment, y);
        for x in 0..width {
            let squares = own.iter().zip(&reference[x]).map(|(a, b)| (a - b).powi(2));
            let here: f32 = squares.sum();
            let left = if x > 0 {
                cost[y * width + x - 1]
            } else {
                f32::INFINITY
            };
            let up = if y > 0 {
                cost[(y - 1) * width + x]
            } else {
                f32::INFINITY
            };
            let both = if x > 0 && y > 0 {
                cost[(y - 1) * width + x - 1]
            } else {
                f32::INFINITY
            };
            let before = left.min(up).min(both);
            cost[y * width + x] = here + if before.is_finite() { before } else { 0.0 };
        }
    }
    let mut aligned = vec![0; height];
    let (mut x, mut y) = (width - 1, height - 1);
    loop {
        aligned[y] = x;
        if x == 0 && y == 0 {
            return aligned;
        }
        let at = |x: usize, y: usize| cost[y * width + x];
        if y == 0 {
            x -= 1;
        } else if x == 0 {
            y -= 1;
        } else if at(x - 1, y - 1) <= at(x - 1, y).min(at(x, y - 1)) {
            (x, y) = (x - 1, y - 1);
        } else if at(x - 1, y) < at(x, y - 1) {
            x -= 1;
        } else {
            y -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(values: &[f32]) -> Vec<f32> {
        values
            .iter()
            .flat_map(|value| {
                let mut row = [0.0; BODY_COUNT];
                row[7] = *value;
                row
            })
            .collect()
    }

    #[test]
    fn a_slower_segment_is_warped_to_its_reference() {
        let reference = rows(&[0.0, 1.0, 2.0, 3.0]);
        let slow = rows(&[0.0, 0.1, 0.9, 1.1, 2.0, 2.1, 3.0]);
        assert_eq!(warp(&reference, &slow), [0, 0, 1, 1, 2, 2, 3]);
        assert_eq!(warp(&reference, &rows(&[0.0, 2.0, 3.0])), [0, 2, 3]);
        assert_eq!(warp(&reference, &reference), [0, 1, 2, 3]);
        assert!(warp(&reference, &[]).is_empty());
    }
}
