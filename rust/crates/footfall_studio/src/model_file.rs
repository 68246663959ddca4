//! Models that come with the add-on.

use std::path::{Path, PathBuf};

/// A model that comes with the add-on, where the studio is started in or near its folder.
pub(crate) fn shipped_model(name: &str) -> Option<PathBuf> {
    let here = std::env::current_dir().ok();
    let program = std::env::current_exe().ok();
    let starts = [here, program].into_iter().flatten();
    starts
        .flat_map(|start| start.ancestors().map(Path::to_owned).collect::<Vec<_>>())
        .map(|folder| folder.join("addons/footfall/models").join(name))
        .find(|path| path.is_file())
}
