//! Standing by measures: how far and how fast hips and head sway, the spectrum by part of the body, knees, and whether anything comes back.

use crate::standing::{RATE_HZ, Stretch};
use core::f64::consts::TAU;
use core::ops::Range;
use footfall_core::{Joint, Side};
use footfall_imu::filter::low_pass;
use footfall_model::layout::feature_offset;
use glam::Vec3;

/// Length of the windows in which sway is measured, and what lies between their beginnings, seconds.
pub const WINDOW_SECS: f64 = 20.0;
const HOP_SECS: f64 = 10.0;

/// Faster motion is noise of cameras, hertz.
const CUT_OFF_HZ: f64 = 3.0;

/// Bands of the spectrum, hertz: shifts of weight, breathing and slow sway, sway, tremor.
pub const BANDS_HZ: [[f64; 2]; BANDS] = [[0.05, 0.2], [0.2, 0.5], [0.5, 1.0], [1.0, 2.4]];
const BANDS: usize = 4;

/// Parts of the body: name, unit, and how to read it. Turns of a chain of joints are added up.
pub const PARTS: [&str; PART_COUNT] = [
    "hips sideways, mm",
    "hips forwards, mm",
    "pelvis, degrees",
    "trunk, degrees",
    "head, degrees",
    "shoulders, degrees",
    "arms, degrees",
];
const PART_COUNT: usize = 7;

/// Standing of one person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingMeasures {
    /// Root mean square of the way over the ground from its mean within [`WINDOW_SECS`], centimetres: hips, head.
    pub sway_cm: [f64; 2],
    /// Mean speed over the ground, centimetres a second: hips, head.
    pub speed_cm_s: [f64; 2],
    /// 10th and 90th percentile of both knees' angles, degrees.
    pub knees_deg: [f64; 2],
    /// Greatest correlation of the head's way with itself a window or more before; `None` for stretches of less than two windows.
    pub return_correlation: Option<f64>,
    /// Root mean square in each of [`BANDS_HZ`], for each of [`PARTS`].
    pub spectrum: [[f64; BANDS]; PART_COUNT],
}

/// Measures one person's stretches; `None` where none is as long as a window. `leg_m` is the length of a leg.
pub fn measure(stretches: &[Stretch], leg_m: f64) -> Option<StandingMeasures> {
    let frames = (WINDOW_SECS * RATE_HZ) as usize;
    let hop = (HOP_SECS * RATE_HZ) as usize;
    let mut windows = 0.0;
    let mut measures = StandingMeasures {
        sway_cm: [0.0; 2],
        speed_cm_s: [0.0; 2],
        knees_deg: [0.0; 2],
        return_correlation: None,
        spectrum: [[0.0; BANDS]; PART_COUNT],
    };
    for stretch in stretches {
        for begin in (0..(stretch.frames() + 1).saturating_sub(frames)).step_by(hop) {
            windows += 1.0;
            let window = begin..begin + frames;
            for (index, way) in [&stretch.hips, &stretch.head].into_iter().enumerate() {
                let [sway, speed] = sway(&way[window.clone()]);
                measures.sway_cm[index] += 100.0 * leg_m * sway;
                measures.speed_cm_s[index] += 100.0 * leg_m * speed;
            }
            for (part, bands) in measures.spectrum.iter_mut().enumerate() {
                let signals = signals(stretch, part, window.clone(), leg_m);
                for (sum, power) in bands.iter_mut().zip(powers(&signals)) {
                    *sum += power;
                }
            }
        }
    }
    if windows < 1.0 {
        return None;
    }
    for value in measures.sway_cm.iter_mut().chain(&mut measures.speed_cm_s) {
        *value /= windows;
    }
    for power in measures.spectrum.iter_mut().flatten() {
        *power = (*power / windows).sqrt();
    }
    measures.knees_deg = knees(stretches);
    let correlations = stretches.iter().filter_map(return_correlation);
    measures.return_correlation = correlations.reduce(f64::max);
    Some(measures)
}

/// Root mean square about the mean, and mean speed, in units a second.
fn sway(way: &[[f64; 2]]) -> [f64; 2] {
    let places: Vec<Vec3> = way
        .iter()
        .map(|[x, z]| Vec3::new(*x as f32, 0.0, *z as f32))
        .collect();
    let places = low_pass(&places, RATE_HZ, CUT_OFF_HZ);
    let mean = places.iter().sum::<Vec3>() / places.len() as f32;
    let squares: f32 = places
        .iter()
        .map(|place| place.distance_squared(mean))
        .sum();
    let way: f32 = places
        .windows(2)
        .map(|pair| pair[0].distance(pair[1]))
        .sum();
    let secs = (places.len() - 1) as f64 / RATE_HZ;
    [
        f64::from(squares / places.len() as f32).sqrt(),
        f64::from(way) / secs,
    ]
}

/// Motion of one part in a window, number by number.
fn signals(stretch: &Stretch, part: usize, window: Range<usize>, leg_m: f64) -> Vec<Vec<f64>> {
    let hips = |axis: usize| {
        let rows = stretch.hips[window.clone()].iter();
        rows.map(|row| 1000.0 * leg_m * row[axis])
            .collect::<Vec<f64>>()
    };
    let turns = |chain: &[Joint]| {
        let rows = &stretch.features[window.clone()];
        (0..3)
            .map(|axis| {
                let sum = |row: &Vec<f64>| {
                    let turns = chain.iter().map(|joint| row[feature_offset(*joint) + axis]);
                    turns.sum::<f64>().to_degrees()
                };
                rows.iter().map(sum).collect()
            })
            .collect::<Vec<Vec<f64>>>()
    };
    match part {
        0 | 1 => vec![hips(part)],
        2 => turns(&[Joint::Hips]),
        3 => turns(&[Joint::Spine, Joint::Chest, Joint::UpperChest]),
        4 => turns(&[Joint::Neck, Joint::Head]),
        5 => [Joint::LeftShoulder, Joint::RightShoulder]
            .into_iter()
            .flat_map(|joint| turns(&[joint]))
            .collect(),
        _ => [
            Joint::LeftUpperArm,
            Joint::LeftLowerArm,
            Joint::RightUpperArm,
            Joint::RightLowerArm,
        ]
        .into_iter()
        .flat_map(|joint| turns(&[joint]))
        .collect(),
    }
}

/// Power in each band, added up over signals: a Hann window's periodogram.
fn powers(signals: &[Vec<f64>]) -> [f64; BANDS] {
    let mut powers = [0.0; BANDS];
    for signal in signals {
        let count = signal.len() as f64;
        let mean = signal.iter().sum::<f64>() / count;
        let hann = |frame: usize| 0.5 - 0.5 * (TAU * (frame as f64 + 0.5) / count).cos();
        let windowed: Vec<f64> = signal
            .iter()
            .enumerate()
            .map(|(frame, value)| hann(frame) * (value - mean))
            .collect();
        let most = (BANDS_HZ[BANDS - 1][1] * WINDOW_SECS).round() as usize;
        for bin in 1..=most {
            let angle = TAU * bin as f64 / count;
            let (mut cosine, mut sine) = (0.0, 0.0);
            for (frame, value) in windowed.iter().enumerate() {
                cosine += value * (angle * frame as f64).cos();
                sine += value * (angle * frame as f64).sin();
            }
            let hz = bin as f64 / WINDOW_SECS;
            let band = BANDS_HZ
                .iter()
                .position(|[low, high]| (*low..*high).contains(&hz));
            if let Some(band) = band {
                // A Hann window keeps 3/8 of the power.
                powers[band] += 2.0 * (cosine * cosine + sine * sine) / (count * count * 0.375);
            }
        }
    }
    powers
}

fn knees(stretches: &[Stretch]) -> [f64; 2] {
    let mut angles: Vec<f64> = stretches
        .iter()
        .flat_map(|stretch| &stretch.features)
        .flat_map(|row| {
            Side::BOTH.map(|side| {
                let knee = &row[feature_offset(side.lower_leg())..][..3];
                knee.iter().map(|v| v * v).sum::<f64>().sqrt().to_degrees()
            })
        })
        .collect();
    angles.sort_by(f64::total_cmp);
    [0.1, 0.9].map(|share| angles[((angles.len() - 1) as f64 * share) as usize])
}

/// Greatest correlation of the head's way with itself a window or more before.
fn return_correlation(stretch: &Stretch) -> Option<f64> {
    let frames = stretch.frames();
    let least = (WINDOW_SECS * RATE_HZ) as usize;
    let mean: [f64; 2] = core::array::from_fn(|axis| {
        stretch.head.iter().map(|place| place[axis]).sum::<f64>() / frames as f64
    });
    let way: Vec<[f64; 2]> = stretch
        .head
        .iter()
        .map(|place| [place[0] - mean[0], place[1] - mean[1]])
        .collect();
    let product = |a: &[f64; 2], b: &[f64; 2]| a[0] * b[0] + a[1] * b[1];
    let like = |lag: usize| {
        let pairs = || way.iter().zip(&way[lag..]);
        let together: f64 = pairs().map(|(a, b)| product(a, b)).sum();
        let first: f64 = pairs().map(|(a, _)| product(a, a)).sum();
        let second: f64 = pairs().map(|(_, b)| product(b, b)).sum();
        together / (first * second).sqrt().max(f64::MIN_POSITIVE)
    };
    // What is left to compare must be as long.
    (least..(frames + 1).saturating_sub(least))
        .step_by(6)
        .map(like)
        .reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_model::FEATURE_COUNT;

    /// Hips that swing sideways at 0.3 Hz with this amplitude in leg lengths.
    fn swinging(amplitude: f64, secs: f64) -> Stretch {
        let frames = (secs * RATE_HZ) as usize;
        let at = |frame: usize| amplitude * (TAU * 0.3 * frame as f64 / RATE_HZ).sin();
        let mut row = vec![0.0; FEATURE_COUNT];
        row[feature_offset(Joint::LeftLowerLeg)] = 0.1;
        row[feature_offset(Joint::RightLowerLeg)] = 0.2;
        Stretch {
            begin_secs: 0.0,
            features: vec![row; frames],
            hips: (0..frames).map(|frame| [at(frame), 0.0]).collect(),
            head: (0..frames).map(|frame| [2.0 * at(frame), 0.0]).collect(),
            gaze: vec![[0.0; 2]; frames],
            turned_out: 0.0,
        }
    }

    #[test]
    fn a_swing_has_its_length_speed_band_and_return() {
        let found = measure(&[swinging(0.02, 60.0)], 0.8).unwrap();
        let deviation = 1.6 / 2.0_f64.sqrt();
        assert!((found.sway_cm[0] / deviation - 1.0).abs() < 0.02);
        assert!((found.sway_cm[1] / (2.0 * deviation) - 1.0).abs() < 0.02);
        // A sine goes four times its amplitude in a period.
        assert!((found.speed_cm_s[0] / (4.0 * 1.6 * 0.3) - 1.0).abs() < 0.03);
        let [slow, sway, fast, tremor] = found.spectrum[0];
        assert!((sway / (10.0 * deviation) - 1.0).abs() < 0.05, "{sway}");
        assert!(
            slow < 0.1 && fast < 0.1 && tremor < 0.1,
            "{:?}",
            found.spectrum[0]
        );
        assert!(found.return_correlation.unwrap() > 0.99);
        assert!(
            (found.knees_deg[0] - 5.73).abs() < 0.01 && (found.knees_deg[1] - 11.46).abs() < 0.01
        );
        assert_eq!(measure(&[swinging(0.02, 15.0)], 0.8), None);
    }
}
