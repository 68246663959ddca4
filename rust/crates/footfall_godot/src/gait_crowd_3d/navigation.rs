//! Ways around what stands between walkers and where they go: over the navigation map of the world.

use crate::convert;
use footfall_rig::crowd::{Agent, Crowd};
use glam::{Vec2, Vec3, Vec3Swizzles as _};
use godot::classes::{Engine, Node3D, Object};
use godot::prelude::*;

/// Most routes that are computed in one frame: each takes tens of microseconds.
const MOST_A_FRAME: usize = 32;
/// Walkers whose ground is checked in one frame, to keep them off walls: this many, or as many as are needed to check all of them within this many frames; and as many of those on a new way.
const MOST_KEPT: usize = 32;
const MOST_FRAMES: usize = 60;
/// Distance of the checked ground ahead of a walker, metres; a runner looks ahead for this time, seconds, for a turn begins with the next step.
const AHEAD_M: f32 = 1.0;
const AHEAD_SECS: f32 = 0.6;
/// Ground that is checked for detours, to both sides: beside that ahead, metres, and as far ahead after a slight turn, radians; and the distance kept from the edges, metres, for a walker
/// continues for a step before it turns back.
const ASIDE_M: f32 = 1.5;
const SLIGHT_RAD: f32 = 0.4;
const MARGIN_M: f32 = 0.2;
/// Turns from the way that are tried, radians.
const TURNS_RAD: [f32; 4] = [0.35, 0.7, 1.1, 1.5];
/// A place counts as on the map when it is no farther off, metres. A map keeps clear of walls by the radius of its agents.
const ON_MAP_M: f32 = 0.05;

/// The navigation map, as the crowd sees it.
pub(super) struct Navigation {
    /// Called by name: the bindings leave out classes that Godot still names experimental.
    server: Gd<Object>,
    map: Variant,
    layers: u32,
    world_from_crowd: Transform3D,
    crowd_from_world: Transform3D,
}

impl Navigation {
    /// The map of the world that the crowd is in, once there is any ground on it: a map's first iteration may be empty.
    pub(super) fn of(crowd: &Gd<Node3D>, layers: u32) -> Option<Self> {
        let map = crowd.get_world_3d()?.get_navigation_map().to_variant();
        let mut server = Engine::singleton().get_singleton("NavigationServer3D")?;
        let found = server.call("map_get_iteration_id", core::slice::from_ref(&map));
        if found.try_to::<i64>().unwrap_or(0) <= 0 {
            return None;
        }
        let world_from_crowd = crowd.get_global_transform();
        let asked = [map.clone(), world_from_crowd.origin.to_variant()];
        let ground = server.call("map_get_closest_point_owner", &asked);
        ground.try_to::<Rid>().ok()?.is_valid().then(|| Self {
            server,
            map,
            layers,
            world_from_crowd,
            crowd_from_world: world_from_crowd.affine_inverse(),
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
        // Where the walker stands is no place to go to.
        agent.go_along(path.as_slice().iter().skip(1).map(|place| {
            let place = self.crowd_from_world * *place;
            Vec2::new(place.x, place.z)
        }));
        true
    }

    /// Sends those off who await a route, and looks at the ground ahead of those who are on their way: in turn, beginning at this row, and of those who have just set off or come to a corner
    /// before their next step. Returns the row to begin at next time.
    pub(super) fn keep(&mut self, walkers: &mut Crowd, from: usize) -> usize {
        let next = self.keep_in_turn(walkers, from);
        let (before, after) = walkers.agents_mut().split_at_mut(next);
        let agents = after.iter_mut().chain(before);
        for agent in agents.filter(|agent| agent.is_on_new_way()).take(MOST_KEPT) {
            self.look(agent);
        }
        next
    }

    /// The part of [`keep`](Self::keep) that goes through all rows.
    fn keep_in_turn(&mut self, walkers: &mut Crowd, from: usize) -> usize {
        let rows = walkers.agents().len();
        let mut left = MOST_KEPT.max(rows / MOST_FRAMES);
        for row in (from.min(rows)..rows).chain(0..from.min(rows)) {
            let agent = &mut walkers.agents_mut()[row];
            agent.follow_route();
            left -= usize::from(self.set_off(agent) || self.look(agent));
            if left == 0 {
                return row + 1;
            }
        }
        0
    }

    /// Sends a walker to the place to which it awaits a route; whether it awaits one. It stays where it is if there is none.
    fn set_off(&mut self, agent: &mut Agent) -> bool {
        let Some(to) = agent.awaited() else {
            return false;
        };
        if !self.send(agent, convert::vector3(to)) {
            agent.go_to(agent.place.xz());
        }
        true
    }

    /// Looks at the ground ahead of a walker; whether it is on its way.
    fn look(&mut self, agent: &mut Agent) -> bool {
        let Some(straight) = agent.straight_way() else {
            return false;
        };
        let ahead_m = AHEAD_M.max(AHEAD_SECS * agent.speed_mps);
        let bent = self.bent(agent.place, straight, ahead_m);
        let way = bent.unwrap_or(straight);
        let room_rad = [1.0, -1.0].map(|side| self.room(agent.place, way, ahead_m, side));
        agent.guide(bent, room_rad);
        true
    }

    /// Direction that stays on the map, or leads back to it, for a walker whose way does not: the one nearest to its way. The map's place nearest to one inside a stall that it is to
    /// go round would be the stall's own end.
    fn bent(&mut self, place: Vec3, way: Vec2, ahead_m: f32) -> Option<Vec2> {
        let (nearest, _) = self.off_map(place, ahead_m * way)?;
        let turned = TURNS_RAD
            .into_iter()
            .flat_map(|turn| [turn, -turn])
            .map(|turn| Vec2::from_angle(turn).rotate(way))
            .find(|way| self.off_map(place, ahead_m * *way).is_none());
        turned.or_else(|| (nearest - place.xz()).try_normalize())
    }

    /// Most that a walker may turn aside to one side (1 right, -1 left), radians, so that the ground ahead of it is on the map. The corner of a block that it passes lies between the way and the
    /// place beside it, which may be on the map again.
    fn room(&mut self, place: Vec3, way: Vec2, ahead_m: f32, side: f32) -> f32 {
        let beside = place + (ahead_m * way).extend(0.0).xzy();
        let off_m = |found: Option<(Vec2, f32)>| found.map_or(0.0, |(_, off_m)| off_m);
        let beside_m = ASIDE_M - off_m(self.off_map(beside, side * ASIDE_M * way.perp()));
        let room = (beside_m - MARGIN_M).max(0.0).atan2(ahead_m);
        let turned = Vec2::from_angle(side * SLIGHT_RAD).rotate(way);
        match self.off_map(place, ahead_m * turned) {
            Some((_, off_m)) => room.min((SLIGHT_RAD - (off_m + MARGIN_M) / ahead_m).max(0.0)),
            None => room,
        }
    }

    /// The map's place nearest to one that a step of this length leads to, and its distance, metres; `None` where the step stays on the map or nothing is known.
    fn off_map(&mut self, from: Vec3, step: Vec2) -> Option<(Vec2, f32)> {
        let to = from.xz() + step;
        let on_map = self.on_map(Vec3::new(to.x, from.y, to.y))?;
        let off_m = on_map.distance(to);
        (off_m > ON_MAP_M).then_some((on_map, off_m))
    }

    /// The map's place nearest to one of the crowd's space.
    fn on_map(&mut self, place: Vec3) -> Option<Vec2> {
        let found = self.closest(self.world_from_crowd * convert::vector3(place))?;
        Some(convert::vec3(found).xz())
    }

    /// The map's place nearest to one of the world, in the crowd's space.
    fn closest(&mut self, place: Vector3) -> Option<Vector3> {
        let asked = [self.map.clone(), place.to_variant()];
        let found = self.server.call("map_get_closest_point", &asked);
        let found: Vector3 = found.try_to().ok()?;
        Some(self.crowd_from_world * found)
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
        self.closest(wanted)
            .unwrap_or(self.crowd_from_world * wanted)
    }

    /// A box around all regions of the map.
    fn bounds(&mut self) -> Aabb {
        let regions = self
            .server
            .call("map_get_regions", core::slice::from_ref(&self.map));
        let regions: Array<Rid> = regions.try_to().unwrap_or_default();
        let boxes = regions.iter_shared().filter_map(|region| {
            let found = self
                .server
                .call("region_get_bounds", &[region.to_variant()]);
            found.try_to::<Aabb>().ok()
        });
        boxes.reduce(Aabb::merge).unwrap_or_default()
    }
}
