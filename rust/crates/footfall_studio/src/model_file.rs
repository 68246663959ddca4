//! Models and styles on disk.

use footfall_model::{GaitModel, GaitStyle, ImuModel};
use std::path::{Path, PathBuf};

pub(crate) fn read_model(path: &Path) -> Result<GaitModel, String> {
    read(path, GaitModel::from_bytes)
}

pub(crate) fn read_style(path: &Path) -> Result<GaitStyle, String> {
    read(path, GaitStyle::from_bytes)
}

pub(crate) fn read_imu_model(path: &Path) -> Result<ImuModel, String> {
    read(path, ImuModel::from_bytes)
}

/// Reads a file of ours; errors name it.
fn read<T, E: ToString>(path: &Path, parse: fn(&[u8]) -> Result<T, E>) -> Result<T, String> {
    let name = path.display();
    let bytes = std::fs::read(path).map_err(|error| format!("{name}: {error}"))?;
    parse(&bytes).map_err(|error| format!("{name}: {}", error.to_string()))
}

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
