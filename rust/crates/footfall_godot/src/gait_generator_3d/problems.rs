//! Problems that keep a character from walking, for the editor, scripts and the log.

use super::GaitGenerator3D;
use crate::gait_model::NO_STYLES;
use crate::modifier::BodyModifier as _;
use footfall_core::Side;
use footfall_synth::Gait;
use godot::prelude::*;

/// Facts that were announced last, so that each is announced once.
#[derive(Default)]
pub(super) struct Announced {
    pub(super) gait: Gait,
    /// The foot whose next landing was announced.
    pub(super) landing: Option<Side>,
    pub(super) problem: Option<String>,
    /// True when other animation has taken the body at once and `handed_over` is still to be emitted.
    pub(super) left: bool,
}

impl GaitGenerator3D {
    /// Problems of the model, its styles, the skeleton and the node's place.
    pub(super) fn find_problems(&self) -> PackedStringArray {
        let mut problems = PackedStringArray::new();
        if let Err(problem) = self.find_source() {
            problems.push(&GString::from(&problem));
        }
        if self.passes_over_styles() {
            problems.push(NO_STYLES);
        }
        let (styles, weights) = (self.styles.len(), self.style_weights.len());
        if styles != weights {
            let problem = format!(
                "Styles has {styles} entries, Style Weights has {weights}. Set one weight for every style."
            );
            problems.push(&GString::from(&problem));
        }
        if let Some(problem) = self.skeleton_problem() {
            problems.push(&problem);
        }
        if let Some(skeleton) = self.base().get_skeleton()
            && let Some(problem) = self.find_rivalry(&skeleton)
        {
            problems.push(&GString::from(&problem));
        }
        problems
    }
}
