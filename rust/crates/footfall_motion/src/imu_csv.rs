//! Recordings of an inertial sensor as CSV: header `time_s,ax,ay,az,gx,gy,gz`; specific force in m/s², angular rate in rad/s.

use std::path::{Path, PathBuf};

const HEADER: [&str; 7] = ["time_s", "ax", "ay", "az", "gx", "gy", "gz"];

/// Longest recording that is read, samples: a day at 200 Hz is shorter.
const MAX_SAMPLES: usize = 20_000_000;

/// A recording of one sensor, in its own axes.
#[derive(Clone, Debug, PartialEq)]
pub struct ImuRecording {
    /// Samples per second: the number of steps in time over the whole time.
    pub rate_hz: f64,
    /// Time of the first sample, seconds.
    pub start_secs: f64,
    /// Specific force x, y, z (m/s²), then angular rate x, y, z (rad/s).
    pub samples: Vec<[f64; 6]>,
}

/// Why a recording cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ImuCsvError {
    /// The file cannot be opened or is no CSV file.
    #[error("{}: {source}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the line if there is one.
        source: csv::Error,
    },
    /// The header is another.
    #[error("{}, line 1: the columns are {found}; they must be time_s,ax,ay,az,gx,gy,gz", path.display())]
    Header {
        /// The file.
        path: PathBuf,
        /// What it has.
        found: String,
    },
    /// A value is no finite number, or time does not go on.
    #[error("{}, line {line}: {column} is '{value}'; it must be a finite number, and time must rise", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// The column.
        column: &'static str,
        /// What it has.
        value: String,
    },
    /// There are too few samples, or too many.
    #[error("{}: {found} samples; there must be 2 to {MAX_SAMPLES}", path.display())]
    Samples {
        /// The file.
        path: PathBuf,
        /// How many it has.
        found: usize,
    },
}

/// Reads a recording.
///
/// # Errors
/// [`ImuCsvError`] names file, line and column.
pub fn read(path: &Path) -> Result<ImuRecording, ImuCsvError> {
    let csv_error = |source| ImuCsvError::Csv {
        path: path.to_owned(),
        source,
    };
    let mut reader = csv::Reader::from_path(path).map_err(csv_error)?;
    let header = reader.headers().map_err(csv_error)?;
    if header.iter().map(str::trim).ne(HEADER) {
        return Err(ImuCsvError::Header {
            path: path.to_owned(),
            found: header.iter().collect::<Vec<_>>().join(","),
        });
    }
    let mut samples = Vec::new();
    let (mut start_secs, mut last) = (0.0, f64::NEG_INFINITY);
    for record in reader.records() {
        let record = record.map_err(csv_error)?;
        let mut row = [0.0; 7];
        for ((value, text), column) in row.iter_mut().zip(&record).zip(HEADER) {
            let number = text.trim().parse().ok().filter(|number: &f64| {
                number.is_finite() && (column != HEADER[0] || *number > last)
            });
            *value = number.ok_or_else(|| ImuCsvError::Value {
                path: path.to_owned(),
                line: record.position().map_or(0, csv::Position::line),
                column,
                value: text.to_owned(),
            })?;
        }
        let [time, sample @ ..] = row;
        if samples.is_empty() {
            start_secs = time;
        }
        last = time;
        samples.push(sample);
        if samples.len() > MAX_SAMPLES {
            break;
        }
    }
    if !(2..=MAX_SAMPLES).contains(&samples.len()) {
        return Err(ImuCsvError::Samples {
            path: path.to_owned(),
            found: samples.len(),
        });
    }
    Ok(ImuRecording {
        rate_hz: (samples.len() - 1) as f64 / (last - start_secs),
        start_secs,
        samples,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<ImuRecording, ImuCsvError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("imu.csv");
        std::fs::write(&path, text).unwrap();
        read(&path)
    }

    #[test]
    fn a_recording_is_read_and_faults_name_their_line() {
        let head = "time_s,ax,ay,az,gx,gy,gz\n";
        let good = format!("{head}1.0,0,9.81,0,0,0,0.5\n1.01,1,2,3,4,5,6\n1.02,1,2,3,4,5,6\n");
        let recording = read_text(&good).unwrap();
        assert!((recording.rate_hz - 100.0).abs() < 1e-6);
        assert_eq!(recording.samples.len(), 3);
        assert!((recording.samples[0][1] - 9.81).abs() < 1e-12);
        assert!((recording.samples[2][5] - 6.0).abs() < 1e-12);
        for (text, part) in [
            (good.replace("1.01,1", "1.01,nan"), "line 3: ax is 'nan'"),
            (good.replace("1.02,", "1.01,"), "line 4: time_s"),
            (good.replace("gx", "rx"), "line 1"),
            (format!("{head}1,0,0,0,0,0,0\n"), "1 samples"),
            (good.replace("1.01,1,", "1.01,"), "line"),
        ] {
            let error = read_text(&text).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }
}
