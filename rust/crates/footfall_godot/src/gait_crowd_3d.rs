//! `GaitCrowd3D`: thousands of walkers from one node.

mod actors;
mod batch;
mod behaviour;
mod bounds;
mod crowd_material;
mod crowd_mesh;
mod flock;
mod frame;
mod ground;
mod instances;
mod making;
mod members;
mod navigation;
mod others;
mod paint;
mod replica;
mod scene;
mod shared_flock;
mod sizes;
mod stand_in_mesh;

use crate::gait_model::GaitModel;
use crate::gait_style::GaitStyle;
use crate::shipped::{self, Fallback};
use behaviour::{CrowdBehaviour, FASTEST_MPS, MOST_AGENTS};
pub(crate) use crowd_material::release_shader;
use crowd_mesh::CrowdMesh;
use footfall_rig::crowd::Crowd;
use godot::classes::{Engine, INode3D, Node3D, PackedScene, ShaderMaterial};
use godot::prelude::*;
use others::Others;
use replica::Replica;
use scene::CrowdScene;

/// Warning where there is no character.
const NO_CHARACTER: &str = "There is no character. Load a scene with a humanoid character into Character, for example an imported .glb.";

/// Walks thousands of characters, each with its own style, speed, size, phase and steps.
///
/// Set its `model`, its `character` (a scene with a humanoid skeleton) and the number of walkers, `count`. Walkers wander over an area,
/// follow a `Path3D`, or do what a script sets, and avoid each other.
///
/// The distance from the camera determines how walkers are drawn. The nearest are full scenes with all their nodes,
/// such as a `FootPlacement3D`. The next are instances of one mesh with poses streamed to the GPU, new in every
/// frame. More distant ones update every few frames, are blended in between, and walk in shared steps. Those who are only a few pixels high
/// are drawn as stand-ins of few triangles. Numbers and distances are settings.
///
/// Equal seeds, sizes and time steps give equal crowds, if the camera moves equally: distant walkers share steps.
#[derive(GodotClass)]
#[class(tool, init, base = Node3D)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "the inspector shows check boxes"
)]
pub(crate) struct GaitCrowd3D {
    /// The gait model: a `.footfall` file such as `addons/footfall/models/locomotion.footfall`, which is also used if this is empty.
    #[export]
    #[var(set = set_model, usage_flags = [DEFAULT, EDITOR_INSTANTIATE_OBJECT])]
    model: Option<Gd<GaitModel>>,

    /// Styles of walkers: `.footstyle` files made for this model.
    #[export]
    #[var(set = set_styles)]
    styles: Array<Option<Gd<GaitStyle>>>,

    /// Greatest weight of a walker's style. Each walker has one of `styles` or none, drawn by its seed.
    #[export(range = (0.0, 1.5, 0.01))]
    #[var(set = set_style_amount)]
    #[init(val = 1.0)]
    style_amount: f64,

    /// The character: a scene with a `Skeleton3D` with humanoid bones and a skinned mesh, such as an imported `.glb`.
    #[export]
    #[var(set = set_character)]
    character: Option<Gd<PackedScene>>,

    /// Number of the crowd's own walkers; `add_agents()` adds more. At run time, raising it adds walkers and lowering it removes
    /// the latest ones; the others continue.
    #[export(range = (0.0, 20000.0, 1.0, or_greater))]
    #[var(set = set_count)]
    #[init(val = 200)]
    count: i64,

    /// Behaviour of the walkers: they wander over `area`, follow `path`, walk between places of the
    /// world's navigation map, or do only what a script sets.
    #[export]
    #[var(set = set_behaviour)]
    behaviour: CrowdBehaviour,

    /// Size of the rectangle around this node in which walkers start and wander.
    #[export(range = (0.0, 1000.0, 0.1, or_greater, suffix = "m"))]
    #[var(set = set_area)]
    #[init(val = Vector2::new(40.0, 40.0))]
    area: Vector2,

    /// The `Path3D` that walkers follow, side by side within `path_width`.
    #[export(node_path = ("Path3D"))]
    #[var(get = get_followed_path, set = set_path)]
    path: NodePath,

    /// Width of the stream of walkers along `path`.
    #[export(range = (0.0, 50.0, 0.1, or_greater, suffix = "m"))]
    #[var(set = set_path_width)]
    #[init(val = 4.0)]
    path_width: f64,

    /// Navigation layers of the walkers, for `behaviour` navigate and `set_destinations()`.
    #[export(flags_3d_navigation)]
    #[init(val = 1)]
    navigation_layers: u32,

    /// Speed of the slowest and of the fastest walker. Above about 2 m/s they run, if the model can.
    #[export(range = (0.4, 4.0, 0.01, or_greater, or_less, suffix = "m/s"))]
    #[var(set = set_speed_range)]
    #[init(val = Vector2::new(0.95, 1.55))]
    speed_range: Vector2,

    /// Size of the smallest and of the largest walker, relative to the character.
    #[export(range = (0.5, 2.0, 0.01, or_greater, or_less))]
    #[var(set = set_size_range)]
    #[init(val = Vector2::new(0.92, 1.08))]
    size_range: Vector2,

    /// Colours, one of which multiplies the material's colour of each walker. If empty, white.
    #[export]
    #[var(set = set_colours)]
    colours: PackedColorArray,

    /// Seed of the crowd. Equal seeds give equal crowds.
    #[export]
    #[var(set = set_seed)]
    seed: i64,

    /// Motion of standing walkers: 0 is a still pose; 1 sways, breathes, shifts weight and looks about as people do; up to 2. Models without
    /// standing motion stand in a still pose.
    #[export(range = (0.0, 2.0, 0.01))]
    #[init(val = 1.0)]
    standing_motion: f64,

    /// If `true`, walkers with a goal avoid each other.
    #[export]
    #[init(val = true)]
    avoidance: bool,

    /// Group of nodes that walkers with a goal also avoid, such as players; a `GaitCrowd3D` in it counts with all its walkers.
    /// If empty, walkers avoid only each other.
    #[export]
    avoided_group: StringName,

    /// If `true`, time advances.
    #[export]
    #[init(val = true)]
    playing: bool,

    /// Physics layers of the ground, queried once per step and walker. If none, the ground is flat, at the height of
    /// this node.
    #[export(flags_3d_physics)]
    ground_mask: u32,

    /// Number of the nearest walkers that are full scenes.
    #[export_group(name = "Tiers")]
    #[export(range = (0.0, 200.0, 1.0, or_greater))]
    #[init(val = 12)]
    full_count: i64,

    /// Greatest distance of full scenes from the camera.
    #[export(range = (0.0, 100.0, 0.1, or_greater, suffix = "m"))]
    #[init(val = 12.0)]
    full_distance: f64,

    /// Number of walkers beyond them with a new pose in every frame.
    #[export(range = (0.0, 10000.0, 1.0, or_greater))]
    #[init(val = 600)]
    near_count: i64,

    /// Greatest distance of these walkers from the camera.
    #[export(range = (0.0, 500.0, 0.1, or_greater, suffix = "m"))]
    #[init(val = 60.0)]
    near_distance: f64,

    /// If `true`, more distant walkers walk in steps that all walkers of the same style share, and cost one kilobyte of memory each. Each keeps its speed, but not its own gait.
    #[export]
    #[init(val = true)]
    repeat_far: bool,

    /// Height on screen below which walkers are drawn as stand-ins: about 150 triangles around the same body, in the same steps and colours, made of the
    /// character's mesh. 0 turns stand-ins off. Walkers with a `material` of your own keep their mesh.
    #[export(range = (0.0, 200.0, 1.0, or_greater, suffix = "px"))]
    #[init(val = 24.0)]
    stand_in_pixels: f64,

    /// If `true`, walkers outside the camera's view get no poses.
    #[export]
    #[init(val = true)]
    culling: bool,

    /// Material with a shader of your own that includes `addons/footfall/shaders/crowd_pose.gdshaderinc`. If empty, instances are
    /// drawn with the colours and the texture of the character's own materials.
    #[export]
    #[var(set = set_material)]
    material: Option<Gd<ShaderMaterial>>,

    /// If `true`, the crowd repeats another peer's crowd of a multiplayer game: `hear_message()` adds, removes and moves walkers with the same ids, while `count`, `behaviour` and calls
    /// that steer walkers have no effect. If set back to `false`, it continues by itself with the same walkers. `controller/crowd_synchronizer.tscn` sets it.
    #[var(get = get_follows, set = set_follows)]
    follows: PhantomVar<bool>,

    /// The add-on's own walk, where `model` is empty.
    fallback: Fallback<GaitModel>,
    walkers: Option<Crowd>,
    /// Mesh of the character, until the scene has it.
    mesh: Option<CrowdMesh>,
    scene: Option<CrowdScene>,
    others: Others,
    replica: Replica,
    /// True if scripts sent walkers over the navigation map.
    sends: bool,
    /// Row of the walker whose place on the map is checked next.
    kept: usize,
    /// Problem that kept the crowd from being created, until a setting changes.
    problem: Option<String>,
    base: Base<Node3D>,
}

#[godot_api]
impl INode3D for GaitCrowd3D {
    fn enter_tree(&mut self) {
        self.base_mut().set_process(true);
        self.forget();
    }

    fn exit_tree(&mut self) {
        self.forget();
    }

    fn process(&mut self, delta: f64) {
        let in_editor = Engine::singleton().is_editor_hint();
        let dt = if self.playing && !in_editor && delta.is_finite() {
            delta.clamp(0.0, 0.25) as f32
        } else {
            0.0
        };
        self.advance_by(dt, false);
    }

    fn get_configuration_warnings(&self) -> PackedStringArray {
        self.problems()
    }
}

#[godot_api]
impl GaitCrowd3D {
    /// `behaviour`: walkers walk between places of `area`.
    #[constant]
    const WANDER: i32 = CrowdBehaviour::Wander as i32;
    /// `behaviour`: walkers follow `path`.
    #[constant]
    const PATH: i32 = CrowdBehaviour::Path as i32;
    /// `behaviour`: walkers follow `set_targets()`, `set_destinations()` or `set_turn_rates()`.
    #[constant]
    const SCRIPTED: i32 = CrowdBehaviour::Scripted as i32;

    /// `behaviour`: walkers walk between places of the world's navigation map, around obstacles. A few hundred find their
    /// first path within a second.
    #[constant]
    const NAVIGATE: i32 = CrowdBehaviour::Navigate as i32;

    /// Emitted once per frame with all contacts of the frame: ids of walkers, feet (0 left, 1 right), and positions in global space.
    #[signal]
    fn footsteps(agents: PackedInt32Array, feet: PackedByteArray, positions: PackedVector3Array);

    /// Emitted with the ids of walkers that were created and began to walk in the last frame. Creation runs on other threads; `is_making()` returns
    /// `true` while more are pending.
    #[signal]
    fn agents_ready(agents: PackedInt32Array);

    /// Emitted when a message about the crowd that this one follows is refused: `reason` gives the cause and what to do. See `hear_message()`.
    #[signal]
    fn message_refused(reason: GString);

    #[func]
    fn set_model(&mut self, model: Option<Gd<GaitModel>>) {
        self.model = shipped::instead_of_new(model);
        self.restart();
    }

    #[func]
    fn set_styles(&mut self, styles: Array<Option<Gd<GaitStyle>>>) {
        self.styles = styles;
        self.restart();
    }

    #[func]
    fn set_style_amount(&mut self, style_amount: f64) {
        if style_amount.is_finite() {
            self.style_amount = style_amount;
            self.restart();
        }
    }

    #[func]
    fn set_character(&mut self, character: Option<Gd<PackedScene>>) {
        self.character = character;
        self.restart();
    }

    #[func]
    fn set_count(&mut self, count: i64) {
        if count > MOST_AGENTS {
            godot_warn!(
                "A crowd holds {MOST_AGENTS} walkers at most. Count {count} is limited to that."
            );
        }
        self.count = count.clamp(0, MOST_AGENTS);
        if let Some(walkers) = &mut self.walkers {
            let places = walkers.set_count(self.count as usize);
            self.left(&places);
        }
    }

    #[func]
    fn set_behaviour(&mut self, behaviour: CrowdBehaviour) {
        self.behaviour = behaviour;
        self.restart();
    }

    #[func]
    fn set_area(&mut self, area: Vector2) {
        if area.is_finite() {
            self.area = area.abs();
            self.restart();
        }
    }

    /// A getter named after the property would hide the node's own `get_path()`.
    #[func]
    fn get_followed_path(&self) -> NodePath {
        self.path.clone()
    }

    #[func]
    fn set_path(&mut self, path: NodePath) {
        self.path = path;
        self.restart();
    }

    #[func]
    fn set_path_width(&mut self, path_width: f64) {
        if path_width.is_finite() {
            self.path_width = path_width.max(0.0);
            self.restart();
        }
    }

    #[func]
    fn set_speed_range(&mut self, speed_range: Vector2) {
        if speed_range.is_finite() {
            self.speed_range = speed_range.clamp(Vector2::ZERO, Vector2::splat(FASTEST_MPS));
            self.restart();
        }
    }

    #[func]
    fn set_size_range(&mut self, size_range: Vector2) {
        if size_range.is_finite() {
            self.size_range = size_range.clamp(Vector2::splat(0.1), Vector2::splat(10.0));
            self.restart();
        }
    }

    #[func]
    fn set_colours(&mut self, colours: PackedColorArray) {
        self.colours = colours;
        self.restart();
    }

    #[func]
    fn set_seed(&mut self, seed: i64) {
        self.seed = seed;
        self.restart();
    }

    #[func]
    fn get_follows(&self) -> bool {
        self.replica.follows
    }

    #[func]
    fn set_follows(&mut self, follows: bool) {
        self.let_follow(follows);
    }

    #[func]
    fn set_material(&mut self, material: Option<Gd<ShaderMaterial>>) {
        self.material = material;
        self.restart();
    }
}
