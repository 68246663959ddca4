//! The class `GaitGenerator3D`, which walks a character.

mod absence;
mod bake;
mod beside;
mod detail;
mod fit;
mod following;
mod gait_choice;
mod leaving;
mod methods;
mod moves;
mod observed_motion;
mod ownership;
#[cfg(feature = "editor")]
mod preview_path;
mod problems;
mod replica;
mod rival;
mod seed;
mod session;
mod source;
mod walk;
mod watch;

use crate::bones;
use crate::convert::finite_or;
use crate::gait_model::GaitModel;
use crate::gait_style::GaitStyle;
use crate::modifier::{BodyModifier as _, engine_calls};
use crate::root_motion::RootMotion;
use crate::shipped::{self, Fallback};
use crate::walk_source::WalkSource;
use absence::{Absent, Pending};
use detail::{AutoDetail, GaitDetail};
use gait_choice::GaitMode;
use glam::Vec3;
use godot::classes::{BoneMap, ISkeletonModifier3D, Skeleton3D, SkeletonModifier3D};
use godot::prelude::*;
use ownership::{Ownership, Request};
use problems::Announced;
use replica::Replica;
use rival::Rivals;
use session::WalkSession;

/// Walks a character: poses the parent `Skeleton3D` in every frame with steps generated from a trained model.
///
/// Add it under a `Skeleton3D` with humanoid bones, set its `model`, and the character walks. No animation clips are needed.
/// Feet stay planted; every seed gives a slightly different walk.
///
/// Bones are found by `bone_map` if it is set, else by the names of `SkeletonProfileHumanoid`, else by recognising the rig: Mixamo, `VRM` (`VRoid`), Unreal,
/// Rigify, Reallusion CC, Daz Genesis, `MakeHuman`, Biped and others. Chest, `UpperChest`, Neck, the shoulders and the toes may be missing. Bones that are none of the body's 22
/// joints, such as fingers, keep their pose.
///
/// In the editor the character walks in place while `playing` is on; the scene does not save the preview.
#[derive(GodotClass)]
#[class(tool, init, base = SkeletonModifier3D)]
pub(crate) struct GaitGenerator3D {
    /// The gait model: a `.footfall` file such as `addons/footfall/models/locomotion.footfall`, or a `.footdyn` file such as
    /// `addons/footfall/models/walk.footdyn`, a switching model, which is smaller and has no styles.
    ///
    /// A node added in the editor starts with `locomotion.footfall`. If this is empty, as after `GaitGenerator3D.new()` in a script, the
    /// same model is used.
    #[export]
    #[var(set = set_model, usage_flags = [DEFAULT, EDITOR_INSTANTIATE_OBJECT])]
    model: Option<Gd<GaitModel>>,

    /// Styles of the walk: `.footstyle` files made for this model. `style_weights` sets the weight of each.
    ///
    /// Changing the list starts the walk anew. To change the style of a running walk, change the weights.
    #[export]
    #[var(set = set_styles)]
    styles: Array<Option<Gd<GaitStyle>>>,

    /// Weights of the styles, in the order of `styles`: 0 is none, 1 the style as recorded.
    ///
    /// Any mixture is valid: more than 1 exaggerates, less than 0 gives the opposite, and the sum need not be 1. Poses beyond a
    /// body's limits are limited. Changes apply with the next step. A missing weight counts as 0.
    #[export]
    #[var(set = set_style_weights)]
    style_weights: PackedFloat32Array,

    /// Walking or running speed in metres per second. Cadence and step length follow as in people; `gait` sets when the character runs.
    ///
    /// A change applies at once while one foot stands and the other is in the air, otherwise with the next step. `GaitModel.get_speed_range()` returns the speeds that the model
    /// was trained on. At 0 the character stops within two steps and stands, or turns on the spot by `turn_rate`.
    #[export(range = (0.0, 5.0, 0.01, or_greater, suffix = "m/s"))]
    #[var(set = set_speed)]
    #[init(val = 1.3)]
    speed: f64,

    /// Turn rate of the character in radians per second; positive turns to its left. Changes apply as for `speed`.
    #[export(range = (-180.0, 180.0, 0.1, or_less, or_greater, radians_as_degrees, suffix = "°/s"))]
    #[var(set = set_turn_rate)]
    turn_rate: f64,

    /// Direction of travel relative to the facing direction, in radians: 0 forwards, 90° to the left, -90° to the right, 180° backwards.
    ///
    /// For characters that look elsewhere than where they go. Changes apply as for `speed`; large changes take several steps. Steps sideways and backwards are
    /// shorter than forward steps, as in people: a character reaches about 1.6 m/s sideways and 2.0 m/s backwards, whatever `speed` is.
    #[export(range = (-180.0, 180.0, 1.0, radians_as_degrees, suffix = "°"))]
    #[var(set = set_direction)]
    direction: f64,

    /// Choice between walking and running.
    ///
    /// Auto changes as people do: the character runs above about 2 m/s, or sooner on short legs, and walks again a little below that speed. Walk and Run keep to one
    /// gait at any speed. Starting and stopping steps and steps sideways or backwards are always walked. Models without running,
    /// such as every `.footdyn`, only walk. `get_current_gait()` returns the current gait.
    #[export]
    gait: GaitMode,

    /// Depth of the crouch, standing or walking: 0 upright, 1 as low as the recorded people.
    ///
    /// Changes apply at once and smoothly; feet stay in place. A crouching character is as slow as those people, about 1 m/s at 1. A model without
    /// crouching (any `.footdyn`, and `.footfall` files trained without `footfall train --crouching`) stays upright.
    #[export(range = (0.0, 1.0, 0.01))]
    #[var(set = set_crouch)]
    crouch: f64,

    /// Weight of the walk in the spine's pose. At 0, other animation poses `Spine`, `Chest` and `UpperChest`, such
    /// as an `AnimationPlayer`, an `AnimationTree` or a script. Hips and legs always walk.
    ///
    /// The spine keeps the animation's orientation relative to the character, whatever the hips do, so steps do not shake
    /// an aimed weapon. All weights can be keyed and changed at any time without a jump in the pose.
    #[export(range = (0.0, 1.0, 0.01))]
    #[init(val = 1.0)]
    spine_weight: f64,

    /// Weight of the walk in the pose of `Neck` and `Head`. At 0 they keep the animation's orientation relative to the character.
    #[export(range = (0.0, 1.0, 0.01))]
    #[init(val = 1.0)]
    head_weight: f64,

    /// Weight of the walk in the left arm's pose, from shoulder to hand. At 0 the arm follows the walking chest, posed by the animation.
    #[export(range = (0.0, 1.0, 0.01))]
    #[init(val = 1.0)]
    left_arm_weight: f64,

    /// Weight of the walk in the right arm's pose, from shoulder to hand. At 0 the arm follows the walking chest, posed by the animation.
    #[export(range = (0.0, 1.0, 0.01))]
    #[init(val = 1.0)]
    right_arm_weight: f64,

    /// Seed of the walk. Equal seeds give equal walks.
    ///
    /// 0 derives the seed and the initial phase from the node's path in its scene: the walk is the same whenever the scene runs, and differs between nodes.
    /// `get_effective_seed()` returns the seed in use. A saved state holds the seed, so a loaded walk continues alike wherever the node is. Changing it starts the
    /// walk anew.
    #[export]
    #[var(set = set_seed)]
    seed: i64,

    /// Phase of the stride at which the walk starts: 0 at the left initial contact, 0.5 at the right, up to 1.
    ///
    /// With a `seed` of 0 it is relative to the node's own initial phase. Changing it starts the walk anew.
    #[export(range = (0.0, 1.0, 0.01))]
    #[var(set = set_phase)]
    phase: f64,

    /// Variation between steps: 0 repeats the same step, 1 varies as in people.
    ///
    /// Changing it starts the walk anew.
    #[export(range = (0.0, 1.0, 0.01, or_greater))]
    #[var(set = set_variation)]
    #[init(val = 1.0)]
    variation: f64,

    /// Motion of the standing character: 0 is a still pose; 1 sways, breathes, shifts weight and looks about as people do; up to 2.
    ///
    /// Feet stay planted. Seeds differ, and the motion does not loop. It fades in as the character comes to rest and out with the first
    /// step. Models without standing motion, such as those of earlier versions and every `.footdyn`, stand in a still pose.
    #[export(range = (0.0, 2.0, 0.01))]
    #[init(val = 1.0)]
    standing_motion: f64,

    /// Resolution of the walk: every frame of the model, every second (half) or every fourth (quarter).
    ///
    /// Lower it for characters far from the camera. The walk is the same, but feet slip slightly between frames. Auto chooses by the character's height in the
    /// viewport of the current camera: full from 150 pixels, half from 40, quarter below, and full without a camera; `get_current_detail()` returns its choice.
    /// Changes apply with the next step.
    #[export]
    detail: GaitDetail,

    /// If `true`, the character walks. If `false`, it holds its pose.
    #[export]
    #[init(val = true)]
    playing: bool,

    /// If `true`, the walk moves the character.
    ///
    /// On: the node of `character` travels so that the standing foot does not move. Off: the character
    /// walks in place, and `get_root_motion_delta()` returns the travel.
    #[export]
    #[init(val = true)]
    root_motion: bool,

    /// The `Node3D` that travels, above the `Skeleton3D`. Its Y axis is up.
    ///
    /// If empty, the nearest `CharacterBody3D` above the skeleton travels; without one, the root of the scene that contains the skeleton,
    /// which for an imported character is its top node.
    #[export(node_path = ("Node3D"))]
    #[var(set = set_character)]
    character: NodePath,

    /// Assignment of bones to the joints of the profile, for rigs that are not recognised. It takes precedence over bone names.
    #[export]
    #[var(set = set_bone_map)]
    bone_map: Option<Gd<BoneMap>>,

    /// Identity of the walk for other peers of a multiplayer game. A `MultiplayerSynchronizer`, such as the add-on's `controller/gait_synchronizer.tscn`, replicates it
    /// On Change and with Spawn. Peers without multiplayer authority over the node that travels receive it and make that walker's steps. Empty until the walk begins.
    #[var(get = get_replica_identity, set = set_replica_identity)]
    replica_identity: PhantomVar<PackedByteArray>,

    /// Progress of the walk for other peers: 24 bytes, replicated Always, every 0.03 to 0.07 s. Updates may be lost.
    /// On peers that receive it nothing else steers the character. The next steps walk off a difference in place; beyond 0.75 m the character is moved. Places are relative to the parent of the
    /// node that travels, or of the `CharacterBody3D` that holds it: do not also replicate `position` and `rotation`.
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
    session: Option<WalkSession>,
    /// The walk that went on before the node left the tree or its skeleton.
    absent: Option<Absent>,
    announced: Announced,
    travelled: RootMotion,
    /// Velocity of the character on the ground in the last frame: metres and radians a second.
    velocity: (Vec3, f32),
    ownership: Ownership,
    request: Option<Request>,
    rivals: Rivals,
    /// Share of the speed that is left on the ground at hand: 1 on level ground.
    #[init(val = 1.0)]
    slowed: f32,
    /// True on ground on which nobody runs.
    climbs: bool,
    replica: Replica,
    auto_detail: AutoDetail,
    base: Base<SkeletonModifier3D>,
}

engine_calls!(GaitGenerator3D);

#[godot_api]
impl GaitGenerator3D {
    /// Emitted when a foot touches down: `foot` is `left` or `right`, `position` the middle of the contact on the ground, in global space.
    ///
    /// Emitted exactly once for every initial contact, not in the editor.
    #[signal]
    fn footstep(foot: StringName, position: Vector3);

    /// Emitted when a step begins: `foot`, `left` or `right`, will land at `position` in `seconds` if nothing changes the walk.
    ///
    /// `position` is in global space, on the flat floor of the walk. Emitted once for every step, not in the editor.
    #[signal]
    fn foothold_planned(foot: StringName, position: Vector3, seconds: f64);

    /// Emitted with the first step of a new gait: `gait` is `walk` or `run`. Not emitted in the editor.
    #[signal]
    fn gait_changed(gait: StringName);

    /// Emitted when the character leaves the ground in a jump. Not emitted in the editor.
    #[signal]
    fn took_off();

    /// Emitted when a foot, `left` or `right`, lands after a jump: one foot after a leap, both after a two-footed jump. Not emitted in the editor.
    #[signal]
    fn landed(foot: StringName);

    /// Emitted after `take_over()`, when the previous pose has faded out.
    #[signal]
    fn taken_over();

    /// Emitted when a peer's message about this walk is refused: `reason` gives the cause and what to do. Emitted every five seconds at most; the walk continues.
    #[signal]
    fn replica_refused(reason: GString);

    /// Emitted after `hand_over()`, when other animation poses the whole skeleton.
    #[signal]
    fn handed_over();

    #[func]
    fn set_model(&mut self, model: Option<Gd<GaitModel>>) {
        self.model = shipped::instead_of_new(model);
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
        self.identity_bytes()
    }

    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_replica_identity(&mut self, identity: PackedByteArray) {
        self.receive_identity(&identity);
    }

    #[func]
    fn get_replica_state(&self) -> PackedByteArray {
        self.state_bytes()
    }

    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_replica_state(&mut self, state: PackedByteArray) {
        self.receive_state(&state);
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
        self.bone_map = bones::completed(bone_map);
        self.restart();
    }
}
