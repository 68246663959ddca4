//! Soles and normals drawn for the developer.

use crate::convert;
use footfall_ik::placement::PlacedFoot;
use glam::Vec3;
use godot::classes::base_material_3d::{Flags, ShadingMode};
use godot::classes::mesh::PrimitiveType;
use godot::classes::{ImmediateMesh, MeshInstance3D, Node, StandardMaterial3D};
use godot::prelude::*;

/// The outline of a sole, metres: from the ground under the ankle, +Z to the toes.
const OUTLINE: [(f32, f32); 5] = [
    (-0.04, -0.05),
    (-0.045, 0.2),
    (0.045, 0.2),
    (0.04, -0.05),
    (-0.04, -0.05),
];
const NORMAL_M: f32 = 0.25;
/// Lines keep this far from the ground, metres, so that they are seen.
const LIFT_M: f32 = 0.006;
const LOCKED: Color = Color::from_rgb(0.2, 0.9, 0.35);
const LOOSE: Color = Color::from_rgb(1.0, 0.6, 0.15);

/// Lines under the feet; nothing as long as they are not wanted.
#[derive(Default)]
pub(super) struct Marks {
    shown: Option<(Gd<MeshInstance3D>, Gd<ImmediateMesh>)>,
}

impl Marks {
    /// Draws, or stops drawing. `host` is the node that the lines hang from.
    pub(super) fn show(&mut self, wanted: bool, host: &Gd<Node>, feet: &[PlacedFoot; 2]) {
        if !wanted {
            self.remove();
            return;
        }
        let (_, mesh) = self.shown.get_or_insert_with(|| hang(host));
        mesh.clear_surfaces();
        mesh.surface_begin(PrimitiveType::LINES);
        for foot in feet {
            let colour = if foot.locked { LOCKED } else { LOOSE };
            let at = |x: f32, y: f32, z: f32| foot.sole.point(Vec3::new(x, y, z));
            let mut line = |from: Vec3, to: Vec3| {
                for end in [from, to] {
                    mesh.surface_set_color(colour);
                    mesh.surface_add_vertex(convert::vector3(end));
                }
            };
            for pair in OUTLINE.windows(2) {
                let [from, to] = [pair[0], pair[1]].map(|(x, z)| at(x, LIFT_M, z));
                line(from, to);
            }
            line(at(0.0, LIFT_M, 0.0), at(0.0, NORMAL_M, 0.0));
        }
        mesh.surface_end();
    }

    /// Takes the lines away.
    pub(super) fn remove(&mut self) {
        if let Some((instance, _)) = self.shown.take()
            && instance.is_instance_valid()
        {
            instance.clone().queue_free();
        }
    }
}

fn hang(host: &Gd<Node>) -> (Gd<MeshInstance3D>, Gd<ImmediateMesh>) {
    let mut material = StandardMaterial3D::new_gd();
    material.set_shading_mode(ShadingMode::UNSHADED);
    material.set_flag(Flags::ALBEDO_FROM_VERTEX_COLOR, true);
    material.set_flag(Flags::DISABLE_DEPTH_TEST, true);
    let mesh = ImmediateMesh::new_gd();
    let mut instance = MeshInstance3D::new_alloc();
    instance.set_mesh(&mesh);
    instance.set_material_override(&material);
    instance.set_as_top_level(true);
    let mut host = host.clone();
    host.add_child_ex(&instance)
        .internal(godot::classes::node::InternalMode::BACK)
        .done();
    (instance, mesh)
}
