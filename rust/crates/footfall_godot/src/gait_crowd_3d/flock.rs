//! Walkers that are drawn together: one `MultiMesh`, and the texture that its shader reads their poses from.

use super::crowd_mesh::{CrowdMesh, give_poses};
use crate::convert;
use footfall_core::{JOINT_COUNT, Joint};
use footfall_rig::crowd::Drawn;
use footfall_synth::CrowdPose;
use glam::{Quat, Vec3};
use godot::classes::image::Format;
use godot::classes::multi_mesh::TransformFormat;
use godot::classes::{
    Image, ImageTexture, MultiMesh, MultiMeshInstance3D, Node, RenderingServer, ShaderMaterial,
};
use godot::prelude::*;
use half::f16;
use half::slice::HalfFloatSliceExt as _;

/// Poses beside each other in the texture, as `crowd_pose.gdshaderinc` has it.
const POSES_PER_ROW: usize = 32;
/// Texels of a row of the texture: four numbers each.
const ROW_TEXELS: usize = POSES_PER_ROW * POSE_NUMBERS / 4;
const JOINT_NUMBERS: usize = CrowdPose::JOINT_NUMBERS;
const POSE_NUMBERS: usize = JOINT_COUNT * JOINT_NUMBERS;
/// Bytes of one pose.
pub(super) const POSE_BYTES: usize = POSE_NUMBERS * size_of::<f16>();
/// Numbers of one instance: a transform, a colour and custom data.
pub(super) const INSTANCE_NUMBERS: usize = 20;

/// A group of instances and their poses.
pub(super) struct Flock {
    instance: Gd<MultiMeshInstance3D>,
    multimesh: Gd<MultiMesh>,
    image: Gd<Image>,
    texture: Gd<ImageTexture>,
    /// Two of each, written in turn: the engine still holds the one that it was given last, and a shared array is copied when it is
    /// written.
    poses: [PackedByteArray; 2],
    instances: [PackedFloat32Array; 2],
    turn: [usize; 2],
    height: i32,
    /// Most instances.
    pub(super) room: usize,
}

impl Flock {
    /// Room for so many instances and so many poses.
    pub(super) fn new(
        host: &Gd<Node>,
        mesh: &CrowdMesh,
        level: usize,
        room: usize,
        poses: usize,
        material: Option<&Gd<ShaderMaterial>>,
    ) -> Option<Self> {
        let width = convert::count(ROW_TEXELS);
        let height = poses.div_ceil(POSES_PER_ROW).max(1);
        let zeros = |_| {
            let mut zeros = PackedByteArray::new();
            zeros.resize(height * POSES_PER_ROW * POSE_BYTES);
            zeros
        };
        let poses = [0, 1].map(zeros);
        let rows = convert::count(height);
        let image = Image::create_from_data(width, rows, false, Format::RGBAH, &poses[0])?;
        let texture = ImageTexture::create_from_image(&image)?;
        let shown = give_poses(&mesh.meshes[level], &mesh.rest, &texture, material);
        let mut multimesh = MultiMesh::new_gd();
        multimesh.set_transform_format(TransformFormat::TRANSFORM_3D);
        multimesh.set_use_colors(true);
        multimesh.set_use_custom_data(true);
        multimesh.set_mesh(&shown);
        multimesh.set_instance_count(convert::count(room));
        multimesh.set_visible_instance_count(0);
        let mut instance = MultiMeshInstance3D::new_alloc();
        instance.set_multimesh(&multimesh);
        host.clone()
            .add_child_ex(&instance)
            .internal(godot::classes::node::InternalMode::BACK)
            .done();
        let numbers = room * INSTANCE_NUMBERS;
        Some(Self {
            instance,
            multimesh,
            image,
            texture,
            poses,
            instances: [(); 2].map(|()| {
                let mut zeros = PackedFloat32Array::new();
                zeros.resize(numbers);
                zeros
            }),
            room,
            // The image holds the first poses already.
            turn: [1, 0],
            height: rows,
        })
    }

    /// Index of the buffer that is written next.
    pub(super) const fn turn(&self) -> usize {
        self.turn[0]
    }

    /// The poses, [`POSE_BYTES`] each, to be written anew; what they were two uploads ago is in them.
    pub(super) fn poses(&mut self) -> &mut [u8] {
        self.poses[self.turn[0]].as_mut_slice()
    }

    /// The same, and the poses as they were uploaded last.
    pub(super) fn poses_and_last(&mut self) -> (&mut [u8], &[u8]) {
        let [first, second] = &mut self.poses;
        let (now, last) = if self.turn[0] == 0 {
            (first, second)
        } else {
            (second, first)
        };
        (now.as_mut_slice(), last.as_slice())
    }

    /// The instances, [`INSTANCE_NUMBERS`] each, to be written anew.
    pub(super) fn instances(&mut self) -> &mut [f32] {
        self.instances[self.turn[1]].as_mut_slice()
    }

    /// Hands the poses that were written to the renderer.
    pub(super) fn upload_poses(&mut self) {
        let width = convert::count(ROW_TEXELS);
        let poses = &self.poses[self.turn[0]];
        self.image
            .set_data(width, self.height, false, Format::RGBAH, poses);
        self.texture.update(&self.image);
        self.turn[0] = 1 - self.turn[0];
    }

    /// Hands so many instances, which lie in this box of the crowd's space, to the renderer.
    pub(super) fn upload_instances(&mut self, count: usize, bounds: Aabb) {
        let numbers = &self.instances[self.turn[1]];
        let id = self.multimesh.get_rid();
        if count > 0 {
            RenderingServer::singleton().multimesh_set_buffer(id, numbers);
            self.instance.set_custom_aabb(bounds);
            self.turn[1] = 1 - self.turn[1];
        }
        self.multimesh
            .set_visible_instance_count(convert::count(count));
        self.instance.set_visible(count > 0);
    }

    /// Removes what is drawn.
    pub(super) fn free(self) {
        if self.instance.is_instance_valid() {
            self.instance.free();
        }
    }
}

/// Writes a pose as the shader reads it.
pub(super) fn write_pose(pose: &CrowdPose, turned_by: &[Joint; JOINT_COUNT], out: &mut [u8]) {
    let mut halves = [f16::ZERO; POSE_NUMBERS];
    halves.convert_from_f32_slice(pose.numbers());
    for joint in Joint::ALL {
        let turning = turned_by[joint.index()];
        if turning != joint {
            let from = turning.index() * JOINT_NUMBERS;
            halves.copy_within(from..from + 4, joint.index() * JOINT_NUMBERS);
        }
    }
    for (bytes, half) in out.chunks_exact_mut(2).zip(halves) {
        bytes.copy_from_slice(&half.to_le_bytes());
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
