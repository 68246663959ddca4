//! `cargo xtask pictures`: the pictures of the README and of the entries in Godot's stores, as the demo's scenes take them.

use crate::demo::{SCENES, Stage};
use crate::paths;
use anyhow::{Context as _, Result};
use image::imageops::{self, FilterType};
use std::path::Path;

const SIZE: &str = "1280x720";
/// Size of a picture in the README, pixels.
const SHOWN: (u32, u32) = (960, 540);

/// Pictures of the README, in `demo_project/pictures`: name, topic, and the picture that its scene takes.
const README: [(&str, &str, &str); 12] = [
    ("town.png", "town", "hero_square.png"),
    ("walk.png", "walk", "hero_side.png"),
    ("run.png", "run", "hero_side.png"),
    ("styles.png", "styles", "hero_front.png"),
    ("stairs.png", "uneven", "hero_stairs.png"),
    ("hills.png", "uneven", "hero_hills.png"),
    ("crowd.png", "crowd", "hero_among.png"),
    ("third_person.png", "third_person", "hero_behind.png"),
    ("own_character.png", "own_character", "hero_side.png"),
    ("sensor.png", "sensor", "hero_three_quarter.png"),
    ("live_sensor.png", "live_sensor", "frame_0008.png"),
    ("switching.png", "switching", "hero_three_quarter.png"),
];
/// Scenes that are asked for something else than they begin with: topic, scene, and what is asked.
const ASKED: [(&str, &str, [&str; 2]); 1] =
    [("run", "res://scenes/walk/walk.tscn", ["--speed", "3.4"])];
/// Picture of a store's list, at its full size, and where it comes from.
const THUMBNAIL: (&str, &str, &str) = ("rust/store/thumbnail.png", "town", "hero_square.png");

/// Renders the pictures.
///
/// # Errors
/// When a part cannot be built or had, a scene fails, or a picture cannot be written.
pub(crate) fn command() -> Result<()> {
    let stage = Stage::build("pictures")?;
    let folder = paths::target_folder().join("pictures");
    paths::make_empty(&folder)?;
    let plain = SCENES.map(|(topic, scene)| (topic, scene, None));
    let asked = ASKED.map(|(topic, scene, asked)| (topic, scene, Some(asked)));
    for (topic, scene, asked) in plain.into_iter().chain(asked) {
        if README.iter().all(|(_, of, _)| *of != topic) {
            continue;
        }
        eprintln!("{topic} …");
        let asked = asked.as_ref().map_or(&[][..], |asked| asked);
        let options = ["--resolution", SIZE];
        stage.photograph(scene, &options, asked, &folder.join(topic))?;
    }
    let root = paths::repository_root();
    for (name, topic, picture) in README {
        let file = root.join("demo_project/pictures").join(name);
        keep(&folder.join(topic).join(picture), &file, Some(SHOWN))?;
    }
    let (name, topic, picture) = THUMBNAIL;
    keep(&folder.join(topic).join(picture), &root.join(name), None)
}

/// Writes a picture, at another size or its own.
fn keep(picture: &Path, file: &Path, size: Option<(u32, u32)>) -> Result<()> {
    let taken = image::open(picture)
        .with_context(|| format!("cannot read {}", picture.display()))?
        .to_rgb8();
    let shown = match size {
        Some((width, height)) => imageops::resize(&taken, width, height, FilterType::CatmullRom),
        None => taken,
    };
    shown
        .save(file)
        .with_context(|| format!("cannot write {}", file.display()))?;
    println!("{}", file.display());
    Ok(())
}
