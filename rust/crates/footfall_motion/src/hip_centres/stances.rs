//! Legs of one person over many stances: mean flexion of the knees for any place of the hip joints.

use super::leg::flexion;
use super::reference::KneeCurve;
use super::{HipCorrection, WalkingEvidence};
use crate::walking_evidence::PHASES;
use footfall_core::Side;
use glam::{DVec3, Vec2, Vec3};
use nalgebra::{DMatrix, DVector, SVector};

/// Number of a correction's parameters.
pub(super) const COUNT: usize = 5;
/// Limits of the distance of a stride of plain walking from the middle one: in medians, and in degrees; beyond both it is excluded.
const OUTLIER: f64 = 2.5;
const OUTLIER_DEG: f64 = 4.0;

/// Up, forwards, share that legs are longer; what the left hip joint moves beyond the mean, up and forwards.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Parameters(pub(super) SVector<f64, COUNT>);

impl Parameters {
    pub(super) fn correction(&self) -> HipCorrection {
        let [up, forward, lengthened, up_apart, forward_apart] = self.0.data.0[0];
        HipCorrection {
            offsets: Side::BOTH.map(|side| {
                let sign = f64::from(side.sign());
                Vec2::new(
                    (up + sign * up_apart) as f32,
                    (forward + sign * forward_apart) as f32,
                )
            }),
            leg_factor: (1.0 + lengthened) as f32,
        }
    }
}

/// One stance with the leg that stands.
#[derive(Clone, Debug)]
struct LegOverStance {
    sign: f64,
    segments: [f64; 2],
    hip_from_ankle: [DVec3; PHASES],
}

impl LegOverStance {
    /// Flexion at a phase, degrees, and its gradient.
    fn knee(&self, phase: usize, parameters: &Parameters) -> (f64, SVector<f64, COUNT>) {
        let [up, forward, lengthened, up_apart, forward_apart] = parameters.0.data.0[0];
        let sign = self.sign;
        let hip = self.hip_from_ankle[phase]
            + DVec3::new(0.0, up + sign * up_apart, forward + sign * forward_apart);
        let factor = 1.0 + lengthened;
        let length = hip.length().max(1e-9);
        let distance = length / factor;
        let (angle, slope) = flexion(distance, self.segments);
        let (angle, slope) = (angle.to_degrees(), slope.to_degrees());
        let by_up = slope * hip.y / (length * factor);
        let by_forward = slope * hip.z / (length * factor);
        let gradient = SVector::from([
            by_up,
            by_forward,
            -slope * distance / factor,
            sign * by_up,
            sign * by_forward,
        ]);
        (angle, gradient)
    }

    fn curve(&self, parameters: &Parameters) -> KneeCurve {
        core::array::from_fn(|phase| self.knee(phase, parameters).0)
    }
}

/// The stances of the left and of the right leg.
#[derive(Clone, Debug)]
pub(super) struct Legs([Vec<LegOverStance>; 2]);

impl Legs {
    /// All usable stances; a stride that is no plain walking among those of its leg is left out.
    pub(super) fn new(recordings: &[&WalkingEvidence]) -> Self {
        let stances_of = |side: Side| {
            let stances = recordings.iter().flat_map(|recording| {
                let own = recording.stances.iter().filter(move |stance| {
                    stance.side == side && stance.hip_from_ankle.iter().all(|hip| hip.is_finite())
                });
                own.map(move |stance| LegOverStance {
                    sign: f64::from(side.sign()),
                    segments: recording.segments[side.index()].map(f64::from),
                    hip_from_ankle: stance.hip_from_ankle.map(Vec3::as_dvec3),
                })
            });
            without_outliers(stances.collect())
        };
        Self(Side::BOTH.map(stances_of))
    }

    /// Strides of each leg.
    pub(super) fn strides(&self) -> [usize; 2] {
        [self.0[0].len(), self.0[1].len()]
    }

    /// Mean flexion of the left and then of the right knee, degrees, and its derivatives.
    pub(super) fn knees(&self, parameters: &Parameters) -> (DVector<f64>, DMatrix<f64>) {
        let mut angles = DVector::zeros(2 * PHASES);
        let mut slopes = DMatrix::zeros(2 * PHASES, COUNT);
        for (side, stances) in self.0.iter().enumerate() {
            let share = 1.0 / stances.len().max(1) as f64;
            for stance in stances {
                for phase in 0..PHASES {
                    let row = side * PHASES + phase;
                    let (angle, slope) = stance.knee(phase, parameters);
                    angles[row] += share * angle;
                    for (column, by) in slope.iter().enumerate() {
                        slopes[(row, column)] += share * by;
                    }
                }
            }
        }
        (angles, slopes)
    }

    /// Mean of both legs.
    pub(super) fn mean_knee(&self, parameters: &Parameters) -> KneeCurve {
        let (angles, _) = self.knees(parameters);
        core::array::from_fn(|phase| 0.5 * (angles[phase] + angles[PHASES + phase]))
    }
}

fn without_outliers(stances: Vec<LegOverStance>) -> Vec<LegOverStance> {
    if stances.len() < 4 {
        return stances;
    }
    let curves: Vec<KneeCurve> = stances
        .iter()
        .map(|stance| stance.curve(&Parameters::default()))
        .collect();
    let middle: KneeCurve = core::array::from_fn(|phase| {
        median(&mut curves.iter().map(|curve| curve[phase]).collect::<Vec<_>>())
    });
    let distances: Vec<f64> = curves
        .iter()
        .map(|curve| distance(curve, &middle))
        .collect();
    let limit = (OUTLIER * median(&mut distances.clone())).max(OUTLIER_DEG);
    let near = stances.into_iter().zip(distances);
    near.filter(|(_, distance)| *distance <= limit)
        .map(|(stance, _)| stance)
        .collect()
}

/// Root mean square difference.
fn distance(a: &KneeCurve, b: &KneeCurve) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / PHASES as f64).sqrt()
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
