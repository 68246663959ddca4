//! Whatever a sensor or a file gives, nothing panics.

use footfall_imu::events::{detect_swings, events_of};
use footfall_imu::strides::measure_strides;
use footfall_imu::{FeatureStream, ImuRecording, ImuSample, check_recording, csv};
use glam::Vec3;
use proptest::prelude::*;
use std::path::Path;

fn any_vector(most: f32) -> impl Strategy<Value = Vec3> {
    proptest::array::uniform3(-most..most).prop_map(Vec3::from_array)
}

fn any_recording() -> impl Strategy<Value = ImuRecording> {
    let sample = (1e-4_f64..0.3, any_vector(200.0), any_vector(60.0));
    proptest::collection::vec(sample, 2..400).prop_map(|rows| {
        let mut time_secs = -5.0;
        let samples = rows.into_iter().map(|(step, force, rate)| {
            time_secs += step;
            ImuSample {
                time_secs,
                force,
                rate,
            }
        });
        ImuRecording {
            samples: samples.collect(),
        }
    })
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(lines in proptest::collection::vec("[-0-9.,eE+ainf\" ]{0,40}", 0..12)) {
        let text = format!("time_s,ax,ay,az,gx,gy,gz\n{}", lines.join("\n"));
        if let Ok(recording) = csv::parse_text(&text, Path::new("any.csv")) {
            prop_assert!(recording.samples.len() >= 2);
            prop_assert!(recording.samples.iter().all(ImuSample::is_finite));
            // What was read is written and read again, exactly.
            prop_assert_eq!(csv::parse_text(&csv::write(&recording), Path::new("again.csv")).unwrap(), recording);
        }
    }

    #[test]
    fn any_recording_has_events_and_strides_in_order(recording in any_recording()) {
        let _verdict = check_recording(&recording);
        let swings = detect_swings(&recording);
        let events = events_of(&swings);
        prop_assert!(events.windows(2).all(|pair| pair[0].time_secs <= pair[1].time_secs));
        for stride in measure_strides(&recording, &swings) {
            prop_assert!(stride.start_secs < stride.end_secs && stride.length_m.is_finite());
        }
    }

    #[test]
    fn any_samples_give_frames_in_order(
        recording in any_recording(),
        broken in proptest::collection::vec((0_usize..400, 0_u8..4), 0..20),
    ) {
        let mut samples = recording.samples;
        for (place, how) in broken {
            let count = samples.len();
            let sample = &mut samples[place % count];
            match how {
                0 => sample.force.x = f32::NAN,
                1 => sample.rate.z = f32::INFINITY,
                2 => sample.time_secs = f64::NAN,
                _ => sample.time_secs -= 3.0,
            }
        }
        let mut stream = FeatureStream::new(30.0);
        let mut last = f64::NEG_INFINITY;
        let mut frames = 0_usize;
        for sample in samples {
            stream.push(sample, |frame| {
                assert!(frame.time_secs > last, "time goes on");
                last = frame.time_secs;
                frames += 1;
                let values = frame.values.unwrap_or_default();
                assert!(values.iter().all(|value| value.is_finite()));
                assert!(frame.world_from_sensor.is_finite() && frame.tilt_deviation.is_finite());
            });
        }
        prop_assert!(frames < 400 * 30);
    }
}
