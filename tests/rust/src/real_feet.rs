//! Recordings of real sensors on feet, where the folder with recordings has them.

use footfall_imu::{ImuRecording, ImuSample};
use glam::Vec3;
use std::path::Path;

/// A recording of ipol's data set: person 1 to 8, trial 1 or 2, `lf` or `rf`.
///
/// Numbers of samples that were lost on the way are missing, so that times show it.
pub fn ipol(data: &Path, person: u32, trial: u32, foot: &str) -> ImuRecording {
    let file = format!("imu/ipol_voisard/GaitData/{person}-{trial}_{foot}.txt");
    let rows = rows(&data.join(file));
    let sample = |row: Vec<f64>| (row[0] / 100.0, [1, 2, 3, 4, 5, 6].map(|n| row[n]));
    recording(rows.into_iter().map(sample))
}

/// A loop that ends where it began, of x-io: `short_walk` or `long_walk`.
pub fn xio(data: &Path, name: &str) -> ImuRecording {
    let path = data.join(format!("imu/xio_gait_tracking/{name}.csv"));
    footfall_imu::csv::read(&path).expect("a recording")
}

/// Rows of seven numbers or more, after two lines.
fn rows(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).expect("a recording");
    let row = |line: &str| -> Vec<f64> {
        let fields = line.split('\t');
        fields.filter_map(|f| f.trim().parse().ok()).collect()
    };
    let rows = text.lines().skip(2).map(row);
    rows.filter(|row| row.len() >= 7).collect()
}

fn recording(rows: impl Iterator<Item = (f64, [f64; 6])>) -> ImuRecording {
    let mut samples: Vec<ImuSample> = Vec::new();
    for (time_secs, row) in rows {
        let vector = |n: usize| Vec3::new(row[n] as f32, row[n + 1] as f32, row[n + 2] as f32);
        // A time that comes twice is left out.
        if samples.last().is_none_or(|last| time_secs > last.time_secs) {
            samples.push(ImuSample {
                time_secs,
                force: vector(0),
                rate: vector(3),
            });
        }
    }
    ImuRecording { samples }
}
