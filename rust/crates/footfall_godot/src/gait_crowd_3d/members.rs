//! Methods for scripts that add, remove, find and save walkers.

use super::GaitCrowd3D;
use crate::convert;
use footfall_rig::crowd::{Crowd, MOST_AGENTS, SavedCrowd};
use godot::classes::{Node, Node3D};
use godot::prelude::*;

/// The id that stands for no walker.
const NOBODY: i32 = -1;

#[godot_api(secondary)]
impl GaitCrowd3D {
    /// Adds walkers at these positions and headings (radians about +Y from +Z; 0 if missing), in this node's space. Returns their
    /// ids in the same order, without those of non-finite positions; empty if the crowd cannot be created.
    ///
    /// Walkers have ids at once and appear when they are created, on other threads: see `agents_ready`. Five hundred a frame join the
    /// arrays, so that adding many does not stall a frame. A call that reads or sets walkers before that makes all of them join first,
    /// at their initial positions.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn add_agents(
        &mut self,
        positions: PackedVector3Array,
        #[opt(default = &PackedFloat32Array::new())] headings: PackedFloat32Array,
    ) -> PackedInt32Array {
        if self.is_others() {
            return PackedInt32Array::new();
        }
        self.make();
        let Some(walkers) = &mut self.walkers else {
            return PackedInt32Array::new();
        };
        let room = (MOST_AGENTS as usize).saturating_sub(walkers.roster().order().len());
        if positions.len() > room {
            godot_warn!(
                "A crowd holds {MOST_AGENTS} walkers at most. {} are left out.",
                positions.len() - room
            );
        }
        let places = positions.as_slice().iter().take(room).enumerate();
        let starts: Vec<_> = places
            .map(|(index, place)| (convert::vec3(*place), headings.get(index).unwrap_or(0.0)))
            .filter(|(place, heading)| place.is_finite() && heading.is_finite())
            .collect();
        walkers.add(starts.into_iter()).into()
    }

    /// Removes the walkers with these ids. Other walkers keep their ids and goals.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn remove_agents(&mut self, agents: PackedInt32Array) {
        self.make_whole();
        let Some(walkers) = &mut self.walkers else {
            return;
        };
        let names = agents.as_slice().iter();
        let mut places: Vec<usize> = names
            .filter_map(|name| walkers.roster().place(*name))
            .collect();
        places.sort_unstable();
        places.dedup();
        walkers.leave(&places);
        self.left(&places);
    }

    /// Removes all walkers.
    #[func]
    fn clear_agents(&mut self) {
        if let Some(walkers) = &mut self.walkers {
            let everybody = walkers.clear();
            self.left(&everybody);
        }
    }

    /// Creates the crowd again from `count` and `seed`.
    #[func]
    pub(super) fn restart(&mut self) {
        self.forget();
        self.base_mut().update_configuration_warnings();
    }

    /// Returns the number of walkers, including pending ones.
    #[func]
    fn get_agent_count(&mut self) -> i64 {
        self.make();
        let walkers = self.walkers.as_ref();
        walkers.map_or(0, |walkers| {
            i64::from(convert::count(walkers.roster().order().len()))
        })
    }

    /// Returns the ids of all walkers, in the order in which they were added. All arrays for all walkers have this order.
    ///
    /// A walker keeps its id while it is in the crowd, also through `get_state()` and `set_state()`; ids are not reused for a long
    /// time. While no walker is removed, ids are 0, 1, 2 and so on.
    #[func]
    fn get_agents(&mut self) -> PackedInt32Array {
        self.make();
        let walkers = self.walkers.iter();
        walkers.flat_map(Crowd::names).collect()
    }

    /// Returns `true` if a walker has this id.
    #[func]
    fn has_agent(&mut self, agent: i32) -> bool {
        self.make();
        self.place(agent).is_some()
    }

    /// Returns `true` while walkers are pending.
    #[func]
    fn is_making(&self) -> bool {
        let walkers = self.walkers.as_ref();
        walkers.is_some_and(Crowd::is_making)
    }

    /// Returns the id of the first walker that a ray hits, or -1. The ray goes between two points in global space, as from `Camera3D.project_ray_origin()` and
    /// `Camera3D.project_ray_normal()`. Bodies count as capsules.
    #[func]
    fn pick(&mut self, from: Vector3, to: Vector3) -> i32 {
        self.make_whole();
        let crowd_from_world = self.base().get_global_transform().affine_inverse();
        let [from, to] = [from, to].map(|point| convert::vec3(crowd_from_world * point));
        let walkers = self.walkers.as_ref();
        let met = walkers.and_then(|walkers| walkers.first_met(from, to));
        self.name_at(met)
    }

    /// Returns the id of the walker nearest to a point in global space, within `max_distance`, or -1.
    #[func]
    fn find_nearest(
        &mut self,
        position: Vector3,
        #[opt(default = f64::INFINITY)] max_distance: f64,
    ) -> i32 {
        self.make_whole();
        let world = self.base().get_global_transform();
        let near = convert::vec3(world.affine_inverse() * position);
        let scale = world.basis.get_scale().x.abs().max(1e-6);
        let reach = max_distance as f32 / scale;
        let walkers = self.walkers.as_ref();
        let nearest = walkers.and_then(|walkers| walkers.nearest(near, reach));
        self.name_at(nearest)
    }

    /// Returns the full scene that shows a walker, or `null` while it is drawn as an instance. Do not keep it: it shows another walker later.
    #[func]
    fn get_agent_node(&self, agent: i32) -> Option<Gd<Node3D>> {
        let scene = self.scene.as_ref()?;
        scene.actors().node_of(self.place(agent)?)
    }

    /// Returns the id of the walker that a node shows: a full scene of the crowd, or any node in it, such as a body that a ray has hit. -1
    /// if it shows none.
    #[func]
    fn get_agent_of(&self, node: Option<Gd<Node>>) -> i32 {
        let scene = self.scene.as_ref();
        let place = scene
            .zip(node)
            .and_then(|(scene, node)| scene.actors().walker_of(&node));
        self.name_at(place)
    }

    /// Returns the state of the crowd, to be saved: places, goals, phases and ids of all walkers. `set_state()` continues with
    /// the same walkers at the same places; their next steps are drawn again.
    #[func]
    fn get_state(&mut self) -> PackedByteArray {
        self.make_whole();
        let walkers = self.walkers.as_ref();
        let bytes = walkers.map(Crowd::save);
        bytes.unwrap_or_default().into()
    }

    /// Restores a state from `get_state()`. Other bytes are refused: the log gives the reason, and the crowd does not change.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_state(&mut self, state: PackedByteArray) {
        match SavedCrowd::from_bytes(state.as_slice()) {
            Ok(saved) if !self.is_others() && self.make_whole() => {
                if let Some(walkers) = &mut self.walkers {
                    let everybody = walkers.clear();
                    walkers.restore(&saved);
                    self.left(&everybody);
                }
            }
            Ok(_) => {}
            Err(problem) => {
                let node = self.base().get_path();
                godot_warn!("{node}: the state was refused: {problem}");
            }
        }
    }

    /// Advances time immediately, in seconds, whatever `playing` is: for tests, and for games with their own clock. The call waits for
    /// pending walkers, so that equal calls give equal crowds.
    #[func]
    fn advance(&mut self, delta: f64) {
        if delta.is_finite() {
            self.advance_by(delta.clamp(0.0, 0.25) as f32, true);
        }
    }

    /// Returns the problems that keep the crowd from walking, each with what to do next; empty if there are none.
    #[func]
    fn get_problems(&mut self) -> PackedStringArray {
        if self.problems().is_empty() {
            self.make_whole();
        }
        self.problems()
    }
}

impl GaitCrowd3D {
    fn place(&self, name: i32) -> Option<usize> {
        self.walkers.as_ref()?.roster().place(name)
    }

    fn name_at(&self, place: Option<usize>) -> i32 {
        let walkers = self.walkers.as_ref().zip(place);
        walkers.map_or(NOBODY, |(walkers, place)| walkers.roster().name(place))
    }

    /// Removes the walkers of these rows from the scene.
    pub(super) fn left(&mut self, places: &[usize]) {
        if let Some(scene) = &mut self.scene {
            scene.leave(places);
        }
    }
}
