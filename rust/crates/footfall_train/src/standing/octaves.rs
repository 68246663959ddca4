//! Sway and shifts of weight as noises of octaves.
//!
//! Offsets are split into bands by differences of ever narrower smoothings, and each band has a covariance. A noise of an octave puts known shares of its
//! variance into every band, so the octaves' covariances are those, positive semidefinite, whose sums come nearest to the bands'. Directions are the
//! principal ones of each octave: weight goes over slowly and the head trembles fast.

use super::{Offsets, RATE_HZ, mirrored};
use footfall_core::Joint;
use footfall_model::layout::feature_offset;
use footfall_model::{FEATURE_COUNT, SWAY_COUNT, SwayOctave};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Times between the knots of the octaves, seconds, slowest first: from shifts of weight at 0.04 Hz to tremor at 1.5 Hz.
const KNOTS_SECS: [f64; OCTAVES] = [8.0, 3.2, 1.28, 0.5, 0.2];
const OCTAVES: usize = 5;

/// Time between the knots of the slow difference between the legs.
const STANCE_KNOT_SECS: f64 = 40.0;

/// The deviation of the Gaussian that leaves an octave and all slower ones, by the time between its knots.
const SMOOTHING: f64 = 0.35;

/// The choice of directions weighs radians of the trunk and the head twice, for what hangs from them moves with them, and the hips' way as if it
/// turned a lever of 0.15 m.
const TRUNK_WEIGHT: f64 = 2.0;
const HIPS_WEIGHT: f64 = 5.6;

/// Directions of an octave that is not the stance's, and the share of the energy that is enough.
const DIRECTIONS: usize = 6;
const ENOUGH_ENERGY: f64 = 0.93;

/// Less is rounding, rad².
const LEAST_VARIANCE: f64 = 1e-14;

/// Rounds of the fit of covariances.
const ROUNDS: usize = 20;

/// Number of frequencies at which spectra are compared, and the highest of them, hertz.
const FREQUENCIES: usize = 6000;
const MOST_HZ: f64 = 12.0;

/// Sway of a standing body, as found.
pub(super) struct Swayed {
    /// Weight on one leg for long.
    pub(super) stance: SwayOctave,
    /// Slowest first.
    pub(super) octaves: Vec<SwayOctave>,
    /// Standard deviation of the logarithm of people's strength.
    pub(super) strength_spread: f64,
}

/// One covariance for each band.
type Bands = [DMatrix<f64>; OCTAVES];

/// Fits octaves to people's offsets: stretches by person, and how much each counts.
pub(super) fn estimate(people: &[Vec<Offsets>], weights: &[f64]) -> Swayed {
    let own: Vec<Bands> = people.iter().map(|stretches| bands_of(stretches)).collect();
    let total: f64 = weights.iter().sum();
    let mean = |values: &[f64]| {
        let pairs = values.iter().zip(weights);
        pairs.map(|(value, weight)| value * weight).sum::<f64>() / total
    };
    let strengths: Vec<[f64; OCTAVES]> = own.iter().map(log_strengths).collect();
    let whole = |strengths: &[f64; OCTAVES]| strengths.iter().sum::<f64>() / OCTAVES as f64;
    let wholes: Vec<f64> = strengths.iter().map(whole).collect();
    let usual = mean(&wholes);
    let squares: Vec<f64> = wholes.iter().map(|s| (s - usual).powi(2)).collect();
    let count = people.len() as f64;
    let freed = count / (count - 1.0).max(1.0);
    let bands: Bands = core::array::from_fn(|band| {
        // Each person is scaled to the geometric mean: restless people would dominate otherwise.
        let own_strengths: Vec<f64> = strengths.iter().map(|own| own[band]).collect();
        let usual = mean(&own_strengths);
        let mut sum = DMatrix::zeros(SWAY_COUNT, SWAY_COUNT);
        for ((own, strength), weight) in own.iter().zip(&own_strengths).zip(weights) {
            sum += weight / total * (2.0 * (usual - strength)).exp() * &own[band];
        }
        sum
    });
    let covariances = fit(&bands);
    let octaves = covariances.iter().zip(KNOTS_SECS);
    let octaves = octaves.map(|(covariance, knot_secs)| SwayOctave {
        knot_secs,
        directions: directions(covariance),
    });
    Swayed {
        stance: stance(people, weights, &covariances),
        octaves: octaves.collect(),
        strength_spread: (freed * mean(&squares)).sqrt(),
    }
}

/// Weight of a number.
fn weight(number: usize) -> f64 {
    if number >= FEATURE_COUNT {
        HIPS_WEIGHT
    } else if number < feature_offset(Joint::LeftShoulder) {
        TRUNK_WEIGHT
    } else {
        1.0
    }
}

/// The logarithm of the deviation in each band.
fn log_strengths(bands: &Bands) -> [f64; OCTAVES] {
    bands.each_ref().map(|band| {
        let diagonal = band.diagonal();
        let parts = diagonal.iter().enumerate();
        let energy: f64 = parts.map(|(n, value)| weight(n).powi(2) * value).sum();
        0.5 * energy.max(1e-12).ln()
    })
}

/// Covariances of the bands of one person's offsets about the mean, mirrored ones included.
fn bands_of(stretches: &[Offsets]) -> Bands {
    let frames: usize = stretches.iter().map(Vec::len).sum();
    let mut mean = [0.0; SWAY_COUNT];
    for row in stretches.iter().flatten() {
        for (mean, value) in mean.iter_mut().zip(row) {
            *mean += value / frames as f64;
        }
    }
    let mut bands: Bands = core::array::from_fn(|_| DMatrix::zeros(SWAY_COUNT, SWAY_COUNT));
    for stretch in stretches {
        let mut slower: Offsets = vec![mean; stretch.len()];
        for (band, knot_secs) in bands.iter_mut().zip(KNOTS_SECS) {
            let smoothed = smoothed(stretch, SMOOTHING * knot_secs * RATE_HZ);
            for (row, slower) in smoothed.iter().zip(&slower) {
                let own: [f64; SWAY_COUNT] = core::array::from_fn(|n| row[n] - slower[n]);
                for row in [own, mirrored(&own)] {
                    let row = DMatrix::from_row_slice(1, SWAY_COUNT, &row);
                    band.gemm_tr(0.5 / frames as f64, &row, &row, 1.0);
                }
            }
            slower = smoothed;
        }
    }
    bands
}

/// Rows smoothed by a Gaussian with this deviation in frames; the ends are reflected.
fn smoothed(rows: &Offsets, deviation: f64) -> Offsets {
    let reach = (3.0 * deviation).ceil() as usize;
    let kernel: Vec<f64> = (0..=2 * reach)
        .map(|tap| (-0.5 * ((tap as f64 - reach as f64) / deviation).powi(2)).exp())
        .collect();
    let whole: f64 = kernel.iter().sum();
    let period = 2 * rows.len();
    (0..rows.len())
        .map(|frame| {
            let mut sum = [0.0; SWAY_COUNT];
            for (tap, share) in kernel.iter().enumerate() {
                let at = (frame + tap + period * reach.div_ceil(period) - reach) % period;
                let row = &rows[at.min(period - 1 - at)];
                for (sum, value) in sum.iter_mut().zip(row) {
                    *sum += share / whole * value;
                }
            }
            sum
        })
        .collect()
}

/// Shares of the octaves' variances (columns) in the bands (rows).
fn shares() -> [[f64; OCTAVES]; OCTAVES] {
    let frequency = |index: usize| (index as f64 + 0.5) * MOST_HZ / FREQUENCIES as f64;
    let passed = |band: usize, hz: f64| {
        let deviation = SMOOTHING * KNOTS_SECS[band];
        (-2.0 * (core::f64::consts::PI * hz * deviation).powi(2)).exp()
    };
    core::array::from_fn(|band| {
        core::array::from_fn(|octave| {
            let (mut inside, mut whole) = (0.0, 0.0);
            for index in 0..FREQUENCIES {
                let hz = frequency(index);
                let power = spline_power(hz * KNOTS_SECS[octave]);
                let slower = if band == 0 { 0.0 } else { passed(band - 1, hz) };
                inside += power * (passed(band, hz) - slower).powi(2);
                whole += power;
            }
            inside / whole
        })
    })
}

/// Spectrum of independent weights on cubic B-splines, by frequency times the time between knots.
fn spline_power(cycles: f64) -> f64 {
    let angle = core::f64::consts::PI * cycles;
    if angle < 1e-6 {
        return 1.0;
    }
    (angle.sin() / angle).powi(8)
}

/// Covariances of octaves whose shares in the bands add up to the bands' covariances.
fn fit(bands: &Bands) -> Bands {
    let shares = shares();
    let mut octaves: Bands = core::array::from_fn(|n| bands[n].clone() / shares[n][n]);
    for _ in 0..ROUNDS {
        for octave in 0..OCTAVES {
            let mut rest = bands[octave].clone();
            for (other, covariance) in octaves.iter().enumerate() {
                if other != octave {
                    rest -= covariance * shares[octave][other];
                }
            }
            octaves[octave] = positive(&(rest / shares[octave][octave]));
        }
    }
    octaves
}

/// The nearest covariance that a process can have, in the weighted numbers.
fn positive(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(SWAY_COUNT, SWAY_COUNT);
    for direction in principal(matrix) {
        let direction = DVector::from_vec(direction);
        sum += &direction * direction.transpose();
    }
    sum
}

/// The strongest directions of a covariance, as many as hold nearly all of it.
fn directions(covariance: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let energy = |direction: &Vec<f64>| {
        let parts = direction.iter().enumerate();
        parts
            .map(|(n, part)| (weight(n) * part).powi(2))
            .sum::<f64>()
    };
    let mut all = principal(covariance);
    let whole: f64 = all.iter().map(energy).sum();
    let mut kept = 0.0;
    all.truncate(DIRECTIONS);
    all.retain(|direction| {
        let enough = kept > ENOUGH_ENERGY * whole;
        kept += energy(direction);
        !enough
    });
    all
}

/// Directions in which a process of this covariance goes, each as long as its deviation, strongest first in the weighted numbers. Where the
/// matrix is no covariance there is none.
fn principal(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let moving: Vec<usize> = (0..SWAY_COUNT)
        .filter(|n| matrix[(*n, *n)] > LEAST_VARIANCE)
        .collect();
    if moving.is_empty() {
        return Vec::new();
    }
    let eigen = SymmetricEigen::new(DMatrix::from_fn(moving.len(), moving.len(), |a, b| {
        let [a, b] = [moving[a], moving[b]];
        0.5 * (matrix[(a, b)] + matrix[(b, a)]) * weight(a) * weight(b)
    }));
    let mut order: Vec<usize> = (0..moving.len())
        .filter(|index| eigen.eigenvalues[*index] > LEAST_VARIANCE)
        .collect();
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let rows = order.into_iter().map(|index| {
        let length = eigen.eigenvalues[index].sqrt();
        let mut direction = vec![0.0; SWAY_COUNT];
        for (part, number) in eigen.eigenvectors.column(index).iter().zip(&moving) {
            direction[*number] = length * part / weight(*number);
        }
        direction
    });
    rows.collect()
}

/// Weight on one leg for long: as far as people's mean places of the hips are from the middle, with what goes with such a shift in the slowest
/// octaves.
fn stance(people: &[Vec<Offsets>], weights: &[f64], octaves: &Bands) -> SwayOctave {
    let side = FEATURE_COUNT;
    let (mut squares, mut total) = (0.0, 0.0);
    for (stretches, weight) in people.iter().zip(weights) {
        let frames: usize = stretches.iter().map(Vec::len).sum();
        let sum: f64 = stretches.iter().flatten().map(|row| row[side]).sum();
        squares += weight * (sum / frames as f64).powi(2);
        total += weight;
    }
    let slow = &octaves[0] + &octaves[1];
    let spread = (squares / total).sqrt();
    let variance = slow[(side, side)].max(1e-12);
    SwayOctave {
        knot_secs: STANCE_KNOT_SECS,
        directions: vec![
            slow.column(side)
                .iter()
                .map(|value| spread * value / variance)
                .collect(),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_chacha::ChaCha8Rng;

    /// A first-order process with this correlation time, frame by frame, of variance 1.
    fn process(rng: &mut ChaCha8Rng, frames: usize, secs: f64) -> Vec<f64> {
        let keep = (-1.0 / (secs * RATE_HZ)).exp();
        let mut value = 0.0;
        (0..frames)
            .map(|_| {
                let normal: f64 = (0..12).map(|_| rng.random_range(-0.5..0.5)).sum();
                value = keep * value + (1.0 - keep * keep).sqrt() * normal;
                value
            })
            .collect()
    }

    /// Autoregressive processes along known directions: their variances, directions and spectra come back.
    #[test]
    fn known_processes_are_recovered() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let frames = (400.0 * RATE_HZ) as usize;
        let side = FEATURE_COUNT;
        let people: Vec<Vec<Offsets>> = (0..4)
            .map(|_| {
                let slow = process(&mut rng, frames, 2.0);
                let fast = process(&mut rng, frames, 0.15);
                let rows = slow.iter().zip(&fast).map(|(slow, fast)| {
                    let mut row = [0.0; SWAY_COUNT];
                    // Weight to the side turns the pelvis; the chest nods.
                    row[side] = 0.03 * slow;
                    row[2] = 0.02 * slow;
                    row[9] = 0.01 * fast;
                    row
                });
                vec![rows.collect()]
            })
            .collect();
        let swayed = estimate(&people, &[1.0; 4]);
        let octaves = &swayed.octaves[..];
        let variance = |n: usize, octaves: &[SwayOctave]| {
            let rows = octaves.iter().flat_map(|octave| &octave.directions);
            rows.map(|row| row[n] * row[n]).sum::<f64>()
        };
        let found = variance(side, octaves).sqrt();
        assert!((found / 0.03 - 1.0).abs() < 0.15, "{found}");
        let found = variance(9, octaves).sqrt();
        assert!((found / 0.01 - 1.0).abs() < 0.15, "{found}");
        // Slow is slow and fast is fast: of this process 0.89 and 0.2 of the variance lie below 0.4 Hz.
        let slow_share = |n: usize| variance(n, &octaves[..3]) / variance(n, octaves);
        assert!(slow_share(side) > 0.8, "{}", slow_share(side));
        assert!(slow_share(9) < 0.45, "{}", slow_share(9));
        // What goes together stays together, and what does not does not.
        let together = |a: usize, b: usize| {
            let rows = octaves.iter().flat_map(|octave| &octave.directions);
            let sum: f64 = rows.map(|row| row[a] * row[b]).sum();
            sum / (variance(a, octaves) * variance(b, octaves)).sqrt()
        };
        assert!(together(side, 2) > 0.97, "{}", together(side, 2));
        assert!(together(side, 9).abs() < 0.15, "{}", together(side, 9));
        assert!(swayed.strength_spread < 0.15, "{}", swayed.strength_spread);
    }

    #[test]
    fn the_lively_and_the_calm_weigh_the_same() {
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        let frames = (300.0 * RATE_HZ) as usize;
        let people: Vec<Vec<Offsets>> = [0.5, 1.0, 2.0]
            .into_iter()
            .map(|strength| {
                let values = process(&mut rng, frames, 1.0);
                let row = |value: f64| {
                    let mut row = [0.0; SWAY_COUNT];
                    row[FEATURE_COUNT + 1] = 0.02 * strength * value;
                    row
                };
                vec![values.into_iter().map(row).collect()]
            })
            .collect();
        let swayed = estimate(&people, &[1.0; 3]);
        let rows = swayed.octaves.iter().flat_map(|octave| &octave.directions);
        let deviation = rows
            .map(|row| row[FEATURE_COUNT + 1].powi(2))
            .sum::<f64>()
            .sqrt();
        assert!((deviation / 0.02 - 1.0).abs() < 0.2, "{deviation}");
        // Factors of two: a deviation of ln 2.
        assert!((swayed.strength_spread / 2_f64.ln() - 1.0).abs() < 0.25);
    }
}
