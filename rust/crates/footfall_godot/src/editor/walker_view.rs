//! A small stage on which a body of capsules walks, to look at a style.

use crate::convert;
use footfall_core::{ModelPose, Pose, Skeleton};
use footfall_motion::figure::{Limb, Part, limbs};
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
use glam::{Affine3A, Mat3, Quat, Vec3};
use godot::classes::{
    Camera3D, CylinderMesh, DirectionalLight3D, ISubViewportContainer, Mesh, MeshInstance3D,
    PlaneMesh, SphereMesh, StandardMaterial3D, SubViewport, SubViewportContainer,
};
use godot::prelude::*;
use std::sync::Arc;

/// Place of the camera and the point that it looks at, metres.
const EYE: Vector3 = Vector3::new(1.7, 1.25, 2.5);
const TARGET: Vector3 = Vector3::new(0.0, 0.86, 0.0);

/// Shows a walker; empty until it is given one.
#[derive(GodotClass)]
#[class(tool, init, internal, base = SubViewportContainer)]
pub(super) struct FootfallWalkerView {
    walk: Option<PreviewWalk>,
    base: Base<SubViewportContainer>,
}

/// The one that walks.
struct PreviewWalk {
    generator: GaitGenerator,
    skeleton: Skeleton,
    controls: Controls,
    body: Gd<Node3D>,
    limbs: Vec<LimbNodes>,
}

/// The meshes of one limb: its shaft along Y and the balls at its ends.
struct LimbNodes {
    shaft: Gd<MeshInstance3D>,
    length: f32,
    balls: [Gd<MeshInstance3D>; 2],
}

impl FootfallWalkerView {
    /// An empty stage.
    pub(super) fn stage() -> Gd<Self> {
        let mut view = Self::new_alloc();
        view.set_stretch(true);
        view.set_custom_minimum_size(Vector2::new(0.0, 240.0));
        let mut viewport = SubViewport::new_alloc();
        viewport.set_use_own_world_3d(true);
        let mut camera = Camera3D::new_alloc();
        camera.look_at_from_position(EYE, TARGET);
        camera.set_fov(38.0);
        let mut light = DirectionalLight3D::new_alloc();
        light.set_rotation(Vector3::new(-0.9, 0.6, 0.0));
        let mut floor = PlaneMesh::new_gd();
        floor.set_size(Vector2::new(3.0, 3.0));
        let floor = solid(&floor.upcast(), Color::from_rgb(0.32, 0.34, 0.38));
        viewport.add_child(&camera);
        viewport.add_child(&light);
        viewport.add_child(&floor);
        view.add_child(&viewport);
        view
    }

    /// Shows a walker with the only style of a space, at the speed that suits the style.
    pub(super) fn show(&mut self, space: &Arc<StyleSpace>) {
        if let Some(walk) = self.walk.take() {
            walk.body.free();
        }
        let skeleton = space.model().skeleton.clone();
        let config = GeneratorConfig {
            seed: 0,
            phase: 0.0,
            variation: 1.0,
        };
        let Ok(generator) = GaitGenerator::new(space, &[1.0], &skeleton, &config) else {
            return;
        };
        let Some(mut viewport) = self.base().get_child(0) else {
            return;
        };
        let mut body = Node3D::new_alloc();
        let rest = ModelPose::of(&skeleton, &Pose::rest(&skeleton));
        let nodes = limbs(&skeleton, &rest)
            .iter()
            .map(|limb| LimbNodes::hang(limb, &mut body))
            .collect();
        viewport.add_child(&body);
        self.walk = Some(PreviewWalk {
            controls: Controls {
                speed_mps: generator.usual_speed_mps(),
                ..Controls::STAND
            },
            generator,
            skeleton,
            body,
            limbs: nodes,
        });
    }
}

#[godot_api]
impl ISubViewportContainer for FootfallWalkerView {
    fn process(&mut self, delta: f64) {
        let Some(walk) = &mut self.walk else {
            return;
        };
        let mut pose = Pose::default();
        let controls = walk.controls;
        walk.generator.step(delta as f32, &controls, &mut pose);
        let model = ModelPose::of(&walk.skeleton, &pose);
        let now = limbs(&walk.skeleton, &model);
        for (nodes, limb) in walk.limbs.iter_mut().zip(&now) {
            nodes.place(limb);
        }
    }
}

impl LimbNodes {
    fn hang(limb: &Limb, body: &mut Gd<Node3D>) -> Self {
        let color = match limb.part {
            Part::Trunk => Color::from_rgb(0.75, 0.76, 0.8),
            Part::Arm(footfall_core::Side::Left) | Part::Leg(footfall_core::Side::Left) => {
                Color::from_rgb(1.0, 0.55, 0.2)
            }
            Part::Arm(footfall_core::Side::Right) | Part::Leg(footfall_core::Side::Right) => {
                Color::from_rgb(0.3, 0.65, 1.0)
            }
        };
        let length = limb.ends[0].distance(limb.ends[1]).max(1e-3);
        let mut cylinder = CylinderMesh::new_gd();
        cylinder.set_bottom_radius(limb.radii[0]);
        cylinder.set_top_radius(limb.radii[1]);
        cylinder.set_height(length);
        let shaft = solid(&cylinder.upcast(), color);
        body.add_child(&shaft);
        let balls = limb.radii.map(|radius| {
            let mut sphere = SphereMesh::new_gd();
            sphere.set_radius(radius);
            sphere.set_height(2.0 * radius);
            let ball = solid(&sphere.upcast(), color);
            body.add_child(&ball);
            ball
        });
        Self {
            shaft,
            length,
            balls,
        }
    }

    fn place(&mut self, limb: &Limb) {
        let along = limb.ends[1] - limb.ends[0];
        let turn = Quat::from_rotation_arc(Vec3::Y, along.normalize_or(Vec3::Y));
        let mut axes = Mat3::from_quat(turn);
        axes.y_axis *= along.length() / self.length;
        let middle = 0.5 * (limb.ends[0] + limb.ends[1]);
        let placed = Affine3A::from_mat3_translation(axes, middle);
        self.shaft.set_transform(convert::scaled(&placed));
        for (ball, end) in self.balls.iter_mut().zip(limb.ends) {
            ball.set_position(convert::vector3(end));
        }
    }
}

fn solid(mesh: &Gd<Mesh>, color: Color) -> Gd<MeshInstance3D> {
    let mut material = StandardMaterial3D::new_gd();
    material.set_albedo(color);
    let mut instance = MeshInstance3D::new_alloc();
    instance.set_mesh(mesh);
    instance.set_material_override(&material);
    instance
}
