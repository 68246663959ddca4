//! Ways around what stands between walkers and where they go: over the navigation map of the world.

use crate::convert;
use footfall_rig::crowd::{Agent, Crowd};
use glam::{Vec2, Vec3};
use godot::classes::{Engine, Node3D, Object};
use godot::prelude::*;

/// Ways that are looked for in one frame at most: each costs tens of microseconds.
const MOST_A_FRAME: usize = 32;

/// The navigation map, as the crowd sees it.
pub(super) struct Navigation {
    /// Called by name: the bindings leave out classes that Godot still names experimental.
    server: Gd<Object>,
    map: Variant,
    layers: u32,
    world_from_crowd: Transform3D,
}

impl Navigation {
    /// The map of the world that the crowd is in, once there is anything in it.
    pub(super) fn of(crowd: &Gd<Node3D>, layers: u32) -> Option<Self> {
        let map = crowd.get_world_3d()?.get_navigation_map().to_variant();
        let mut server = Engine::singleton().get_singleton("NavigationServer3D")?;
        let told = server.call("map_get_iteration_id", core::slice::from_ref(&map));
        (told.try_to::<i64>().unwrap_or(0) > 0).then_some(Self {
            server,
            map,
            layers,
            world_from_crowd: crowd.get_global_transform(),
        })
    }

    /// Sends a walker to a place, in the crowd's space; whether there is a way.
    pub(super) fn send(&mut self, agent: &mut Agent, to: Vector3) -> bool {
        let from = self.world_from_crowd * convert::vector3(agent.place);
        let asked = [
            self.map.clone(),
            from.to_variant(),
            (self.world_from_crowd * to).to_variant(),
            true.to_variant(),
            self.layers.to_variant(),
        ];
        let path = self.server.call("map_get_path", &asked);
        let path: PackedVector3Array = path.try_to().unwrap_or_default();
        if path.is_empty() {
            return false;
        }
        let crowd_from_world = self.world_from_crowd.affine_inverse();
        // Where the walker stands is no place to go to.
        agent.go_along(path.as_slice().iter().skip(1).map(|place| {
            let place = crowd_from_world * *place;
            Vec2::new(place.x, place.z)
        }));
        true
    }

    /// Sends those who have arrived somewhere else on the map, a few in every frame.
    pub(super) fn wander(&mut self, walkers: &mut Crowd) {
        let mut left = MOST_A_FRAME;
        let mut bounds = None;
        for agent in walkers.agents_mut() {
            if left == 0 {
                break;
            }
            if !agent.is_made() || agent.is_on_its_way() {
                continue;
            }
            left -= 1;
            let shares = Vec3::from_array([(); 3].map(|()| agent.chance()));
            let bounds = *bounds.get_or_insert_with(|| self.bounds());
            let place = self.place_at(bounds, shares);
            self.send(agent, place);
        }
    }

    /// Some place of the map. The server's own choice would not be the same for equal seeds.
    fn place_at(&mut self, bounds: Aabb, shares: Vec3) -> Vector3 {
        let wanted = bounds.position + bounds.size * convert::vector3(shares);
        let asked = [self.map.clone(), wanted.to_variant()];
        let found = self.server.call("map_get_closest_point", &asked);
        self.world_from_crowd.affine_inverse() * found.try_to().unwrap_or(wanted)
    }

    /// A box around all regions of the map.
    fn bounds(&mut self) -> Aabb {
        let regions = self
            .server
            .call("map_get_regions", core::slice::from_ref(&self.map));
        let regions: Array<Rid> = regions.try_to().unwrap_or_default();
        let boxes = regions.iter_shared().filter_map(|region| {
            let told = self
                .server
                .call("region_get_bounds", &[region.to_variant()]);
            told.try_to::<Aabb>().ok()
        });
        boxes.reduce(Aabb::merge).unwrap_or_default()
    }
}
