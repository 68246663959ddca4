//! The states in which segments begin.

use super::AffineSystem;
use crate::error::{ProbError, check_finite, check_len};
use nalgebra::{DMatrix, DVector};

/// Weight that holds a state near zero where a segment does not determine it.
const RIDGE: f64 = 1e-9;

/// As [`initial_states`], of one segment.
///
/// # Errors
/// [`ProbError`] when the segment is empty, no whole frames or not finite.
pub fn initial_state(system: &AffineSystem, segment: &[f64]) -> Result<DVector<f64>, ProbError> {
    let mut states = initial_states(system, &[segment])?;
    Ok(states.swap_remove(0))
}

/// The states from which the system left to itself comes closest to each segment (least squares, slightly held near zero).
///
/// # Errors
/// [`ProbError`] when a segment is empty, no whole frames or not finite.
pub fn initial_states(
    system: &AffineSystem,
    segments: &[&[f64]],
) -> Result<Vec<DVector<f64>>, ProbError> {
    let (order, channels) = (system.order(), system.channels());
    let length = |segment: &[f64]| segment.len() / channels.max(1);
    for segment in segments {
        if length(segment) == 0 {
            return Err(ProbError::Empty { what: "segment" });
        }
        check_len("segment", segment.len(), length(segment) * channels)?;
        check_finite("segment", segment)?;
    }
    let longest = segments.iter().map(|segment| length(segment)).max();
    let alone = system.simulate(&DVector::zeros(order), longest.unwrap_or(0));
    // y[k] = C Aᵏ x + (what the offsets alone put out). All segments share C Aᵏ, and its normal equations up to their ends.
    let mut states = vec![DVector::<f64>::zeros(order); segments.len()];
    let mut normal = DMatrix::<f64>::identity(order, order) * RIDGE;
    let mut observed = system.output.clone();
    let mut row = DVector::<f64>::zeros(channels);
    for frame in 0..longest.unwrap_or(0) {
        normal.gemm_tr(1.0, &observed, &observed, 1.0);
        let range = frame * channels..(frame + 1) * channels;
        for (segment, target) in segments.iter().zip(&mut states) {
            if frame >= length(segment) {
                continue;
            }
            let values = segment[range.clone()].iter().zip(&alone[range.clone()]);
            for (row, (value, alone)) in row.iter_mut().zip(values) {
                *row = value - alone;
            }
            target.gemv_tr(1.0, &observed, &row, 1.0);
        }
        let mut factor = None;
        for (segment, state) in segments.iter().zip(&mut states) {
            if length(segment) != frame + 1 {
                continue;
            }
            if factor.is_none() {
                factor = normal.clone().cholesky();
            }
            let factor = factor.as_ref().ok_or(ProbError::NoData {
                what: "an initial state",
            })?;
            factor.solve_mut(state);
        }
        observed *= &system.transition;
    }
    Ok(states)
}
