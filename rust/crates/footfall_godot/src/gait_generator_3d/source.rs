//! The model with its styles, prepared for walkers.

use super::GaitGenerator3D;
use crate::gait_model::GaitModel;
use crate::gait_style;
use crate::walk_source::WalkSource;
use footfall_model::WalkModel;
use godot::obj::Gd;
use std::sync::Arc;

impl GaitGenerator3D {
    /// The model, or the add-on's own if none is set.
    fn used_model(&self) -> Result<Gd<GaitModel>, String> {
        self.fallback.model(self.model.as_ref())
    }

    /// Returns whether there are styles although the model supports none.
    pub(super) fn passes_over_styles(&self) -> bool {
        !self.styles.is_empty()
            && self
                .used_model()
                .is_ok_and(|model| model.bind().is_switching())
    }

    fn trained(&self) -> Result<Arc<WalkModel>, String> {
        let model = self.used_model()?;
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

    /// Returns whether a source is that of the resources as they are now.
    fn is_current(&self, source: &WalkSource) -> bool {
        let model = self.used_model().and_then(|model| model.bind().trained());
        let known = source.styles();
        model.is_ok_and(|model| source.is_of(&model))
            && (known.len() == self.styles.len() || self.passes_over_styles())
            && self.styles.iter_shared().zip(known).all(|(style, known)| {
                let style = style.map(|style| style.bind().trained());
                matches!(style, Some(Ok(style)) if Arc::ptr_eq(&style, known))
            })
    }

    pub(super) fn find_source(&self) -> Result<WalkSource, String> {
        self.trained()?;
        let styles = if self.passes_over_styles() {
            Vec::new()
        } else {
            gait_style::trained_all(&self.styles)?
        };
        let mut model = self.used_model()?;
        let source = model.bind_mut().source(&styles);
        source.map_err(|error| format!("The styles cannot be used: {error}"))
    }
}
