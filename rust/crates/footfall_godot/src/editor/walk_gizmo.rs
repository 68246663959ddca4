//! The way that a character will walk, drawn in the editor: the path of its body and the places of its feet.

use crate::convert;
use crate::gait_generator_3d::GaitGenerator3D;
use footfall_core::Side;
use glam::Vec3;
use godot::classes::{
    EditorNode3DGizmo, EditorNode3DGizmoPlugin, IEditorNode3DGizmoPlugin, Material, Node3D,
};
use godot::prelude::*;

/// The outline of a footprint, metres: from the ground under the ankle, +Z to the toes.
const OUTLINE: [(f32, f32); 9] = [
    (-0.03, -0.06),
    (-0.04, 0.03),
    (-0.045, 0.13),
    (-0.025, 0.2),
    (0.025, 0.2),
    (0.045, 0.13),
    (0.04, 0.03),
    (0.03, -0.06),
    (-0.03, -0.06),
];

/// Lines keep this far from the ground, metres, so that they are seen.
const LIFT: Vec3 = Vec3::new(0.0, 0.01, 0.0);

const WAY: &str = "way";

/// Draws where a `GaitGenerator3D` will take its character.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorNode3DGizmoPlugin)]
pub(crate) struct FootfallWalkGizmo {
    base: Base<EditorNode3DGizmoPlugin>,
}

impl FootfallWalkGizmo {
    /// The plugin, ready to draw.
    pub(crate) fn with_materials() -> Gd<Self> {
        let mut plugin = Self::new_gd();
        plugin.create_material(WAY, Color::from_rgb(0.9, 0.9, 0.9));
        plugin.create_material(Side::Left.name(), Color::from_rgb(1.0, 0.55, 0.2));
        plugin.create_material(Side::Right.name(), Color::from_rgb(0.3, 0.65, 1.0));
        plugin
    }
}

#[godot_api]
impl IEditorNode3DGizmoPlugin for FootfallWalkGizmo {
    fn get_gizmo_name(&self) -> GString {
        "GaitGenerator3D".into()
    }

    fn has_gizmo(&self, for_node_3d: Option<Gd<Node3D>>) -> bool {
        for_node_3d.is_some_and(|node| node.try_cast::<GaitGenerator3D>().is_ok())
    }

    fn redraw(&mut self, gizmo: Option<Gd<EditorNode3DGizmo>>) {
        let Some(mut gizmo) = gizmo else { return };
        gizmo.clear();
        let node = gizmo.get_node_3d();
        let Some(node) = node.and_then(|node| node.try_cast::<GaitGenerator3D>().ok()) else {
            return;
        };
        let Some(way) = node.bind().preview_path() else {
            return;
        };
        let node_from_ground =
            convert::affine(node.get_global_transform()).inverse() * way.world_from_ground;
        let point = |place: Vec3| convert::vector3(node_from_ground.transform_point3(place + LIFT));
        let mut draw = |name: &str, places: Vec<[Vec3; 2]>| {
            let material = self.base().get_material_ex(name).gizmo(&gizmo).done();
            if let Some(material) = material {
                let ends = places.into_iter().flatten().map(point);
                let lines: PackedVector3Array = ends.collect();
                gizmo.add_lines(&lines, &material.upcast::<Material>());
            }
        };
        draw(WAY, pairs(&way.path));
        for side in Side::BOTH {
            let footsteps = way.footsteps.iter().filter(|step| step.side == side);
            let outlines = footsteps.flat_map(|step| {
                let turned = footfall_core::rotation::from_heading(step.heading);
                let corners = OUTLINE.map(|(x, z)| step.position + turned * Vec3::new(x, 0.0, z));
                pairs(&corners)
            });
            draw(side.name(), outlines.collect());
        }
    }
}

/// A line of points as the lines between them.
fn pairs(points: &[Vec3]) -> Vec<[Vec3; 2]> {
    points.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}
