//! `GaitGenerator3D`: walks a character.

mod absence;
mod bake;
mod beside;
mod detail;
mod fit;
mod following;
#[cfg(feature = "editor")]
mod foresight;
mod gait_choice;
mod leaving;
mod methods;
mod moves;
mod problems;
mod reign;
mod replica;
mod rival;
mod seed;
mod seen;
mod session;
mod source;
mod walk;
mod watch;

use crate::bones;
use crate::convert::finite_or;
use crate::gait_model::GaitModel;
use crate::gait_style::GaitStyle;
use crate::root_motion::RootMotion;
use crate::shipped::{self, Fallback};
use crate::walk_source::WalkSource;
use absence::{Absent, Pending};
use detail::GaitDetail;
use gait_choice::GaitMode;
use glam::Vec3;
use godot::classes::{BoneMap, ISkeletonModifier3D, Skeleton3D, SkeletonModifier3D};
use godot::prelude::*;
use problems::Told;
use reign::{Reign, Wish};
use replica::Replica;
use rival::Rivals;
use session::Session;

/// Walks a character: every frame it poses the parent `Skeleton3D` with steps generated from a trained model.
///
/// Add it under a `Skeleton3D` with humanoid bones, give it a `model`, and the character walks. No animation clips are needed.
/// Feet stay where they are put; every seed walks a little differently.
///
/// Bones are found by `bone_map` where there is one, else by the names of `SkeletonProfileHumanoid`, else the rig is recognised: Mixamo, `VRM` (`VRoid`), Unreal,
/// Rigify, Reallusion CC, Daz Genesis, `MakeHuman`, Biped and others. Chest, `UpperChest`, Neck, the shoulders and the toes may be missing. Bones that are none of the body's 22
/// joints, such as fingers, keep the pose that they have.
///
/// In the editor the character walks in place while `playing` is on, and nothing of it is saved.
#[derive(GodotClass)]
#[class(tool, init, base = SkeletonModifier3D)]
pub(crate) struct GaitGenerator3D {
    /// The way of walking: a `.footfall` file such as `addons/footfall/models/locomotion.footfall`, or a `.footdyn` file such as
    /// `addons/footfall/models/walk.footdyn`, a switching model, which is smaller and wears no styles.
    ///
    /// A node that is added in the editor has `locomotion.footfall`; where this is empty, as after `GaitGenerator3D.new()` in a script, the
    /// character walks with the same.
    #[export]
    #[var(set = set_model, usage_flags = [DEFAULT, EDITOR_INSTANTIATE_OBJECT])]
    model: Option<Gd<GaitModel>>,

    /// Styles to walk in, `.footstyle` files that were made for this model. `style_weights` says how much of each.
    ///
    /// Changing the list starts the walk anew; change weights to change the style while it walks.
    #[export]
    #[var(set = set_styles)]
    styles: Array<Option<Gd<GaitStyle>>>,

    /// Weights of the styles, in the order of `styles`: 0 is none, 1 the style as it was recorded.
    ///
    /// Any mixture goes: more than 1 exaggerates, less than 0 is the opposite, and the sum need not be 1. What is too much for a
    /// body is held back. May change at any time; the walk takes it up with the next step. A missing weight counts as 0.
    #[export]
    #[var(set = set_style_weights)]
    style_weights: PackedFloat32Array,

    /// Walking or running speed in metres per second. Cadence and step length follow as they do in people, and `gait` says from where on it runs.
    ///
    /// May change at any time: a walk whose foot is in the air takes it up at once, any other step with the next. `GaitModel.get_speed_range()` tells what the model was
    /// trained on. At 0 the character stops within two steps and stands, or turns in place by `turn_rate`.
    #[export(range = (0.0, 5.0, 0.01, or_greater, suffix = "m/s"))]
    #[var(set = set_speed)]
    #[init(val = 1.3)]
    speed: f64,

    /// Turning of the character in radians per second. Positive turns to its left. Taken up as `speed` is.
    #[export(range = (-180.0, 180.0, 0.1, or_less, or_greater, radians_as_degrees, suffix = "°/s"))]
    #[var(set = set_turn_rate)]
    turn_rate: f64,

    /// Direction of travel relative to where the character faces, in radians: 0 forwards, 90° to its left, -90° to its right, 180° backwards.
    ///
    /// For characters that look at something else than their way. Taken up as `speed` is, over several steps where the change is
    /// great. Steps to the side and backwards are shorter than those forwards, as people's are: sideways a character reaches about 0.65 m/s,
    /// backwards 1 m/s, whatever `speed` says.
    #[export(range = (-180.0, 180.0, 1.0, radians_as_degrees, suffix = "°"))]
    #[var(set = set_direction)]
    direction: f64,

    /// Walking or running.
    ///
    /// Auto changes as people do: it runs from about 2 m/s on, sooner on short legs, and walks again a little below that. Walk and Run keep to one
    /// gait at any speed; the steps in which the character starts and stops are walked, as are those to the side and backwards. A model that only walks,
    /// as every `.footdyn`, walks. `get_current_gait()` tells which it is.
    #[export]
    gait: GaitMode,

    /// Depth of the crouch, standing or walking: 0 upright, 1 as low as the model's people.
    ///
    /// Taken up at once and smoothly; feet stay where they are. Who crouches goes no faster than those people do, about 1 m/s at 1. A model that knows
    /// no crouch (any `.footdyn`, and `.footfall` files without `footfall train --crouching`) stays upright.
    #[export(range = (0.0, 1.0, 0.01))]
    #[var(set = set_crouch)]
    crouch: f64,

    /// Weight of the walk in the spine's pose: at 0 `Spine`, `Chest` and `UpperChest` are posed by what else animates the skeleton, such
    /// as an `AnimationPlayer`, an `AnimationTree` or a script. Hips and legs always walk.
    ///
    /// The spine keeps the direction that the animation gives it in the character's space, whatever the hips do, so that steps do not shake
    /// what is aimed. Like the other weights it may be keyed and changed at any time; nothing pops on the way.
    #[export(range = (0.0, 1.0, 0.01))]
    #[init(val = 1.0)]
    spine_weight: f64,

    /// Weight of the walk in the pose of `Neck` and `Head`; at 0 they look where the animation has them look in the character's space.
    #[export(range = (0.0, 1.0, 0.01))]
    #[init(val = 1.0)]
    head_weight: f64,

    /// Weight of the walk in the left arm's pose, from shoulder to hand; at 0 it hangs from the walking chest as the animation poses it.
    #[export(range = (0.0, 1.0, 0.01))]
    #[init(val = 1.0)]
    left_arm_weight: f64,

    /// Weight of the walk in the right arm's pose, from shoulder to hand; at 0 it hangs from the walking chest as the animation poses it.
    #[export(range = (0.0, 1.0, 0.01))]
    #[init(val = 1.0)]
    right_arm_weight: f64,

    /// Seed of the walk. Equal seeds give equal walks.
    ///
    /// 0 gives every node a walk of its own, and a place in the stride of its own to begin at: both follow from the node's path in its
    /// scene, so a scene that is run again walks as before, and two nodes differ. `get_effective_seed()` tells which it is. A saved state
    /// holds it, so a walk that is loaded goes on alike wherever the node is then. Changing it starts the walk anew.
    #[export]
    #[var(set = set_seed)]
    seed: i64,

    /// Phase of the stride at which the walk starts: 0 with the left foot touching down, 0.5 with the right, up to 1.
    ///
    /// With a `seed` of 0 it is counted from the node's own place in the stride. Changing it starts the walk anew.
    #[export(range = (0.0, 1.0, 0.01))]
    #[var(set = set_phase)]
    phase: f64,

    /// Variation between steps: 0 repeats the same step, 1 varies as people do.
    ///
    /// Changing it starts the walk anew.
    #[export(range = (0.0, 1.0, 0.01, or_greater))]
    #[var(set = set_variation)]
    #[init(val = 1.0)]
    variation: f64,

    /// Motion of the character as it stands: 0 rests in a still pose, 1 sways, breathes, shifts its weight and looks about as people do, up to 2.
    ///
    /// Feet stay planted. Seeds differ, and nothing comes back in a loop. It comes up as the character comes to rest and dies away with the first
    /// step. A model that knows nothing of standing, as those of earlier versions and every `.footdyn`, rests in a still pose.
    #[export(range = (0.0, 2.0, 0.01))]
    #[init(val = 1.0)]
    standing_motion: f64,

    /// Resolution of the walk: every frame of the model, every second (half) or every fourth (quarter).
    ///
    /// Lower it for characters far from the camera. The walk is the same, but feet slip a little between frames. Taken up with
    /// the next step.
    #[export]
    detail: GaitDetail,

    /// If `true`, the character walks. When off, it holds the pose that it is in.
    #[export]
    #[init(val = true)]
    playing: bool,

    /// If `true`, the walk moves the character.
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

    /// Map of the bones to the profile's joints, where they are not recognised. It comes before the bones' names.
    #[export]
    #[var(set = set_bone_map)]
    bone_map: Option<Gd<BoneMap>>,

    /// Identity of the walk for other peers of a multiplayer game, for a `MultiplayerSynchronizer` such as `controller/gait_synchronizer.tscn` of the add-on: to be replicated
    /// On Change, and with Spawn. Peers without the multiplayer authority of the node that travels get it, and make that walker's steps. Empty until the walk begins.
    #[var(get = get_replica_identity, set = set_replica_identity)]
    replica_identity: PhantomVar<PackedByteArray>,

    /// Progress of the walk for other peers: 24 bytes, to be replicated Always, every 0.03 to 0.07 s. Any may get lost.
    /// On peers that get it nothing else steers the character; what parts it from its place is walked off, beyond 0.75 m it is set there. Places are those of the parent of the
    /// node that travels, or of the `CharacterBody3D` that it is in: do not replicate its `position` and `rotation` as well.
    #[var(get = get_replica_state, set = set_replica_state)]
    replica_state: PhantomVar<PackedByteArray>,

    /// The add-on's own walk, where `model` is empty.
    fallback: Fallback<GaitModel>,
    /// The model and its styles; `None` until they are needed.
    source: Option<WalkSource>,
    /// True while the editor holds the walk; `None` while `playing` decides.
    preview_paused: Option<bool>,
    pending: Pending,
    /// The walk under way; `None` until the next frame that can start it.
    session: Option<Session>,
    /// The walk that went on before the node left the tree or its skeleton.
    absent: Option<Absent>,
    told: Told,
    travelled: RootMotion,
    /// Velocity of the character on the ground in the last frame: metres and radians a second.
    velocity: (Vec3, f32),
    reign: Reign,
    wish: Option<Wish>,
    rivals: Rivals,
    /// Share of the speed that is left on the ground at hand: 1 on level ground.
    #[init(val = 1.0)]
    slowed: f32,
    replica: Replica,
    base: Base<SkeletonModifier3D>,
}

#[godot_api]
impl ISkeletonModifier3D for GaitGenerator3D {
    fn enter_tree(&mut self) {
        self.put_aside();
    }

    fn skeleton_changed(&mut self, _old: Option<Gd<Skeleton3D>>, _new: Option<Gd<Skeleton3D>>) {
        self.put_aside();
    }

    fn process_modification_with_delta(&mut self, delta: f64) {
        self.pass_frame(delta);
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

    /// The character begins to walk or to run: `gait` is `walk` or `run`. Emitted with the first step of it, not in the editor.
    #[signal]
    fn gait_changed(gait: StringName);

    /// The character leaves the ground in a jump. Not emitted in the editor.
    #[signal]
    fn took_off();

    /// A foot, `left` or `right`, lands after a jump: one after a leap, both after a jump off both feet. Not emitted in the editor.
    #[signal]
    fn landed(foot: StringName);

    /// Emitted when the pose from before `take_over()` has faded: the pose is the walk's.
    #[signal]
    fn taken_over();

    /// A peer's message about this walk is refused: `reason` says why and what to do. Emitted every five seconds at most; the walk goes on as before.
    #[signal]
    fn replica_refused(reason: GString);

    /// After `hand_over()`: the pose is that of what else animates the skeleton.
    #[signal]
    fn handed_over();

    #[func]
    fn set_model(&mut self, model: Option<Gd<GaitModel>>) {
        self.model = shipped::instead_of_new(model, shipped::WALK, |model| model.bind().is_new());
        self.renew();
    }

    #[func]
    fn set_styles(&mut self, styles: Array<Option<Gd<GaitStyle>>>) {
        self.styles = styles;
        self.renew();
    }

    #[func]
    fn set_style_weights(&mut self, style_weights: PackedFloat32Array) {
        self.weigh_styles(style_weights);
    }

    #[func]
    fn set_speed(&mut self, speed: f64) {
        self.speed = finite_or(speed, self.speed).max(0.0);
        self.redraw_way();
    }

    #[func]
    fn set_turn_rate(&mut self, turn_rate: f64) {
        self.turn_rate = finite_or(turn_rate, self.turn_rate);
        self.redraw_way();
    }

    #[func]
    fn set_direction(&mut self, direction: f64) {
        self.direction = finite_or(direction, self.direction);
        self.redraw_way();
    }

    #[func]
    fn set_crouch(&mut self, crouch: f64) {
        self.crouch = finite_or(crouch, self.crouch).clamp(0.0, 1.0);
    }

    #[func]
    fn get_replica_identity(&self) -> PackedByteArray {
        self.tell_identity()
    }

    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_replica_identity(&mut self, identity: PackedByteArray) {
        self.hear_identity(&identity);
    }

    #[func]
    fn get_replica_state(&self) -> PackedByteArray {
        self.tell_state()
    }

    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_replica_state(&mut self, state: PackedByteArray) {
        self.hear_state(&state);
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
        bones::complete(bone_map.as_ref());
        self.bone_map = bone_map;
        self.restart();
    }
}
