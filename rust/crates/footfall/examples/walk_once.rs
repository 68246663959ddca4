//! Walks a dozen steps and writes them as BVH, for any animation program.
//!
//! `cargo run --example walk_once [MODEL.footfall [OUT.bvh]]`
#![expect(clippy::print_stdout, reason = "examples print")]

use footfall::gait::{EventKind, GaitChoice, SynthError, SynthesizedWalk, WalkConfig, synthesize};
use footfall::model::GaitModel;
use footfall_motion::bvh;
use std::path::PathBuf;
use std::sync::Arc;
use std::{env, error, fs};

/// The project's walk.
pub(crate) const MODEL: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../../addons/footfall/models/locomotion.footfall"
);

/// Generates a walk of this many steps that begins and ends standing.
pub(crate) fn walk(model: &Arc<GaitModel>, steps: usize) -> Result<SynthesizedWalk, SynthError> {
    let config = WalkConfig {
        steps,
        seed: 1,
        variation: 1.0,
        speed_mps: Some(1.3),
        turn_rate_radps: 0.0,
        frame_rate_hz: Some(60.0),
        direction_rad: 0.0,
        gait: GaitChoice::Auto,
        from_standing: true,
    };
    synthesize(model, &model.skeleton, &config)
}

fn main() -> Result<(), Box<dyn error::Error>> {
    let mut arguments = env::args().skip(1);
    let model = arguments.next().unwrap_or_else(|| MODEL.to_owned());
    let out = arguments
        .next()
        .map_or_else(|| env::temp_dir().join("walk_once.bvh"), PathBuf::from);

    let model = Arc::new(GaitModel::from_bytes(&fs::read(model)?)?);
    let walk = walk(&model, 12)?;
    for event in walk.events() {
        if event.kind == EventKind::InitialContact {
            let secs = event.frame as f64 / walk.clip.frame_rate_hz;
            let foot = event.side.name();
            println!("{secs:5.2} s  the {foot} foot lands");
        }
    }
    let last = walk.clip.poses.last().ok_or("a walk without frames")?;
    let metres = last.root_position.z;
    let secs = walk.clip.duration_secs();
    println!("{metres:.2} m in {secs:.2} s");

    bvh::write_file(&bvh::clip_to_bvh(&walk.clip), &out)?;
    println!("wrote {}", out.display());
    Ok(())
}
