//! The ground as the physics server sees it.

use crate::convert;
use footfall_ik::placement::{Frame, Ground, SupportId, Terrain};
use glam::Vec3;
use godot::classes::{
    CollisionObject3D, PhysicsDirectSpaceState3D, PhysicsRayQueryParameters3D,
    PhysicsShapeQueryParameters3D, SphereShape3D,
};
use godot::prelude::*;

/// Finds ground by casting rays or spheres into the physics space of a scene.
pub(crate) struct PhysicsGround {
    ray: Gd<PhysicsRayQueryParameters3D>,
    sphere: Gd<PhysicsShapeQueryParameters3D>,
    radius: f32,
    /// Keys of a ray's answer. Made once: a search for a foothold casts hundreds of rays, and each would make them anew.
    position: Variant,
    normal: Variant,
    collider_id: Variant,
}

/// The ground in one frame.
pub(crate) struct GroundNow<'a> {
    ground: &'a mut PhysicsGround,
    space: Gd<PhysicsDirectSpaceState3D>,
}

impl PhysicsGround {
    /// Ground on these layers, but not these bodies. A `radius` of 0 casts rays.
    pub(crate) fn new(mask: u32, radius: f32, exclude: &Array<Rid>) -> Self {
        let mut ray = PhysicsRayQueryParameters3D::new_gd();
        ray.set_collision_mask(mask);
        ray.set_exclude(exclude);
        ray.set_hit_back_faces(false);
        let mut shape = SphereShape3D::new_gd();
        shape.set_radius(radius.max(1e-3));
        let mut sphere = PhysicsShapeQueryParameters3D::new_gd();
        sphere.set_shape(&shape);
        sphere.set_collision_mask(mask);
        sphere.set_exclude(exclude);
        Self {
            ray,
            sphere,
            radius,
            position: "position".to_variant(),
            normal: "normal".to_variant(),
            collider_id: "collider_id".to_variant(),
        }
    }

    /// The ground of a physics space, for one frame.
    pub(crate) fn now(&mut self, space: Gd<PhysicsDirectSpaceState3D>) -> GroundNow<'_> {
        GroundNow {
            ground: self,
            space,
        }
    }
}

/// The bodies that belong to a character: itself, those below it, and those above that move as characters do. A character that a platform carries may be
/// its child, and stands on it.
pub(crate) fn own_bodies(character: &Gd<Node3D>) -> Array<Rid> {
    let mut bodies = Array::new();
    let mut above = character.get_parent();
    while let Some(node) = above {
        if let Ok(body) = node.clone().try_cast::<CollisionObject3D>()
            && !body.is_class("StaticBody3D")
        {
            bodies.push(body.get_rid());
        }
        above = node.get_parent();
    }
    add_bodies(&character.clone().upcast(), &mut bodies);
    bodies
}

fn add_bodies(node: &Gd<Node>, bodies: &mut Array<Rid>) {
    if let Ok(body) = node.clone().try_cast::<CollisionObject3D>() {
        bodies.push(body.get_rid());
    }
    for child in node.get_children().iter_shared() {
        add_bodies(&child, bodies);
    }
}

impl GroundNow<'_> {
    fn cast_ray(&mut self, from: Vec3, to: Vec3) -> Option<Ground> {
        let ray = &mut self.ground.ray;
        ray.set_from(convert::vector3(from));
        ray.set_to(convert::vector3(to));
        let hit = self.space.intersect_ray(&*ray);
        let position = hit.get(&self.ground.position)?.try_to::<Vector3>().ok()?;
        let normal = hit.get(&self.ground.normal)?.try_to::<Vector3>().ok()?;
        let collider = hit.get(&self.ground.collider_id)?.try_to::<i64>().ok()?;
        Some(Ground {
            position: convert::vec3(position),
            normal: convert::vec3(normal).try_normalize()?,
            support: collider.cast_unsigned(),
        })
    }

    fn cast_sphere(&mut self, from: Vec3, way: Vec3) -> Option<Ground> {
        let radius = self.ground.radius;
        let sphere = &mut self.ground.sphere;
        let place = |at: Vec3| Transform3D::new(Basis::IDENTITY, convert::vector3(at));
        sphere.set_transform(place(from));
        sphere.set_motion(convert::vector3(way));
        let shares = self.space.cast_motion(&*sphere);
        let share = *shares.as_slice().get(1)?;
        if share >= 1.0 {
            return None;
        }
        let at = from + way * share;
        sphere.set_transform(place(at));
        let rest = self.space.get_rest_info(&*sphere);
        let normal =
            convert::vec3(rest.get("normal")?.try_to::<Vector3>().ok()?).try_normalize()?;
        let collider = rest.get("collider_id")?.try_to::<i64>().ok()?;
        let touched = convert::vec3(rest.get("point")?.try_to::<Vector3>().ok()?);
        // The ground under the middle of the sphere, on the plane that it touches: the cast itself stops a few millimetres off.
        let down = way.normalize_or(Vec3::NEG_Y);
        let below = (touched - at).dot(normal) / down.dot(normal).min(-0.3);
        Some(Ground {
            position: at + down * below.clamp(0.0, 4.0 * radius),
            normal,
            support: collider.cast_unsigned(),
        })
    }
}

impl Terrain for GroundNow<'_> {
    fn cast(&mut self, from: Vec3, way: Vec3) -> Option<Ground> {
        if self.ground.radius > 0.0 {
            self.cast_sphere(from, way)
        } else {
            self.cast_ray(from, from + way)
        }
    }

    fn support(&mut self, support: SupportId) -> Option<Frame> {
        if support == 0 {
            return Some(Frame::IDENTITY);
        }
        let id = InstanceId::try_from_i64(support.cast_signed())?;
        let node = Gd::<Node3D>::try_from_instance_id(id).ok()?;
        let in_tree = node.is_inside_tree();
        in_tree.then(|| convert::frame(node.get_global_transform()))
    }
}
