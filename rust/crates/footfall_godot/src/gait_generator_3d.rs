//! `GaitGenerator3D`: walks a character.

#[cfg(feature = "editor")]
mod foresight;
mod session;

use crate::character;
use crate::gait_model::{GaitModel, NO_MODEL};
use crate::gait_style::{self, GaitStyle};
use crate::report;
use crate::skeleton_binding::SkeletonBinding;
use crate::walk_source::WalkSource;
use footfall_core::Side;
use footfall_ik::placement::Landing;
use footfall_model::WalkModel;
use footfall_synth::{Controls, Detail, Footstep, GeneratorConfig};
use godot::classes::{BoneMap, Engine, ISkeletonModifier3D, Skeleton3D, SkeletonModifier3D};
use godot::prelude::*;
use session::Session;
use std::sync::Arc;

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
    /// The way of walking: an imported `.footfall` file such as `addons/footfall/models/walk.footfall`, or a `.footdyn` file such as
    /// `addons/footfall/models/walk.footdyn`, a switching model, which is smaller and wears no styles.
    #[export]
    #[var(set = set_model)]
    model: Option<Gd<GaitModel>>,

    /// Styles to walk in, imported `.footstyle` files that were made for this model. `style_weights` says how much of each.
    ///
    /// Changing the list starts the walk anew; change weights to change the style while it walks.
    #[export]
    #[var(set = set_styles)]
    styles: Array<Option<Gd<GaitStyle>>>,

    /// How much of each style there is in the walk, in the order of `styles`: 0 is none, 1 the style as it was recorded.
    ///
    /// Any mixture goes: more than 1 exaggerates, less than 0 is the opposite, and the sum need not be 1. What is too much for a
    /// body is held back. May change at any time; the walk takes it up with the next step. A missing weight counts as 0.
    #[export]
    #[var(set = set_style_weights)]
    style_weights: PackedFloat32Array,

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

    /// Where the character goes, seen from where it faces, in radians: 0 forwards, 90° to its left, -90° to its right, 180° backwards.
    ///
    /// For characters that look at something else than their way. Taken up with the next step, over several steps where the change is
    /// great. Steps to the side and backwards are shorter than those forwards, as people's are: sideways a character reaches about 0.65 m/s,
    /// backwards 1 m/s, whatever `speed` says.
    #[export(range = (-180.0, 180.0, 1.0, radians_as_degrees, suffix = "°"))]
    #[var(set = set_direction)]
    direction: f64,

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

    /// How finely the walk is worked out: every frame of the model, every second (half) or every fourth (quarter).
    ///
    /// Lower it for characters far from the camera. The walk is the same, but feet slip a little between frames. Taken up with
    /// the next step.
    #[export]
    detail: GaitDetail,

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

    /// The model and its styles; `None` until they are needed.
    source: Option<WalkSource>,
    /// The time of the walk to go to in the next frame, seconds.
    pending_seek: Option<f64>,
    /// Whether the editor holds the walk; `None` while `playing` says.
    preview_paused: Option<bool>,
    /// A state that the next walk goes on from.
    pending_state: Option<PackedByteArray>,
    /// The walk under way; `None` until the next frame that can start it.
    session: Option<Session>,
    /// What was last reported, so that it is reported once.
    reported: Option<String>,
    root_motion_delta: Transform3D,
    /// What is left of the speed on the ground at hand: 1 on level ground.
    #[init(val = 1.0)]
    slowed: f32,
    /// The foot whose next landing was announced last.
    announced: Option<Side>,
    base: Base<SkeletonModifier3D>,
}

/// How finely a walk is worked out.
#[derive(GodotConvert, Var, Export, Default, Clone, Copy, Debug)]
#[godot(via = i64)]
pub(crate) enum GaitDetail {
    #[default]
    Full = 0,
    Half = 1,
    Quarter = 2,
}

impl From<GaitDetail> for Detail {
    fn from(detail: GaitDetail) -> Self {
        match detail {
            GaitDetail::Full => Self::Full,
            GaitDetail::Half => Self::Half,
            GaitDetail::Quarter => Self::Quarter,
        }
    }
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
        self.problems()
    }
}

#[godot_api]
impl GaitGenerator3D {
    /// A foot touches down: `foot` is `left` or `right`, `position` the middle of the contact on the ground, in global space.
    ///
    /// Emitted exactly once for every initial contact, not in the editor.
    #[signal]
    fn footstep(foot: StringName, position: Vector3);

    /// A step begins: `foot`, `left` or `right`, will land at `position` in `seconds`, as long as the walk goes on as it does.
    ///
    /// `position` is in global space, on the flat floor of the walk. Emitted once for every step, not in the editor.
    #[signal]
    fn foothold_planned(foot: StringName, position: Vector3, seconds: f64);

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

    /// Goes to a time of the walk, in seconds from where it began: it is walked there from its beginning with the speed, turning and styles that
    /// are set now. The character does not travel by it. At most an hour; a minute takes some milliseconds.
    #[func]
    pub(crate) fn seek(&mut self, seconds: f64) {
        if seconds.is_finite() {
            self.session = None;
            self.pending_seek = Some(seconds.clamp(0.0, 3600.0));
        }
    }

    /// How long the walk has gone on, in seconds from where it began.
    #[func]
    pub(crate) fn get_time(&self) -> f64 {
        let session = self.session.as_ref();
        session.map_or(0.0, |session| session.elapsed_secs)
    }

    /// What keeps the character from walking, each with what to do next; empty when nothing does.
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
        match (&self.session, &self.pending_state) {
            (Some(session), None) => PackedByteArray::from(session.generator.state()),
            (_, Some(pending)) => pending.clone(),
            (None, None) => PackedByteArray::new(),
        }
    }

    /// Goes on from a state that `get_state()` told, at the next frame. A state of another model, other styles or from a damaged
    /// file is refused: the log says why, and the walk goes on as it was.
    ///
    /// `seed`, `phase` and `variation` keep their values, for the next walk that starts anew.
    #[func]
    fn set_state(&mut self, state: PackedByteArray) {
        self.pending_state = Some(state);
    }

    #[func]
    fn set_model(&mut self, model: Option<Gd<GaitModel>>) {
        self.model = model;
        self.source = None;
        self.restart();
    }

    #[func]
    fn set_styles(&mut self, styles: Array<Option<Gd<GaitStyle>>>) {
        self.styles = styles;
        self.source = None;
        self.restart();
    }

    #[func]
    fn set_style_weights(&mut self, style_weights: PackedFloat32Array) {
        let sizes_differ = style_weights.len() != self.style_weights.len();
        self.style_weights = style_weights;
        if sizes_differ {
            self.base_mut().update_configuration_warnings();
        }
        self.redraw_way();
    }

    #[func]
    fn set_speed(&mut self, speed: f64) {
        if speed.is_finite() {
            self.speed = speed.max(0.0);
            self.redraw_way();
        }
    }

    #[func]
    fn set_turn_rate(&mut self, turn_rate: f64) {
        if turn_rate.is_finite() {
            self.turn_rate = turn_rate;
            self.redraw_way();
        }
    }

    #[func]
    fn set_direction(&mut self, direction: f64) {
        if direction.is_finite() {
            self.direction = direction;
            self.redraw_way();
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
    fn problems(&self) -> PackedStringArray {
        let mut problems = PackedStringArray::new();
        if let Err(problem) = self.find_source() {
            problems.push(&GString::from(&problem));
        }
        let (styles, weights) = (self.styles.len(), self.style_weights.len());
        if styles != weights {
            let problem = format!(
                "There are {styles} styles and {weights} style weights. Give Style Weights one number for every style."
            );
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

    /// The walk under way, or a new one where there is none, the model was replaced or the body changed.
    fn take_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<Session, String> {
        let source = self.take_source()?;
        if let Some(session) = self.session.take()
            && session.is_for(&source, skeleton)
        {
            return Ok(session);
        }
        let (character, binding) = self.bind(skeleton)?;
        let config = self.config();
        self.redraw_way();
        let weights = self.style_weights.as_slice();
        Session::new(
            &source,
            weights,
            character,
            binding,
            &config,
            self.controls(),
        )
    }

    /// Which walk of the model's it is.
    fn config(&self) -> GeneratorConfig {
        GeneratorConfig {
            seed: self.seed.cast_unsigned(),
            phase: self.phase.rem_euclid(1.0) as f32,
            variation: self.variation as f32,
        }
    }

    fn controls(&self) -> Controls {
        Controls {
            speed_mps: self.speed as f32 * self.slowed,
            turn_rate_radps: self.turn_rate as f32,
            direction_rad: self.direction as f32,
        }
    }

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
    fn take_source(&mut self) -> Result<WalkSource, String> {
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

    fn find_source(&self) -> Result<WalkSource, String> {
        self.trained()?;
        let styles = gait_style::trained_all(&self.styles)?;
        let Some(model) = &self.model else {
            return Err(NO_MODEL.to_owned());
        };
        let mut model = model.clone();
        let source = model.bind_mut().source(&styles);
        source.map_err(|error| format!("The styles cannot be worn: {error}"))
    }

    /// The node that travels.
    ///
    /// # Errors
    /// What to set, when there is none.
    pub(crate) fn find_character(&self, skeleton: &Gd<Skeleton3D>) -> Result<Gd<Node3D>, String> {
        let node = self.base().clone().upcast::<Node>();
        character::find(&node, skeleton, &self.character)
    }

    /// What tells bones from joints.
    pub(crate) fn bones(&self) -> Option<Gd<BoneMap>> {
        self.bone_map.clone()
    }

    /// Has the editor draw the way ahead anew. Games without the editor's half have nobody who draws it.
    fn redraw_way(&mut self) {
        if cfg!(feature = "editor") {
            self.base_mut().update_gizmos();
        }
    }

    /// Whether the editor holds the walk.
    pub(crate) fn is_preview_paused(&self) -> bool {
        self.preview_paused.unwrap_or(!self.playing)
    }

    /// Holds the walk in the editor, or lets it go on; nothing of it is saved.
    #[cfg(feature = "editor")]
    pub(crate) fn pause_preview(&mut self, paused: bool) {
        self.preview_paused = Some(paused);
    }

    /// Which feet stand and where they land next, on the floor of the walk; `None` while nobody walks.
    pub(crate) fn feet(&self) -> Option<([bool; 2], [Option<Landing>; 2])> {
        let session = self.session.as_ref()?;
        let landings = Footstep::landings(session.generator.next_footstep());
        Some((session.generator.feet_in_contact(), landings))
    }

    /// Walks at this share of the speed from the next step on.
    pub(crate) fn slow_down(&mut self, share: f32) {
        self.slowed = share;
    }

    fn bind(&self, skeleton: &Gd<Skeleton3D>) -> Result<(Gd<Node3D>, SkeletonBinding), String> {
        let character = self.find_character(skeleton)?;
        let binding = SkeletonBinding::new(skeleton, &character, self.bone_map.as_ref())
            .map_err(|error| error.to_string())?;
        Ok((character, binding))
    }

    /// One frame: time passes, the character travels, bones are posed, footsteps are told.
    fn walk(&mut self, mut session: Session, mut skeleton: Gd<Skeleton3D>, delta: f64) {
        self.reported = None;
        let in_editor = Engine::singleton().is_editor_hint();
        let holds = if in_editor {
            self.is_preview_paused()
        } else {
            !self.playing
        };
        let dt_secs = if holds { 0.0 } else { delta.max(0.0) };
        let travels = self.root_motion && !in_editor;
        session
            .generator
            .set_style_weights(self.style_weights.as_slice());
        session.generator.set_detail(self.detail.into());
        if let Some(state) = self.pending_state.take()
            && let Err(problem) = session.restore(state.as_slice())
        {
            let node = self.base().get_path();
            godot_warn!("{node}: the state is refused: {problem}");
        }
        if let Some(secs) = self.pending_seek.take() {
            session.skip(secs, self.controls());
        }
        let travel = session.advance(dt_secs, self.controls());
        self.root_motion_delta = session.traveller.local_delta(&travel);
        {
            // Scripts may answer to what happens here and come back to this node: no borrow may be held.
            let _released = self.base_mut();
            if travels {
                session.traveller.move_character(&travel);
            }
            session.write(&mut skeleton);
        }
        let footsteps = if in_editor {
            Vec::new()
        } else {
            session.footsteps(&travel)
        };
        let foothold = session.next_foothold(&travel).filter(|_| !in_editor);
        self.session = Some(session);
        for (side, position) in footsteps {
            let foot = StringName::from(side.name());
            self.signals().footstep().emit(&foot, position);
        }
        let side = foothold.map(|(side, ..)| side);
        if side != self.announced {
            self.announced = side;
            if let Some((side, position, secs)) = foothold {
                let foot = StringName::from(side.name());
                self.signals()
                    .foothold_planned()
                    .emit(&foot, position, f64::from(secs));
            }
        }
    }

    /// Tells the log what keeps the character from walking, once.
    fn report(&mut self, problem: String) {
        if self.reported.as_ref() == Some(&problem) {
            return;
        }
        report::tell(&self.base_mut(), &problem);
        self.reported = Some(problem);
    }
}
