//! Recordings from files of their own, for tools in which a person picks them one by one.

use crate::adapt::{AdaptConfig, AdaptMethod, Adapted, adapt_style};
use crate::error::TrainError;
use crate::progress::{Progress, advance};
use crate::train::TrainingClip;
use footfall_model::{GaitModel, Provenance};
use footfall_motion::corpus::{PersonFile, find_people, options_of};
use footfall_motion::recording::Recording;
use footfall_motion::retarget::RetargetOptions;
use std::path::PathBuf;

/// Recordings, and who walks in each.
#[derive(Clone, Debug, Default)]
pub struct Recordings(pub Vec<(String, Recording)>);

impl Recordings {
    /// Reads files; each comes with the name of who walks in it. [Hip joints](footfall_motion::hip_centres) are found person by person.
    ///
    /// # Errors
    /// [`TrainError::Recording`] names the file; [`TrainError::NoRecordings`] where there is none.
    pub fn read(
        chosen: &[(PathBuf, String)],
        progress: &mut dyn Progress,
    ) -> Result<Self, TrainError> {
        if chosen.is_empty() {
            return Err(TrainError::NoRecordings);
        }
        let mut read = Vec::with_capacity(chosen.len());
        let options = RetargetOptions::default();
        let files: Vec<PersonFile<'_>> = chosen
            .iter()
            .map(|(path, subject)| PersonFile {
                path,
                subject,
                is_plain: true,
            })
            .collect();
        let people = find_people(&files, &options);
        for (done, (path, subject)) in chosen.iter().enumerate() {
            advance(progress, "reading", done, chosen.len())?;
            let recording = Recording::read(path, &options_of(&people, path, &options))?;
            read.push((subject.clone(), recording));
        }
        Ok(Self(read))
    }

    /// As training takes them.
    pub fn clips(&self) -> Vec<TrainingClip> {
        let read = self.0.iter();
        read.map(|(subject, recording)| {
            TrainingClip::new(subject, &recording.retargeted, &recording.walks)
        })
        .collect()
    }

    /// Adapts a walk to the first so many of their steps, in the way that suits a dozen best, and calls the result `name`.
    ///
    /// # Errors
    /// As [`adapt_style`].
    pub fn adapt(
        &self,
        base: &GaitModel,
        name: &str,
        steps: usize,
        made_from: Provenance,
        progress: &mut dyn Progress,
    ) -> Result<Adapted, TrainError> {
        let config = AdaptConfig {
            method: AdaptMethod::Csmaplr,
            steps: Some(steps),
        };
        adapt_style(base, &self.clips(), name, &config, made_from, progress)
    }
}
