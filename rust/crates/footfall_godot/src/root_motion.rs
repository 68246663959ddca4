//! Clocks of the engine, by which a character's travel is counted.

use footfall_rig::root_motion::{Advance, FrameClock};
use godot::classes::skeleton_3d::ModifierCallbackModeProcess;
use godot::classes::{Engine, Skeleton3D};
use godot::prelude::*;

/// Travel of a node's character.
pub(crate) type RootMotion = footfall_rig::root_motion::RootMotion<Transform3D>;

/// Number of the current frame by both clocks.
pub(crate) fn frame_clock() -> FrameClock {
    let engine = Engine::singleton();
    FrameClock {
        physics: engine.get_physics_frames(),
        process: engine.get_process_frames(),
        in_physics: engine.is_in_physics_frame(),
    }
}

/// Moment within a frame at which a skeleton moves.
fn advance_of(skeleton: &Gd<Skeleton3D>) -> Advance {
    let mode = skeleton.get_modifier_callback_mode_process();
    if mode == ModifierCallbackModeProcess::PHYSICS {
        Advance::InPhysics
    } else if mode == ModifierCallbackModeProcess::MANUAL {
        Advance::ByHand
    } else {
        Advance::InProcess
    }
}

/// Travel since the last frame of a skeleton's character, for a script; none without a skeleton.
pub(crate) fn delta_for(
    travelled: &mut RootMotion,
    skeleton: Option<Gd<Skeleton3D>>,
) -> Transform3D {
    skeleton.map_or(Transform3D::IDENTITY, |skeleton| {
        travelled.since_last_frame(advance_of(&skeleton), frame_clock())
    })
}
