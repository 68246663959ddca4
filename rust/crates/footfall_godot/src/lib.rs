//! The Godot nodes: the only crate that names `godot`.
//!
//! Resources: `gait_model` holds a trained walk, `gait_style` a style, `imu_model` a sensor model. Nodes: `gait_generator_3d`
//! walks a character, `foot_placement_3d` places feet on uneven ground, `gait_crowd_3d` walks thousands, `imu_reconstructor_3d` drives a character by sensors.
//! Sources of samples: `replay_imu_source` for recordings,
//! `serial_`, `network_`, `phone_` and `device_imu_source` for live sensors, `imu_source` as their common interface. `loaded` holds a resource's parsed file,
//! `format_loader` loads files, `shipped` finds the add-on's models.
//! `skeleton_binding` (bones), `character` and `travel` (the node that travels, and its motion), `modifier` (binding and problems, common to all modifiers), `physics_ground` (ground) and `convert` (vectors) connect the engine with the runtime, which for bones and crowds is `footfall_rig`.
//!
//! The library is built in two flavours. The feature `editor` adds `editor` (a dock, gizmos, a preview bar) and the
//! class reference that Godot shows; exported games get the library without it. Both register the same runtime classes.

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
mod modifier;
mod network_imu_source;
mod node_imu_source;
mod phone_imu_source;
mod physics_ground;
mod replay_imu_source;
mod report;
mod root_motion;
mod screen_size;
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
            gait_crowd_3d::release_shader();
            footfall_rig::crowd::finish_disposals();
        }
    }
}
