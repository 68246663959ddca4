//! Interface of the generator to the nodes beside it and to the editor.

use super::GaitGenerator3D;
use super::ownership::Ownership;
use crate::skeleton_binding::LayerWeights;
use footfall_ik::placement::Landing;
use godot::prelude::*;

impl GaitGenerator3D {
    /// Returns whether the editor holds the walk.
    pub(crate) fn is_preview_paused(&self) -> bool {
        self.preview_paused.unwrap_or(!self.playing)
    }

    /// Holds the walk in the editor, or lets it go on; nothing of it is saved.
    #[cfg(feature = "editor")]
    pub(crate) fn pause_preview(&mut self, paused: bool) {
        self.preview_paused = Some(paused);
    }

    /// Feet that stand, and the places where they land next, on the floor of the walk; `None` without a walk.
    pub(crate) fn feet(&self) -> Option<([bool; 2], [Option<Landing>; 2])> {
        let session = self
            .session
            .as_ref()
            .filter(|_| self.ownership == Ownership::Walking)?;
        let landings = session.generator.landings();
        Some((session.generator.feet_in_contact(), landings))
    }

    /// Returns true in the flight of a two-footed jump.
    pub(crate) fn soars(&self) -> bool {
        let walks = self.ownership == Ownership::Walking;
        let session = self.session.as_ref().filter(|_| walks);
        session.is_some_and(|session| session.generator.soars())
    }

    /// Changes the length of the step that has just begun to this share.
    pub(crate) fn stretch_step(&mut self, share: f32) {
        // A replica's foothold was chosen by the walker that it is one of.
        if let Some(session) = &mut self.session
            && !self.replica.is_led()
        {
            session.generator.stretch_step(share);
        }
    }

    /// Leaves the current step as it is, whatever else is asked for.
    pub(crate) fn keep_step(&mut self) {
        if let Some(session) = &mut self.session
            && !self.replica.is_led()
        {
            session.generator.keep_step();
        }
    }

    /// Moves at this share of the speed from the next step on, and walks where a run is too steep.
    pub(crate) fn slow_down(&mut self, share: f32, is_steep: bool) {
        self.slowed = share;
        self.climbs = is_steep;
    }

    /// Walks on on a way of this grade.
    pub(crate) fn set_grade(&mut self, grade: f32) {
        if let Some(session) = &mut self.session {
            session.generator.set_grade(grade);
        }
    }

    /// Takes weights of the styles.
    pub(super) fn weigh_styles(&mut self, style_weights: PackedFloat32Array) {
        let sizes_differ = style_weights.len() != self.style_weights.len();
        self.style_weights = style_weights;
        if sizes_differ {
            self.base_mut().update_configuration_warnings();
        }
        self.redraw_way();
    }

    /// Shares of the body's parts that are the walk's. A weight that is not a number counts as 1.
    pub(super) fn layer_weights(&self) -> LayerWeights {
        let [spine, head, left_arm, right_arm] = [
            self.spine_weight,
            self.head_weight,
            self.left_arm_weight,
            self.right_arm_weight,
        ]
        .map(|weight| {
            if weight.is_finite() {
                weight.clamp(0.0, 1.0) as f32
            } else {
                1.0
            }
        });
        LayerWeights {
            spine,
            head,
            left_arm,
            right_arm,
        }
    }

    /// Makes the editor redraw the path ahead. Exported games have no such drawing.
    pub(super) fn redraw_way(&mut self) {
        if cfg!(feature = "editor") {
            self.base_mut().update_gizmos();
        }
    }
}
