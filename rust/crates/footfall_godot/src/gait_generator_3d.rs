//! `GaitGenerator3D`: walks a character.

mod session;

use crate::character;
use crate::gait_model::GaitModel;
use crate::skeleton_binding::SkeletonBinding;
use footfall_core::Side;
use footfall_synth::{Controls, GeneratorConfig};
use godot::classes::{BoneMap, Engine, ISkeletonModifier3D, Skeleton3D, SkeletonModifier3D};
use godot::prelude::*;
use session::Session;

/// Walks a character: every frame it poses the parent `Skeleton3D` with steps generated from a trained model.
///
/// Add it under a `Skeleton3D` with humanoid bones, give it a `model`, and the character walks. No animation clips are needed.
/// Feet stay where they are put; every seed walks a little differently.
///
/// Bones are found by the names of `SkeletonProfileHumanoid`, which the importer gives a character that is retargeted, or
/// through `bone_map`. Chest, `UpperChest`, Neck, the shoulders and the toes may be missing. Bones that are none of the body's 22
/// joints, such as fingers, keep the pose that they have.
///
/// In the editor the character walks in place while `playing` is on, and nothing of it is saved.
#[derive(GodotClass)]
#[class(tool, init, base = SkeletonModifier3D)]
pub(crate) struct GaitGenerator3D {
    /// The trained walk, an imported `.footfall` file such as `addons/footfall/models/walk.footfall`.
    #[export]
    #[var(set = set_model)]
    model: Option<Gd<GaitModel>>,

    /// How fast the character walks, in metres per second. Cadence and step length follow as they do in people.
    ///
    /// May change at any time; the walk takes it up with the next step. `GaitModel.get_speed_range()` tells what the model was
    /// trained on. At 0 the character stops within two steps and stands, or turns in place by `turn_rate`.
    #[export(range = (0.0, 2.5, 0.01, or_greater, suffix = "m/s"))]
    #[var(set = set_speed)]
    #[init(val = 1.3)]
    speed: f64,

    /// How fast the character turns, in radians per second. Positive turns to its left. Taken up with the next step.
    #[export(range = (-180.0, 180.0, 0.1, or_less, or_greater, radians_as_degrees, suffix = "°/s"))]
    #[var(set = set_turn_rate)]
    turn_rate: f64,

    /// Which walk of the many that the model can generate. Equal seeds give equal walks.
    ///
    /// Changing it starts the walk anew.
    #[export]
    #[var(set = set_seed)]
    seed: i64,

    /// Where in the stride the walk starts: 0 with the left foot touching down, 0.5 with the right, up to 1.
    ///
    /// Give neighbours different phases, lest they march in step. Changing it starts the walk anew.
    #[export(range = (0.0, 1.0, 0.01))]
    #[var(set = set_phase)]
    phase: f64,

    /// How much steps differ from each other: 0 repeats the same step, 1 varies as people do.
    ///
    /// Changing it starts the walk anew.
    #[export(range = (0.0, 1.0, 0.01, or_greater))]
    #[var(set = set_variation)]
    #[init(val = 1.0)]
    variation: f64,

    /// Whether the character walks. When off, it holds the pose that it is in.
    #[export]
    #[init(val = true)]
    playing: bool,

    /// Whether the walk moves the character.
    ///
    /// On: the node found through `character` travels, in such a way that the standing foot does not move. Off: the character
    /// walks in place, and `get_root_motion_delta()` tells how far it would have travelled.
    #[export]
    #[init(val = true)]
    root_motion: bool,

    /// The `Node3D` that travels, above the `Skeleton3D`. Its Y axis is up.
    ///
    /// Left empty, it is the nearest `CharacterBody3D` above the skeleton; failing that the root of the scene that the skeleton came in,
    /// for an imported character its top node.
    #[export(node_path = ("Node3D"))]
    #[var(set = set_character)]
    character: NodePath,

    /// Tells which bones are which joints, where they are not named as in SkeletonProfileHumanoid.
    #[export]
    #[var(set = set_bone_map)]
    bone_map: Option<Gd<BoneMap>>,

    /// The walk under way; `None` until the next frame that can start it.
    session: Option<Session>,
    /// What was last reported, so that it is reported once.
    reported: Option<String>,
    root_motion_delta: Transform3D,
    base: Base<SkeletonModifier3D>,
}

#[godot_api]
impl ISkeletonModifier3D for GaitGenerator3D {
    fn enter_tree(&mut self) {
        self.session = None;
        self.reported = None;
    }

    fn skeleton_changed(&mut self, _old: Option<Gd<Skeleton3D>>, _new: Option<Gd<Skeleton3D>>) {
        self.session = None;
        self.reported = None;
    }

    // May come before `ready`, outside a frame, and more than once a frame; then `delta` is 0.
    fn process_modification_with_delta(&mut self, delta: f64) {
        self.root_motion_delta = Transform3D::IDENTITY;
        let Some(skeleton) = self.base().get_skeleton() else {
            return;
        };
        if !skeleton.is_inside_tree() {
            return;
        }
        match self.take_session(&skeleton) {
            Ok(session) => self.walk(session, skeleton, delta),
            // Without time passing the node may still be about to get what it lacks.
            Err(problem) if delta > 0.0 => self.report(problem),
            Err(_) => {}
        }
    }

    fn get_configuration_warnings(&self) -> PackedStringArray {
        self.get_problems()
    }
}

#[godot_api]
impl GaitGenerator3D {
    /// A foot touches down: `foot` is `left` or `right`, `position` the middle of the contact on the ground, in global space.
    ///
    /// Emitted exactly once for every initial contact, not in the editor.
    #[signal]
    fn footstep(foot: StringName, position: Vector3);

    /// How far and about what the character travelled in the last frame, in its own space: axes and scale are those of its node.
    ///
    /// With `root_motion` off, move the character by it in a function connected to `modification_processed`, so that body and feet
    /// move in the same frame: `character.global_transform *= gait.get_root_motion_delta()`, or with collisions
    /// `character.move_and_collide(character.global_basis * gait.get_root_motion_delta().origin)`.
    #[func]
    fn get_root_motion_delta(&self) -> Transform3D {
        self.root_motion_delta
    }

    /// Whether any part of a foot, `left` or `right`, stands on the ground.
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
    fn restart(&mut self) {
        self.session = None;
        self.reported = None;
        self.base_mut().update_configuration_warnings();
    }

    /// What keeps the character from walking, each with what to do next; empty when nothing does.
    ///
    /// The editor shows the same as configuration warnings.
    #[func]
    fn get_problems(&self) -> PackedStringArray {
        let mut problems = PackedStringArray::new();
        if let Err(problem) = self.trained() {
            problems.push(&GString::from(&problem));
        }
        let Some(skeleton) = self.base().get_skeleton() else {
            problems.push("Put this node under a Skeleton3D.");
            return problems;
        };
        if skeleton.is_inside_tree()
            && let Err(problem) = self.bind(&skeleton)
        {
            problems.push(&GString::from(&problem));
        }
        problems
    }

    #[func]
    fn set_model(&mut self, model: Option<Gd<GaitModel>>) {
        self.model = model;
        self.restart();
    }

    #[func]
    fn set_speed(&mut self, speed: f64) {
        if speed.is_finite() {
            self.speed = speed.max(0.0);
        }
    }

    #[func]
    fn set_turn_rate(&mut self, turn_rate: f64) {
        if turn_rate.is_finite() {
            self.turn_rate = turn_rate;
        }
    }

    #[func]
    fn set_seed(&mut self, seed: i64) {
        self.seed = seed;
        self.restart();
    }

    #[func]
    fn set_phase(&mut self, phase: f64) {
        if phase.is_finite() {
            self.phase = phase;
            self.restart();
        }
    }

    #[func]
    fn set_variation(&mut self, variation: f64) {
        if variation.is_finite() {
            self.variation = variation.max(0.0);
            self.restart();
        }
    }

    #[func]
    fn set_character(&mut self, character: NodePath) {
        self.character = character;
        self.restart();
    }

    #[func]
    fn set_bone_map(&mut self, bone_map: Option<Gd<BoneMap>>) {
        self.bone_map = bone_map;
        self.restart();
    }
}

impl GaitGenerator3D {
    /// The walk under way, or a new one where there is none, the model was replaced or the body changed.
    fn take_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<Session, String> {
        let trained = self.trained()?;
        if let Some(session) = self.session.take()
            && session.is_for(&trained, skeleton)
        {
            return Ok(session);
        }
        let (character, binding) = self.bind(skeleton)?;
        let config = GeneratorConfig {
            seed: self.seed.cast_unsigned(),
            phase: self.phase.rem_euclid(1.0) as f32,
            variation: self.variation as f32,
        };
        Session::new(&trained, character, binding, &config, self.controls())
    }

    fn controls(&self) -> Controls {
        Controls {
            speed_mps: self.speed as f32,
            turn_rate_radps: self.turn_rate as f32,
        }
    }

    fn trained(&self) -> Result<std::sync::Arc<footfall_model::GaitModel>, String> {
        let Some(model) = &self.model else {
            return Err(
                "No gait model. Load a .footfall file into Model, for example addons/footfall/models/walk.footfall."
                    .to_owned(),
            );
        };
        model.bind().trained().map_err(|error| {
            let path = model.get_path();
            let name = if path.is_empty() { "it".into() } else { path };
            format!("The gait model cannot be used ({name}): {error}")
        })
    }

    fn bind(&self, skeleton: &Gd<Skeleton3D>) -> Result<(Gd<Node3D>, SkeletonBinding), String> {
        let node = self.base().clone().upcast::<Node>();
        let character = character::find(&node, skeleton, &self.character)?;
        let binding = SkeletonBinding::new(skeleton, &character, self.bone_map.as_ref())
            .map_err(|error| error.to_string())?;
        Ok((character, binding))
    }

    /// One frame: time passes, the character travels, bones are posed, footsteps are told.
    fn walk(&mut self, mut session: Session, mut skeleton: Gd<Skeleton3D>, delta: f64) {
        self.reported = None;
        let in_editor = Engine::singleton().is_editor_hint();
        let dt_secs = if self.playing {
            delta.max(0.0) as f32
        } else {
            0.0
        };
        let travels = self.root_motion && !in_editor;
        let travel = session.advance(dt_secs, self.controls());
        self.root_motion_delta = session.local_delta(&travel);
        {
            // Scripts may answer to what happens here and come back to this node: no borrow may be held.
            let _released = self.base_mut();
            if travels {
                session.move_character(&travel);
            }
            session.write(&mut skeleton);
        }
        let footsteps = if in_editor {
            Vec::new()
        } else {
            session.footsteps(&travel)
        };
        self.session = Some(session);
        for (side, position) in footsteps {
            let foot = StringName::from(side.name());
            self.signals().footstep().emit(&foot, position);
        }
    }

    /// Tells the log what keeps the character from walking, once.
    fn report(&mut self, problem: String) {
        if self.reported.as_ref() == Some(&problem) {
            return;
        }
        // The editor shows it at the node instead.
        if Engine::singleton().is_editor_hint() {
            self.base_mut().update_configuration_warnings();
        } else {
            let node = self.base().get_path();
            godot_warn!("{node}: {problem}");
        }
        self.reported = Some(problem);
    }
}
