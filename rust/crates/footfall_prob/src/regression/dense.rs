//! Dense algebra of transforms: nalgebra's, with the limits below which a matrix counts as singular.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Factor of a symmetric matrix.
pub(super) struct Factor(Cholesky<f64, Dyn>);

impl Factor {
    /// Factors a symmetric matrix, of which the lower triangle is given, row-major; `None` when it is not positive definite.
    pub(super) fn new(matrix: &[f64], size: usize) -> Option<Self> {
        let matrix = DMatrix::from_row_slice(size, size, matrix);
        let scales = matrix.diagonal();
        let factor = Cholesky::new(matrix)?;
        let pivots = factor.l_dirty().diagonal();
        // What is left of the diagonal by rounding alone counts as nothing.
        let mut pairs = pivots.iter().zip(scales.iter());
        pairs
            .all(|(pivot, scale)| pivot * pivot > scale * 1e-13)
            .then_some(Self(factor))
    }

    /// Solves for one right-hand side.
    pub(super) fn solve(&self, values: &[f64]) -> Vec<f64> {
        let solved = self.0.solve(&DVector::from_column_slice(values));
        solved.as_slice().to_vec()
    }
}

/// The inverse of a row-major matrix and ln |det|; `None` when it is singular.
pub(super) fn invert(matrix: &[f64], size: usize) -> Option<(DMatrix<f64>, f64)> {
    let factors = DMatrix::from_row_slice(size, size, matrix).lu();
    let pivots = factors.u().diagonal();
    if !pivots.iter().all(|pivot| pivot.is_normal()) {
        return None;
    }
    let log_det = pivots.iter().map(|pivot| pivot.abs().ln()).sum();
    Some((factors.try_inverse()?, log_det))
}

/// The inverse after `change` was added to row `row` of the matrix (Sherman and Morrison).
pub(super) fn update_inverse(inverse: &mut DMatrix<f64>, row: usize, change: &[f64]) {
    let column = inverse.column(row).into_owned();
    let product = inverse.tr_mul(&DVector::from_column_slice(change));
    let denominator = 1.0 + product[row];
    inverse.ger(-1.0 / denominator, &column, &product, 1.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_follows_a_row_that_changes() {
        let mut matrix = [4.0, 1.0, 0.0, -2.0, 3.0, 0.5, 1.0, 0.0, 2.0];
        let (mut inverse, log_det) = invert(&matrix, 3).unwrap();
        // 4 (3·2 − 0.5·0) − 1 (−2·2 − 0.5·1) = 28.5
        assert!((log_det - 28.5_f64.ln()).abs() < 1e-12);
        let change = [0.5, -1.0, 2.0];
        update_inverse(&mut inverse, 1, &change);
        for (entry, change) in matrix[3..6].iter_mut().zip(change) {
            *entry += change;
        }
        let (expected, _) = invert(&matrix, 3).unwrap();
        assert!((inverse - expected).amax() < 1e-12);
    }

    #[test]
    fn what_is_singular_but_for_rounding_is_refused() {
        assert!(invert(&[1.0, 2.0, 2.0, 4.0], 2).is_none());
        // The upper triangle is not read.
        let factor = Factor::new(&[4.0, 9.0, 2.0, 5.0], 2).unwrap();
        let solved = factor.solve(&[8.0, 8.0]);
        assert!((solved[0] - 1.5).abs() < 1e-12 && (solved[1] - 1.0).abs() < 1e-12);
        assert!(Factor::new(&[1.0, 0.0, 1.0, 1.0 + 1e-15], 2).is_none());
        assert!(Factor::new(&[1.0, 0.0, 2.0, 1.0], 2).is_none());
    }
}
