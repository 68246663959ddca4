//! The mesh of a crowd's stand-ins, made of a character's mesh as the crowd draws it.

use super::crowd_material::crowd_material;
use super::crowd_mesh::{INFLUENCES, add_surface};
use super::instances::draws_in_srgb;
use super::paint::Paint;
use crate::convert;
use footfall_core::{JOINT_COUNT, Joint};
use footfall_rig::{Facet, StandIn};
use glam::Vec3;
use godot::classes::mesh::ArrayType;
use godot::classes::{ArrayMesh, Mesh, ShaderMaterial};
use godot::obj::EngineEnum as _;
use godot::prelude::*;

/// A stand-in's mesh.
#[derive(Clone)]
pub(super) struct StandInMesh {
    pub(super) mesh: Gd<ArrayMesh>,
    /// Its height, metres.
    pub(super) height_m: f32,
}

impl StandInMesh {
    /// Makes it of a mesh in the T-pose; `None` where there is nothing to stand for.
    pub(super) fn of(mesh: &Gd<ArrayMesh>, rest: &[Vec3; JOINT_COUNT]) -> Option<Self> {
        let in_srgb = draws_in_srgb();
        let mut facets = Vec::new();
        let mut gloss = Gloss::default();
        for surface in 0..mesh.clone().upcast::<Mesh>().get_surface_count() {
            let first = facets.len();
            let material = mesh
                .surface_get_material(surface)
                .and_then(|material| material.try_cast::<ShaderMaterial>().ok());
            let paint = Paint::of(material.as_ref(), in_srgb);
            add_facets(&mesh.surface_get_arrays(surface), &paint, &mut facets);
            if let Some(material) = material {
                let area = facets[first..].iter().map(Facet::area).sum();
                gloss.add(&material, area);
            }
        }
        let made = StandIn::new(&facets, rest);
        if made.indices.is_empty() {
            return None;
        }
        let mut mesh = ArrayMesh::new_gd();
        // Vertices have eight bits a colour: their colours are parts of the brightest, which the material has.
        let brightest = made
            .vertices
            .iter()
            .fold(Vec3::splat(1e-3), |most, vertex| most.max(vertex.colour));
        add_surface(&mut mesh, &arrays(&made, brightest, in_srgb));
        let mut material = crowd_material(None)?;
        material.set_shader_parameter("albedo", &shown(brightest).to_variant());
        gloss.give(&mut material);
        mesh.surface_set_material(0, &material);
        Some(Self {
            mesh,
            height_m: made.height_m(),
        })
    }
}

/// A linear colour as the inspector has it.
fn shown(linear: Vec3) -> Color {
    Color::from_rgb(linear.x, linear.y, linear.z).linear_to_srgb()
}

/// Shine of a character: the mean of its materials.
#[derive(Default)]
struct Gloss {
    area: f32,
    sums: [f32; 2],
}

impl Gloss {
    const PARAMETERS: [&str; 2] = ["roughness", "metallic"];

    fn add(&mut self, material: &Gd<ShaderMaterial>, area: f32) {
        let values = Self::PARAMETERS.map(|name| material.get_shader_parameter(name));
        if let [Ok(roughness), Ok(metallic)] = values.map(|value| value.try_to::<f32>()) {
            self.sums[0] += area * roughness;
            self.sums[1] += area * metallic;
            self.area += area;
        }
    }

    fn give(&self, material: &mut Gd<ShaderMaterial>) {
        if self.area > 0.0 {
            for (name, sum) in Self::PARAMETERS.into_iter().zip(self.sums) {
                material.set_shader_parameter(name, &(sum / self.area).to_variant());
            }
        }
    }
}

/// Adds the triangles of a surface.
fn add_facets(arrays: &VarArray, paint: &Paint, facets: &mut Vec<Facet>) {
    let get = |kind: ArrayType| arrays.get(kind.ord() as usize).unwrap_or_default();
    let floats = |kind: ArrayType| get(kind).try_to::<PackedFloat32Array>();
    let (Ok(places), Ok(joints), Ok(weights)) = (
        get(ArrayType::VERTEX).try_to::<PackedVector3Array>(),
        floats(ArrayType::CUSTOM0),
        floats(ArrayType::CUSTOM1),
    ) else {
        return;
    };
    let uvs = get(ArrayType::TEX_UV).try_to::<PackedVector2Array>();
    let colours = get(ArrayType::COLOR).try_to::<PackedColorArray>();
    let (uvs, colours) = (uvs.unwrap_or_default(), colours.unwrap_or_default());
    let indices = get(ArrayType::INDEX).try_to::<PackedInt32Array>();
    let indices: Vec<usize> = indices.map_or_else(
        |_| (0..places.len()).collect(),
        |indices| {
            let counted = indices.as_slice().iter();
            counted
                .filter_map(|index| usize::try_from(*index).ok())
                .collect()
        },
    );
    for triangle in indices.chunks_exact(3) {
        let corners = [triangle[0], triangle[1], triangle[2]];
        let Some(joint) = moved_by(corners, joints.as_slice(), weights.as_slice()) else {
            continue;
        };
        facets.push(Facet {
            corners: corners.map(|corner| convert::vec3(places[corner])),
            joint,
            colour: paint.of_triangle(
                corners.map(|corner| uvs.get(corner)),
                corners.map(|corner| colours.get(corner)),
            ),
        });
    }
}

/// The joint that moves a triangle most.
fn moved_by(corners: [usize; 3], joints: &[f32], weights: &[f32]) -> Option<Joint> {
    let mut shares = [0.0; JOINT_COUNT];
    for corner in corners {
        let influences = corner * INFLUENCES..(corner + 1) * INFLUENCES;
        let joints = joints.get(influences.clone())?;
        for (joint, weight) in joints.iter().zip(weights.get(influences)?) {
            *shares.get_mut(*joint as usize)? += weight;
        }
    }
    Joint::ALL
        .into_iter()
        .max_by(|a, b| shares[a.index()].total_cmp(&shares[b.index()]))
}

/// The arrays of a surface, whose colours are parts of the brightest one.
fn arrays(made: &StandIn, brightest: Vec3, in_srgb: bool) -> VarArray {
    let vertices = || made.vertices.iter();
    let mut arrays = VarArray::new();
    arrays.resize(ArrayType::MAX.ord() as usize, &Variant::nil());
    let mut set = |kind: ArrayType, values: Variant| arrays.set(kind.ord() as usize, &values);
    let places: PackedVector3Array = vertices()
        .map(|vertex| convert::vector3(vertex.place))
        .collect();
    let normals: PackedVector3Array = vertices()
        .map(|vertex| convert::vector3(vertex.normal))
        .collect();
    let white = shown(brightest);
    let colours: PackedColorArray = vertices()
        .map(|vertex| {
            if in_srgb {
                let own = shown(vertex.colour);
                Color::from_rgb(own.r / white.r, own.g / white.g, own.b / white.b)
            } else {
                let part = vertex.colour / brightest;
                Color::from_rgb(part.x, part.y, part.z)
            }
        })
        .collect();
    let joints: PackedFloat32Array = vertices()
        .flat_map(|vertex| {
            let [first, second] = vertex.joints.map(|joint| joint.index() as f32);
            [first, second, 0.0, 0.0]
        })
        .collect();
    let weights: PackedFloat32Array = vertices()
        .flat_map(|vertex| {
            if vertex.joints[0] == vertex.joints[1] {
                [1.0, 0.0, 0.0, 0.0]
            } else {
                [0.5, 0.5, 0.0, 0.0]
            }
        })
        .collect();
    let indices: PackedInt32Array = made
        .indices
        .iter()
        .map(|index| index.cast_signed())
        .collect();
    set(ArrayType::VERTEX, places.to_variant());
    set(ArrayType::NORMAL, normals.to_variant());
    set(ArrayType::COLOR, colours.to_variant());
    set(ArrayType::CUSTOM0, joints.to_variant());
    set(ArrayType::CUSTOM1, weights.to_variant());
    set(ArrayType::INDEX, indices.to_variant());
    arrays
}
