//! glTF 2.0 binary: the skeleton as a tree of nodes, one skin, and the meshes bound to it.

use super::body::Region;
use super::paint::Painted;
use super::rest::model_from_bone;
use anyhow::{Result, bail};
use footfall_core::{JOINT_COUNT, Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_motion::gltf::glb::{ComponentType, GlbBuffer, Layout, Target, Type};
use glam::{Mat4, Quat, Vec3};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Materials, in the file's order: the light shells, which a game may tint, and the rest, coloured by vertex.
const SHELL: usize = 0;
const TRIM: usize = 1;

/// Linear colour of what is not a shell.
fn colour(region: Region) -> [u8; 4] {
    match region {
        Region::Shell => [255, 255, 255, 255],
        Region::Joint => [24, 27, 33, 255],
        Region::Left => [2, 110, 128, 255],
        Region::Right => [215, 62, 18, 255],
    }
}

const VERTEX: Option<Target> = Some(Target::ArrayBuffer);

/// Layout of four bytes a vertex.
const fn bytes(normalized: bool) -> Layout {
    Layout {
        component: ComponentType::U8,
        shape: Type::Vec4,
        normalized,
        target: VERTEX,
    }
}

/// The file's bytes: a node tree with the humanoid's names and one skinned mesh per level of detail.
pub(super) fn encode(skeleton: &Skeleton, levels: &[Painted]) -> Result<Vec<u8>> {
    let mut buffer = GlbBuffer::default();
    let mut nodes = Joint::ALL.map(|joint| bone(skeleton, joint)).to_vec();
    let mut roots = vec![Joint::Hips.index()];
    let skin = skin(skeleton, &mut buffer);
    let mut meshes = Vec::new();
    for (level, painted) in levels.iter().enumerate() {
        let name = if level == 0 {
            "Body".to_owned()
        } else {
            format!("Body_LOD{level}")
        };
        let mut primitives = Vec::new();
        for (material, wanted) in [(SHELL, true), (TRIM, false)] {
            primitives.push(primitive(
                painted,
                material,
                |region| (region == Region::Shell) == wanted,
                &mut buffer,
            )?);
        }
        meshes.push(json!({"name": name, "primitives": primitives}));
        roots.push(nodes.len());
        nodes.push(json!({"name": name, "mesh": level, "skin": 0}));
    }
    let material = |name: &str, colour: [f32; 3], roughness: f32| {
        json!({"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": [colour[0], colour[1], colour[2], 1.0], "metallicFactor": 0.0, "roughnessFactor": roughness,
        }})
    };
    let document = json!({
        "asset": {"version": "2.0", "generator": "footfall xtask mannequin"},
        "scene": 0,
        "scenes": [{"name": "Mannequin", "nodes": roots}],
        "nodes": nodes,
        "meshes": meshes,
        "skins": [skin],
        "materials": [material("Shell", [0.52, 0.505, 0.475], 0.6), material("Trim", [1.0, 1.0, 1.0], 0.6)],
    });
    Ok(buffer.into_file(document))
}

/// One bone as a node; children follow from [`Joint::parent`].
fn bone(skeleton: &Skeleton, joint: Joint) -> Value {
    let parent = joint.parent().map_or(glam::Mat3::IDENTITY, model_from_bone);
    let translation = parent.transpose() * skeleton.offset(joint);
    let rotation = Quat::from_mat3(&(parent.transpose() * model_from_bone(joint))).normalize();
    let children: Vec<usize> = Joint::ALL
        .into_iter()
        .filter(|child| child.parent() == Some(joint))
        .map(Joint::index)
        .collect();
    let mut node = json!({"name": joint.name(), "translation": translation.to_array(), "rotation": rotation.to_array()});
    if !children.is_empty() {
        node["children"] = children.into();
    }
    node
}

fn skin(skeleton: &Skeleton, buffer: &mut GlbBuffer) -> Value {
    let mut model = ModelPose::default();
    forward_kinematics(skeleton, &Pose::rest(skeleton), &mut model);
    let inverse_binds: Vec<f32> = Joint::ALL
        .iter()
        .flat_map(|&joint| {
            let axes = Quat::from_mat3(&model_from_bone(joint));
            Mat4::from_rotation_translation(axes, model.position(joint))
                .inverse()
                .to_cols_array()
        })
        .collect();
    let accessor = buffer.push_floats(&inverse_binds, Layout::floats(Type::Mat4));
    let joints: Vec<usize> = (0..JOINT_COUNT).collect();
    json!({"name": "Mannequin", "joints": joints, "skeleton": Joint::Hips.index(), "inverseBindMatrices": accessor})
}

/// The triangles of some regions, with vertices of their own, so that colours do not run across borders.
fn primitive(
    painted: &Painted,
    material: usize,
    wanted: impl Fn(Region) -> bool,
    buffer: &mut GlbBuffer,
) -> Result<Value> {
    let mut index_of = BTreeMap::new();
    let (mut positions, mut normals, mut colours) = (Vec::new(), Vec::new(), Vec::new());
    let (mut joints, mut weights, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for (triangle, &region) in painted.mesh.triangles.iter().zip(&painted.regions) {
        if !wanted(region) {
            continue;
        }
        for &vertex in triangle {
            let index = *index_of.entry((vertex, region)).or_insert_with(|| {
                let vertex = vertex as usize;
                positions.push(painted.mesh.positions[vertex]);
                normals.push(painted.mesh.normals[vertex]);
                colours.push(colour(region));
                let (four_joints, four_weights) = quantised(&painted.weights[vertex]);
                joints.push(four_joints);
                weights.push(four_weights);
                positions.len() - 1
            });
            indices.push(index);
        }
    }
    if positions.len() > usize::from(u16::MAX) {
        bail!(
            "a mesh of {} vertices is too fine for 16-bit indices: use a coarser grid",
            positions.len()
        );
    }
    let count = indices.len();
    let indices: Vec<u8> = indices
        .into_iter()
        .flat_map(|index| (index as u16).to_le_bytes())
        .collect();
    let (low, high) = positions
        .iter()
        .fold((Vec3::MAX, Vec3::MIN), |(low, high), &position| {
            (low.min(position), high.max(position))
        });
    let position = buffer.push_vectors(&positions, VERTEX);
    buffer.bound(position, &low.to_array(), &high.to_array());
    let layout = Layout {
        component: ComponentType::U16,
        shape: Type::Scalar,
        normalized: false,
        target: Some(Target::ElementArrayBuffer),
    };

    let mut attributes = json!({
        "POSITION": position,
        "NORMAL": buffer.push_vectors(&normals, VERTEX),
        "JOINTS_0": buffer.push(joints.as_flattened(), joints.len(), bytes(false)),
        "WEIGHTS_0": buffer.push(weights.as_flattened(), weights.len(), bytes(true)),
    });
    if material == TRIM {
        let accessor = buffer.push(colours.as_flattened(), colours.len(), bytes(true));
        attributes["COLOR_0"] = accessor.into();
    }
    Ok(
        json!({"attributes": attributes, "indices": buffer.push(&indices, count, layout), "material": material}),
    )
}

/// Joints and weights as bytes; the weights sum to exactly 255.
fn quantised(weights: &[f32; JOINT_COUNT]) -> ([u8; 4], [u8; 4]) {
    let mut order: Vec<usize> = (0..JOINT_COUNT).collect();
    order.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]));
    let mut bytes = [0, 1, 2, 3].map(|place| (weights[order[place]] * 255.0).round() as u8);
    let rest: u32 = bytes[1..].iter().map(|&byte| u32::from(byte)).sum();
    bytes[0] = (255 - rest) as u8;
    let joints = [0, 1, 2, 3].map(|place| {
        if bytes[place] > 0 {
            order[place] as u8
        } else {
            0
        }
    });
    (joints, bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_of_weights_sum_to_255() {
        let mut weights = [0.0; JOINT_COUNT];
        weights[2] = 0.334;
        weights[4] = 0.333;
        weights[20] = 0.333;
        let (joints, bytes) = quantised(&weights);
        assert_eq!(bytes.iter().map(|&byte| u32::from(byte)).sum::<u32>(), 255);
        assert_eq!((joints[0], joints[3], bytes[3]), (2, 0, 0));
    }

    #[test]
    fn bones_at_rest_stand_where_the_skeleton_does() {
        let skeleton = Skeleton::standard();
        let mut model = ModelPose::default();
        forward_kinematics(&skeleton, &Pose::rest(&skeleton), &mut model);
        let mut model_from_node = vec![Mat4::IDENTITY; JOINT_COUNT];
        for joint in Joint::ALL {
            let node = bone(&skeleton, joint);
            let floats = |key: &str| -> Vec<f32> {
                node[key]
                    .as_array()
                    .unwrap()
                    .iter()
                    .map(|value| value.as_f64().unwrap() as f32)
                    .collect()
            };
            let local = Mat4::from_rotation_translation(
                Quat::from_slice(&floats("rotation")),
                Vec3::from_slice(&floats("translation")),
            );
            let parent = joint
                .parent()
                .map_or(Mat4::IDENTITY, |parent| model_from_node[parent.index()]);
            model_from_node[joint.index()] = parent * local;
            let stands = model_from_node[joint.index()].transform_point3(Vec3::ZERO);
            assert!(
                stands.distance(model.position(joint)) < 1e-5,
                "{} at {stands}",
                joint.name()
            );
        }
    }
}
