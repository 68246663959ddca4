//! Reading of model files.

use footfall_model::ModelFileError;
use std::path::{Path, PathBuf};

/// Reasons why a model file cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadModelError {
    /// The file is not there, or may not be read.
    #[error("{path}: cannot read the model: {error}", path = path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The reason.
        error: std::io::Error,
    },
    /// The file holds no such model.
    #[error("{path}: {error}", path = path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// The reason.
        error: ModelFileError,
    },
}

/// Reads a file as a model or a style, by the `from_bytes` of its type.
///
/// # Errors
/// [`ReadModelError`], which names the file.
pub fn read_model_file<T>(
    path: &Path,
    from_bytes: fn(&[u8]) -> Result<T, ModelFileError>,
) -> Result<T, ReadModelError> {
    let bytes = std::fs::read(path).map_err(|error| ReadModelError::Io {
        path: path.to_owned(),
        error,
    })?;
    from_bytes(&bytes).map_err(|error| ReadModelError::Content {
        path: path.to_owned(),
        error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_model::{GaitModel, GaitStyle};

    #[test]
    fn errors_name_the_file_and_what_is_wrong() {
        let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../addons/footfall/models");
        let style = models.join("sad.footstyle");
        assert!(read_model_file(&style, GaitStyle::from_bytes).is_ok());
        let error = read_model_file(&style, GaitModel::from_bytes).unwrap_err();
        assert!(matches!(error, ReadModelError::Content { .. }), "{error}");
        assert!(error.to_string().contains("sad.footstyle: "), "{error}");
        let missing = models.join("missing.footfall");
        let error = read_model_file(&missing, GaitModel::from_bytes).unwrap_err();
        assert!(
            error.to_string().contains("missing.footfall: cannot read"),
            "{error}"
        );
    }
}
