//! The projection residual of block Hankel matrices (equations 4, 8 and 9).

use crate::error::{ProbError, check_finite, check_len};

/// Directions shorter than this, of their own length, are taken to lie in the span of the others: a constant channel, or the
/// exact modes of a system without noise.
const DEPENDENT: f64 = 1e-9;

/// Residual of every stretch of future outputs after projection onto the stretch of past ones before it.
#[derive(Clone, Debug, PartialEq)]
pub struct ProjectionResidual {
    window: usize,
    columns: usize,
    channels: usize,
    /// Row by row: frame of the future, channel; each of all columns.
    rows: Vec<f64>,
}

impl ProjectionResidual {
    /// `Ê = Y_f − Y_f W_p† W_p` with `W_p = [Y_p; 1]`, for `outputs` of T frames × `channels`, frame by frame, and windows of
    /// `window` frames of past and future.
    ///
    /// # Errors
    /// [`ProbError::SequenceTooShort`] when there are fewer frames than the projection has unknowns, and other [`ProbError`]s
    /// for outputs that are not whole frames or not finite.
    pub fn new(outputs: &[f64], channels: usize, window: usize) -> Result<Self, ProbError> {
        if channels == 0 || window == 0 {
            return Err(ProbError::Empty {
                what: "channels or window",
            });
        }
        let frames = outputs.len() / channels;
        check_len("outputs", outputs.len(), frames * channels)?;
        check_finite("outputs", outputs)?;
        let unknowns = channels * window + 1;
        let needed = unknowns + 2 * window;
        if frames < needed {
            return Err(ProbError::SequenceTooShort {
                frames,
                segments: needed,
            });
        }
        let columns = frames - 2 * window + 1;
        // A row of a Hankel matrix is a stretch of a channel.
        let series: Vec<Vec<f64>> = (0..channels)
            .map(|channel| {
                outputs[channel..]
                    .iter()
                    .step_by(channels)
                    .copied()
                    .collect()
            })
            .collect();
        let row = |first: usize, channel: usize| &series[channel][first..first + columns];
        let mut basis = Basis::constant(columns);
        for first in 0..window {
            for channel in 0..channels {
                basis.extend(row(first, channel));
            }
        }
        let mut rows = Vec::with_capacity(window * channels * columns);
        for first in window..2 * window {
            for channel in 0..channels {
                rows.extend(basis.residual(row(first, channel)));
            }
        }
        Ok(Self {
            window,
            columns,
            channels,
            rows,
        })
    }

    /// The frame that the first column stands for: a jump in frame `first_frame` + t peaks in column t.
    pub fn first_frame(&self) -> usize {
        self.window
    }

    /// The norm of every column of Ê.
    pub fn norms(&self) -> Vec<f64> {
        self.norms_of(|_| true)
    }

    /// The norm of every column over the rows of some channels.
    pub fn norms_of(&self, is_used: impl Fn(usize) -> bool) -> Vec<f64> {
        let mut norms = vec![0.0; self.columns];
        for (index, row) in self.rows.chunks_exact(self.columns).enumerate() {
            if is_used(index % self.channels) {
                for (norm, value) in norms.iter_mut().zip(row) {
                    *norm += value * value;
                }
            }
        }
        for norm in &mut norms {
            *norm = norm.sqrt();
        }
        norms
    }
}

/// Orthonormal vectors, grown one by one (Gram-Schmidt, twice, so that they stay orthogonal).
struct Basis {
    vectors: Vec<Vec<f64>>,
}

impl Basis {
    fn constant(len: usize) -> Self {
        Self {
            vectors: vec![vec![(len as f64).sqrt().recip(); len]],
        }
    }

    fn extend(&mut self, row: &[f64]) {
        let length = dot(row, row).sqrt();
        let mut rest = self.residual(row);
        let norm = dot(&rest, &rest).sqrt();
        if norm > DEPENDENT * length {
            for value in &mut rest {
                *value /= norm;
            }
            self.vectors.push(rest);
        }
    }

    /// Component of a row that is orthogonal to the span.
    fn residual(&self, row: &[f64]) -> Vec<f64> {
        let mut rest = row.to_vec();
        for _ in 0..2 {
            for vector in &self.vectors {
                let share = dot(vector, &rest);
                for (rest, value) in rest.iter_mut().zip(vector) {
                    *rest -= share * value;
                }
            }
        }
        rest
    }
}

/// Eight running sums, so that the compiler can use vector registers.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<8>();
    let (b, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    /// The definition, with a pseudo-inverse.
    fn reference(outputs: &[f64], channels: usize, window: usize) -> Vec<f64> {
        let frames = outputs.len() / channels;
        let columns = frames - 2 * window + 1;
        let hankel = |from: usize| {
            DMatrix::from_fn(window * channels, columns, |row, column| {
                outputs[(from + row / channels + column) * channels + row % channels]
            })
        };
        let past = hankel(0).insert_row(window * channels, 1.0);
        let future = hankel(window);
        let inverse = past.clone().pseudo_inverse(1e-9).unwrap();
        let residual = &future - &future * inverse * past;
        residual.column_iter().map(|column| column.norm()).collect()
    }

    proptest! {
        #[test]
        fn norms_are_those_of_the_definition(
            values in proptest::collection::vec(-1.0_f64..1.0, 120..200),
            window in 1_usize..5,
        ) {
            let channels = 2;
            let outputs = &values[..values.len() / channels * channels];
            let found = ProjectionResidual::new(outputs, channels, window).unwrap();
            let expected = reference(outputs, channels, window);
            for (found, expected) in found.norms().iter().zip(expected) {
                prop_assert!((found - expected).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn an_undisturbed_system_leaves_nothing_and_a_jump_peaks_in_its_frame() {
        // Two damped oscillations, mixed, on a constant; the state jumps in frame 70.
        let mut state = [1.0_f64, 0.3, -0.5, 0.8];
        let mut outputs = Vec::new();
        for frame in 0..150 {
            if frame == 70 {
                state = [0.2, -0.9, 1.0, 0.1];
            }
            outputs.extend([state[0] + 0.5 * state[2] + 3.0, state[1] - state[3]]);
            let turn = |[x, y]: [f64; 2], angle: f64, decay: f64| {
                let (sin, cos) = angle.sin_cos();
                [decay * (cos * x - sin * y), decay * (sin * x + cos * y)]
            };
            let [a, b] = turn([state[0], state[1]], 0.3, 0.999);
            let [c, d] = turn([state[2], state[3]], 0.17, 0.998);
            state = [a, b, c, d];
        }
        let clean = ProjectionResidual::new(&outputs[..140], 2, 4).unwrap();
        assert!(clean.norms().iter().all(|norm| *norm < 1e-7));
        let residual = ProjectionResidual::new(&outputs, 2, 4).unwrap();
        let norms = residual.norms();
        let top = (0..norms.len())
            .max_by(|a, b| norms[*a].total_cmp(&norms[*b]))
            .unwrap();
        assert_eq!(top + residual.first_frame(), 70);
    }

    #[test]
    fn constant_channels_are_harmless_and_bad_input_is_named() {
        let flat = ProjectionResidual::new(&[2.5; 80], 2, 3).unwrap();
        assert!(flat.norms().iter().all(|norm| *norm < 1e-9));
        assert!(matches!(
            ProjectionResidual::new(&[0.0; 20], 2, 3),
            Err(ProbError::SequenceTooShort { frames: 10, .. })
        ));
        assert!(matches!(
            ProjectionResidual::new(&[f64::NAN; 80], 2, 3),
            Err(ProbError::NotFinite { .. })
        ));
        assert!(ProjectionResidual::new(&[0.0; 81], 2, 3).is_err());
        assert!(ProjectionResidual::new(&[0.0; 80], 0, 3).is_err());
    }
}
