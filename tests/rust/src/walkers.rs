//! Walkers of the shipped walk, walks as recordings, and models of sensors on them.

use crate::data::repository;
use footfall_core::rotation::from_heading;
use footfall_core::{Clip, ModelPose, Pose, Site, Skeleton};
use footfall_model::{GaitModel, Provenance};
use footfall_recon::Prepared;
use footfall_synth::{
    Controls, GaitChoice, GaitGenerator, GeneratorConfig, StyleSpace, WalkConfig, synthesize,
};
use footfall_train::imu::{ImuClip, ImuTrainConfig, TrunkTurn, train_imu_clips};
use glam::Vec3;
use std::sync::{Arc, OnceLock};

/// A model of the repository, by its path from the root.
pub fn model(path: &str) -> Arc<GaitModel> {
    let bytes = std::fs::read(repository().join(path)).expect("the model is there");
    Arc::new(GaitModel::from_bytes(&bytes).expect("the model can be read"))
}

/// A walker of the shipped walk with this body.
pub fn generator(skeleton: &Skeleton, seed: u64) -> GaitGenerator {
    static SPACE: OnceLock<Arc<StyleSpace>> = OnceLock::new();
    let space = SPACE.get_or_init(|| {
        let model = model("addons/footfall/models/locomotion.footfall");
        Arc::new(StyleSpace::new(&model, &[]).expect("the shipped walk walks"))
    });
    let config = GeneratorConfig {
        seed,
        phase: 0.0,
        variation: 1.0,
    };
    GaitGenerator::new(space, &[], skeleton, &config).expect("the body walks")
}

/// Lets a walker go on by a frame; returns its pose in the space where it began.
pub fn step_in_world(walker: &mut GaitGenerator, dt_secs: f32, controls: &Controls) -> Pose {
    let mut pose = Pose::default();
    walker.step(dt_secs, controls, &mut pose);
    let place = walker.start_from_character();
    let turn = from_heading(place.heading);
    pose.root_position = place.position + turn * pose.root_position;
    pose.rotations[0] = turn * pose.rotations[0];
    pose
}

/// Bodies of so many frames of a walker of the shipped walk, sixty a second, and the feet that stand in them. It is out of standing, under these controls.
pub fn shown(
    seed: u64,
    frames: usize,
    controls: impl Fn(usize) -> Controls,
) -> Vec<(ModelPose, [bool; 2])> {
    let skeleton = Skeleton::standard();
    let mut walker = generator(&skeleton, seed);
    (0..frames)
        .map(|frame| {
            let pose = step_in_world(&mut walker, 1.0 / 60.0, &controls(frame));
            (ModelPose::of(&skeleton, &pose), walker.feet_in_contact())
        })
        .collect()
}

/// Greatest change of velocity along places of sixty frames a second, m/s².
pub fn most_acceleration(places: &[Vec3]) -> f32 {
    let changes = places.windows(3).map(|frames| {
        let [before, now, after] = [0, 1, 2].map(|index| frames[index]);
        (before - 2.0 * now + after).length() * 3600.0
    });
    changes.fold(0.0, f32::max)
}

/// A walk of 24 steps, as if it had been recorded.
pub fn recorded(gait: &Arc<GaitModel>, skeleton: &Skeleton, seed: u64, speed_mps: f32) -> Clip {
    let config = WalkConfig {
        steps: 24,
        seed,
        variation: 1.0,
        speed_mps: Some(speed_mps),
        turn_rate_radps: 0.0,
        direction_rad: 0.0,
        gait: GaitChoice::Auto,
        frame_rate_hz: Some(60.0),
        from_standing: false,
    };
    let walk = synthesize(gait, skeleton, &config);
    walk.expect("the body walks").clip
}

/// A model of sensors at these sites, learned from walks of as many people.
pub fn sensor_model(walks: &[Clip], sites: &[Site]) -> Arc<Prepared> {
    let subjects: Vec<String> = (0..walks.len()).map(|walk| walk.to_string()).collect();
    let clips: Vec<ImuClip<'_>> = subjects
        .iter()
        .zip(walks)
        .map(|(subject, clip)| ImuClip {
            subject,
            clip,
            first_frame: 0,
            recordings: &[],
            trunk: TrunkTurn::default(),
        })
        .collect();
    let config = ImuTrainConfig::new(sites);
    let model = train_imu_clips(&clips, &config, Provenance::default());
    let model = Arc::new(model.expect("a model of the walks"));
    Arc::new(Prepared::new(model).expect("a sound model"))
}
