//! Walkers that are drawn together: the texture that shaders read their poses from, instances of the character's mesh, and instances of its stand-in.

use super::bounds::Bounds;
use super::crowd_mesh::CrowdMesh;
use super::instances::{INSTANCE_NUMBERS, Instances};
use crate::convert;
use footfall_core::{JOINT_COUNT, Joint};
use footfall_synth::CrowdPose;
use glam::Vec3;
use godot::classes::image::Format;
use godot::classes::{ArrayMesh, Image, ImageTexture, Node, ShaderMaterial};
use godot::prelude::*;
use half::f16;
use half::slice::HalfFloatSliceExt as _;
use rayon::prelude::*;

/// Poses beside each other in the texture, as `crowd_pose.gdshaderinc` has it.
const POSES_PER_ROW: usize = 32;
/// Texels of a row of the texture: four numbers each.
const ROW_TEXELS: usize = POSES_PER_ROW * POSE_NUMBERS / 4;
const JOINT_NUMBERS: usize = CrowdPose::JOINT_NUMBERS;
const POSE_NUMBERS: usize = JOINT_COUNT * JOINT_NUMBERS;
/// Bytes of one pose.
pub(super) const POSE_BYTES: usize = POSE_NUMBERS * size_of::<f16>();

/// A group of instances and their poses.
pub(super) struct Flock {
    /// Instances with the character's mesh, and with its stand-in if there is one.
    instances: [Option<Instances>; 2],
    image: Gd<Image>,
    texture: Gd<ImageTexture>,
    /// Two, written in turn: the engine still holds the one that it was given last, and a shared array is copied when it is
    /// written.
    poses: [PackedByteArray; 2],
    turn: usize,
    height: i32,
    /// Most walkers.
    pub(super) room: usize,
}

impl Flock {
    /// Creates space for these numbers of walkers and poses.
    pub(super) fn new(
        host: &Gd<Node>,
        body: &CrowdMesh,
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
        let instances =
            |mesh: &Gd<ArrayMesh>| Instances::new(host, mesh, &body.rest, &texture, material);
        let stand_in = body.stand_in.as_ref();
        Some(Self {
            instances: [
                Some(instances(&body.meshes[level])),
                stand_in.map(|stand_in| instances(&stand_in.mesh)),
            ],
            image,
            texture,
            poses,
            room,
            // The image holds the first poses already.
            turn: 1,
            height: rows,
        })
    }

    /// Index of the buffer that is written next.
    pub(super) const fn turn(&self) -> usize {
        self.turn
    }

    /// The poses, [`POSE_BYTES`] each, to be written anew; what they were two uploads ago is in them.
    pub(super) fn poses(&mut self) -> &mut [u8] {
        self.poses[self.turn].as_mut_slice()
    }

    /// The same, and the poses as they were uploaded last.
    pub(super) fn poses_and_last(&mut self) -> (&mut [u8], &[u8]) {
        let [first, second] = &mut self.poses;
        let (now, last) = if self.turn == 0 {
            (first, second)
        } else {
            (second, first)
        };
        (now.as_mut_slice(), last.as_slice())
    }

    /// Instances of the character's mesh, and of its stand-in.
    pub(super) fn instances(&mut self) -> &mut [Option<Instances>; 2] {
        &mut self.instances
    }

    /// Shows these rows, the first with the character's mesh and the second with its stand-in. An instance is written by its number, counted through
    /// both, and its row; what writes it returns its place.
    pub(super) fn show(
        &mut self,
        rows: [&[u32]; 2],
        write: impl Fn(usize, u32, &mut [f32]) -> Vec3 + Sync,
    ) {
        let mut first = 0;
        for (instances, rows) in self.instances.iter_mut().zip(rows) {
            let Some(instances) = instances else {
                continue;
            };
            let bounds = instances
                .numbers(rows.len())
                .par_chunks_exact_mut(INSTANCE_NUMBERS)
                .zip(rows)
                .enumerate()
                .with_min_len(256)
                .fold(Bounds::default, |mut bounds, (number, (out, row))| {
                    bounds.add(write(first + number, *row, out));
                    bounds
                })
                .reduce(Bounds::default, |mut bounds, other| {
                    bounds.join(&other);
                    bounds
                });
            instances.upload(rows.len(), bounds.aabb());
            first += rows.len();
        }
    }

    /// Hands the poses that were written to the renderer.
    pub(super) fn upload_poses(&mut self) {
        let width = convert::count(ROW_TEXELS);
        let poses = &self.poses[self.turn];
        self.image
            .set_data(width, self.height, false, Format::RGBAH, poses);
        self.texture.update(&self.image);
        self.turn = 1 - self.turn;
    }

    /// Removes what is drawn.
    pub(super) fn free(self) {
        for instances in self.instances.into_iter().flatten() {
            instances.free();
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
