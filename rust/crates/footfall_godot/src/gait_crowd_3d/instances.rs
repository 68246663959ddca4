//! Instances of one mesh: a `MultiMesh`, and what its buffer holds.

use super::crowd_mesh::give_poses;
use crate::convert;
use footfall_core::JOINT_COUNT;
use footfall_rig::crowd::Drawn;
use glam::{Quat, Vec3};
use godot::classes::multi_mesh::TransformFormat;
use godot::classes::{
    ArrayMesh, ImageTexture, MultiMesh, MultiMeshInstance3D, Node, RenderingServer, ShaderMaterial,
};
use godot::prelude::*;

/// Numbers of one instance: a transform, a colour and custom data.
pub(super) const INSTANCE_NUMBERS: usize = 20;
/// Room grows by half.
const GROWTH: (usize, usize) = (3, 2);

/// Instances of one mesh.
pub(super) struct Instances {
    node: Gd<MultiMeshInstance3D>,
    multimesh: Gd<MultiMesh>,
    /// Two, written in turn: the engine still holds the one that it was given last, and a shared array is copied when it is
    /// written.
    numbers: [PackedFloat32Array; 2],
    turn: usize,
    room: usize,
}

impl Instances {
    /// Instances of a mesh that reads these poses, without room for any yet.
    pub(super) fn new(
        host: &Gd<Node>,
        mesh: &Gd<ArrayMesh>,
        rest: &[Vec3; JOINT_COUNT],
        poses: &Gd<ImageTexture>,
        material: Option<&Gd<ShaderMaterial>>,
    ) -> Self {
        let mut multimesh = MultiMesh::new_gd();
        multimesh.set_transform_format(TransformFormat::TRANSFORM_3D);
        multimesh.set_use_colors(true);
        multimesh.set_use_custom_data(true);
        multimesh.set_mesh(&give_poses(mesh, rest, poses, material));
        let mut node = MultiMeshInstance3D::new_alloc();
        node.set_multimesh(&multimesh);
        node.set_visible(false);
        host.clone()
            .add_child_ex(&node)
            .internal(godot::classes::node::InternalMode::BACK)
            .done();
        Self {
            node,
            multimesh,
            numbers: [PackedFloat32Array::new(), PackedFloat32Array::new()],
            turn: 0,
            room: 0,
        }
    }

    /// The numbers of this many instances, [`INSTANCE_NUMBERS`] each, to be overwritten.
    pub(super) fn numbers(&mut self, count: usize) -> &mut [f32] {
        if count > self.room {
            self.room = count.max(self.room * GROWTH.0 / GROWTH.1);
            self.multimesh.set_instance_count(convert::count(self.room));
            for numbers in &mut self.numbers {
                numbers.resize(self.room * INSTANCE_NUMBERS);
            }
        }
        &mut self.numbers[self.turn].as_mut_slice()[..count * INSTANCE_NUMBERS]
    }

    /// Passes this many instances, which lie in this box of the crowd's space, to the renderer.
    pub(super) fn upload(&mut self, count: usize, bounds: Aabb) {
        let id = self.multimesh.get_rid();
        if count > 0 {
            RenderingServer::singleton().multimesh_set_buffer(id, &self.numbers[self.turn]);
            self.node.set_custom_aabb(bounds);
            self.turn = 1 - self.turn;
        }
        self.multimesh
            .set_visible_instance_count(convert::count(count));
        self.node.set_visible(count > 0);
    }

    /// Removes what is drawn.
    pub(super) fn free(self) {
        if self.node.is_instance_valid() {
            self.node.free();
        }
    }
}

/// Returns whether the renderer blends colours as they are shown, without turning them into light before: the Compatibility renderer does.
pub(super) fn draws_in_srgb() -> bool {
    RenderingServer::singleton().get_current_rendering_method() == "gl_compatibility"
}

/// Part of a colour in sRGB from a linear one, both of 0 to 1, within 0.007: three roots take less time than a power for every walker.
fn srgb_part(light: f32) -> f32 {
    let root = light.max(0.0).sqrt();
    let fourth = root.sqrt();
    let eighth = fourth.sqrt();
    0.662_002_7 * root + 0.684_122_1 * fourth - 0.323_583_6 * eighth - 0.022_541_147 * light
}

/// Writes an instance: where it stands, its tint, linear or [in sRGB](draws_in_srgb), the slot of its pose, the way from there to the pose in the next slot, and the speed that it leaves: so many
/// [steps of poses](footfall_synth::SharedPose::beside) beside that slot, and its weight.
pub(super) fn write_instance(
    place: Vec3,
    heading: f32,
    drawn: &Drawn,
    (slot, blend, leaving): (usize, f32, f32),
    in_srgb: bool,
    out: &mut [f32],
) {
    let turn = glam::Mat3::from_quat(Quat::from_rotation_y(heading)) * drawn.size;
    for row in 0..3 {
        out[4 * row..4 * row + 3].copy_from_slice(&turn.row(row).to_array());
        out[4 * row + 3] = place[row];
    }
    out[12..16].copy_from_slice(&drawn.tint);
    if in_srgb {
        for part in &mut out[12..15] {
            *part = srgb_part(*part);
        }
    }
    // The Compatibility renderer keeps half floats, which are exact up to 2048.
    let (low, high) = (slot % 1024, slot / 1024);
    out[16..20].copy_from_slice(&[low as f32, high as f32, blend, leaving]);
}
