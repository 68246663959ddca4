//! The model with its styles, prepared for walkers.

use super::GaitGenerator3D;
use crate::gait_model::NO_MODEL;
use crate::gait_style;
use crate::walk_source::WalkSource;
use footfall_model::WalkModel;
use std::sync::Arc;

impl GaitGenerator3D {
    fn trained(&self) -> Result<Arc<WalkModel>, String> {
        let Some(model) = &self.model else {
            return Err(NO_MODEL.to_owned());
        };
        model.bind().trained().map_err(|error| {
            let path = model.get_path();
            let name = if path.is_empty() { "it".into() } else { path };
            format!("The gait model cannot be used ({name}): {error}")
        })
    }

    /// The model with its styles, prepared if it is not yet or if a resource has changed.
    pub(super) fn take_source(&mut self) -> Result<WalkSource, String> {
        if let Some(source) = &self.source
            && self.is_current(source)
        {
            return Ok(source.clone());
        }
        let source = self.find_source()?;
        self.source = Some(source.clone());
        Ok(source)
    }

    /// Whether a source is that of the resources as they are now.
    fn is_current(&self, source: &WalkSource) -> bool {
        let model = self.model.as_ref().map(|model| model.bind().trained());
        let known = source.styles();
        matches!(model, Some(Ok(model)) if source.is_of(&model))
            && known.len() == self.styles.len()
            && self.styles.iter_shared().zip(known).all(|(style, known)| {
                let style = style.map(|style| style.bind().trained());
                matches!(style, Some(Ok(style)) if Arc::ptr_eq(&style, known))
            })
    }

    pub(super) fn find_source(&self) -> Result<WalkSource, String> {
        self.trained()?;
        let styles = gait_style::trained_all(&self.styles)?;
        let Some(model) = &self.model else {
            return Err(NO_MODEL.to_owned());
        };
        let mut model = model.clone();
        let source = model.bind_mut().source(&styles);
        source.map_err(|error| format!("The styles cannot be worn: {error}"))
    }
}
