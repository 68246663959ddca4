//! The little dense algebra that transforms need, on row-major slices.

use super::dot;

/// Factors a symmetric matrix in place, reading and writing its lower triangle; false when it is not positive definite.
pub(super) fn cholesky(matrix: &mut [f64], size: usize) -> bool {
    for i in 0..size {
        let (done, rest) = matrix.split_at_mut(i * size);
        let row = &mut rest[..size];
        for j in 0..i {
            let other = &done[j * size..=j * size + j];
            row[j] = (row[j] - dot(&row[..j], &other[..j])) / other[j];
        }
        let scale = row[i];
        let pivot = scale - dot(&row[..i], &row[..i]);
        // What is left of the diagonal by rounding alone counts as nothing.
        if pivot.is_nan() || pivot <= scale * 1e-13 {
            return false;
        }
        row[i] = pivot.sqrt();
    }
    true
}

/// Solves with a factor of [`cholesky`], in place.
pub(super) fn solve_cholesky(factor: &[f64], size: usize, values: &mut [f64]) {
    for i in 0..size {
        let row = &factor[i * size..=i * size + i];
        values[i] = (values[i] - dot(&row[..i], &values[..i])) / row[i];
    }
    for i in (0..size).rev() {
        let row = &factor[i * size..=i * size + i];
        let value = values[i] / row[i];
        values[i] = value;
        for (rest, entry) in values[..i].iter_mut().zip(row) {
            *rest -= entry * value;
        }
    }
}

/// The inverse and ln |det|, by Gauss-Jordan elimination with row pivots; `None` when singular.
pub(super) fn invert(matrix: &[f64], size: usize) -> Option<(Vec<f64>, f64)> {
    let mut left = matrix.to_vec();
    let mut right = vec![0.0; size * size];
    for i in 0..size {
        right[i * size + i] = 1.0;
    }
    let mut log_det = 0.0;
    for column in 0..size {
        let pivot_row = (column..size)
            .max_by(|a, b| {
                let entry = |row: usize| left[row * size + column].abs();
                entry(*a).total_cmp(&entry(*b))
            })
            .unwrap_or(column);
        let pivot = left[pivot_row * size + column];
        if !pivot.is_normal() {
            return None;
        }
        log_det += pivot.abs().ln();
        for j in 0..size {
            left.swap(pivot_row * size + j, column * size + j);
            right.swap(pivot_row * size + j, column * size + j);
        }
        for half in [&mut left, &mut right] {
            for value in &mut half[column * size..(column + 1) * size] {
                *value /= pivot;
            }
        }
        for row in (0..size).filter(|row| *row != column) {
            let factor = left[row * size + column];
            if factor.abs() > 0.0 {
                subtract_row(&mut left, size, row, column, factor);
                subtract_row(&mut right, size, row, column, factor);
            }
        }
    }
    Some((right, log_det))
}

fn subtract_row(matrix: &mut [f64], size: usize, row: usize, from: usize, factor: f64) {
    let source = matrix[from * size..(from + 1) * size].to_vec();
    let target = &mut matrix[row * size..(row + 1) * size];
    for (value, other) in target.iter_mut().zip(source) {
        *value -= factor * other;
    }
}

/// The inverse after `change` was added to row `row` of the matrix (Sherman and Morrison).
pub(super) fn update_inverse(inverse: &mut [f64], size: usize, row: usize, change: &[f64]) {
    let column: Vec<f64> = (0..size).map(|i| inverse[i * size + row]).collect();
    let mut product = vec![0.0; size];
    for (factor, source) in change.iter().zip(inverse.chunks_exact(size)) {
        for (sum, value) in product.iter_mut().zip(source) {
            *sum += factor * value;
        }
    }
    let denominator = 1.0 + product[row];
    for (i, factor) in column.iter().enumerate() {
        let target = &mut inverse[i * size..(i + 1) * size];
        for (value, product) in target.iter_mut().zip(&product) {
            *value -= factor * product / denominator;
        }
    }
}
