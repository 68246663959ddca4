//! Real sensors' recordings that an index names beside its clips.

use crate::output;
use anyhow::Result;
use footfall_core::Site;
use footfall_imu::{ImuRecording, csv};
use footfall_motion::recording::Recording;
use footfall_train::imu::synchronise;
use std::path::{Path, PathBuf};

/// Reads measurements of real sensors during a clip, one recording for each site, on the clip's time; none unless the index names one for
/// each in columns like `imu_right_foot`, relative to itself. One that does not go with its clip is reported, and simulated instead.
///
/// # Errors
/// When the model would overwrite one.
pub(super) fn recordings(
    index: &Path,
    clip: &Recording,
    sites: &[Site],
    model: &Path,
) -> Result<Vec<ImuRecording>> {
    let folder = index.parent().unwrap_or(Path::new(""));
    let named = |site: &Site| {
        let column = format!("imu_{}", site.name());
        clip.row.column(&column).filter(|path| !path.is_empty())
    };
    let Some(paths) = sites.iter().map(named).collect::<Option<Vec<_>>>() else {
        return Ok(Vec::new());
    };
    let paths: Vec<PathBuf> = paths.into_iter().map(|path| folder.join(path)).collect();
    for path in &paths {
        output::refuse_overwrite(&[path], model)?;
    }
    let read = |(site, path): (&Site, &PathBuf)| {
        let recording = csv::read(path).map_err(|error| error.to_string())?;
        let body = &clip.retargeted;
        let found = synchronise(&body.clip, body.first_frame, *site, &recording)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        output::note(&format!(
            "{}: begins {:.3} s before {}, correlation {:.3}",
            path.display(),
            found.offset_secs - recording.start_secs(),
            clip.row.path.display(),
            found.correlation
        ));
        Ok(found.recording)
    };
    let all: Result<Vec<ImuRecording>, String> = sites.iter().zip(&paths).map(read).collect();
    Ok(all.unwrap_or_else(|reason| {
        output::note(&format!(
            "warning: a simulated sensor is used instead: {reason}"
        ));
        Vec::new()
    }))
}
