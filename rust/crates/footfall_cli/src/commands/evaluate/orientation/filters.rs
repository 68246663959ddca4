//! The filters that are compared, each as a function from samples to the vertical.

use footfall_core::rotation::{exp_map, shortest_arc};
use footfall_imu::{ImuRecording, OrientationFilter};
use glam::{DQuat, DVec3, Quat, Vec3};
use vqf_rs::VQF;

/// Up in the sensor's axes after each sample of an evenly spaced recording.
type Verticals = fn(&ImuRecording) -> Vec<Vec3>;

/// Names of the filters and how each is run.
pub(super) const FILTERS: [(&str, Verticals); 3] = [
    ("gyroscope alone", gyroscope_alone),
    ("VQF", vqf),
    ("Footfall", footfall),
];

/// The trivial answer: the vertical of the first sample, turned by the angular rate.
fn gyroscope_alone(recording: &ImuRecording) -> Vec<Vec3> {
    let dt = recording.rate_hz().recip() as f32;
    let mut turn: Option<Quat> = None;
    let samples = recording.samples.iter();
    samples
        .map(|sample| {
            let next = match turn {
                None => shortest_arc(sample.force, Vec3::Y),
                Some(turn) => (turn * exp_map(sample.rate * dt)).normalize(),
            };
            turn = Some(next);
            next.conjugate() * Vec3::Y
        })
        .collect()
}

/// VQF (Laidig and Seel, 2023) without magnetometer, with its published parameters.
fn vqf(recording: &ImuRecording) -> Vec<Vec3> {
    let mut filter = VQF::new(recording.rate_hz().recip(), None, None, None);
    let samples = recording.samples.iter();
    samples
        .map(|sample| {
            let [rate, force] = [sample.rate, sample.force].map(|v| v.as_dvec3().to_array());
            filter.update(rate, force, None);
            let turn = filter.quat_6d();
            let earth_from_sensor = DQuat::from_xyzw(turn.1, turn.2, turn.3, turn.0);
            (earth_from_sensor.conjugate() * DVec3::Z).as_vec3()
        })
        .collect()
}

fn footfall(recording: &ImuRecording) -> Vec<Vec3> {
    let dt = recording.rate_hz().recip() as f32;
    let mut filter: Option<OrientationFilter> = None;
    let samples = recording.samples.iter();
    samples
        .map(|sample| match &mut filter {
            None => filter.insert(OrientationFilter::new(sample.force)).up(),
            Some(filter) => {
                filter.step(dt, sample.force, sample.rate);
                filter.up()
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_imu::{GRAVITY_MPS2, ImuSample};

    #[test]
    fn all_of_them_follow_a_sensor_that_turns_slowly() {
        let rate = Vec3::new(0.3, 0.2, -0.4);
        let mut turn = exp_map(Vec3::new(0.5, 0.0, 0.3));
        let mut ups = Vec::new();
        let samples = (0..500).map(|n| {
            if n > 0 {
                turn *= exp_map(rate * 0.01);
            }
            ups.push(turn.conjugate() * Vec3::Y);
            ImuSample {
                time_secs: f64::from(n) * 0.01,
                force: turn.conjugate() * Vec3::Y * GRAVITY_MPS2,
                rate,
            }
        });
        let recording = ImuRecording {
            samples: samples.collect(),
        };
        for (name, verticals) in FILTERS {
            let found = verticals(&recording);
            let worst = found.iter().zip(&ups).map(|(a, b)| a.angle_between(*b));
            let worst = worst.fold(0.0, f32::max);
            assert!(worst < 0.02, "{name}: {worst} rad");
        }
    }
}
