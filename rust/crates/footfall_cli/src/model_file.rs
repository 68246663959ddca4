//! Models and styles on disk.

use anyhow::{Context as _, Result};
use footfall_model::{DynamicsModel, GaitModel, GaitStyle, ImuModel};
use std::fs;
use std::path::Path;

/// Reads a `.footfall` file; errors name it.
pub(crate) fn read_model(path: &Path) -> Result<GaitModel> {
    let bytes =
        fs::read(path).with_context(|| format!("{}: cannot read the model", path.display()))?;
    GaitModel::from_bytes(&bytes).with_context(|| path.display().to_string())
}

/// Reads a `.footstyle` file; errors name it.
pub(crate) fn read_style(path: &Path) -> Result<GaitStyle> {
    let bytes =
        fs::read(path).with_context(|| format!("{}: cannot read the style", path.display()))?;
    GaitStyle::from_bytes(&bytes).with_context(|| path.display().to_string())
}

/// Reads a `.footdyn` file; errors name it.
pub(crate) fn read_dynamics(path: &Path) -> Result<DynamicsModel> {
    let bytes =
        fs::read(path).with_context(|| format!("{}: cannot read the model", path.display()))?;
    DynamicsModel::from_bytes(&bytes).with_context(|| path.display().to_string())
}

/// Reads a `.footimu` file; errors name it.
pub(crate) fn read_imu_model(path: &Path) -> Result<ImuModel> {
    let bytes =
        fs::read(path).with_context(|| format!("{}: cannot read the model", path.display()))?;
    ImuModel::from_bytes(&bytes).with_context(|| path.display().to_string())
}
