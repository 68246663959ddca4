//! Nodes of a group that a crowd's walkers avoid.

use super::GaitCrowd3D;
use crate::convert;
use footfall_rig::crowd::{Crowd, Passerby};
use glam::{Affine3A, Vec3, Vec3Swizzles as _};
use godot::classes::Node3D;
use godot::prelude::*;

/// Time constant of a node's velocity, seconds: bodies move in physics frames, which are not those in which they are looked at.
const VELOCITY_SECS: f32 = 0.1;
/// Motion of a node in a frame beyond which it was teleported, metres.
const PUT_M: f32 = 2.0;

/// A node of the group, as it was seen last.
#[derive(Clone, Copy, Debug)]
struct Watched {
    id: InstanceId,
    place: Vec3,
    velocity: Vec3,
}

/// Nodes of the group that a crowd keeps clear of.
#[derive(Debug, Default)]
pub(super) struct Others {
    watched: Vec<Watched>,
    /// The same, a frame before.
    before: Vec<Watched>,
    passersby: Vec<Passerby>,
}

impl Others {
    /// Gives the crowd the places of the group's nodes. A crowd in the group counts with all its walkers.
    pub(super) fn watch(
        &mut self,
        walkers: &mut Crowd,
        host: &Gd<Node3D>,
        group: &StringName,
        dt_secs: f32,
    ) {
        self.passersby.clear();
        core::mem::swap(&mut self.before, &mut self.watched);
        self.watched.clear();
        if !group.is_empty() {
            self.watch_group(host, group, dt_secs);
        }
        walkers.set_others(self.passersby.iter().copied());
    }

    fn watch_group(&mut self, host: &Gd<Node3D>, group: &StringName, dt_secs: f32) {
        let nodes = host.get_tree().get_nodes_in_group(group);
        let crowd_from_world = convert::affine(host.get_global_transform()).inverse();
        for node in nodes.iter_shared() {
            let Ok(node) = node.try_cast::<Node3D>() else {
                continue;
            };
            if node == *host {
                continue;
            }
            match node.try_cast::<GaitCrowd3D>() {
                Ok(crowd) => self.add_crowd(&crowd, &crowd_from_world),
                Err(node) => {
                    let seen = self.look(&node, dt_secs);
                    self.watched.push(seen);
                    self.add(&crowd_from_world, seen.place, seen.velocity);
                }
            }
        }
    }

    /// A node's place, and its velocity since it was seen last.
    fn look(&self, node: &Gd<Node3D>, dt_secs: f32) -> Watched {
        let id = node.instance_id();
        let place = convert::vec3(node.get_global_position());
        let before = self.before.iter().find(|seen| seen.id == id);
        let velocity = match before {
            Some(before) if dt_secs <= 0.0 => before.velocity,
            Some(before) if before.place.distance(place) < PUT_M => {
                let share = 1.0 - (-dt_secs / VELOCITY_SECS).exp();
                let now = (place - before.place) / dt_secs;
                before.velocity.lerp(now, share)
            }
            _ => Vec3::ZERO,
        };
        Watched {
            id,
            place,
            velocity,
        }
    }

    fn add_crowd(&mut self, crowd: &Gd<GaitCrowd3D>, crowd_from_world: &Affine3A) {
        let from_theirs = *crowd_from_world * convert::affine(crowd.get_global_transform());
        let crowd = crowd.bind();
        for agent in crowd.walkers.iter().flat_map(Crowd::agents) {
            if agent.is_made() {
                let velocity = agent.velocity();
                self.add(
                    &from_theirs,
                    agent.place,
                    Vec3::new(velocity.x, 0.0, velocity.y),
                );
            }
        }
    }

    fn add(&mut self, to_crowd: &Affine3A, place: Vec3, velocity: Vec3) {
        self.passersby.push(Passerby {
            place: to_crowd.transform_point3(place).xz(),
            velocity: to_crowd.transform_vector3(velocity).xz(),
        });
    }
}
