//! Recordings as CSV: header `time_s,ax,ay,az,gx,gy,gz`; specific force in m/s², angular rate in rad/s. Files of other programs are read if their header has units.

use crate::columns::Columns;
use crate::sample::{ImuRecording, ImuSample};
use glam::Vec3;
use std::path::{Path, PathBuf};

const HEADER: [&str; 7] = ["time_s", "ax", "ay", "az", "gx", "gy", "gz"];

/// Longest recording that is read, samples: a day at 200 Hz is shorter.
const MAX_SAMPLES: usize = 20_000_000;

/// Errors of reading a recording.
#[derive(Debug, thiserror::Error)]
pub enum ImuCsvError {
    /// The file cannot be opened or is no CSV file.
    #[error("{}: {source}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// Underlying error, with the line if there is one.
        source: csv::Error,
    },
    /// The header is another.
    #[error("{}, line 1: the columns are {found}; they must be time_s,ax,ay,az,gx,gy,gz, or have names and units such as 'Time (s)', 'Gyroscope X (deg/s)' and 'Accelerometer X (g)'", path.display())]
    Header {
        /// The file.
        path: PathBuf,
        /// Header of the file.
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
        /// Text of the value.
        value: String,
    },
    /// There are too few samples, or too many.
    #[error("{}: {found} samples; there must be 2 to {MAX_SAMPLES}", path.display())]
    Samples {
        /// The file.
        path: PathBuf,
        /// Number of samples in the file.
        found: usize,
    },
}

/// Reads a recording.
///
/// # Errors
/// [`ImuCsvError`] names file, line and column.
pub fn read(path: &Path) -> Result<ImuRecording, ImuCsvError> {
    let reader = csv::Reader::from_path(path).map_err(|source| ImuCsvError::Csv {
        path: path.to_owned(),
        source,
    })?;
    parse(reader, path)
}

/// Parses the text of a recording's file; `path` names it in errors.
///
/// # Errors
/// As [`read`].
pub fn parse_text(text: &str, path: &Path) -> Result<ImuRecording, ImuCsvError> {
    parse(csv::Reader::from_reader(text.as_bytes()), path)
}

fn parse(
    mut reader: csv::Reader<impl std::io::Read>,
    path: &Path,
) -> Result<ImuRecording, ImuCsvError> {
    let csv_error = |source| ImuCsvError::Csv {
        path: path.to_owned(),
        source,
    };
    let header = reader.headers().map_err(csv_error)?;
    let cells = Cells::of(header).ok_or_else(|| ImuCsvError::Header {
        path: path.to_owned(),
        found: header.iter().collect::<Vec<_>>().join(","),
    })?;
    let mut samples: Vec<ImuSample> = Vec::new();
    let mut before = csv::StringRecord::new();
    for record in reader.records() {
        let record = record.map_err(csv_error)?;
        // Other programs write a line twice.
        if cells != Cells::OWN && record == before {
            continue;
        }
        let last = samples.last().map(|sample| sample.time_secs);
        let mut row = [0.0; 7];
        let texts = cells.of_record(&record).zip(HEADER);
        for (value, ((text, scale), column)) in row.iter_mut().zip(texts) {
            let number = text.trim().parse().map(|number: f64| number * scale);
            let number = number.ok().filter(|number| {
                let in_order = column != HEADER[0] || last.is_none_or(|last| *number > last);
                // Values are kept as f32, and what overflows there is no measurement.
                number.abs() < 1e30 && in_order
            });
            *value = number.ok_or_else(|| ImuCsvError::Value {
                path: path.to_owned(),
                line: record.position().map_or(0, csv::Position::line),
                column,
                value: text.to_owned(),
            })?;
        }
        let [time_secs, force @ .., gx, gy, gz] = row;
        samples.push(ImuSample {
            time_secs,
            force: Vec3::from_array(force.map(|value| value as f32)),
            rate: Vec3::from_array([gx, gy, gz].map(|value| value as f32)),
        });
        if samples.len() > MAX_SAMPLES {
            break;
        }
        before = record;
    }
    if !(2..=MAX_SAMPLES).contains(&samples.len()) {
        return Err(ImuCsvError::Samples {
            path: path.to_owned(),
            found: samples.len(),
        });
    }
    Ok(ImuRecording { samples })
}

/// Places of time, specific force and angular rate in a line, and the factors to their units.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cells {
    places: [usize; 7],
    scales: [f64; 7],
}

impl Cells {
    /// Those of [`HEADER`].
    const OWN: Self = Self {
        places: [0, 1, 2, 3, 4, 5, 6],
        scales: [1.0; 7],
    };

    /// Returns those of a header; `None` if it is not [`HEADER`] and does not name all channels and their units.
    fn of(header: &csv::StringRecord) -> Option<Self> {
        if header.iter().map(str::trim).eq(HEADER) {
            return Some(Self::OWN);
        }
        let columns = Columns::of_names(header.iter())?;
        let mut cells = Self::OWN;
        cells.places[0] = columns.time?;
        cells.places[1..].copy_from_slice(&columns.values);
        cells.scales[0] = columns.units.time?.seconds();
        cells.scales[1..4].fill(columns.units.force?.mps2());
        cells.scales[4..].fill(columns.units.rate?.radps());
        Some(cells)
    }

    fn of_record<'a>(&self, record: &'a csv::StringRecord) -> impl Iterator<Item = (&'a str, f64)> {
        let cells = self.places.into_iter().zip(self.scales);
        cells.map(|(place, scale)| (record.get(place).unwrap_or_default(), scale))
    }
}

/// The first line of a recording's file.
pub(crate) fn header() -> String {
    HEADER.join(",")
}

/// A sample's line. Numbers are as short as they can be and still read back exactly.
pub(crate) fn line(sample: &ImuSample) -> String {
    let (force, rate) = (sample.force, sample.rate);
    let values = [force.x, force.y, force.z, rate.x, rate.y, rate.z];
    let values = values.map(|value| value.to_string());
    format!("{},{}", sample.time_secs, values.join(","))
}

/// The text of a recording's file, which reads back exactly.
pub fn write(recording: &ImuRecording) -> String {
    let rows = recording.samples.iter().map(line);
    let lines: Vec<String> = core::iter::once(header()).chain(rows).collect();
    lines.join("\n") + "\n"
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
        assert!((recording.rate_hz() - 100.0).abs() < 1e-6);
        assert_eq!(recording.samples.len(), 3);
        assert!((recording.samples[0].force.y - 9.81).abs() < 1e-6);
        assert!((recording.channels()[2][5] - 6.0).abs() < 1e-12);
        assert_eq!(read_text(&write(&recording)).unwrap(), recording);
        for (text, part) in [
            (good.replace("1.01,1", "1.01,nan"), "line 3: ax is 'nan'"),
            (good.replace("1.01,1", "1.01,1e39"), "line 3: ax is '1e39'"),
            (good.replace("1.02,", "1.01,"), "line 4: time_s"),
            (good.replace("gx", "rx"), "line 1"),
            (format!("{head}1,0,0,0,0,0,0\n"), "1 samples"),
            (good.replace("1.01,1,", "1.01,"), "line"),
        ] {
            let error = read_text(&text).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }

    #[test]
    fn a_recording_of_another_program_is_read_in_its_units() {
        let text = "Time (s),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g)\n\
                    0,180,0,0,0,1,0\n0,180,0,0,0,1,0\n0.01,0,0,90,0,0,-2\n";
        let recording = read_text(text).unwrap();
        let [first, second] = recording.samples[..] else {
            panic!("{recording:?}")
        };
        assert!(
            (first.force - Vec3::Y * 9.80665).length() < 1e-4,
            "{first:?}"
        );
        assert!((first.rate - Vec3::X * core::f32::consts::PI).length() < 1e-6);
        assert!((second.rate.z - core::f32::consts::FRAC_PI_2).abs() < 1e-6);
        let micros = text.replace("Time (s)", "Timestamp (us)");
        let micros = micros.replace("\n0.01,", "\n10000,");
        assert_eq!(read_text(&micros).unwrap(), recording);
        for (part, other, fault) in [
            ("0.01,", "0,", "line 4: time_s"),
            (" (deg/s)", "", "line 1"),
            (" (g)", "", "line 1"),
            ("Accelerometer Z", "Magnetometer Z", "line 1"),
            ("Time (s)", "Packet", "line 1"),
        ] {
            let error = read_text(&text.replace(part, other)).unwrap_err();
            assert!(error.to_string().contains(fault), "{other}: {error}");
        }
    }
}
