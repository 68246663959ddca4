//! Linear systems from many short segments: subspace identification and prediction-error refinement (*Gait as a switching
//! dynamical system*, section 3.2, equations 10 and 11).
//!
//! `x[k+1] = A x[k] + b + K e[k]`, `y[k] = C x[k] + d + e[k]`. The offsets b and d stand for what keeps the body up and moving: the
//! system is affine. Nothing is assumed about stability: a segment of gait ends long before an unstable system is far.
//!
//! In reading order: [`AffineSystem`], [`identify`], [`refine`], [`initial_states`].

mod identify;
mod initial;
mod problem;
mod refine;

pub use identify::{IdentifyConfig, identify};
pub use initial::{initial_state, initial_states};
pub use refine::{Refined, Refinement, refine};

use crate::error::{ProbError, check_finite, check_len};
use nalgebra::{DMatrix, DVector};

/// A linear system with offsets, in innovation form.
#[derive(Clone, Debug, PartialEq)]
pub struct AffineSystem {
    /// State transition A, n × n.
    pub transition: DMatrix<f64>,
    /// State offset b, n.
    pub drift: DVector<f64>,
    /// Output matrix C, m × n.
    pub output: DMatrix<f64>,
    /// Output offset d, m.
    pub offset: DVector<f64>,
    /// Kalman gain K, n × m.
    pub gain: DMatrix<f64>,
}

impl AffineSystem {
    /// Order n.
    pub fn order(&self) -> usize {
        self.drift.len()
    }

    /// Number of outputs m.
    pub fn channels(&self) -> usize {
        self.offset.len()
    }

    /// A system from its numbers, matrices row by row: A, b, C, d, K.
    ///
    /// # Errors
    /// [`ProbError`] when a length does not fit the order and the number of outputs, or a value is not finite.
    pub fn from_rows(order: usize, channels: usize, rows: [&[f64]; 5]) -> Result<Self, ProbError> {
        let (n, m) = (order, channels);
        let names = ["transition", "drift", "output matrix", "offset", "gain"];
        for ((values, what), expected) in rows.iter().zip(names).zip([n * n, n, m * n, m, n * m]) {
            check_len(what, values.len(), expected)?;
            check_finite(what, values)?;
        }
        let [transition, drift, output, offset, gain] = rows;
        Ok(Self {
            transition: DMatrix::from_row_slice(n, n, transition),
            drift: DVector::from_column_slice(drift),
            output: DMatrix::from_row_slice(m, n, output),
            offset: DVector::from_column_slice(offset),
            gain: DMatrix::from_row_slice(n, m, gain),
        })
    }

    /// The numbers of [`from_rows`](Self::from_rows).
    pub fn to_rows(&self) -> [Vec<f64>; 5] {
        let rows = |matrix: &DMatrix<f64>| matrix.transpose().as_slice().to_vec();
        [
            rows(&self.transition),
            self.drift.as_slice().to_vec(),
            rows(&self.output),
            self.offset.as_slice().to_vec(),
            rows(&self.gain),
        ]
    }

    /// Output of the system in a state.
    pub fn put_out(&self, state: &DVector<f64>) -> DVector<f64> {
        &self.output * state + &self.offset
    }

    /// The next state of the system left to itself.
    pub fn next(&self, state: &DVector<f64>) -> DVector<f64> {
        &self.transition * state + &self.drift
    }

    /// `frames` outputs of the system left to itself from a state, frame by frame.
    pub fn simulate(&self, start: &DVector<f64>, frames: usize) -> Vec<f64> {
        let mut state = start.clone();
        let mut outputs = Vec::with_capacity(frames * self.channels());
        for _ in 0..frames {
            outputs.extend(self.put_out(&state).iter());
            state = self.next(&state);
        }
        outputs
    }

    /// The prediction errors `e[k] = y[k] − ŷ[k|k−1]` of a segment from a state, frame by frame.
    pub fn prediction_errors(&self, start: &DVector<f64>, segment: &[f64]) -> Vec<f64> {
        let mut state = start.clone();
        let mut errors = Vec::with_capacity(segment.len());
        for frame in segment.chunks_exact(self.channels()) {
            let error = DVector::from_column_slice(frame) - self.put_out(&state);
            errors.extend(error.iter());
            state = self.next(&state) + &self.gain * error;
        }
        errors
    }
}
