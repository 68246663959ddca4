//! Methods of the node for scripts.

use super::GaitGenerator3D;
use super::detail::GaitDetail;
use super::gait_choice::name_of;
use crate::modifier::BodyModifier as _;
use crate::root_motion;
use footfall_core::Side;
use footfall_synth::Gait;
use godot::prelude::*;

#[godot_api(secondary)]
impl GaitGenerator3D {
    /// Returns the character's travel and turn in its own space, along the axes and in the scale of its node.
    ///
    /// The call returns the travel since the previous physics frame in `_physics_process()`, and since the previous frame in `_process()`: one call per frame
    /// adds up to the whole travel at any frame rate, and repeated calls in a frame return the same value. After the skeleton has moved within a frame, as in a
    /// function connected to `modification_processed`, it returns that frame's travel. For a skeleton that is advanced by hand, it returns the travel of the last
    /// `advance()`.
    ///
    /// With `root_motion` off, move the character by it in a function connected to `modification_processed`, so that body and feet
    /// move in the same frame: `character.global_transform *= gait.get_root_motion_delta()`, or with collisions
    /// `character.move_and_collide(character.global_basis * gait.get_root_motion_delta().origin)`.
    #[func]
    fn get_root_motion_delta(&mut self) -> Transform3D {
        let skeleton = self.base().get_skeleton();
        root_motion::delta_for(&mut self.travelled, skeleton)
    }

    /// Returns the seed in use: `seed`; if that is 0, the node's own seed, or that of a restored state.
    #[func]
    fn get_effective_seed(&self) -> i64 {
        self.effective_seed().cast_signed()
    }

    /// Returns the gait of the current step: `walk` or `run`.
    #[func]
    fn get_current_gait(&self) -> StringName {
        let session = self.session.as_ref();
        name_of(session.map_or(Gait::Walk, |session| session.generator.gait()))
    }

    /// Returns the detail that the next step will have: `detail`, or the choice of Auto.
    #[func]
    fn get_current_detail(&self) -> GaitDetail {
        self.current_detail()
    }

    /// Returns `true` if any part of the foot, `left` or `right`, is on the ground.
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

    /// Starts the walk anew from `seed` and `phase` at the character's current place. Also measures the skeleton again.
    #[func]
    pub(super) fn restart(&mut self) {
        self.session = None;
        self.absent = None;
        self.announced.problem = None;
        self.base_mut().update_configuration_warnings();
    }

    /// Moves to a time of the walk, in seconds from its beginning, computed with the current speed, turning and styles. The character does not
    /// travel. At most an hour; a minute takes some milliseconds.
    #[func]
    pub(crate) fn seek(&mut self, seconds: f64) {
        if seconds.is_finite() {
            self.session = None;
            self.absent = None;
            self.pending.seek = Some(seconds.clamp(0.0, 3600.0));
        }
    }

    /// Returns the time since the walk began, in seconds.
    #[func]
    pub(crate) fn get_time(&self) -> f64 {
        let session = self.session.as_ref().map(|session| session.elapsed_secs);
        let absent = self.absent.as_ref().map(|absent| absent.elapsed_secs);
        session.or(absent).unwrap_or_default()
    }

    /// Returns the problems that keep the character from walking, each with what to do next; empty if there are none.
    ///
    /// The editor shows the same texts as configuration warnings.
    #[func]
    fn get_problems(&self) -> PackedStringArray {
        self.problems()
    }

    /// Returns the current state of the walk, to be saved or sent: `set_state()` on a node with the same model, styles and body continues
    /// with the same poses. About 1.5 kB; empty while the character does not walk.
    ///
    /// The state does not include the character's transform: save it as well.
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

    /// Restores a state from `get_state()` in the next frame. A state of another model, of other styles or from a damaged
    /// file is refused: the log gives the reason, and the walk continues unchanged.
    ///
    /// `seed`, `phase` and `variation` keep their values for the next walk that restarts.
    #[func]
    fn set_state(&mut self, state: PackedByteArray) {
        self.pending.state = Some(state);
    }
}
