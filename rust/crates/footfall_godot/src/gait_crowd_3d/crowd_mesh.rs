//! A character's meshes as a crowd draws them: in the T-pose, with joints and weights where a shader finds them.

use super::crowd_material::crowd_material;
use super::stand_in_mesh::StandInMesh;
use crate::bones;
use crate::convert;
use crate::skeleton_binding::SkeletonBinding;
use footfall_core::{JOINT_COUNT, Joint, ModelPose, Pose, Skeleton};
use glam::{Affine3A, Vec3, Vec3A};
use godot::classes::mesh::{ArrayCustomFormat, ArrayFormat, ArrayType, PrimitiveType};
use godot::classes::{
    ArrayMesh, Mesh, MeshInstance3D, Node3D, PackedScene, ShaderMaterial, Skeleton3D,
};
use godot::obj::{EngineBitfield as _, EngineEnum as _};
use godot::prelude::*;

/// Joints that move one vertex.
pub(super) const INFLUENCES: usize = 4;

/// Character of a crowd: its mesh and its body.
#[derive(Clone)]
pub(super) struct CrowdMesh {
    /// For walkers whose pose is new in every frame, and for those far away.
    pub(super) meshes: [Gd<ArrayMesh>; 2],
    /// For walkers of whom only some pixels are seen.
    pub(super) stand_in: Option<StandInMesh>,
    pub(super) body: Skeleton,
    /// Positions of the joints in the T-pose.
    pub(super) rest: [Vec3; JOINT_COUNT],
    /// The joint whose rotation each joint's bone takes.
    pub(super) turned_by: [Joint; JOINT_COUNT],
}

/// Finds the skeleton of a character.
pub(super) fn skeleton_of(character: &Gd<Node3D>) -> Option<Gd<Skeleton3D>> {
    let found = character
        .find_children_ex("*")
        .type_("Skeleton3D")
        .owned(false)
        .done();
    let first = found.iter_shared().next();
    first.and_then(|node| node.try_cast::<Skeleton3D>().ok())
}

impl CrowdMesh {
    /// Takes a character to pieces. `host` is a node in the tree, under which it is put for a moment.
    ///
    /// # Errors
    /// Text for the user that says what is wrong with the character.
    pub(super) fn new(scene: &Gd<PackedScene>, host: &mut Gd<Node3D>) -> Result<Self, String> {
        let made = scene
            .instantiate()
            .ok_or("Character cannot be instantiated. Open the scene and repair it.")?;
        let mut character = made.try_cast::<Node3D>().map_err(|node| {
            node.free();
            "The root of Character is not a Node3D. Choose a scene with a character.".to_owned()
        })?;
        host.add_child_ex(&character)
            .internal(godot::classes::node::InternalMode::BACK)
            .done();
        character.set_global_transform(Transform3D::IDENTITY);
        let taken = Self::of(&character);
        character.free();
        taken
    }

    fn of(character: &Gd<Node3D>) -> Result<Self, String> {
        let skeleton = skeleton_of(character).ok_or(
            "Character has no Skeleton3D. Choose a scene with a humanoid character, such as an imported .glb.",
        )?;
        let binding = SkeletonBinding::new(&skeleton, character, None)
            .map_err(|error| format!("Character: {error}"))?;
        let bones = binding.t_pose_of_bones(&bones::at_rest(&skeleton));
        let mut instances: Vec<(f32, Gd<MeshInstance3D>)> = Vec::new();
        for node in skeleton
            .find_children_ex("*")
            .type_("MeshInstance3D")
            .owned(false)
            .done()
            .iter_shared()
        {
            if let Ok(instance) = node.try_cast::<MeshInstance3D>()
                && instance.get_mesh().is_some()
                && instance.get_skin_reference().is_some()
            {
                instances.push((instance.get_visibility_range_begin(), instance));
            }
        }
        if instances.is_empty() {
            return Err(
                "Character has no skinned mesh under its Skeleton3D. Choose a scene with one."
                    .to_owned(),
            );
        }
        // Meshes that take over with the distance: the second for those near, the last for those far away.
        let mut begins: Vec<f32> = instances.iter().map(|(begin, _)| *begin).collect();
        begins.sort_by(f32::total_cmp);
        begins.dedup();
        let last = begins.len() - 1;
        let mesh_of = |level: usize| {
            let mut mesh = ArrayMesh::new_gd();
            for (begin, instance) in &instances {
                if (*begin - begins[level]).abs() < 1e-3 {
                    add_surfaces(&mut mesh, instance, &skeleton, &bones);
                }
            }
            mesh
        };
        let far = mesh_of(last);
        let near = if last > 1 { mesh_of(1) } else { far.clone() };
        let meshes = [near, far];
        let t_pose = ModelPose::of(&binding.body, &Pose::rest(&binding.body));
        Ok(Self {
            stand_in: StandInMesh::of(&meshes[1], &t_pose.positions),
            meshes,
            rest: t_pose.positions,
            turned_by: binding.turned_by(),
            body: binding.body.clone(),
        })
    }
}

/// Adds the surfaces of one skinned mesh.
fn add_surfaces(
    mesh: &mut Gd<ArrayMesh>,
    instance: &Gd<MeshInstance3D>,
    skeleton: &Gd<Skeleton3D>,
    bones: &[(Joint, Affine3A)],
) {
    let (Some(source), Some(skin)) = (
        instance.get_mesh(),
        instance
            .get_skin_reference()
            .and_then(|skin| skin.get_skin()),
    ) else {
        return;
    };
    let binds: Vec<(Joint, Affine3A)> = (0..skin.get_bind_count())
        .map(|bind| {
            let name = skin.get_bind_name(bind);
            let bone = if name.is_empty() {
                skin.get_bind_bone(bind)
            } else {
                skeleton.find_bone(&GString::from(&name))
            };
            let index = usize::try_from(bone).unwrap_or(0).min(bones.len() - 1);
            let (joint, t_pose) = bones[index];
            let rest = convert::affine(skeleton.get_bone_global_rest(convert::count(index)));
            (
                joint,
                t_pose * rest * convert::affine(skin.get_bind_pose(bind)),
            )
        })
        .collect();
    for surface in 0..source.get_surface_count() {
        let arrays = source.surface_get_arrays(surface);
        let Some(arrays) = t_posed(&arrays, &binds) else {
            continue;
        };
        let index = mesh.get_surface_count();
        add_surface(mesh, &arrays);
        let material = instance.get_active_material(surface);
        if let Some(material) = crowd_material(material) {
            mesh.surface_set_material(index, &material);
        }
    }
}

/// Adds a surface with joints and weights in its custom channels.
pub(super) fn add_surface(mesh: &mut Gd<ArrayMesh>, arrays: &VarArray) {
    mesh.add_surface_from_arrays_ex(PrimitiveType::TRIANGLES, arrays)
        .flags(custom_format())
        .done();
}

/// Four floats in each custom channel. The Compatibility renderer of Godot 4.6 reads only part of four bytes.
fn custom_format() -> ArrayFormat {
    let floats = ArrayCustomFormat::RGBA_FLOAT.ord().cast_unsigned();
    let shift = |format: ArrayFormat| format.ord();
    let channels = [
        shift(ArrayFormat::CUSTOM0_SHIFT),
        shift(ArrayFormat::CUSTOM1_SHIFT),
    ];
    ArrayFormat::from_ord(
        channels
            .map(|shift| u64::from(floats) << shift)
            .iter()
            .sum(),
    )
}

/// The arrays of a surface in the T-pose; `None` for one without bones.
fn t_posed(arrays: &VarArray, binds: &[(Joint, Affine3A)]) -> Option<VarArray> {
    let slot = |kind: ArrayType| kind.ord() as usize;
    let get = |kind: ArrayType| arrays.get(slot(kind));
    let vertices = get(ArrayType::VERTEX)?
        .try_to::<PackedVector3Array>()
        .ok()?;
    let normals = get(ArrayType::NORMAL)?
        .try_to::<PackedVector3Array>()
        .ok()?;
    let bones = get(ArrayType::BONES)?.try_to::<PackedInt32Array>().ok()?;
    let weights = get(ArrayType::WEIGHTS)?
        .try_to::<PackedFloat32Array>()
        .ok()?;
    let count = vertices.len();
    let each = bones.len().checked_div(count)?;
    if each == 0 || weights.len() != bones.len() || normals.len() != count {
        return None;
    }
    let mut places = Vec::with_capacity(count);
    let mut directions = Vec::with_capacity(count);
    let mut joint_numbers = Vec::with_capacity(INFLUENCES * count);
    let mut weight_numbers = Vec::with_capacity(INFLUENCES * count);
    for vertex in 0..count {
        let mut by_joint = [0.0; JOINT_COUNT];
        let point = Vec3A::from(convert::vec3(vertices.as_slice()[vertex]));
        let normal = Vec3A::from(convert::vec3(normals.as_slice()[vertex]));
        let (mut place, mut direction) = (Vec3A::ZERO, Vec3A::ZERO);
        let range = vertex * each..(vertex + 1) * each;
        let total: f32 = weights.as_slice()[range.clone()].iter().sum();
        for influence in range {
            let weight = weights.as_slice()[influence] / total.max(1e-6);
            let bind = usize::try_from(bones.as_slice()[influence]).unwrap_or(0);
            let Some((joint, t_pose)) = binds.get(bind).filter(|_| weight > 0.0) else {
                continue;
            };
            by_joint[joint.index()] += weight;
            place += weight * t_pose.transform_point3a(point);
            direction += weight * t_pose.transform_vector3a(normal);
        }
        places.push(convert::vector3(place.into()));
        directions.push(convert::vector3(
            Vec3::from(direction).normalize_or(Vec3::Y),
        ));
        let (joints, shares) = strongest(&by_joint);
        joint_numbers.extend_from_slice(&joints);
        weight_numbers.extend_from_slice(&shares);
    }
    let mut made = VarArray::new();
    made.resize(slot(ArrayType::MAX), &Variant::nil());
    made.set(
        slot(ArrayType::VERTEX),
        &PackedVector3Array::from(places).to_variant(),
    );
    made.set(
        slot(ArrayType::NORMAL),
        &PackedVector3Array::from(directions).to_variant(),
    );
    made.set(
        slot(ArrayType::CUSTOM0),
        &PackedFloat32Array::from(joint_numbers).to_variant(),
    );
    made.set(
        slot(ArrayType::CUSTOM1),
        &PackedFloat32Array::from(weight_numbers).to_variant(),
    );
    for kept in [ArrayType::COLOR, ArrayType::TEX_UV, ArrayType::INDEX] {
        if let Some(values) = get(kept) {
            made.set(slot(kept), &values);
        }
    }
    Some(made)
}

/// The four joints that move a vertex most, and their weights, which add up to one.
fn strongest(by_joint: &[f32; JOINT_COUNT]) -> ([f32; INFLUENCES], [f32; INFLUENCES]) {
    let mut order: [usize; JOINT_COUNT] = core::array::from_fn(|joint| joint);
    order.sort_by(|a, b| by_joint[*b].total_cmp(&by_joint[*a]));
    let joints: [usize; INFLUENCES] = core::array::from_fn(|index| order[index]);
    let total: f32 = joints.iter().map(|joint| by_joint[*joint]).sum();
    let weights = joints.map(|joint| by_joint[joint] / total.max(1e-6));
    (joints.map(|joint| joint as f32), weights)
}

/// Gives the shaders of a mesh these poses.
pub(super) fn give_poses(
    mesh: &Gd<ArrayMesh>,
    rest: &[Vec3; JOINT_COUNT],
    poses: &Gd<godot::classes::ImageTexture>,
    over: Option<&Gd<ShaderMaterial>>,
) -> Gd<ArrayMesh> {
    let mut own = mesh.duplicate_resource();
    let rest: PackedVector3Array = rest.iter().map(|place| convert::vector3(*place)).collect();
    for surface in 0..own.clone().upcast::<Mesh>().get_surface_count() {
        let shown = over.cloned().or_else(|| {
            let material = mesh.surface_get_material(surface)?;
            material.try_cast::<ShaderMaterial>().ok()
        });
        let Some(shown) = shown else {
            continue;
        };
        let mut material = shown.duplicate_resource();
        material.set_shader_parameter("crowd_poses", &poses.to_variant());
        material.set_shader_parameter("crowd_rest", &rest.to_variant());
        own.surface_set_material(surface, &material);
    }
    own
}
