//! Methods of the node for scripts.

use super::GaitGenerator3D;
use super::gait_choice::name_of;
use crate::root_motion::{advance_of, frame_clock};
use footfall_core::Side;
use footfall_synth::Gait;
use godot::prelude::*;

#[godot_api(secondary)]
impl GaitGenerator3D {
    /// Returns the character's travel and turn in its own space: axes and scale are those of its node.
    ///
    /// Asked in `_physics_process()`, since the frame of the physics before; asked in `_process()`, since the frame before: whoever asks once
    /// a frame is told all of it, at any frame rate, and asked twice in a frame it says the same. After the skeleton has moved within a frame, as in a
    /// function connected to `modification_processed`, it is that frame's. For a skeleton that is advanced by hand, it is what the last
    /// `advance()` did.
    ///
    /// With `root_motion` off, move the character by it in a function connected to `modification_processed`, so that body and feet
    /// move in the same frame: `character.global_transform *= gait.get_root_motion_delta()`, or with collisions
    /// `character.move_and_collide(character.global_basis * gait.get_root_motion_delta().origin)`.
    #[func]
    fn get_root_motion_delta(&mut self) -> Transform3D {
        let Some(skeleton) = self.base().get_skeleton() else {
            return Transform3D::IDENTITY;
        };
        self.travelled
            .since_last_frame(advance_of(&skeleton), frame_clock())
    }

    /// The seed of the walk: `seed`, or where that is 0 the node's own, or that of the state that it goes on from.
    #[func]
    fn get_effective_seed(&self) -> i64 {
        self.effective_seed().cast_signed()
    }

    /// The gait of the step that is walked now: `walk` or `run`.
    #[func]
    fn get_current_gait(&self) -> StringName {
        let session = self.session.as_ref();
        name_of(session.map_or(Gait::Walk, |session| session.generator.gait()))
    }

    /// Returns whether any part of a foot, `left` or `right`, stands on the ground.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn is_foot_on_ground(&self, foot: StringName) -> bool {
        let contacts = self
            .session
            .as_ref()
            .map_or([true; 2], |session| session.generator.feet_in_contact());
        Side::BOTH
            .into_iter()
            .find(|side| foot == side.name())
            .is_some_and(|side| contacts[side.index()])
    }

    /// Starts the walk anew from `seed` and `phase`, where the character stands now. Also measures the skeleton anew.
    #[func]
    pub(super) fn restart(&mut self) {
        self.session = None;
        self.absent = None;
        self.told.problem = None;
        self.base_mut().update_configuration_warnings();
    }

    /// Goes to a time of the walk, in seconds from where it began: it is walked there from its beginning with the speed, turning and styles that
    /// are set now. The character does not travel by it. At most an hour; a minute takes some milliseconds.
    #[func]
    pub(crate) fn seek(&mut self, seconds: f64) {
        if seconds.is_finite() {
            self.session = None;
            self.absent = None;
            self.pending.seek = Some(seconds.clamp(0.0, 3600.0));
        }
    }

    /// Time since the walk began, in seconds.
    #[func]
    pub(crate) fn get_time(&self) -> f64 {
        let session = self.session.as_ref().map(|session| session.elapsed_secs);
        let absent = self.absent.as_ref().map(|absent| absent.elapsed_secs);
        session.or(absent).unwrap_or_default()
    }

    /// Problems that keep the character from walking, each with what to do next; empty without any.
    ///
    /// The editor shows the same as configuration warnings.
    #[func]
    fn get_problems(&self) -> PackedStringArray {
        self.problems()
    }

    /// The walk as it is now, to be saved or sent: `set_state()` of a node with the same model, styles and body goes on from it
    /// with the same poses. About 1.5 kB; empty while the character does not walk.
    ///
    /// It holds the walk and not the place of the character: save that beside it.
    #[func]
    fn get_state(&self) -> PackedByteArray {
        match (&self.session, &self.pending.state) {
            (Some(session), None) => PackedByteArray::from(session.generator.state()),
            (_, Some(pending)) => pending.clone(),
            (None, None) => {
                let absent = self.absent.as_ref();
                absent.map_or_else(PackedByteArray::new, |absent| {
                    absent.state.as_slice().into()
                })
            }
        }
    }

    /// Goes on from a state that `get_state()` told, at the next frame. A state of another model, other styles or from a damaged
    /// file is refused: the log says why, and the walk goes on as it was.
    ///
    /// `seed`, `phase` and `variation` keep their values, for the next walk that starts anew.
    #[func]
    fn set_state(&mut self, state: PackedByteArray) {
        self.pending.state = Some(state);
    }
}
