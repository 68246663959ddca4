//! The ground under a crowd: a ray for every step of every walker.

use crate::convert;
use crate::physics_ground::PhysicsGround;
use footfall_ik::placement::Terrain as _;
use footfall_rig::crowd::Crowd;
use glam::Vec3;
use godot::classes::Node3D;
use godot::prelude::*;

/// Range above and below a walker in which ground is searched for, metres.
const GROUND_REACH_M: f32 = 1.5;

/// Finds the ground under walkers that have just put a foot down, and under new ones.
pub(super) fn find(walkers: &mut Crowd, host: &Gd<Node3D>, mask: u32) {
    if mask == 0 {
        return;
    }
    let space = host
        .get_world_3d()
        .and_then(|world| world.get_direct_space_state());
    let Some(space) = space else {
        return;
    };
    let world = convert::frame(host.get_global_transform());
    let mut rays = PhysicsGround::new(mask, 0.0, &Array::new());
    let mut ground = rays.now(space);
    for index in 0..walkers.agents().len() {
        let has_landed = walkers.has_landed(index);
        let agent = &mut walkers.agents_mut()[index];
        let is_new = agent.searches_ground();
        if !has_landed && !is_new {
            continue;
        }
        // A little ahead, where it will be in the middle of the step.
        let velocity = agent.velocity();
        let ahead = agent.place + 0.25 * Vec3::new(velocity.x, 0.0, velocity.y);
        let from = world.point(ahead + Vec3::Y * GROUND_REACH_M);
        let way = world.up() * (-2.0 * GROUND_REACH_M);
        if let Some(hit) = ground.cast(from, way) {
            let height = world.local_point(hit.position).y;
            if is_new {
                agent.put_on(height);
            } else {
                agent.ground_m = height;
            }
        }
    }
}
