//! Linear transforms of features.

use super::{dense, dot};
use crate::error::{ProbError, check_finite, check_len};
use crate::gaussian::DiagonalGaussian;

/// An affine map of frames, o ↦ Fo + g.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearTransform {
    pub(super) dim: usize,
    /// D × (D + 1), row-major: g, then F.
    pub(super) rows: Vec<f64>,
}

impl LinearTransform {
    /// The map that changes nothing.
    pub fn identity(dim: usize) -> Self {
        let mut rows = vec![0.0; dim * (dim + 1)];
        for i in 0..dim {
            rows[i * (dim + 1) + 1 + i] = 1.0;
        }
        Self { dim, rows }
    }

    /// A map from its D × (D + 1) rows, each g then F.
    ///
    /// # Errors
    /// [`ProbError`] when the shape is wrong or a value is not finite.
    pub fn from_rows(dim: usize, rows: Vec<f64>) -> Result<Self, ProbError> {
        if dim == 0 {
            return Err(ProbError::Empty { what: "transform" });
        }
        check_len("transform", rows.len(), dim * (dim + 1))?;
        check_finite("transform", &rows)?;
        Ok(Self { dim, rows })
    }

    /// Number of dimensions D.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// D × (D + 1) values, row-major: g, then F.
    pub fn rows(&self) -> &[f64] {
        &self.rows
    }

    pub(super) fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * (self.dim + 1)..(i + 1) * (self.dim + 1)]
    }

    /// F alone, D × D.
    pub(super) fn matrix(&self) -> Vec<f64> {
        self.rows
            .chunks_exact(self.dim + 1)
            .flat_map(|row| row[1..].iter().copied())
            .collect()
    }

    /// Writes F `frame` + g to `out`, D values each.
    pub fn apply(&self, frame: &[f64], out: &mut [f64]) {
        for (out, row) in out.iter_mut().zip(self.rows.chunks_exact(self.dim + 1)) {
            *out = row[0] + dot(&row[1..], frame);
        }
    }

    /// ln |det F|; what every mapped frame's log density gains. -∞ when F is singular.
    pub fn log_determinant(&self) -> f64 {
        dense::invert(&self.matrix(), self.dim).map_or(f64::NEG_INFINITY, |(_, log_det)| log_det)
    }

    /// The Gaussians that explain the frames as they are, not mapped: mean A(μ − g) and the diagonal of `AΣAᵀ`, A = F⁻¹.
    ///
    /// # Errors
    /// [`ProbError`] when F is singular, shapes differ, or the result is not a Gaussian.
    pub fn adapt(
        &self,
        gaussians: &[DiagonalGaussian],
    ) -> Result<Vec<DiagonalGaussian>, ProbError> {
        let (inverse, _) = dense::invert(&self.matrix(), self.dim)
            .ok_or(ProbError::Degenerate { what: "transform" })?;
        gaussians
            .iter()
            .map(|gaussian| {
                check_len("mean", gaussian.dim(), self.dim)?;
                let centred: Vec<f64> = (0..self.dim)
                    .map(|i| gaussian.mean()[i] - self.row(i)[0])
                    .collect();
                let rows = || inverse.row_iter();
                let mean = rows()
                    .map(|row| row.iter().zip(&centred).map(|(a, c)| a * c).sum())
                    .collect();
                let variance = rows()
                    .map(|row| {
                        let terms = row.iter().zip(gaussian.variance());
                        terms.map(|(a, v)| a * a * v).sum()
                    })
                    .collect();
                DiagonalGaussian::new(mean, variance)
            })
            .collect()
    }
}
