//! The work itself, on the job's thread.

use crate::job::Reporter;
use crate::library::Library;
use footfall_model::{GaitModel, Provenance};
use footfall_motion::recording::Recording;
use footfall_motion::retarget::RetargetOptions;
use footfall_prob::windows::Windows;
use footfall_train::{
    AdaptConfig, AdaptMethod, Adapted, EmConfig, TrainConfig, Trained, TrainingClip, adapt_style,
    train_average,
};
use std::path::PathBuf;

/// Recordings to learn from: the file and who walks.
pub(crate) fn chosen_of(library: &Library) -> Vec<(PathBuf, String)> {
    let chosen = library.chosen().into_iter();
    chosen
        .map(|(path, entry)| {
            // Without an index, a folder stands for a walker.
            let subject = if entry.subject.is_empty() {
                &entry.category
            } else {
                &entry.subject
            };
            (path.clone(), subject.clone())
        })
        .collect()
}

/// Recordings, read, and who walks in them.
pub(crate) struct Recorded(pub(crate) Vec<(String, Recording)>);

impl Recorded {
    pub(crate) fn read(chosen: &[(PathBuf, String)], reporter: &Reporter) -> Result<Self, String> {
        if chosen.is_empty() {
            return Err("no recordings; open some, or tick those to use".to_owned());
        }
        let mut read = Vec::with_capacity(chosen.len());
        for (done, (path, subject)) in chosen.iter().enumerate() {
            if reporter.tell("reading", done, chosen.len()).is_break() {
                return Err("stopped".to_owned());
            }
            let recording = Recording::read(path, &RetargetOptions::default())
                .map_err(|error| error.to_string())?;
            read.push((subject.clone(), recording));
        }
        Ok(Self(read))
    }

    fn clips(&self) -> Vec<TrainingClip> {
        let read = self.0.iter();
        read.map(|(subject, recording)| {
            TrainingClip::new(subject, &recording.retargeted, &recording.walks)
        })
        .collect()
    }
}

fn provenance(what: &str) -> Provenance {
    Provenance {
        corpus: what.to_owned(),
        terms: "not stated".to_owned(),
        command: "footfall studio".to_owned(),
        ..Provenance::default()
    }
}

pub(super) fn train(
    recorded: &Recorded,
    rate_hz: f64,
    iterations: usize,
    reporter: &mut Reporter,
) -> Result<Trained, String> {
    let config = TrainConfig {
        frame_rate_hz: rate_hz,
        windows: Windows::Compact,
        mirror: true,
        em: EmConfig {
            max_iterations: iterations,
            min_gain_per_frame: 1e-3,
        },
    };
    train_average(
        &recorded.clips(),
        &config,
        provenance("recordings chosen in Footfall Studio"),
        reporter,
    )
    .map_err(|error| error.to_string())
}

/// Adapts a base model to recordings.
pub(crate) fn adapt_to(
    base: &GaitModel,
    recorded: &Recorded,
    name: &str,
    steps: usize,
    reporter: &mut Reporter,
) -> Result<Adapted, String> {
    let config = AdaptConfig {
        method: AdaptMethod::Csmaplr,
        steps: Some(steps),
    };
    let made_from = provenance("recordings chosen in Footfall Studio");
    adapt_style(base, &recorded.clips(), name, &config, made_from, reporter)
        .map_err(|error| error.to_string())
}
