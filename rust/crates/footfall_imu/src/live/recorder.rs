//! Samples into a file, which replays exactly.

use crate::csv;
use crate::sample::ImuSample;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

/// Writes a recording under a temporary name, and gives it its name when it is finished: a crash leaves what was there, and what was recorded.
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    temporary: PathBuf,
    file: BufWriter<File>,
    begin_secs: Option<f64>,
    samples: u64,
}

impl Recorder {
    /// Begins a recording.
    ///
    /// # Errors
    /// The file cannot be made.
    pub fn new(path: &Path) -> io::Result<Self> {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}.part", std::process::id()));
        let temporary = path.with_file_name(name);
        let mut file = BufWriter::new(File::create(&temporary)?);
        writeln!(file, "{}", csv::header())?;
        Ok(Self {
            path: path.to_owned(),
            temporary,
            file,
            begin_secs: None,
            samples: 0,
        })
    }

    /// Writes a sample; times are counted from the first one.
    ///
    /// # Errors
    /// The disk is full or gone.
    pub fn push(&mut self, sample: ImuSample) -> io::Result<()> {
        let begin = *self.begin_secs.get_or_insert(sample.time_secs);
        let sample = ImuSample {
            time_secs: sample.time_secs - begin,
            ..sample
        };
        self.samples += 1;
        writeln!(self.file, "{}", csv::line(&sample))
    }

    /// Samples so far.
    pub const fn samples(&self) -> u64 {
        self.samples
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// The disk is full or gone; what was written stays under its temporary name.
    pub fn finish(self) -> io::Result<()> {
        let file = self
            .file
            .into_inner()
            .map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        drop(file);
        fs::rename(&self.temporary, &self.path)
    }
}
