//! Pictures without a window.

use crate::controls::course;
use crate::walker::Walker;
use anyhow::{Context as _, Result, bail};
use bevy::app::PluginGroupBuilder;
use bevy::camera::RenderTarget;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::view::screenshot::{Screenshot, save_to_disk};
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Size of a picture, pixels.
const SIZE: UVec2 = UVec2::new(576, 324);
pub(crate) const RATE_HZ: u32 = 60;
const FRAMES: u32 = 600;
/// Frames from one picture to the next; no stride lasts as long.
const EVERY: u32 = 40;
/// Longest that something may take that goes on beside the frames.
const PATIENCE: Duration = Duration::from_mins(2);

/// Bevy as it is for a program without a window, which shows every frame completely.
pub(crate) fn without_window(plugins: PluginGroupBuilder) -> PluginGroupBuilder {
    plugins
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            synchronous_pipeline_compilation: true,
            ..default()
        })
        .disable::<WinitPlugin>()
}

/// Walks the course and leaves pictures `frame_….png` of it in a folder.
///
/// # Errors
/// A folder that cannot be written, or a program that ends before the course does.
pub(crate) fn take(app: &mut App, folder: &Path) -> Result<AppExit> {
    fs::create_dir_all(folder)
        .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let target = Image::new_target_texture(SIZE.x, SIZE.y, TextureFormat::Rgba8UnormSrgb, None);
    let target = app.world_mut().resource_mut::<Assets<Image>>().add(target);
    let seen = RenderTarget::from(target.clone());
    app.add_systems(
        PostStartup,
        move |mut commands: Commands, camera: Single<Entity, With<Camera3d>>| {
            commands.entity(*camera).insert(seen.clone());
        },
    );
    load(app)?;
    for frame in 0..FRAMES {
        let is_shown = frame % EVERY == EVERY - 1;
        // Frames without a picture need not be drawn.
        let mut cameras = app.world_mut().query::<&mut Camera>();
        cameras.single_mut(app.world_mut())?.is_active = is_shown;
        if is_shown {
            let file = folder.join(format!("frame_{frame:04}.png"));
            app.world_mut()
                .spawn(Screenshot::image(target.clone()))
                .observe(save_to_disk(file));
        }
        advance(app, frame)?;
    }
    // The last ones are on their way.
    until(app, "the last picture", |world| {
        let mut waiting = world.query_filtered::<(), With<Screenshot>>();
        waiting.iter(world).next().is_none()
    })?;
    Ok(AppExit::Success)
}

/// Starts an app whose frames are counted, and waits for the character.
///
/// # Errors
/// A character that cannot be loaded.
pub(crate) fn load(app: &mut App) -> Result<()> {
    let frame = Duration::from_secs(1) / RATE_HZ;
    app.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    app.finish();
    app.cleanup();
    until(app, "the character", |world| {
        world.query::<&Walker>().iter(world).next().is_some()
    })
}

/// Moves on by one frame of the course.
///
/// # Errors
/// A program that ends.
pub(crate) fn advance(app: &mut App, frame: u32) -> Result<()> {
    let world = app.world_mut();
    for mut walker in world.query::<&mut Walker>().iter_mut(world) {
        walker.controls = course(frame as f32 / RATE_HZ as f32);
    }
    update(app)
}

/// Runs frames until something is there.
fn until(app: &mut App, what: &str, mut is_there: impl FnMut(&mut World) -> bool) -> Result<()> {
    let begin = Instant::now();
    while !is_there(app.world_mut()) {
        if begin.elapsed() > PATIENCE {
            bail!("{what} did not come within {} s", PATIENCE.as_secs());
        }
        update(app)?;
        sleep(Duration::from_millis(5));
    }
    Ok(())
}

fn update(app: &mut App) -> Result<()> {
    app.update();
    if let Some(exit) = app.should_exit() {
        bail!("Bevy has ended the program ({exit:?}); what it said above is why");
    }
    Ok(())
}
