//! Closed-form identification over segments.

use super::AffineSystem;
use crate::error::{ProbError, check_finite, check_len};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Settings of identification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IdentifyConfig {
    /// Order n of the system.
    pub order: usize,
    /// Frames of a column of the Hankel matrix; with m outputs, at least n / m.
    pub window: usize,
}

/// Weight of a small identity in least squares, relative to the mean of the diagonal: states may say one thing twice.
const RIDGE: f64 = 1e-12;

/// Identifies the system behind segments, each T × `channels` frame by frame. Hankel columns of all segments stand side by side, none
/// across two, so that a segment may be far shorter than the order needs.
///
/// The strongest directions of the columns span what the system can be seen to do (equations 3 and 5 with no input but the offset);
/// the columns' coordinates there are the states. A, b, C and d follow from neighbouring states by least squares, K from what is
/// left of both. Futures are not regressed on pasts first, as for a long recording: that would cost half the frames of a segment.
///
/// # Errors
/// [`ProbError::SequenceTooShort`] when all segments together have too few frames; other [`ProbError`]s for an order that the window
/// cannot show, and for values that are not finite.
pub fn identify(
    segments: &[&[f64]],
    channels: usize,
    config: &IdentifyConfig,
) -> Result<AffineSystem, ProbError> {
    let IdentifyConfig { order, window } = *config;
    let rows = channels * window;
    if order == 0 || rows == 0 {
        return Err(ProbError::Empty {
            what: "order, channels or window",
        });
    }
    if order > rows {
        return Err(ProbError::IndexOutOfRange {
            what: "order of the system",
            index: 0,
            value: order,
            len: rows,
        });
    }
    for segment in segments {
        check_len("segment", segment.len() % channels, 0)?;
        check_finite("segment", segment)?;
    }
    let counts: Vec<usize> = segments
        .iter()
        .map(|segment| (segment.len() / channels + 1).saturating_sub(window))
        .collect();
    let pairs: usize = counts.iter().map(|count| count.saturating_sub(1)).sum();
    if pairs <= order {
        return Err(ProbError::SequenceTooShort {
            frames: segments
                .iter()
                .map(|segment| segment.len() / channels)
                .sum(),
            segments: order + 1 + window,
        });
    }
    let mut hankel = DMatrix::<f64>::zeros(rows, counts.iter().sum());
    let mut columns = hankel.column_iter_mut();
    for (segment, count) in segments.iter().zip(&counts) {
        for (first, mut column) in (0..*count).zip(&mut columns) {
            column.copy_from_slice(&segment[first * channels..][..rows]);
        }
    }
    let states = strongest(&hankel, order);
    realise(segments, channels, &counts, &states)
}

/// The matrix M that takes `inputs` to `targets` by least squares.
fn regress(targets: &DMatrix<f64>, inputs: &DMatrix<f64>) -> Result<DMatrix<f64>, ProbError> {
    let mut normal = inputs * inputs.transpose();
    let ridge = RIDGE * normal.trace() / normal.nrows() as f64;
    for index in 0..normal.nrows() {
        normal[(index, index)] += ridge;
    }
    let factor = normal.cholesky().ok_or(ProbError::NoData {
        what: "a linear system",
    })?;
    Ok(factor.solve(&(inputs * targets.transpose())).transpose())
}

/// The coordinates of the columns, about their mean, along their strongest directions, each scaled to a spread of one.
fn strongest(hankel: &DMatrix<f64>, order: usize) -> DMatrix<f64> {
    let mean = hankel.column_mean();
    let mut centred = hankel.clone();
    for mut column in centred.column_iter_mut() {
        column -= &mean;
    }
    let scatter = &centred * centred.transpose() / hankel.ncols() as f64;
    let eigen = SymmetricEigen::new(scatter);
    let mut rank: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    rank.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let greatest = eigen.eigenvalues[rank[0]].max(f64::MIN_POSITIVE);
    let mut directions = DMatrix::<f64>::zeros(order, hankel.nrows());
    for (row, index) in rank.into_iter().take(order).enumerate() {
        let spread = eigen.eigenvalues[index].max(1e-12 * greatest).sqrt();
        directions.set_row(
            row,
            &(eigen.eigenvectors.column(index).transpose() / spread),
        );
    }
    directions * centred
}

fn realise(
    segments: &[&[f64]],
    channels: usize,
    counts: &[usize],
    states: &DMatrix<f64>,
) -> Result<AffineSystem, ProbError> {
    let order = states.nrows();
    let pairs: usize = counts.iter().map(|count| count.saturating_sub(1)).sum();
    let mut inputs = DMatrix::<f64>::zeros(order + 1, pairs);
    let mut targets = DMatrix::<f64>::zeros(order + channels, pairs);
    let (mut column, mut first) = (0, 0);
    for (segment, count) in segments.iter().zip(counts) {
        for offset in 0..count.saturating_sub(1) {
            let state = states.column(first + offset);
            inputs.view_mut((0, column), (order, 1)).copy_from(&state);
            inputs[(order, column)] = 1.0;
            let next = states.column(first + offset + 1);
            targets.view_mut((0, column), (order, 1)).copy_from(&next);
            let outputs = &segment[offset * channels..][..channels];
            targets
                .view_mut((order, column), (channels, 1))
                .copy_from_slice(outputs);
            column += 1;
        }
        first += count;
    }
    let found = regress(&targets, &inputs)?;
    let rest = targets - &found * inputs;
    let (state_rest, output_rest) = (rest.rows(0, order), rest.rows(order, channels));
    let gain = regress(&state_rest.into_owned(), &output_rest.into_owned())?;
    Ok(AffineSystem {
        transition: found.view((0, 0), (order, order)).into_owned(),
        drift: DVector::from_iterator(order, found.view((0, order), (order, 1)).iter().copied()),
        output: found.view((order, 0), (channels, order)).into_owned(),
        offset: DVector::from_iterator(
            channels,
            found.view((order, order), (channels, 1)).iter().copied(),
        ),
        gain,
    })
}
