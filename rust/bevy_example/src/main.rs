//! A character that walks in Bevy, moved by the crate `footfall`.

mod bones;
mod character;
mod controls;
mod pictures;
mod stage;
#[cfg(test)]
mod tests;
mod walker;

use anyhow::Result;
use bevy::prelude::*;
use character::Character;
use clap::Parser;
use stage::Stage;
use std::path::PathBuf;

const MANNEQUIN: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../demo_project/characters/mannequin.glb"
);
const MODEL: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../addons/footfall/models/locomotion.footfall"
);

/// A character that walks in Bevy: W and S walk, A and D turn, Shift runs, C crouches, Space jumps.
#[derive(Parser)]
struct Arguments {
    /// The character, a skinned humanoid as glTF [default: the mannequin of the demo]
    #[arg(default_value = MANNEQUIN, hide_default_value = true)]
    character: PathBuf,
    /// Open no window, and leave pictures of ten seconds in this folder
    #[arg(long, value_name = "FOLDER")]
    pictures: Option<PathBuf>,
}

fn main() -> AppExit {
    run(&Arguments::parse()).unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        AppExit::error()
    })
}

fn run(arguments: &Arguments) -> Result<AppExit> {
    let character = Character::new(&arguments.character, MODEL.as_ref())?;
    let plugins = DefaultPlugins.set(character.folder());
    let mut app = App::new();
    if let Some(folder) = &arguments.pictures {
        app.add_plugins((pictures::without_window(plugins), character, Stage));
        pictures::take(&mut app, folder)
    } else {
        app.add_plugins((plugins.set(controls::window()), character, Stage))
            .add_systems(Update, controls::obey_keys.before(walker::walk));
        Ok(app.run())
    }
}
