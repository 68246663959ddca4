//! The walk as Bevy has it, without a renderer: places of the entities that are bones.

use crate::character::Character;
use crate::controls::{course, obey_keys};
use crate::pictures::{RATE_HZ, advance, load, without_window};
use crate::walker::Walker;
use crate::{MANNEQUIN, MODEL};
use bevy::ecs::system::RunSystemOnce as _;
use bevy::log::LogPlugin;
use bevy::mesh::skinning::SkinnedMesh;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::settings::WgpuSettings;
use footfall::body::{Joint, ModelPose, Side};
use footfall::gait::{Controls, Gait, StyleSpace};
use footfall::glam::Vec3;
use footfall::ground::Frame;
use footfall::model::GaitModel;
use footfall::rig::RestRig;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The mannequin in Bevy, loaded, with nothing to draw it.
fn mannequin() -> App {
    let character = Character::new(MANNEQUIN.as_ref(), MODEL.as_ref()).unwrap();
    let no_renderer = RenderPlugin {
        render_creation: WgpuSettings {
            backends: None,
            ..default()
        }
        .into(),
        ..default()
    };
    let plugins = without_window(DefaultPlugins.set(character.folder()))
        .set(no_renderer)
        .disable::<LogPlugin>();
    let mut app = App::new();
    app.add_plugins((plugins, character));
    load(&mut app).unwrap();
    app
}

/// The entity of each joint, by its name.
fn entities(app: &mut App) -> [Entity; Joint::ALL.len()] {
    let mut named = app.world_mut().query::<(Entity, &Name)>();
    let found = |joint: Joint| {
        let mut named = named.iter(app.world());
        named.find(|(_, name)| name.as_str() == joint.name())
    };
    Joint::ALL.map(found).map(|found| found.expect("a joint").0)
}

/// Places of all joints in Bevy's world.
fn places(app: &App, entities: &[Entity; Joint::ALL.len()]) -> [Vec3; Joint::ALL.len()] {
    entities.map(|entity| {
        let transform = app.world().get::<GlobalTransform>(entity);
        transform.expect("a place").translation()
    })
}

/// Places of all joints as the library has them.
fn expected(app: &mut App) -> [Vec3; Joint::ALL.len()] {
    let mut walkers = app.world_mut().query::<&Walker>();
    let walker = walkers.single(app.world()).unwrap();
    let start_from_ground = Frame::from(walker.gait.start_from_character());
    let world_from_ground = walker.world_from_start.child(&start_from_ground);
    let model = ModelPose::of(&walker.binding.body, &walker.pose);
    Joint::ALL.map(|joint| world_from_ground.point(model.position(joint)))
}

/// Angle by which a knee is bent, radians, positive as knees bend.
fn bent(places: &[Vec3; Joint::ALL.len()], side: Side) -> f32 {
    let at = |joint: Joint| places[joint.index()];
    let thigh = at(side.lower_leg()) - at(side.upper_leg());
    let shank = at(side.foot()) - at(side.lower_leg());
    let to_left = at(Joint::LeftUpperLeg) - at(Joint::RightUpperLeg);
    let angle = thigh.angle_between(shank);
    angle.copysign(thigh.cross(shank).dot(to_left))
}

#[test]
fn bevy_shows_the_pose_that_the_library_has_all_along_the_course() {
    let mut app = mannequin();
    let entities = entities(&mut app);
    let (mut way, mut ran, mut most_bent): (f32, bool, f32) = (0.0, false, 0.0);
    let mut before = places(&app, &entities)[0];
    for frame in 0..10 * RATE_HZ {
        advance(&mut app, frame).unwrap();
        let places = places(&app, &entities);
        for (joint, (place, expected)) in
            Joint::ALL.iter().zip(places.iter().zip(expected(&mut app)))
        {
            let off = place.distance(expected);
            assert!(
                off < 1e-3,
                "{} is {off} m off at frame {frame}",
                joint.name()
            );
        }
        for side in Side::BOTH {
            let bent = bent(&places, side);
            assert!(
                bent > -0.05,
                "a knee bends backwards by {bent} at frame {frame}"
            );
            most_bent = most_bent.max(bent);
        }
        way += places[0].distance(before);
        before = places[0];
        let mut walkers = app.world_mut().query::<&Walker>();
        ran |= walkers.single(app.world()).unwrap().gait.gait() == Gait::Run;
    }
    assert!((13.0..20.0).contains(&way), "{way} m");
    assert!(ran && most_bent > 1.0, "{ran} {most_bent}");
}

#[test]
fn every_joint_of_the_skin_is_a_bone_of_the_walker_and_one_level_is_shown() {
    let mut app = mannequin();
    app.update();
    let world = app.world_mut();
    let walker = world.query::<&Walker>().single(world).unwrap();
    let posed: BTreeSet<Entity> = walker
        .binding
        .bones()
        .map(|bone| walker.bones[bone])
        .collect();
    let mut skins = world.query::<(&SkinnedMesh, &InheritedVisibility)>();
    let mut shown = 0;
    for (skin, visibility) in skins.iter(world) {
        let joints: BTreeSet<Entity> = skin.joints.iter().copied().collect();
        assert_eq!(joints, posed);
        shown += usize::from(visibility.get());
    }
    // Shells and trim of the finest level.
    assert_eq!(shown, 2);
}

/// Controls of the mannequin while keys are held.
fn asked(app: &mut App, held: &[KeyCode]) -> Controls {
    let mut keys = ButtonInput::default();
    held.iter().for_each(|key| keys.press(*key));
    app.insert_resource(keys);
    let world = app.world_mut();
    world.run_system_once(obey_keys).unwrap();
    world.query::<&Walker>().single(world).unwrap().controls
}

#[test]
fn keys_walk_run_turn_and_jump() {
    let mut app = mannequin();
    assert_eq!(asked(&mut app, &[]), Controls::STAND);
    let walk = asked(&mut app, &[KeyCode::KeyW, KeyCode::KeyA]);
    let run = asked(&mut app, &[KeyCode::KeyW, KeyCode::ShiftLeft]);
    let back = asked(&mut app, &[KeyCode::KeyS, KeyCode::KeyD]);
    assert!(walk.speed_mps > 1.0 && walk.turn_rate_radps > 0.0 && walk.direction_rad == 0.0);
    assert!(run.speed_mps > 2.0 * walk.speed_mps && run.turn_rate_radps == 0.0);
    assert!(back.speed_mps > 0.5 && back.turn_rate_radps < 0.0 && back.direction_rad > 3.0);
    assert_eq!(asked(&mut app, &[KeyCode::KeyC]).crouch, 1.0);
    asked(&mut app, &[KeyCode::Space]);
    let jumps = |walker: &Walker| walker.gait.jump_phase().is_some();
    let mut jumped = false;
    for frame in 0..RATE_HZ {
        // The course begins standing, so that only the key makes it jump.
        advance(&mut app, frame / 3).unwrap();
        let world = app.world_mut();
        jumped |= jumps(world.query::<&Walker>().single(world).unwrap());
    }
    assert!(jumped);
}

#[test]
fn what_cannot_walk_is_named() {
    let missing = Character::new("nobody.glb".as_ref(), MODEL.as_ref());
    assert!(format!("{:#}", missing.err().unwrap()).contains("nobody.glb"));
    let no_model = Character::new(MANNEQUIN.as_ref(), MANNEQUIN.as_ref());
    assert!(format!("{:#}", no_model.err().unwrap()).contains("mannequin.glb"));

    let model = GaitModel::from_bytes(&std::fs::read(MODEL).unwrap()).unwrap();
    let styles = Arc::new(StyleSpace::new(&Arc::new(model), &[]).unwrap());
    let nothing = Walker::new(&styles, &RestRig::default(), vec![], &Transform::IDENTITY);
    assert!(format!("{:#}", nothing.err().unwrap()).contains("Hips"));
}

#[test]
fn the_course_begins_and_ends_standing() {
    assert_eq!(course(0.0).speed_mps, 0.0);
    assert!(course(3.0).speed_mps > 1.0 && course(5.0).turn_rate_radps < 0.0);
    assert_eq!(course(9.9).speed_mps, 0.0);
}
