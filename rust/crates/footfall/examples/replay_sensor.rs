//! Replays the recording of one foot sensor in real time, and drives a whole body by it.
//!
//! `cargo run --example replay_sensor [IMU.csv]`
#![expect(clippy::print_stdout, reason = "examples print")]

use footfall::body::Pose;
use footfall::model::ImuModel;
use footfall::reconstruction::{Prepared, ReconConfig, Reconstructor};
use footfall::sensor::{ImuRecording, csv};
use std::path::Path;
use std::sync::Arc;
use std::{env, error, fs};

/// The project's model for a sensor on the right foot.
const MODEL: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../../addons/footfall/models/right_foot.footimu"
);
/// Measurements of such a sensor on a generated walk.
pub(crate) const RECORDING: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../../tests/data/walker_1_slow.right_foot.csv"
);
pub(crate) const DT_SECS: f32 = 1.0 / 60.0;

/// A body at the origin that waits for samples.
pub(crate) fn body() -> Result<Reconstructor, Box<dyn error::Error>> {
    let model = Arc::new(ImuModel::from_bytes(&fs::read(MODEL)?)?);
    let skeleton = model.skeleton.clone();
    let prepared = Arc::new(Prepared::new(model)?);
    Ok(Reconstructor::new(
        &prepared,
        &skeleton,
        &ReconConfig::default(),
    )?)
}

/// Replays a recording at 60 frames a second; `show` receives every frame's time in seconds, the body and its pose.
pub(crate) fn replay(
    recording: &ImuRecording,
    body: &mut Reconstructor,
    mut show: impl FnMut(f64, &Reconstructor, &Pose),
) {
    let mut samples = recording.samples.iter().peekable();
    let mut pose = Pose::default();
    let mut now = recording.start_secs();
    while samples.peek().is_some() {
        now += f64::from(DT_SECS);
        while let Some(sample) = samples.next_if(|sample| sample.time_secs <= now) {
            body.push(0, *sample);
        }
        body.step(DT_SECS, &mut pose);
        show(now, body, &pose);
    }
}

fn main() -> Result<(), Box<dyn error::Error>> {
    let file = env::args().nth(1).unwrap_or_else(|| RECORDING.to_owned());
    let recording = csv::read(Path::new(&file))?;
    println!(
        "{} samples, {:.0} a second",
        recording.samples.len(),
        recording.rate_hz()
    );
    replay(&recording, &mut body()?, |secs, body, pose| {
        for (foot, landing) in ["left", "right"].iter().zip(body.landings()) {
            if let Some(place) = landing {
                let does = body.behaviour().name();
                let hips = pose.root_position.z;
                println!(
                    "{secs:5.2} s  {does}: the {foot} foot lands at {:.2} m, hips at {hips:.2} m",
                    place.z
                );
            }
        }
    });
    Ok(())
}
