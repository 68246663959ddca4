//! The Godot nodes: the only crate that names `godot`.
//!
//! `gait_model` is the resource that holds a trained walk, `gait_style` one that holds a style of it, `gait_generator_3d` the
//! node that walks a character with them, `foot_placement_3d` the one that puts feet on uneven ground, `gait_crowd_3d` the one that walks thousands;
//! `imu_model` is the resource that knows what sensors mean, `replay_imu_source` one that plays their recordings,
//! `serial_`, `network_`, `phone_` and `device_imu_source` those that hear them live, `imu_source` what all of these are to `imu_reconstructor_3d`, the node that they drive; `loaded` is what a resource made of a file,
//! `format_loader` what loads it, `shipped` where the models are that come with the add-on.
//! Between the engine and the runtime, which is `footfall_rig` where bones and crowds are concerned, stand `skeleton_binding` (the engine's bones), `character` and `travel` (which node travels, and how), `physics_ground` (what feet stand on) and `convert` (vectors).
//!
//! Two flavours are built. With the feature `editor` the library also holds `editor` (a dock, gizmos, a preview bar) and the
//! class reference that Godot shows; exported games get the library without. Both register the same runtime classes.

#![expect(
    unsafe_code,
    reason = "gdext's entry point is an unsafe trait: it vouches for the library's lifecycle"
)]
#![expect(
    unreachable_pub,
    reason = "gdext makes public accessors for exported fields"
)]

mod bones;
mod character;
mod convert;
mod device_imu_source;
#[cfg(feature = "editor")]
mod editor;
mod foot_placement_3d;
mod format_loader;
mod gait_crowd_3d;
mod gait_generator_3d;
mod gait_model;
mod gait_style;
mod imu_model;
mod imu_reconstructor_3d;
mod imu_source;
mod loaded;
mod network_imu_source;
mod node_imu_source;
mod phone_imu_source;
mod physics_ground;
mod replay_imu_source;
mod report;
mod root_motion;
mod serial_imu_source;
mod shipped;
mod skeleton_binding;
mod travel;
mod walk_source;

use godot::init::InitStage;
use godot::prelude::{ExtensionLibrary, gdextension};

/// The entry point that `footfall.gdextension` names.
struct FootfallExtension;

#[gdextension(entry_symbol = footfall_init)]
// SAFETY: the entry point and its level are not overridden, so gdext's own initialisation runs.
unsafe impl ExtensionLibrary for FootfallExtension {
    fn on_stage_init(stage: InitStage) {
        match stage {
            InitStage::Scene => format_loader::register(),
            #[cfg(feature = "editor")]
            InitStage::Editor => editor::headless::skip_class_reference(),
            _ => {}
        }
    }

    fn on_stage_deinit(stage: InitStage) {
        if stage == InitStage::Scene {
            format_loader::unregister();
        }
    }
}
