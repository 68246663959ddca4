//! A floor of tiles, a sun, and a camera that goes along.

use crate::walker::{Walker, walk};
use bevy::asset::RenderAssetUsages;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor};
use bevy::light::CascadeShadowConfigBuilder;
use bevy::math::Affine2;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};

/// Half of the floor's side, metres.
const FLOOR_M: f32 = 100.0;
const SKY: Color = Color::srgb(0.62, 0.70, 0.78);
/// The camera as seen from the character's place, in the axes of the world.
const CAMERA: Vec3 = Vec3::new(2.3, 1.2, 2.1);
/// Height that the camera looks at.
const WAIST_M: f32 = 0.95;

pub(crate) struct Stage;

impl Plugin for Stage {
    fn build(&self, app: &mut App) {
        app.insert_resource(ClearColor(SKY))
            .insert_resource(GlobalAmbientLight {
                color: SKY,
                brightness: 900.0,
                ..default()
            })
            .add_systems(Startup, set_up)
            .add_systems(Update, follow.after(walk));
    }
}

fn set_up(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::new(Vec3::Y, Vec2::splat(FLOOR_M)))),
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color_texture: Some(images.add(tiles())),
            // The picture has four tiles of a metre each.
            uv_transform: Affine2::from_scale(Vec2::splat(FLOOR_M)),
            perceptual_roughness: 0.9,
            ..default()
        })),
    ));
    commands.spawn((
        DirectionalLight {
            illuminance: 9_000.0,
            shadow_maps_enabled: true,
            // Shadows begin at the soles: one shadow map for a few metres can be that exact.
            shadow_normal_bias: 0.6,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: 1,
            maximum_distance: 9.0,
            ..default()
        }
        .build(),
        Transform::from_xyz(3.0, 6.0, 1.5).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.spawn((
        Camera3d::default(),
        // Needs no table of colours, which would have to come with the program.
        Tonemapping::AcesFitted,
        DistanceFog {
            color: SKY,
            falloff: FogFalloff::Linear {
                start: 8.0,
                end: 45.0,
            },
            ..default()
        },
        looking_at(Vec3::ZERO),
    ));
}

/// Light and dark tiles, two by two, to be repeated.
fn tiles() -> Image {
    let [light, dark] = [[150, 147, 140, 255], [126, 124, 119, 255]];
    let mut image = Image::new(
        Extent3d {
            width: 2,
            height: 2,
            ..default()
        },
        TextureDimension::D2,
        [light, dark, dark, light].concat(),
        TextureFormat::Rgba8UnormSrgb,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        ..ImageSamplerDescriptor::nearest()
    });
    image
}

/// Goes along with the character.
fn follow(
    walkers: Query<&Transform, With<Walker>>,
    mut cameras: Query<&mut Transform, (With<Camera3d>, Without<Walker>)>,
) {
    for (place, mut camera) in walkers.iter().zip(&mut cameras) {
        *camera = looking_at(place.translation);
    }
}

fn looking_at(place: Vec3) -> Transform {
    Transform::from_translation(place + CAMERA).looking_at(place + WAIST_M * Vec3::Y, Vec3::Y)
}
