//! Whole scenes with skeletons, lent to the walkers that are nearest.

use super::crowd_mesh::skeleton_of;
use crate::convert;
use crate::foot_placement_3d::FootPlacement3D;
use crate::gait_generator_3d::GaitGenerator3D;
use crate::skeleton_binding::SkeletonBinding;
use footfall_core::rotation::from_heading;
use footfall_rig::crowd::{Agent, FETCHED, Tier};
use footfall_synth::CrowdPose;
use godot::classes::node::ProcessMode;
use godot::classes::{BaseMaterial3D, MeshInstance3D, Node, Node3D, PackedScene, Skeleton3D};
use godot::prelude::*;
use rayon::prelude::*;

/// One scene.
struct Actor {
    node: Gd<Node3D>,
    skeleton: Gd<Skeleton3D>,
    binding: SkeletonBinding,
    placement: Option<Gd<FootPlacement3D>>,
    /// The scene's own materials, copied, and their colours without any tint.
    materials: Vec<(Gd<BaseMaterial3D>, Color)>,
    plays: Option<u32>,
}

/// All of them.
#[derive(Default)]
pub(super) struct Actors {
    all: Vec<Actor>,
    /// True for walkers that a scene plays.
    playing: Vec<bool>,
    /// The walkers whose scenes are posed, and their poses, kept for their memory.
    walkers: Vec<u32>,
    poses: Vec<CrowdPose>,
    broken: bool,
}

impl Actors {
    /// Lends scenes to the walkers of this tier, and takes them back from all others. A walker keeps its scene. One call creates a limited
    /// number of scenes; returns whether walkers are left without one.
    pub(super) fn lend(
        &mut self,
        tiers: &[Tier],
        agents: &[Agent],
        scene: &Gd<PackedScene>,
        host: &mut Gd<Node3D>,
        most_made: usize,
    ) -> bool {
        let is_full = |index: u32| tiers.get(index as usize) == Some(&Tier::Full);
        self.playing.clear();
        self.playing.resize(tiers.len(), false);
        for actor in &mut self.all {
            let Some(index) = actor.plays else {
                continue;
            };
            if is_full(index) {
                self.playing[index as usize] = true;
            } else {
                actor.rest();
            }
        }
        let mut next = 0;
        let mut made = 0;
        for walker in 0..tiers.len() as u32 {
            if !is_full(walker) || self.playing[walker as usize] {
                continue;
            }
            while self
                .all
                .get(next)
                .is_some_and(|actor| actor.plays.is_some())
            {
                next += 1;
            }
            if next == self.all.len() {
                if self.broken || made == most_made {
                    return !self.broken;
                }
                let Some(actor) = Actor::new(scene, host) else {
                    self.broken = true;
                    return false;
                };
                made += 1;
                self.all.push(actor);
            }
            let actor = &mut self.all[next];
            actor.plays = Some(walker);
            if let Some(agent) = agents.get(walker as usize) {
                let [r, g, b, _] = agent.tint;
                for (material, own) in &mut actor.materials {
                    let own = own.srgb_to_linear();
                    let tinted = Color::from_rgba(own.r * r, own.g * g, own.b * b, own.a);
                    material.set_albedo(tinted.linear_to_srgb());
                }
            }
            self.playing[walker as usize] = true;
            actor.node.set_visible(true);
            actor.node.set_process_mode(ProcessMode::INHERIT);
            if let Some(placement) = &mut actor.placement {
                placement.bind_mut().forget();
            }
        }
        false
    }

    /// Takes the scene of a walker back.
    pub(super) fn take_back(&mut self, walker: usize) {
        let mut actors = self.all.iter_mut();
        if let Some(actor) = actors.find(|actor| actor.plays == Some(walker as u32)) {
            actor.rest();
        }
        if let Some(playing) = self.playing.get_mut(walker) {
            *playing = false;
        }
    }

    /// The scene that plays a walker.
    pub(super) fn node_of(&self, walker: usize) -> Option<Gd<Node3D>> {
        let mut actors = self.all.iter();
        let actor = actors.find(|actor| actor.plays == Some(walker as u32))?;
        actor.node.is_instance_valid().then(|| actor.node.clone())
    }

    /// The walker whom a scene plays that is this node, or has it in it.
    pub(super) fn walker_of(&self, node: &Gd<Node>) -> Option<usize> {
        let holds = |actor: &&Actor| {
            actor.node.is_instance_valid()
                && (actor.node.instance_id() == node.instance_id()
                    || actor.node.is_ancestor_of(node))
        };
        let actor = self.all.iter().find(holds)?;
        actor.plays.map(|walker| walker as usize)
    }

    /// Poses every scene as the walker that it plays: works out the poses on many threads, and hands them to the engine one after the other.
    pub(super) fn pose(&mut self, agents: &[Agent]) {
        let is_made = |walker: &u32| agents.get(*walker as usize).is_some_and(Agent::is_made);
        let played = |actor: &Actor| actor.plays.filter(is_made);
        self.walkers.clear();
        self.walkers.extend(self.all.iter().filter_map(played));
        self.poses.resize(self.walkers.len(), CrowdPose::default());
        self.poses
            .par_chunks_mut(FETCHED)
            .zip(self.walkers.par_chunks(FETCHED))
            .for_each(|(poses, walkers)| {
                for walker in walkers {
                    agents[*walker as usize].fetch_pose();
                }
                for (pose, walker) in poses.iter_mut().zip(walkers) {
                    agents[*walker as usize].pose(pose);
                }
            });
        let actors = self.all.iter_mut().filter(|actor| played(actor).is_some());
        for ((actor, walker), pose) in actors.zip(&self.walkers).zip(&self.poses) {
            let agent = &agents[*walker as usize];
            let turn = Basis::from_quaternion(convert::quaternion(from_heading(agent.heading)));
            let scaled = turn.scaled(Vector3::splat(agent.size));
            let place = Transform3D::new(scaled, convert::vector3(agent.place));
            actor.node.set_transform(place);
            actor.binding.write_joints(&actor.skeleton, pose);
            if let Some(placement) = &mut actor.placement {
                let (contacts, landings) = (agent.feet_in_contact(), agent.landings());
                placement.bind_mut().feed(contacts, landings);
            }
        }
    }

    /// Returns whether a scene plays this walker.
    pub(super) fn plays(&self, walker: u32) -> bool {
        self.playing
            .get(walker as usize)
            .is_some_and(|plays| *plays)
    }

    /// Removes all scenes.
    pub(super) fn clear(&mut self) {
        for actor in self.all.drain(..) {
            if actor.node.is_instance_valid() {
                actor.node.free();
            }
        }
        self.playing.clear();
        self.broken = false;
    }
}

impl Actor {
    /// Shows no walker.
    fn rest(&mut self) {
        self.plays = None;
        if self.node.is_instance_valid() {
            self.node.set_visible(false);
            self.node.set_process_mode(ProcessMode::DISABLED);
        }
    }

    fn new(scene: &Gd<PackedScene>, host: &mut Gd<Node3D>) -> Option<Self> {
        let mut node = scene.instantiate()?.try_cast::<Node3D>().ok()?;
        host.add_child_ex(&node)
            .internal(godot::classes::node::InternalMode::BACK)
            .done();
        let upright = node.get_global_transform();
        node.set_global_transform(Transform3D::IDENTITY);
        let made = (|| {
            let skeleton = skeleton_of(&node)?;
            let binding = SkeletonBinding::new(&skeleton, &node, None).ok()?;
            let mut placement = None;
            for child in skeleton.get_children().iter_shared() {
                // The crowd walks it: two walks at once would fight.
                if let Ok(mut generator) = child.clone().try_cast::<GaitGenerator3D>() {
                    generator.set_active(false);
                } else if let Ok(found) = child.try_cast::<FootPlacement3D>() {
                    placement = Some(found);
                }
            }
            Some((skeleton, binding, placement))
        })();
        let Some((skeleton, binding, placement)) = made else {
            node.upcast::<Node>().free();
            return None;
        };
        node.set_global_transform(upright);
        let materials = own_materials(&skeleton);
        Some(Self {
            node,
            skeleton,
            binding,
            placement,
            materials,
            plays: None,
        })
    }
}

/// Gives the meshes of a skeleton materials of their own, so that a tint does not reach other scenes.
fn own_materials(skeleton: &Gd<Skeleton3D>) -> Vec<(Gd<BaseMaterial3D>, Color)> {
    let mut materials = Vec::new();
    for node in skeleton.get_children().iter_shared() {
        let Ok(mut mesh) = node.try_cast::<MeshInstance3D>() else {
            continue;
        };
        for surface in 0..mesh.get_surface_override_material_count() {
            let material = mesh
                .get_active_material(surface)
                .and_then(|material| material.try_cast::<BaseMaterial3D>().ok());
            if let Some(material) = material {
                let own = material.duplicate_resource();
                mesh.set_surface_override_material(surface, &own);
                let colour = own.get_albedo();
                materials.push((own, colour));
            }
        }
    }
    materials
}
