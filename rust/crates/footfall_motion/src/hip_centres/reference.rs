//! Normal gait: flexion of the knee while its foot stands, and the spread of it between and within healthy people.
//!
//! Means between those of published studies of normal walking at a comfortable speed (heel strike 3 to 6°, loading 15 to
//! 20°, terminal stance 5 to 12°) and those of recordings whose hip joints were placed well; spreads as published, less
//! what placing joints by markers adds to them.

use crate::walking_evidence::{PHASES, STRIDE_SHARES};
use nalgebra::DMatrix;

/// Flexion at each of [`STRIDE_SHARES`], degrees.
pub(super) const FLEXION_DEG: [f64; PHASES] = [
    4.0, 5.0, 11.5, 17.0, 19.5, 18.5, 15.5, 12.0, 9.8, 9.2, 10.7, 15.0,
];

/// Standard deviation between people, degrees: least where the knee is nearly straight.
const SPREAD_DEG: [f64; PHASES] = [
    3.0, 3.15, 4.05, 4.95, 5.4, 5.4, 4.95, 4.5, 4.5, 4.05, 4.05, 4.5,
];
/// Share of a stride over which what is peculiar to a person's knee changes.
const PECULIARITY: f64 = 0.05;
/// Share of a stride over which legs and strides of one person differ alike.
const DIFFERENCE: f64 = 0.1;
/// Standard deviation of the difference between legs, constant and in shape, degrees.
const LEGS_DEG: f64 = 2.0;
/// Standard deviation of strides, degrees, and the share of it that remains in the mean of many.
const STRIDES_DEG: f64 = 3.0;
const STRIDES_ALIKE: f64 = 0.1;
/// Standard deviation between people where joints are placed, degrees: smaller where the knee is nearly straight, since a millimetre of the
/// joint turns it by a degree there, so that most of what is published is misplacement. Below, the same all along the stance.
const PLACING_SPREAD_DEG: [f64; PHASES] = [
    3.0, 3.15, 4.05, 4.95, 5.4, 5.4, 4.95, 4.5, 3.2, 2.7, 3.2, 4.5,
];
const PLACING_DEG: f64 = 0.4;
/// Error of each point.
const POINT_DEG: f64 = 0.7;

/// Ways of walking that knees are compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Gait {
    /// Plain walking: near to normal gait.
    Plain,
    /// A manner of one's own: bent throughout or less bent, and of another shape.
    Manner,
}

impl Gait {
    /// Standard deviation all along the stance, degrees, and factor on the spread between people.
    const fn freedom(self) -> (f64, f64) {
        match self {
            Self::Plain => (1.5, 1.0),
            Self::Manner => (15.0, 1.3),
        }
    }

    /// Covariance of the mean curves of the left and of the right knee for these numbers of strides, square degrees.
    pub(super) fn covariance(self, strides: [usize; 2]) -> DMatrix<f64> {
        let (all_along, wider) = self.freedom();
        DMatrix::from_fn(2 * PHASES, 2 * PHASES, |row, column| {
            let (side, a, b) = (row / PHASES, row % PHASES, column % PHASES);
            let spread = wider * wider * SPREAD_DEG[a] * SPREAD_DEG[b];
            let person = all_along * all_along + spread * alike(a, b, PECULIARITY);
            if side != column / PHASES {
                return person;
            }
            let slow = alike(a, b, DIFFERENCE);
            let leg = LEGS_DEG * LEGS_DEG * (1.0 + slow);
            let mean_of = STRIDES_ALIKE + 1.0 / strides[side].max(1) as f64;
            let stride = STRIDES_DEG * STRIDES_DEG * slow * mean_of;
            let point = if a == b { POINT_DEG * POINT_DEG } else { 0.0 };
            person + leg + stride + point
        })
    }
}

/// The covariance by which joints are placed once it is sure that they are misplaced: every point on its own. People
/// differ in how far they bend in loading, and hardly in how straight they land, but a knee that is bent all along is what a
/// misplaced joint makes.
pub(super) fn covariance_of_placing(strides: [usize; 2]) -> DMatrix<f64> {
    DMatrix::from_fn(2 * PHASES, 2 * PHASES, |row, column| {
        let all_along = PLACING_DEG * PLACING_DEG;
        if row != column {
            return all_along;
        }
        let strides = strides[row / PHASES].max(1) as f64;
        all_along + PLACING_SPREAD_DEG[row % PHASES].powi(2) + STRIDES_DEG * STRIDES_DEG / strides
    })
}

/// Correlation of two points.
fn alike(a: usize, b: usize, range: f64) -> f64 {
    let apart = f64::from(STRIDE_SHARES[a] - STRIDE_SHARES[b]);
    (-0.5 * (apart / range).powi(2)).exp()
}

/// Mean flexion of both legs over stance, degrees.
pub(super) type KneeCurve = [f64; PHASES];

/// Heel strike, the first peak and the least flexion before push-off; a leg that would have to be longer is straight.
pub(super) fn landmarks(knee: &KneeCurve) -> [f32; 3] {
    let peak = knee[2..7].iter().copied().fold(f64::MIN, f64::max);
    let trough = knee[7..].iter().copied().fold(f64::MAX, f64::min);
    [knee[1], peak, trough].map(|angle| angle.max(0.0) as f32)
}
