//! `FootPlacement3D`: keeps feet on uneven ground.

mod frame;
mod marks;
mod methods;
mod session;

use crate::bones;
use crate::character;
use crate::gait_generator_3d::GaitGenerator3D;
use crate::modifier::{BodyModifier, engine_calls};
use crate::physics_ground::{PhysicsGround, own_bodies};
use footfall_core::Pose;
use footfall_ik::placement::{ContactThresholds, FootPlacer, Landing, PlacementConfig};
use godot::classes::{BoneMap, ISkeletonModifier3D, Skeleton3D, SkeletonModifier3D};
use godot::prelude::*;
use marks::Marks;
use session::PlacementSession;

/// Time constant with which the character rises and falls with the ground, seconds.
const RISE_SECS: f32 = 0.12;

/// Places the feet of an animation on the ground: slopes, stairs, rough ground and moving platforms.
///
/// Add it under a `Skeleton3D` with humanoid bones, below the node that animates it: a `GaitGenerator3D`, or an `AnimationPlayer` or
/// `AnimationTree` elsewhere. A standing foot is locked in place, in the plane of the ground. The pelvis moves so that
/// both legs reach, and a swinging foot keeps clear of edges. With a `GaitGenerator3D` the node knows in advance where and when each
/// foot will land. With other animation it detects a contact from a low and slow foot; feet then settle a little later.
///
/// The animation should move over a flat floor at the height of the character's origin. Ground is everything on `collision_mask`.
#[derive(GodotClass)]
#[class(tool, init, base = SkeletonModifier3D)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "the inspector shows check boxes"
)]
pub(crate) struct FootPlacement3D {
    /// The physics layers that are ground. Bodies of the character itself are never ground.
    #[export(flags_3d_physics)]
    #[var(set = set_collision_mask)]
    #[init(val = 1)]
    collision_mask: u32,

    /// Radius of the spheres that find ground. At 0 rays find it, which is faster; spheres bridge gaps.
    #[export(range = (0.0, 0.2, 0.001, suffix = "m"))]
    #[var(set = set_cast_radius)]
    cast_radius: f64,

    /// Height of the highest edge that feet follow. Higher edges are walls, and deeper ones drops: no foot goes there. The ground ahead is followed edge by
    /// edge, so a staircase of lower steps is never out of reach.
    #[export(range = (0.0, 1.0, 0.01, or_greater, suffix = "m"))]
    #[init(val = 0.5)]
    max_step: f64,

    /// Limit of a foot's tilt relative to the animation.
    #[export(range = (0.0, 60.0, 0.1, radians_as_degrees))]
    #[init(val = 0.6)]
    max_tilt: f64,

    /// Half-life of the pelvis' vertical motion.
    #[export(range = (0.01, 0.5, 0.01, or_greater, suffix = "s"))]
    #[init(val = 0.08)]
    pelvis_half_life: f64,

    /// Limit of the pelvis' offset from the animation.
    #[export(range = (0.0, 1.0, 0.01, or_greater, suffix = "m"))]
    #[init(val = 0.6)]
    max_pelvis_offset: f64,

    /// Distance between a locked foot and the animation beyond which the foot is planted again.
    #[export(range = (0.0, 0.5, 0.01, or_greater, suffix = "m"))]
    #[init(val = 0.2)]
    max_drift: f64,

    /// Angle between a locked foot and the animation beyond which the foot is planted again.
    #[export(range = (0.0, 90.0, 0.1, radians_as_degrees))]
    #[init(val = 0.6)]
    max_twist: f64,

    /// If `true`, a foothold that crosses an edge, as on stairs, is moved ahead, back or aside. A `GaitGenerator3D` beside this
    /// node adapts the length of its steps to that, and to ground that is too high or too low for one step.
    #[export]
    #[init(val = true)]
    adjust_footholds: bool,

    /// If `true`, a `GaitGenerator3D` beside this node moves more slowly uphill, downhill and on stairs, as people do (Tobler's hiking
    /// function, down to 0.45 of its speed), starting one step ahead. A runner walks on stairs and on grades above a quarter.
    #[export]
    #[init(val = true)]
    adapt_speed: bool,

    /// If `true`, the character moves up and down with the ground under its feet, for characters without physics.
    ///
    /// Leave it off for a `CharacterBody3D` with gravity and `move_and_slide()`.
    #[export]
    follow_ground: bool,

    /// If `true`, the character is in the air and feet follow the animation. Set it from the game, for example
    /// `foot_placement.in_air = not is_on_floor()`. Jumps of a `GaitGenerator3D` beside this node need no setting.
    #[var]
    in_air: bool,

    /// The `Node3D` whose origin is on the floor of the animation, above the `Skeleton3D`. Its Y axis is up.
    ///
    /// If empty, it is the node that a `GaitGenerator3D` beside this node moves or would move.
    #[export(node_path = ("Node3D"))]
    #[var(set = set_character)]
    character: NodePath,

    /// Assignment of bones to the joints of the profile, for rigs that are not recognised. It takes precedence over bone names. If empty, the map of a
    /// `GaitGenerator3D` beside this node is used.
    #[export]
    #[var(set = set_bone_map)]
    bone_map: Option<Gd<BoneMap>>,

    /// If `true`, soles and ground normals are drawn: green where a foot is locked, orange elsewhere.
    #[export]
    debug_draw: bool,

    /// Feet that are bound to the skeleton; `None` until the next frame that can bind one.
    session: Option<PlacementSession>,
    reported: Option<String>,
    /// Contacts and landings that were given for this frame.
    fed: Option<([bool; 2], [Option<Landing>; 2])>,
    marks: Marks,
    base: Base<SkeletonModifier3D>,
}

engine_calls!(FootPlacement3D);

#[godot_api]
impl FootPlacement3D {
    /// Emitted when a foot is locked to the ground: `foot` is `left` or `right`, `position` the ground under its ankle in global space, `normal` the
    /// ground's normal. Emitted once for every contact, not in the editor.
    #[signal]
    fn foot_planted(foot: StringName, position: Vector3, normal: Vector3);

    /// Emitted when a foot leaves the ground. Not emitted in the editor.
    #[signal]
    fn foot_lifted(foot: StringName);

    #[func]
    fn set_collision_mask(&mut self, collision_mask: u32) {
        self.collision_mask = collision_mask;
        self.reset();
    }

    #[func]
    fn set_cast_radius(&mut self, cast_radius: f64) {
        if cast_radius.is_finite() {
            self.cast_radius = cast_radius.max(0.0);
            self.reset();
        }
    }

    #[func]
    fn set_character(&mut self, character: NodePath) {
        self.character = character;
        self.reset();
    }

    #[func]
    fn set_bone_map(&mut self, bone_map: Option<Gd<BoneMap>>) {
        self.bone_map = bones::completed(bone_map);
        self.reset();
    }
}

impl FootPlacement3D {
    /// Takes contacts and landings for the next frame from the node that poses the skeleton.
    pub(crate) fn feed(&mut self, contacts: [bool; 2], landings: [Option<Landing>; 2]) {
        self.fed = Some((contacts, landings));
    }

    /// Begins anew with the next frame.
    pub(crate) fn forget(&mut self) {
        self.session = None;
        self.reported = None;
    }

    fn config(&self) -> PlacementConfig {
        let or = |value: f64, otherwise: f32| {
            if value.is_finite() {
                value.max(0.0) as f32
            } else {
                otherwise
            }
        };
        let usual = PlacementConfig::default();
        PlacementConfig {
            max_step_m: or(self.max_step, usual.max_step_m),
            max_tilt: or(self.max_tilt, usual.max_tilt),
            pelvis_half_life_secs: or(self.pelvis_half_life, usual.pelvis_half_life_secs),
            max_pelvis_m: or(self.max_pelvis_offset, usual.max_pelvis_m),
            max_drift_m: or(self.max_drift, usual.max_drift_m),
            max_twist: or(self.max_twist, usual.max_twist),
            adjust_footholds: self.adjust_footholds,
            contact: ContactThresholds::default(),
        }
    }
}

impl BodyModifier for FootPlacement3D {
    type Session = PlacementSession;

    fn character_path(&self) -> &NodePath {
        &self.character
    }

    fn bone_map_for(&self, skeleton: &Gd<Skeleton3D>) -> Option<Gd<BoneMap>> {
        let own = self.bone_map.clone();
        own.or_else(|| generator_beside(skeleton)?.bind().bone_map_for(skeleton))
    }

    fn find_character(&self, skeleton: &Gd<Skeleton3D>) -> Result<Gd<Node3D>, String> {
        match generator_beside(skeleton) {
            Some(generator) if self.character.is_empty() => {
                generator.bind().find_character(skeleton)
            }
            _ => {
                let node = self.base().clone().upcast::<Node>();
                character::find(&node, skeleton, &self.character)
            }
        }
    }

    fn last_problem(&mut self) -> &mut Option<String> {
        &mut self.reported
    }

    fn take_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<PlacementSession, String> {
        if let Some(session) = self.session.take()
            && session.character.is_instance_valid()
            && session.character.is_inside_tree()
            && session.binding.fits(skeleton, &session.character)
        {
            return Ok(session);
        }
        let (character, binding) = self.bind(skeleton)?;
        let exclude = own_bodies(&character);
        Ok(PlacementSession {
            placer: FootPlacer::new(&binding.body, &self.config()),
            pose: Pose::rest(&binding.body),
            ground: PhysicsGround::new(self.collision_mask, self.cast_radius as f32, &exclude),
            binding,
            character,
        })
    }

    fn advance(&mut self, session: PlacementSession, skeleton: Gd<Skeleton3D>, delta: f64) {
        self.place(session, skeleton, delta);
    }

    fn interrupt(&mut self) {
        self.forget();
    }

    fn leave_tree(&mut self) {
        self.marks.remove();
    }

    fn problems(&self) -> PackedStringArray {
        let mut problems = PackedStringArray::new();
        if self.collision_mask == 0 {
            problems.push("Collision Mask is empty. Choose the physics layers that are ground.");
        }
        if let Some(problem) = self.skeleton_problem() {
            problems.push(&problem);
        }
        if let Some(skeleton) = self.base().get_skeleton()
            && let Some(generator) = generator_beside(&skeleton)
            && generator.get_index() > self.base().get_index()
        {
            problems.push(
                "Move this node below the GaitGenerator3D. Modifiers run from top to bottom.",
            );
        }
        problems
    }
}

/// The generator that walks the same skeleton.
fn generator_beside(skeleton: &Gd<Skeleton3D>) -> Option<Gd<GaitGenerator3D>> {
    let children = skeleton.get_children();
    children
        .iter_shared()
        .find_map(|child| child.try_cast::<GaitGenerator3D>().ok())
}
