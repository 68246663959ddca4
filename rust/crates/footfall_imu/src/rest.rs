//! Rest of a sensor: its measurements while still, which are its errors and gravity.

use crate::sample::{ImuRecording, ImuSample};
use glam::Vec3;

/// Length of a rest, seconds.
const REST_SECS: f64 = 0.8;

/// Number of starts tried within that length.
const PARTS: u32 = 4;

/// Largest deviation from the mean at rest of angular rate and specific force, rad/s and m/s², and largest rate that counts as bias.
const DEVIATIONS: [f32; 2] = [0.06, 0.25];
const MOST_BIAS: f32 = 0.3;

/// Measurement of a sensor at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Mean angular rate, in the sensor's axes, rad/s.
    pub rate_bias: Vec3,
    /// Mean specific force, in the sensor's axes, m/s².
    pub force: Vec3,
}

/// Finds the stillest stretch of a recording; `None` if the sensor never rests.
pub fn find_rest(recording: &ImuRecording) -> Option<Rest> {
    let mut best: Option<(f32, Rest)> = None;
    let samples = &recording.samples;
    let mut start_secs = recording.start_secs();
    let last_secs = start_secs + recording.duration_secs() - REST_SECS;
    while start_secs <= last_secs {
        let at = |secs: f64| samples.partition_point(|sample| sample.time_secs < secs);
        let window = &samples[at(start_secs)..at(start_secs + REST_SECS)];
        if let Some((unrest, rest)) = judge(window)
            && best.is_none_or(|(least, _)| unrest < least)
        {
            best = Some((unrest, rest));
        }
        start_secs += REST_SECS / f64::from(PARTS);
    }
    best.map(|(_, rest)| rest)
}

/// Unrest and mean measurement of some samples; `None` where the sensor does not rest.
fn judge(samples: &[ImuSample]) -> Option<(f32, Rest)> {
    let count = samples.len() as f32;
    if samples.len() < 8 {
        return None;
    }
    let of = |pick: fn(&ImuSample) -> Vec3| {
        let mean = samples.iter().map(pick).sum::<Vec3>() / count;
        let squares = samples.iter().map(|s| pick(s).distance_squared(mean));
        (mean, (squares.sum::<f32>() / count).sqrt())
    };
    let (rate_bias, rate) = of(|sample| sample.rate);
    let (force_mean, force) = of(|sample| sample.force);
    let rests = rate < DEVIATIONS[0] && force < DEVIATIONS[1] && rate_bias.length() < MOST_BIAS;
    rests.then_some((
        rate / DEVIATIONS[0] + force / DEVIATIONS[1],
        Rest {
            rate_bias,
            force: force_mean,
        },
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::GRAVITY_MPS2;

    /// A sensor with a bias and a scale that swings, rests from 3 s to 4.5 s, and swings again.
    fn recording(rests: bool) -> ImuRecording {
        let samples = (0..800).map(|n| {
            let time_secs = f64::from(n) * 0.01;
            let still = rests && (3.0..4.5).contains(&time_secs);
            let swing = if still { 0.0 } else { 2.0 };
            let wave = (time_secs as f32 * 7.0).sin();
            let hiss = 0.01 * (n as f32 * 78.233).sin();
            ImuSample {
                time_secs,
                force: Vec3::new(hiss, 0.97 * GRAVITY_MPS2 + swing * wave, 0.0),
                rate: Vec3::new(0.03, -0.01 + hiss, 0.5 * swing * wave),
            }
        });
        ImuRecording {
            samples: samples.collect(),
        }
    }

    #[test]
    fn bias_and_gravity_are_those_of_the_rest() {
        let rest = find_rest(&recording(true)).unwrap();
        assert!(
            rest.rate_bias.distance(Vec3::new(0.03, -0.01, 0.0)) < 2e-3,
            "{rest:?}"
        );
        assert!(
            (rest.force.length() - 0.97 * GRAVITY_MPS2).abs() < 0.01,
            "{rest:?}"
        );
    }

    #[test]
    fn who_never_rests_tells_nothing() {
        assert_eq!(find_rest(&recording(false)), None);
        assert_eq!(find_rest(&ImuRecording { samples: vec![] }), None);
    }
}
