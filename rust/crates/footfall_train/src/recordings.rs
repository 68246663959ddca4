//! Recordings from files of their own, for tools in which a person picks them one by one.

use crate::error::TrainError;
use crate::progress::{Progress, advance};
use footfall_motion::corpus::{PersonFile, find_people, options_of};
use footfall_motion::recording::Recording;
use footfall_motion::retarget::RetargetOptions;
use footfall_motion::walking_evidence::Manner;
use std::path::PathBuf;

/// Reads files; each comes with the name of who walks in it. [Skeletons](footfall_motion::skeleton_fit) are put right person by person.
///
/// # Errors
/// [`TrainError::Recording`] names the file; [`TrainError::NoRecordings`] where there is none.
pub fn read_recordings(
    chosen: &[(PathBuf, String)],
    progress: &mut dyn Progress,
) -> Result<Vec<Recording>, TrainError> {
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
            manner: Manner::Unlabelled,
        })
        .collect();
    let people = find_people(&files, &options);
    for (done, (path, subject)) in chosen.iter().enumerate() {
        advance(progress, "reading", done, chosen.len())?;
        let recording = Recording::read(path, &options_of(&people, path, &options))?;
        read.push(recording.of_subject(subject));
    }
    Ok(read)
}
