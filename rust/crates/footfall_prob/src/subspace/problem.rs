//! Objective of refinement and its gradient, which runs backwards through each segment.

use super::{AffineSystem, Refinement};
use nalgebra::{DMatrix, DVector};

/// Shares of an identified gain that are tried.
const GAIN_SHARES: [f64; 6] = [1.0, 0.5, 0.25, 0.1, 0.03, 0.0];

/// Squared one-step errors of segments as a function of a system's numbers and of the states in which segments begin.
pub(super) struct Problem<'a> {
    pub(super) order: usize,
    pub(super) channels: usize,
    pub(super) segments: &'a [&'a [f64]],
    pub(super) numbers: f64,
    pub(super) refinement: Refinement,
}

/// Ranges of the parts in a point.
pub(super) struct Parts {
    transition: usize,
    drift: usize,
    output: usize,
    offset: usize,
    pub(super) gain: usize,
    pub(super) starts: usize,
}

impl Problem<'_> {
    pub(super) fn parts(&self) -> Parts {
        let (n, m) = (self.order, self.channels);
        Parts {
            transition: 0,
            drift: n * n,
            output: n * n + n,
            offset: n * n + n + m * n,
            gain: n * n + n + m * n + m,
            starts: n * n + n + 2 * m * n + m,
        }
    }

    /// Matrices row by row, so that products run along rows.
    pub(super) fn pack(system: &AffineSystem, starts: &[DVector<f64>]) -> Vec<f64> {
        let mut point = system.to_rows().concat();
        point.extend(starts.iter().flat_map(|start| start.iter()));
        point
    }

    pub(super) fn unpack(&self, point: &[f64]) -> (AffineSystem, Vec<DVector<f64>>) {
        let (n, m) = (self.order, self.channels);
        let parts = self.parts();
        let matrix = |at: usize, rows: usize, columns: usize| {
            DMatrix::from_row_slice(rows, columns, &point[at..at + rows * columns])
        };
        let vector = |at: usize, len: usize| DVector::from_column_slice(&point[at..at + len]);
        let system = AffineSystem {
            transition: matrix(parts.transition, n, n),
            drift: vector(parts.drift, n),
            output: matrix(parts.output, m, n),
            offset: vector(parts.offset, m),
            gain: matrix(parts.gain, n, m),
        };
        let starts = point[parts.starts..].chunks_exact(n);
        (system, starts.map(DVector::from_column_slice).collect())
    }

    /// The first value and gradient, with the share of the gain that predicts best.
    pub(super) fn begin(&self, point: &mut [f64], gradient: &mut [f64]) -> f64 {
        let parts = self.parts();
        let gain = point[parts.gain..parts.starts].to_vec();
        let mut with = |share: f64, gradient: &mut [f64]| {
            for (entry, gain) in point[parts.gain..parts.starts].iter_mut().zip(&gain) {
                *entry = share * gain;
            }
            self.evaluate(point, gradient)
        };
        let best = match self.refinement {
            Refinement::Simulation => 0.0,
            Refinement::Gain => GAIN_SHARES
                .into_iter()
                .map(|share| (with(share, gradient), share))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .map_or(0.0, |(_, share)| share),
        };
        with(best, gradient)
    }

    /// Half the mean squared error and its gradient; infinite where a prediction runs away.
    pub(super) fn evaluate(&self, point: &[f64], gradient: &mut [f64]) -> f64 {
        let (n, m) = (self.order, self.channels);
        let parts = self.parts();
        let a = &point[parts.transition..parts.drift];
        let b = &point[parts.drift..parts.output];
        let c = &point[parts.output..parts.offset];
        let d = &point[parts.offset..parts.gain];
        let k = &point[parts.gain..parts.starts];
        gradient.fill(0.0);
        let mut total = 0.0;
        let (mut states, mut errors) = (Vec::new(), Vec::new());
        for (index, segment) in self.segments.iter().enumerate() {
            let frames = segment.len() / m;
            states.clear();
            errors.clear();
            states.extend_from_slice(&point[parts.starts + index * n..][..n]);
            for frame in 0..frames {
                let state = states.len() - n;
                for channel in 0..m {
                    let x = &states[state..state + n];
                    let foretold = dot(&c[channel * n..][..n], x) + d[channel];
                    errors.push(segment[frame * m + channel] - foretold);
                }
                let error = errors.len() - m;
                for row in 0..n {
                    let x = &states[state..state + n];
                    let next = dot(&a[row * n..][..n], x)
                        + b[row]
                        + dot(&k[row * m..][..m], &errors[error..error + m]);
                    states.push(next);
                }
            }
            total += dot(&errors, &errors);
            // λ[k] = (A − K C)ᵀ λ[k+1] − Cᵀ e[k], from λ beyond the end being 0.
            let mut ahead = vec![0.0; n];
            let mut output_pull = vec![0.0; m];
            for frame in (0..frames).rev() {
                let x = &states[frame * n..][..n];
                let e = &errors[frame * m..][..m];
                output_pull.copy_from_slice(e);
                for row in 0..n {
                    add(&mut output_pull, &k[row * m..][..m], ahead[row]);
                    add(
                        &mut gradient[parts.transition + row * n..][..n],
                        x,
                        ahead[row],
                    );
                    add(&mut gradient[parts.gain + row * m..][..m], e, ahead[row]);
                    gradient[parts.drift + row] += ahead[row];
                }
                let mut here = vec![0.0; n];
                for row in 0..n {
                    add(&mut here, &a[row * n..][..n], ahead[row]);
                }
                for channel in 0..m {
                    let pull = -output_pull[channel];
                    add(&mut gradient[parts.output + channel * n..][..n], x, pull);
                    gradient[parts.offset + channel] += pull;
                    add(&mut here, &c[channel * n..][..n], pull);
                }
                ahead = here;
            }
            gradient[parts.starts + index * n..][..n].copy_from_slice(&ahead);
        }
        for value in &mut *gradient {
            *value /= self.numbers;
        }
        match self.refinement {
            Refinement::Simulation => gradient[parts.gain..parts.starts].fill(0.0),
            Refinement::Gain => {
                gradient[..parts.gain].fill(0.0);
                gradient[parts.starts..].fill(0.0);
            }
        }
        let value = 0.5 * total / self.numbers;
        if value.is_finite() {
            value
        } else {
            f64::INFINITY
        }
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(super) fn add(target: &mut [f64], values: &[f64], weight: f64) {
    for (target, value) in target.iter_mut().zip(values) {
        *target += weight * value;
    }
}
