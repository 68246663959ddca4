//! The character: a glTF scene that walks as soon as it is loaded.

use crate::bones::Nodes;
use crate::walker::{Walker, walk};
use anyhow::{Context as _, Result};
use bevy::asset::UntypedAssetLoadFailedEvent;
use bevy::prelude::*;
use bevy::world_serialization::WorldInstanceReady;
use footfall::gait::StyleSpace;
use footfall::model::GaitModel;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Plugin of one character. Loaded, its scene becomes a [`Walker`].
#[derive(Resource, Clone)]
pub(crate) struct Character {
    file: PathBuf,
    styles: Arc<StyleSpace>,
}

impl Character {
    /// A character's file, and the model that walks it.
    ///
    /// # Errors
    /// A file that is not there, or that holds no model.
    pub(crate) fn new(file: &Path, model: &Path) -> Result<Self> {
        let file = fs::canonicalize(file)
            .with_context(|| format!("cannot find the character {}", file.display()))?;
        let bytes = fs::read(model)
            .with_context(|| format!("cannot read the model {}", model.display()))?;
        let read = GaitModel::from_bytes(&bytes)
            .with_context(|| format!("cannot use the model {}", model.display()))?;
        let styles = Arc::new(StyleSpace::new(&Arc::new(read), &[])?);
        Ok(Self { file, styles })
    }

    /// Bevy's assets: the folder of the character.
    pub(crate) fn folder(&self) -> AssetPlugin {
        let folder = self.file.parent().unwrap_or(Path::new("."));
        AssetPlugin {
            file_path: folder.to_string_lossy().into_owned(),
            ..default()
        }
    }
}

impl Plugin for Character {
    fn build(&self, app: &mut App) {
        app.insert_resource(self.clone())
            .add_systems(Startup, spawn)
            .add_systems(Update, (walk, give_up));
    }
}

fn spawn(mut commands: Commands, character: Res<Character>, assets: Res<AssetServer>) {
    let name = PathBuf::from(character.file.file_name().unwrap_or_default());
    let scene = assets.load(GltfAssetLabel::Scene(0).from_asset(name));
    commands
        .spawn((WorldAssetRoot(scene), Transform::default()))
        .observe(begin)
        .observe(hide_coarse_levels);
}

/// Has a scene walk that was just spawned.
fn begin(
    ready: On<WorldInstanceReady>,
    mut commands: Commands,
    character: Res<Character>,
    places: Query<&Transform>,
    nodes: Nodes,
    mut exit: MessageWriter<AppExit>,
) {
    let (rig, bones) = nodes.at_rest(ready.entity);
    let place = places.get(ready.entity).copied().unwrap_or_default();
    match Walker::new(&character.styles, &rig, bones, &place) {
        Ok(walker) => {
            commands.entity(ready.entity).insert(walker);
        }
        Err(error) => {
            error!("{} cannot walk: {error:#}", character.file.display());
            exit.write(AppExit::error());
        }
    }
}

/// Shows the finest level of detail alone: the others are nodes whose names end with `_LOD1` and so on.
fn hide_coarse_levels(
    ready: On<WorldInstanceReady>,
    mut commands: Commands,
    children: Query<&Children>,
    names: Query<&Name>,
) {
    for entity in children.iter_descendants(ready.entity) {
        if names.get(entity).is_ok_and(|name| name.contains("_LOD")) {
            commands.entity(entity).insert(Visibility::Hidden);
        }
    }
}

/// Ends the program when the scene cannot be loaded; Bevy has said why.
fn give_up(
    mut failures: MessageReader<UntypedAssetLoadFailedEvent>,
    mut exit: MessageWriter<AppExit>,
) {
    for failure in failures.read() {
        error!(
            "cannot load {}, for the reason above: export the character as glTF 2.0, with its skin",
            failure.path
        );
        exit.write(AppExit::error());
    }
}
