//! Motion between 3 and 6 Hz: how strong it is in each part of the body, and how much of it repeats from stride to stride.

use super::swings::{PART_COUNT, PARTS, PHASES, StrideSwings};
use footfall_core::Side;
use glam::Vec3;

/// Walkers with fewer strides of a side say nothing about repetition.
const LEAST_STRIDES: usize = 5;

/// Detail of one part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PartDetail {
    /// Root mean square angle, radians.
    pub rms: f64,
    /// Share of its energy that repeats: energy of the mean over a walker's strides, freed of what chance leaves in a mean.
    pub repeats: f64,
}

/// Detail by part of captured and generated walkers.
pub fn by_part(both: [&Vec<Vec<StrideSwings>>; 2]) -> Vec<(&'static str, [PartDetail; 2])> {
    let of = |part: usize| (PARTS[part], both.map(|walkers| detail(walkers, part)));
    (0..PART_COUNT).map(of).collect()
}

/// Mean over walkers and sides of the energy and of what repeats of it.
fn detail(walkers: &[Vec<StrideSwings>], part: usize) -> PartDetail {
    let (mut energy, mut repeating, mut weights) = (0.0, 0.0, 0.0);
    for strides in walkers {
        for side in Side::BOTH {
            let own: Vec<&StrideSwings> = strides.iter().filter(|one| one.side == side).collect();
            if own.len() < LEAST_STRIDES {
                continue;
            }
            let count = own.len() as f64;
            let (mut all, mut of_mean) = (0.0, 0.0);
            for phase in 0..PHASES {
                let mut mean = Vec3::ZERO;
                for stride in &own {
                    let value = stride.detail[phase][part];
                    all += f64::from(value.length_squared()) / count;
                    mean += value / count as f32;
                }
                of_mean += f64::from(mean.length_squared());
            }
            energy += all / PHASES as f64;
            repeating += (count * of_mean - all) / (count - 1.0) / PHASES as f64;
            weights += 1.0;
        }
    }
    if weights == 0.0 || energy <= 0.0 {
        return PartDetail::default();
    }
    PartDetail {
        rms: (energy / weights).sqrt(),
        repeats: repeating / energy,
    }
}
