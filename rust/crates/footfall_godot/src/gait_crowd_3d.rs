//! `GaitCrowd3D`: thousands of walkers from one node.

mod actors;
mod agent;
mod crowd_mesh;
mod flock;
mod making;
mod navigation;
mod neighbours;
mod save;
mod scene;
mod tiers;
mod walkers;
mod way;

use crate::convert;
use crate::gait_model::{GaitModel, NO_MODEL};
use crate::gait_style::GaitStyle;
use agent::Goal;
use glam::{Vec2, Vec3};
use godot::classes::{Engine, INode3D, Node3D, PackedScene, ShaderMaterial};
use godot::prelude::*;
use navigation::Navigation;
use scene::{CrowdScene, Look};
use tiers::Limits;
use walkers::Walkers;

/// What to do where there is no character.
const NO_CHARACTER: &str = "No character. Load a scene with a humanoid character into Character, for example an imported .glb.";

/// More walkers than this are refused: their steps alone would take gigabytes.
const MOST_AGENTS: i64 = 100_000;

/// What the walkers of a crowd do by themselves.
#[derive(GodotConvert, Var, Export, Default, Clone, Copy, Debug, PartialEq)]
#[godot(via = i64)]
pub(crate) enum CrowdBehaviour {
    #[default]
    Wander = 0,
    Path = 1,
    Scripted = 2,
    Navigate = 3,
}

/// Walks thousands of characters: each in its own style, speed, size and phase, from steps of its own.
///
/// Give it a `model` and a `character`, a scene with a humanoid skeleton, and choose how many in `count`. Walkers wander over an area,
/// follow a `Path3D`, or do what a script tells them, and keep out of each other's way.
///
/// How a walker is drawn depends on its distance from the camera. The nearest are whole scenes, with everything that hangs from them,
/// such as a `FootPlacement3D`. The next are instances of one mesh whose poses are streamed to the graphics processor, new in every
/// frame; those farther away get a new pose in every few frames, blended in between, and repeat their last two steps. Counts and
/// distances are settable.
///
/// Equal seeds, sizes and time steps give equal crowds, as long as the camera moves equally too: who is far away repeats steps.
#[derive(GodotClass)]
#[class(tool, init, base = Node3D)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "the inspector shows check boxes"
)]
pub(crate) struct GaitCrowd3D {
    /// The way of walking: an imported `.footfall` file such as `addons/footfall/models/walk.footfall`.
    #[export]
    #[var(set = set_model)]
    model: Option<Gd<GaitModel>>,

    /// Styles that walkers wear, imported `.footstyle` files that were made for this model.
    #[export]
    #[var(set = set_styles)]
    styles: Array<Option<Gd<GaitStyle>>>,

    /// How much of a style a walker wears at most. Each wears one of `styles` or none, drawn by its seed.
    #[export(range = (0.0, 1.5, 0.01))]
    #[var(set = set_style_amount)]
    #[init(val = 1.0)]
    style_amount: f64,

    /// The character: a scene with a `Skeleton3D` with humanoid bones and a skinned mesh, such as an imported `.glb`.
    #[export]
    #[var(set = set_character)]
    character: Option<Gd<PackedScene>>,

    /// How many walkers there are at the start. `add_agents()` adds more.
    #[export(range = (0.0, 20000.0, 1.0, or_greater))]
    #[var(set = set_count)]
    #[init(val = 200)]
    count: i64,

    /// What walkers do by themselves: wander over `area`, follow `path`, only what a script tells them, or go from place to place of the
    /// world's navigation map.
    #[export]
    #[var(set = set_behaviour)]
    behaviour: CrowdBehaviour,

    /// The rectangle around this node in which walkers begin and wander.
    #[export(range = (0.0, 1000.0, 0.1, or_greater, suffix = "m"))]
    #[var(set = set_area)]
    #[init(val = Vector2::new(40.0, 40.0))]
    area: Vector2,

    /// The `Path3D` that walkers follow, side by side within `path_width`.
    #[export(node_path = ("Path3D"))]
    #[var(set = set_path)]
    path: NodePath,

    /// How wide the stream of walkers along `path` is.
    #[export(range = (0.0, 50.0, 0.1, or_greater, suffix = "m"))]
    #[var(set = set_path_width)]
    #[init(val = 4.0)]
    path_width: f64,

    /// The navigation layers that walkers keep to, for `behaviour` navigate and `set_destinations()`.
    #[export(flags_3d_navigation)]
    #[init(val = 1)]
    navigation_layers: u32,

    /// The slowest and the fastest walker.
    #[export(range = (0.4, 2.2, 0.01, or_greater, or_less, suffix = "m/s"))]
    #[var(set = set_speed_range)]
    #[init(val = Vector2::new(0.95, 1.55))]
    speed_range: Vector2,

    /// The smallest and the largest walker, against the size of the character.
    #[export(range = (0.5, 2.0, 0.01, or_greater, or_less))]
    #[var(set = set_size_range)]
    #[init(val = Vector2::new(0.92, 1.08))]
    size_range: Vector2,

    /// Colours of which each walker gets one, multiplied with the colour of its material. None is white.
    #[export]
    #[var(set = set_colours)]
    colours: PackedColorArray,

    /// Which crowd of the many that there could be. Equal seeds give equal crowds.
    #[export]
    #[var(set = set_seed)]
    seed: i64,

    /// Whether walkers with a goal keep out of each other's way.
    #[export]
    #[init(val = true)]
    avoidance: bool,

    /// Whether time passes.
    #[export]
    #[init(val = true)]
    playing: bool,

    /// The physics layers that are ground, looked at once for every step of every walker. None: the ground is flat, at the height of
    /// this node.
    #[export(flags_3d_physics)]
    ground_mask: u32,

    /// How many of the nearest walkers are whole scenes.
    #[export_group(name = "Tiers")]
    #[export(range = (0.0, 200.0, 1.0, or_greater))]
    #[init(val = 12)]
    full_count: i64,

    /// How far from the camera they are at most.
    #[export(range = (0.0, 100.0, 0.1, or_greater, suffix = "m"))]
    #[init(val = 12.0)]
    full_distance: f64,

    /// How many walkers beyond them have a new pose in every frame.
    #[export(range = (0.0, 10000.0, 1.0, or_greater))]
    #[init(val = 600)]
    near_count: i64,

    /// How far from the camera they are at most.
    #[export(range = (0.0, 500.0, 0.1, or_greater, suffix = "m"))]
    #[init(val = 60.0)]
    near_distance: f64,

    /// Whether walkers beyond that repeat their last two steps instead of taking new ones.
    #[export]
    #[init(val = true)]
    repeat_far: bool,

    /// Whether poses of walkers whom the camera does not see are left out.
    #[export]
    #[init(val = true)]
    culling: bool,

    /// A material with a shader of your own, which includes `addons/footfall/shaders/crowd_pose.gdshaderinc`. Left empty, instances are
    /// drawn with the colours and the texture of the character's own materials.
    #[export]
    #[var(set = set_material)]
    material: Option<Gd<ShaderMaterial>>,

    walkers: Option<Walkers>,
    scene: Option<CrowdScene>,
    /// Whether the crowd could not be made and nothing has changed since.
    failed: bool,
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
        self.advance_by(dt);
    }

    fn get_configuration_warnings(&self) -> PackedStringArray {
        self.problems()
    }
}

#[godot_api]
impl GaitCrowd3D {
    /// `behaviour`: walkers go from one place of `area` to another.
    #[constant]
    const WANDER: i32 = CrowdBehaviour::Wander as i32;
    /// `behaviour`: walkers follow `path`.
    #[constant]
    const PATH: i32 = CrowdBehaviour::Path as i32;
    /// `behaviour`: walkers do what `set_targets()`, `set_destinations()` or `set_turn_rates()` tell them.
    #[constant]
    const SCRIPTED: i32 = CrowdBehaviour::Scripted as i32;

    /// `behaviour`: walkers go from place to place of the world's navigation map, around what is between them. A few hundred find their
    /// first way within a second.
    #[constant]
    const NAVIGATE: i32 = CrowdBehaviour::Navigate as i32;

    /// Feet touched down in the last frame: whose, which (0 left, 1 right), and where in global space. One signal for all of them.
    #[signal]
    fn footsteps(agents: PackedInt32Array, feet: PackedByteArray, positions: PackedVector3Array);

    /// Adds walkers at these places, facing these headings (radians about +Y from +Z; none are 0), in this node's space. Returns the
    /// index of the first, or -1 when the crowd cannot be made.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn add_agents(&mut self, positions: PackedVector3Array, headings: PackedFloat32Array) -> i64 {
        if !self.make() {
            return -1;
        }
        let Some(walkers) = &mut self.walkers else {
            return -1;
        };
        let first = i64::from(convert::count(walkers.agents.len()));
        let room = (MOST_AGENTS - first).max(0) as usize;
        if positions.len() > room {
            godot_warn!(
                "A crowd holds {MOST_AGENTS} walkers at most: {} are left out.",
                positions.len() - room
            );
        }
        for (index, position) in positions.as_slice().iter().take(room).enumerate() {
            let heading = headings.get(index).unwrap_or(0.0);
            if position.is_finite() && heading.is_finite() {
                walkers.add(convert::vec3(*position), heading, None);
            }
        }
        self.changed_count();
        first
    }

    /// Removes all walkers.
    #[func]
    fn clear_agents(&mut self) {
        if let Some(walkers) = &mut self.walkers {
            walkers.clear();
        }
        self.changed_count();
    }

    /// Makes the crowd anew from `count` and `seed`.
    #[func]
    fn restart(&mut self) {
        self.forget();
        self.base_mut().update_configuration_warnings();
    }

    /// How many walkers there are.
    #[func]
    fn get_agent_count(&mut self) -> i64 {
        self.make();
        self.walkers
            .as_ref()
            .map_or(0, |walkers| i64::from(convert::count(walkers.agents.len())))
    }

    /// Where all walkers are, on the ground, in this node's space.
    #[func]
    fn get_positions(&mut self) -> PackedVector3Array {
        self.each(|agent| convert::vector3(agent.place))
    }

    /// Where all walkers face, radians about +Y from +Z.
    #[func]
    fn get_headings(&mut self) -> PackedFloat32Array {
        self.each(|agent| agent.heading)
    }

    /// How much of its stride each walker has behind it: 0 when its left foot lands, 0.5 when its right foot does.
    #[func]
    fn get_phases(&mut self) -> PackedFloat32Array {
        self.each(|agent| agent.walker.phase())
    }

    /// How each walker is drawn: 0 as a whole scene, 1 with a new pose in every frame, 2 as one far away.
    #[func]
    fn get_tiers(&self) -> PackedByteArray {
        let walkers = self.walkers.as_ref();
        walkers
            .into_iter()
            .flat_map(|walkers| walkers.tiers.iter().map(|tier| *tier as u8))
            .collect()
    }

    /// The size of each walker, against the character.
    #[func]
    fn get_sizes(&mut self) -> PackedFloat32Array {
        self.each(|agent| agent.size)
    }

    /// How fast each walker would like to walk, in metres per second. Missing or not finite: it stays.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_speeds(&mut self, speeds: PackedFloat32Array) {
        self.set_each(speeds.as_slice(), |agent, speed| {
            if speed.is_finite() {
                agent.speed_mps = speed.clamp(0.0, 3.0);
            }
        });
    }

    /// How fast each walker turns, in radians per second, positive to its left; it gives up its goal. For `behaviour` scripted.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_turn_rates(&mut self, turn_rates: PackedFloat32Array) {
        self.set_each(turn_rates.as_slice(), |agent, rate| {
            if rate.is_finite() {
                agent.goal = Goal::Turn(*rate);
                agent.route.clear();
            }
        });
    }

    /// Where each walker goes straight, in this node's space. It stops there. For `behaviour` scripted. Not finite: its goal stays.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_targets(&mut self, targets: PackedVector3Array) {
        self.set_each(targets.as_slice(), |agent, target| {
            if target.is_finite() {
                agent.goal = Goal::Place(Vec2::new(target.x, target.z));
                agent.route.clear();
            }
        });
    }

    /// Where each walker goes over the navigation map of the world, around what is between, in this node's space. It stops there. For
    /// `behaviour` scripted. Not finite: its goal stays. Each way takes some tens of microseconds to find, once.
    ///
    /// Returns whether there was a way for everybody; whoever has none keeps its goal. In the first frames of a scene there is no map yet.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_destinations(&mut self, destinations: PackedVector3Array) -> bool {
        let host = self.to_gd().upcast::<Node3D>();
        let Some(mut navigation) = Navigation::of(&host, self.navigation_layers) else {
            return false;
        };
        let mut all = true;
        self.set_each(destinations.as_slice(), |agent, place| {
            if place.is_finite() {
                all &= navigation.send(agent, *place);
            }
        });
        all
    }

    /// The tint of each walker.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_tints(&mut self, colours: PackedColorArray) {
        self.set_each(colours.as_slice(), |agent, colour| {
            agent.tint = linear(*colour);
        });
    }

    /// What one walker wears: weights in the order of `styles`, taken up with its next step. They are rounded to eighths, so that a
    /// crowd needs few mixtures.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_agent_style(&mut self, agent: i64, weights: PackedFloat32Array) {
        if let Some(walkers) = &mut self.walkers
            && let Ok(index) = usize::try_from(agent)
        {
            walkers.wear(index, weights.as_slice());
        }
    }

    /// The crowd as it is now, to be saved: who walks where, how, and in which phase. `set_state()` goes on from it with the same
    /// walkers at the same places; their next steps are drawn anew.
    #[func]
    fn get_state(&self) -> PackedByteArray {
        let agents = self
            .walkers
            .as_ref()
            .map(|walkers| save::write(&walkers.agents));
        agents.unwrap_or_default().into()
    }

    /// Goes on from what `get_state()` told. Bytes that are no crowd are refused: the log says why, and the crowd stays as it is.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_state(&mut self, state: PackedByteArray) {
        match save::read(state.as_slice()) {
            Ok(saved) if self.make() => {
                if let Some(walkers) = &mut self.walkers {
                    walkers.clear();
                    for agent in saved.iter().take(MOST_AGENTS as usize) {
                        walkers.add(Vec3::from(agent.place), agent.heading, Some(agent));
                    }
                }
                self.changed_count();
            }
            Ok(_) => {}
            Err(problem) => {
                let node = self.base().get_path();
                godot_warn!("{node}: the state is refused: {problem}");
            }
        }
    }

    /// Lets time pass at once, in seconds, whatever `playing` says: for tests, and for games with a clock of their own.
    #[func]
    fn advance(&mut self, delta: f64) {
        if delta.is_finite() {
            self.advance_by(delta.clamp(0.0, 0.25) as f32);
        }
    }

    /// What keeps the crowd from walking, each with what to do next; empty when nothing does.
    #[func]
    fn get_problems(&self) -> PackedStringArray {
        self.problems()
    }

    #[func]
    fn set_model(&mut self, model: Option<Gd<GaitModel>>) {
        self.model = model;
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
                "A crowd holds {MOST_AGENTS} walkers at most: count {count} is cut to that."
            );
        }
        self.count = count.clamp(0, MOST_AGENTS);
        self.restart();
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
            self.speed_range = speed_range.clamp(Vector2::ZERO, Vector2::splat(3.0));
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
    fn set_material(&mut self, material: Option<Gd<ShaderMaterial>>) {
        self.material = material;
        self.restart();
    }
}

impl GaitCrowd3D {
    fn forget(&mut self) {
        if let Some(scene) = self.scene.take() {
            scene.free();
        }
        self.walkers = None;
        self.failed = false;
    }

    /// The number of walkers changed: what draws them has to be made anew.
    fn changed_count(&mut self) {
        if let Some(scene) = self.scene.take() {
            scene.free();
        }
    }

    fn each<T, C: FromIterator<T>>(&mut self, of: impl Fn(&agent::Agent) -> T) -> C {
        self.make();
        let agents = self.walkers.iter().flat_map(|walkers| &walkers.agents);
        agents.map(of).collect()
    }

    fn set_each<T>(&mut self, values: &[T], mut set: impl FnMut(&mut agent::Agent, &T)) {
        self.make();
        if let Some(walkers) = &mut self.walkers {
            for (agent, value) in walkers.agents.iter_mut().zip(values) {
                set(agent, value);
            }
        }
    }

    fn problems(&self) -> PackedStringArray {
        let mut problems = PackedStringArray::new();
        let mut say = |problem: &str| problems.push(&GString::from(problem));
        match &self.model {
            None => say(NO_MODEL),
            Some(model) => {
                if let Err(problem) = self.space(model) {
                    say(&problem);
                }
            }
        }
        if self.character.is_none() {
            say(NO_CHARACTER);
        }
        if self.behaviour == CrowdBehaviour::Path
            && let Err(problem) = self.way()
        {
            say(&problem);
        }
        problems
    }

    fn advance_by(&mut self, dt_secs: f32) {
        if !self.make() {
            return;
        }
        let limits = self.limits();
        let (avoidance, repeat_far, mask) = (self.avoidance, self.repeat_far, self.ground_mask);
        let look = Look {
            character: self.character.clone(),
            material: self.material.clone(),
            culls: self.culling,
        };
        let host = self.to_gd().upcast::<Node3D>();
        let (Some(mut walkers), scene) = (self.walkers.take(), self.scene.take()) else {
            return;
        };
        walkers.repeat_far(repeat_far);
        if walkers.is_navigated()
            && let Some(mut navigation) = Navigation::of(&host, self.navigation_layers)
        {
            navigation.wander(&mut walkers);
        }
        walkers.advance(dt_secs, avoidance);
        scene::find_ground(&mut walkers, &host, mask);
        let scene = scene.or_else(|| {
            let _released = self.base_mut();
            CrowdScene::new(&host, &walkers, &limits, &look)
        });
        let drawn = scene.map(|mut scene| {
            let _released = self.base_mut();
            scene.draw(&mut walkers, &host, &limits, &look);
            scene
        });
        let landed = self.landed(&walkers);
        // A script that was called in between may have made everything anew.
        if self.walkers.is_none() && self.base().is_inside_tree() {
            self.walkers = Some(walkers);
            self.scene = drawn;
        } else if let Some(scene) = drawn {
            scene.free();
        }
        if let Some((agents, feet, positions)) = landed {
            self.signals().footsteps().emit(&agents, &feet, &positions);
        }
    }

    fn limits(&self) -> Limits {
        let metres = |value: f64| {
            if value.is_finite() {
                value.max(0.0) as f32
            } else {
                0.0
            }
        };
        Limits {
            counts: [self.full_count, self.near_count]
                .map(|count| count.clamp(0, MOST_AGENTS) as usize),
            distances_m: [metres(self.full_distance), metres(self.near_distance)],
        }
    }

    /// What `footsteps` has to tell, if anything; nothing in the editor.
    fn landed(
        &self,
        walkers: &Walkers,
    ) -> Option<(PackedInt32Array, PackedByteArray, PackedVector3Array)> {
        walkers.landed().next()?;
        if Engine::singleton().is_editor_hint() {
            return None;
        }
        let world = self.base().get_global_transform();
        let agents = walkers.landed().map(|(agent, ..)| convert::count(agent));
        let feet = walkers.landed().map(|(_, side, _)| side.index() as u8);
        let places = walkers
            .landed()
            .map(|(.., place)| world * convert::vector3(place));
        Some((agents.collect(), feet.collect(), places.collect()))
    }
}

/// A colour as instances have it.
fn linear(colour: Color) -> [f32; 4] {
    let colour = colour.srgb_to_linear();
    [colour.r, colour.g, colour.b, colour.a]
}
