//! Standing posture, and the blend between standing and walking.
//!
//! A model that was trained on standing people has their posture. For a model that only walks, the posture is the mean of a walk over straight legs. A
//! step that starts or ends a walk blends between that posture and the walk, with the same planted feet.

use footfall_core::ease::smooth_step;
use footfall_core::rotation::log_map;
use footfall_core::{Joint, Side};
use footfall_model::layout::{feature_offset, mirror};
use footfall_model::{FEATURE_COUNT, GaitModel};
use glam::Quat;

/// Static features of one posture.
pub(crate) type Posture = [f32; FEATURE_COUNT];

/// Flexion of the knees of a standing walker, radians.
const KNEE_FLEXION: f32 = 0.1;

/// Part of a starting step in which the walk sets in; the weight shifts first.
const GROWTH: [f32; 2] = [0.0, 0.7];

/// Part of a stopping step by the end of which the walk has faded.
const SHRUNK_BY: f32 = 0.9;

/// Share of the walk at the beginning and at the end of a step: 0 is standing, 1 is walking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Amplitude {
    pub(crate) from: f32,
    pub(crate) to: f32,
}

impl Amplitude {
    pub(crate) const WALK: Self = Self { from: 1.0, to: 1.0 };
    pub(crate) const STAND: Self = Self { from: 0.0, to: 0.0 };

    /// Returns true in a step that starts a walk or goes on in it.
    pub(crate) fn walks_on(self) -> bool {
        self.to >= 1.0
    }

    /// Share of the walk at part `s` of a step that was replanned when the share `passed` of it had passed. A start goes on from there; a stop begins there.
    pub(crate) fn at(self, s: f32, passed: f32) -> f32 {
        let progress = if self.to < self.from {
            s / SHRUNK_BY
        } else {
            (passed + (1.0 - passed) * s - GROWTH[0]) / (GROWTH[1] - GROWTH[0])
        };
        self.from + smooth_step(progress) * (self.to - self.from)
    }
}

/// Features of the standing walker of a model.
pub(crate) fn standing_features(model: &GaitModel) -> Posture {
    let row = |features: &[f64]| core::array::from_fn(|n| features[n]);
    if let Some(standing) = &model.standing {
        return row(&standing.posture).map(|value| value as f32);
    }
    standing_posture(row(&model.mean_features()))
}

/// Mean features of the steps of a model.
pub(crate) fn mean_posture(model: &GaitModel) -> Posture {
    let mean = model.mean_features();
    core::array::from_fn(|index| mean[index] as f32)
}

/// Features of a standing walker, from the mean of a walk: made symmetric, on straight legs.
pub(crate) fn standing_posture(mut mean: [f64; FEATURE_COUNT]) -> Posture {
    let mut mirrored = mean;
    mirror(&mut mirrored);
    for (mean, mirrored) in mean.iter_mut().zip(mirrored) {
        *mean = 0.5 * (*mean + mirrored);
    }
    // Mirroring leaves only the tilt of the hips; the legs compensate it to stand upright.
    let tilt = Quat::from_rotation_x(mean[feature_offset(Joint::Hips)] as f32);
    let thigh = Quat::from_rotation_x(-0.5 * KNEE_FLEXION);
    let mut set = |joint: Joint, rotation: Quat| {
        let vector = log_map(rotation).as_dvec3().to_array();
        mean[feature_offset(joint)..][..3].copy_from_slice(&vector);
    };
    for side in Side::BOTH {
        set(side.upper_leg(), tilt.inverse() * thigh);
        set(side.lower_leg(), Quat::from_rotation_x(KNEE_FLEXION));
        set(side.foot(), thigh);
        set(side.toes(), Quat::IDENTITY);
    }
    mean.map(|value| value as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amplitudes_begin_and_end_where_they_say() {
        for (from, to) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)] {
            let amplitude = Amplitude { from, to };
            assert!((amplitude.at(0.0, 0.0) - from).abs() < 1e-6);
            assert!((amplitude.at(1.0, 0.0) - to).abs() < 1e-6);
            let halves = [amplitude.at(0.4, 0.0), amplitude.at(0.6, 0.0)];
            assert!((halves[1] - halves[0]) * (to - from) >= 0.0);
        }
    }

    #[test]
    fn a_start_that_is_replanned_goes_on_and_a_stop_begins() {
        let start = Amplitude { from: 0.0, to: 1.0 };
        for s in [0.0, 0.25, 0.5, 1.0] {
            let whole = start.at(0.4 + 0.6 * s, 0.0);
            assert!((start.at(s, 0.4) - whole).abs() < 1e-6);
        }
        let stop = Amplitude { from: 1.0, to: 0.0 };
        for (s, share) in [(0.0, 1.0), (1.0, 0.0)] {
            assert!((stop.at(s, 0.4) - share).abs() < 1e-6);
        }
    }
}
