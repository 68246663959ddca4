//! The work itself, on the job's thread.

use crate::job::Reporter;
use crate::library::Library;
use footfall_model::{GaitModel, Provenance};
use footfall_motion::recording::Recording;
use footfall_prob::windows::Windows;
use footfall_train::{
    AdaptConfig, Adapted, EmConfig, TrainConfig, Trained, adapt_style, train_average,
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

fn provenance(what: &str) -> Provenance {
    Provenance {
        corpus: what.to_owned(),
        terms: "not stated".to_owned(),
        command: "footfall studio".to_owned(),
        ..Provenance::default()
    }
}

pub(super) fn train(
    recorded: &[Recording],
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
        recorded,
        &config,
        provenance("recordings chosen in Footfall Studio"),
        reporter,
    )
    .map_err(|error| error.to_string())
}

/// Adapts a base model to recordings.
pub(crate) fn adapt_to(
    base: &GaitModel,
    recorded: &[Recording],
    name: &str,
    steps: usize,
    reporter: &mut Reporter,
) -> Result<Adapted, String> {
    let made_from = provenance("recordings chosen in Footfall Studio");
    let config = AdaptConfig::first_steps(steps);
    adapt_style(base, recorded, name, &config, made_from, reporter)
        .map_err(|error| error.to_string())
}
