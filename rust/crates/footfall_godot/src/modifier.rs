//! Common part of the modifiers that pose a body: each binds a skeleton, advances a session on it and reports problems.

use crate::skeleton_binding::SkeletonBinding;
use crate::{bones, character, convert, report};
use godot::classes::{BoneMap, Skeleton3D, SkeletonModifier3D};
use godot::obj::WithBaseField;
use godot::prelude::*;

/// A modifier that poses the body of the `Skeleton3D` above it.
pub(crate) trait BodyModifier:
    WithBaseField + GodotClass<Base = SkeletonModifier3D>
{
    /// The motion under way on one skeleton.
    type Session;

    /// Property `character`: path of the node that travels; empty if it is to be found.
    fn character_path(&self) -> &NodePath;

    /// Map from joints to bones that applies to a skeleton.
    fn bone_map_for(&self, skeleton: &Gd<Skeleton3D>) -> Option<Gd<BoneMap>>;

    /// The problem that was reported last, so that each is reported once.
    fn last_problem(&mut self) -> &mut Option<String>;

    /// Takes the session under way, or begins one if the skeleton or the settings have changed.
    ///
    /// # Errors
    /// Problem that keeps the body from being posed, for the user.
    fn take_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<Self::Session, String>;

    /// Advances the session by a frame, poses the skeleton and keeps the session.
    fn advance(&mut self, session: Self::Session, skeleton: Gd<Skeleton3D>, delta: f64);

    /// Drops or sets aside what a change of the surrounding nodes invalidates: the node has entered a tree, or has another skeleton.
    fn interrupt(&mut self);

    /// Removes what the node has added to the tree, before it leaves.
    fn leave_tree(&mut self) {}

    /// Problems that keep the body from being posed, each with what to do, for the editor and for scripts.
    fn problems(&self) -> PackedStringArray;

    /// Finds the node that travels.
    ///
    /// # Errors
    /// Property to set, if there is none.
    fn find_character(&self, skeleton: &Gd<Skeleton3D>) -> Result<Gd<Node3D>, String> {
        let node = self.base().clone().upcast::<Node>();
        character::find(&node, skeleton, self.character_path())
    }

    /// Finds the node that travels and measures the skeleton on it.
    ///
    /// # Errors
    /// Problem of the character, of its bones or of their map, for the user.
    fn bind(&self, skeleton: &Gd<Skeleton3D>) -> Result<(Gd<Node3D>, SkeletonBinding), String> {
        let character = self.find_character(skeleton)?;
        let bone_map = self.bone_map_for(skeleton);
        let binding = SkeletonBinding::new(skeleton, &character, bone_map.as_ref())
            .map_err(|error| error.to_string())?;
        Ok((character, binding))
    }

    /// Advances by a frame. The engine may call it before `ready`, outside a frame, and more than once a frame; then `delta` is 0.
    fn process_frame(&mut self, delta: f64) {
        let Some(skeleton) = self.base().get_skeleton() else {
            return;
        };
        if !skeleton.is_inside_tree() || convert::is_flat(skeleton.get_global_transform()) {
            return;
        }
        match self.take_session(&skeleton) {
            Ok(session) => {
                *self.last_problem() = None;
                self.advance(session, skeleton, delta);
            }
            // Without time passing the node may still be about to get what it lacks.
            Err(problem) if delta > 0.0 => self.report(problem),
            Err(_) => {}
        }
    }

    /// Reports a problem to the developer, once.
    fn report(&mut self, problem: String) {
        if self.last_problem().as_ref() != Some(&problem) {
            self.warn(&problem);
            *self.last_problem() = Some(problem);
        }
    }

    /// Reports a problem to the developer.
    fn warn(&mut self, problem: &str) {
        report::warn(&self.base_mut().clone().upcast(), problem);
    }

    /// Problem of the skeleton or of the character, for the editor and for scripts.
    fn skeleton_problem(&self) -> Option<GString> {
        let Some(skeleton) = self.base().get_skeleton() else {
            return Some(bones::no_skeleton(&self.base()));
        };
        if !skeleton.is_inside_tree() {
            return None;
        }
        let problem = self.bind(&skeleton).err()?;
        Some(GString::from(&problem))
    }
}

/// Passes the engine's calls on to [`BodyModifier`]. A macro, because gdext needs this implementation in every class.
macro_rules! engine_calls {
    ($Node:ident) => {
        #[godot_api]
        impl ISkeletonModifier3D for $Node {
            fn enter_tree(&mut self) {
                self.interrupt();
            }

            fn exit_tree(&mut self) {
                self.leave_tree();
            }

            fn skeleton_changed(&mut self, _: Option<Gd<Skeleton3D>>, _: Option<Gd<Skeleton3D>>) {
                self.interrupt();
            }

            fn process_modification_with_delta(&mut self, delta: f64) {
                self.process_frame(delta);
            }

            fn get_configuration_warnings(&self) -> PackedStringArray {
                self.problems()
            }
        }
    };
}
pub(crate) use engine_calls;
