//! Walks in a game loop of 60 frames a second, up a kerb, and stops on it: `cargo run --example game_loop`.
#![expect(clippy::print_stdout, reason = "examples print")]

use footfall::body::Pose;
use footfall::gait::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
use footfall::glam::Vec3;
use footfall::ground::{FootPlacer, Frame, Ground, PlacementConfig, PlacementInput};
use footfall::model::GaitModel;
use std::{error::Error, fs, path::Path, sync::Arc};

pub(crate) const KERB_M: f32 = 0.15;
pub(crate) const DT_SECS: f32 = 1.0 / 60.0;

/// Flat ground with a kerb across the way at z = 3 m. A game casts a ray instead.
fn street(from: Vec3, way: Vec3) -> Option<Ground> {
    let height = if from.z < 3.0 { 0.0 } else { KERB_M };
    let met = (height..=height - way.y).contains(&from.y);
    met.then(|| Ground {
        position: from.with_y(height),
        normal: Vec3::Y,
        support: 0,
    })
}

/// Plays seven seconds; `show` receives the character's place in each frame, its feet and its pose.
pub(crate) fn play(
    model: &Arc<GaitModel>,
    mut show: impl FnMut(usize, Frame, &FootPlacer, &Pose),
) -> Result<(), Box<dyn Error>> {
    let config = GeneratorConfig {
        seed: 1,
        phase: 0.0,
        variation: 1.0,
    };
    let styles = Arc::new(StyleSpace::new(model, &[])?);
    let mut walker = GaitGenerator::new(&styles, &[], &model.skeleton, &config)?;
    walker.stand();
    let mut placer = FootPlacer::new(&model.skeleton, &PlacementConfig::default());
    let (mut pose, mut height) = (Pose::rest(&model.skeleton), 0.0);
    for frame in 0..420 {
        let asked_mps = if frame < 330 { 1.2 } else { 0.0 };
        let mut controls = Controls::STAND;
        controls.speed_mps = asked_mps * placer.pace();
        walker.step(DT_SECS, &controls, &mut pose);
        // The character rises with the ground below its feet.
        height += (1.0 - (-DT_SECS / 0.12).exp()) * placer.ground_offset_m();
        let mut place = Frame::from(walker.start_from_character());
        place.position.y = height;
        let mut input = PlacementInput {
            world_from_floor: place,
            contacts: Some(walker.feet_in_contact()),
            landings: walker.landings(),
            airborne: false,
        };
        if placer.pace() < 1.0 {
            // A foothold on the kerb is chosen for this step.
            walker.keep_step();
        }
        if let Some(share) = placer.step_share(&input, &mut street) {
            walker.stretch_step(share);
            input.landings = walker.landings();
        }
        placer.step(DT_SECS, &input, &mut street, &mut pose);
        show(frame, place, &placer, &pose);
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../addons/footfall/models");
    let model = GaitModel::from_bytes(&fs::read(models.join("locomotion.footfall"))?)?;
    println!("time, s   way, m   height, m   left foot   right foot");
    play(&Arc::new(model), |frame, place, placer, _| {
        if frame % 30 == 29 {
            let secs = (frame + 1) as f32 * DT_SECS;
            let Vec3 { y, z, .. } = place.position;
            let [left, right] = placer.feet().map(|foot| foot.sole.position.y);
            println!("{secs:7.1}   {z:6.2}   {y:9.2}   {left:9.2}   {right:10.2}");
        }
    })
}
