//! Statistics that the segments of a phase share: how sensors differ between like frames, what follows what, and how the body goes with the sensor.

use super::align::warp;
use super::chain::{Chain, ChainSegment};
use footfall_core::PhaseKind;
use footfall_model::imu_model::{BODY_COUNT, SENSOR_COUNT};
use nalgebra::DMatrix;

/// Real sensors differ from virtual ones by at least this much: angular rate (rad/s), specific force (m/s²), up. A mounting is known to a few degrees; were up
/// trusted more closely, a foot at rest would distinguish a crouch from standing by them.
const LEAST_DEVIATION: [f64; 3] = [0.25, 2.0, 0.15];

/// Least number of aligned frames for a regression.
const LEAST_FRAMES: usize = 60;

/// Statistics of all chains.
pub(super) struct Statistics {
    pub(super) next: Vec<f32>,
    pub(super) deviations: Vec<f32>,
    pub(super) regressions: Vec<Vec<f32>>,
}

impl Statistics {
    pub(super) fn of(chains: &[&Chain], phases: &[PhaseKind], sensors: usize) -> Self {
        let width = SENSOR_COUNT * sensors;
        let mut squares = vec![0.0; width];
        let mut count = 0.0;
        let mut regressions = Vec::with_capacity(phases.len());
        for kind in phases {
            let residuals = Residuals::of(chains, *kind, width);
            for row in residuals.sensor.row_iter() {
                for (square, value) in squares.iter_mut().zip(row.iter()) {
                    *square += value * value;
                }
            }
            count += residuals.sensor.nrows() as f64;
            regressions.push(residuals.regression());
        }
        let deviations = squares.iter().enumerate().map(|(n, square)| {
            let floor = LEAST_DEVIATION[n % SENSOR_COUNT / 3];
            (square / f64::max(count, 1.0)).sqrt().hypot(floor) as f32
        });
        Self {
            next: successors(chains, phases),
            deviations: deviations.collect(),
            regressions,
        }
    }
}

/// Share of each phase among those that follow each, row by row.
fn successors(chains: &[&Chain], phases: &[PhaseKind]) -> Vec<f32> {
    let kinds = phases.len();
    let place = |segment: &ChainSegment| phases.binary_search(&segment.kind).unwrap_or(0);
    let mut next = vec![0.0_f32; kinds * kinds];
    for chain in chains {
        for pair in chain.segments.windows(2) {
            next[place(&pair[0]) * kinds + place(&pair[1])] += 1.0;
        }
    }
    for row in next.chunks_exact_mut(kinds) {
        let sum: f32 = row.iter().sum();
        for share in row {
            *share /= sum.max(1.0);
        }
    }
    next
}

/// Frames of one phase less the mean of those that are aligned with the same frame of the reference.
struct Residuals {
    sensor: DMatrix<f64>,
    body: DMatrix<f64>,
}

impl Residuals {
    fn of(chains: &[&Chain], kind: PhaseKind, width: usize) -> Self {
        let segments: Vec<(&Chain, &ChainSegment)> = chains
            .iter()
            .flat_map(|chain| chain.segments.iter().map(move |segment| (*chain, segment)))
            .filter(|(_, segment)| segment.kind == kind)
            .collect();
        let mut lengths: Vec<usize> = (0..segments.len()).collect();
        lengths.sort_by_key(|n| segments[*n].1.end - segments[*n].1.first);
        let Some(reference) = lengths.get(lengths.len() / 2).map(|n| segments[*n]) else {
            return Self {
                sensor: DMatrix::zeros(0, width),
                body: DMatrix::zeros(0, BODY_COUNT),
            };
        };
        let rows_of = |(chain, segment): (&Chain, &ChainSegment)| {
            chain.body[segment.first * BODY_COUNT..segment.end * BODY_COUNT].to_vec()
        };
        let reference_rows = rows_of(reference);
        let cells = reference_rows.len() / BODY_COUNT;
        let mut aligned: Vec<Vec<(&Chain, usize)>> = vec![Vec::new(); cells];
        for (chain, segment) in segments {
            let path = warp(&reference_rows, &rows_of((chain, segment)));
            for (n, cell) in path.into_iter().enumerate() {
                aligned[cell].push((chain, segment.first + n));
            }
        }
        let (mut sensor, mut body) = (Vec::new(), Vec::new());
        for cell in &aligned {
            center(cell, width, Chain::sensor_row, &mut sensor);
            center(cell, BODY_COUNT, Chain::body_row, &mut body);
        }
        Self {
            sensor: DMatrix::from_row_slice(sensor.len() / width, width, &sensor),
            body: DMatrix::from_row_slice(body.len() / BODY_COUNT, BODY_COUNT, &body),
        }
    }

    /// U^XY (U^YY)⁻¹ of equation 6, row by row; the floor of the deviations keeps the inverse tame.
    fn regression(&self) -> Vec<f32> {
        let (frames, width) = self.sensor.shape();
        if frames < LEAST_FRAMES {
            return Vec::new();
        }
        let mut within = self.sensor.transpose() * &self.sensor / frames as f64;
        for n in 0..width {
            within[(n, n)] += LEAST_DEVIATION[n % SENSOR_COUNT / 3].powi(2);
        }
        let across = self.sensor.transpose() * &self.body / frames as f64;
        let Some(factor) = within.cholesky() else {
            return Vec::new();
        };
        // Columns are body numbers: the storage of the solution is the regression row by row.
        factor
            .solve(&across)
            .iter()
            .map(|value| *value as f32)
            .collect()
    }
}

fn center<'a>(
    cell: &[(&'a Chain, usize)],
    width: usize,
    row: impl Fn(&'a Chain, usize) -> &'a [f32],
    out: &mut Vec<f64>,
) {
    let mut mean = vec![0.0; width];
    for (chain, frame) in cell {
        for (mean, value) in mean.iter_mut().zip(row(chain, *frame)) {
            *mean += f64::from(*value) / cell.len() as f64;
        }
    }
    for (chain, frame) in cell {
        let values = row(chain, *frame).iter().zip(&mean);
        out.extend(values.map(|(value, mean)| f64::from(*value) - mean));
    }
}
