//! Wishes of the player, and those of the course that pictures show.

use crate::walker::Walker;
use bevy::prelude::*;
use footfall::gait::Controls;

const WALK_MPS: f32 = 1.4;
const RUN_MPS: f32 = 3.4;
const BACKWARDS_MPS: f32 = 0.9;
const TURN_RADPS: f32 = 1.6;
const JUMP_M: f32 = 0.3;

/// A window whose title names the keys.
pub(crate) fn window() -> WindowPlugin {
    WindowPlugin {
        primary_window: Some(Window {
            title: "Footfall in Bevy: W S walk, A D turn, Shift runs, C crouches, Space jumps"
                .into(),
            ..default()
        }),
        ..default()
    }
}

/// Has walkers do what the keys say.
pub(crate) fn obey_keys(keys: Res<ButtonInput<KeyCode>>, mut walkers: Query<&mut Walker>) {
    let held = |key| f32::from(u8::from(keys.pressed(key)));
    let ahead = held(KeyCode::KeyW) - held(KeyCode::KeyS);
    let fastest = if keys.pressed(KeyCode::ShiftLeft) {
        RUN_MPS
    } else {
        WALK_MPS
    };
    let backwards = ahead < 0.0;
    for mut walker in &mut walkers {
        walker.controls = Controls {
            speed_mps: ahead.abs() * if backwards { BACKWARDS_MPS } else { fastest },
            direction_rad: if backwards {
                core::f32::consts::PI
            } else {
                0.0
            },
            turn_rate_radps: TURN_RADPS * (held(KeyCode::KeyA) - held(KeyCode::KeyD)),
            crouch: held(KeyCode::KeyC),
            ..Controls::STAND
        };
        if keys.just_pressed(KeyCode::Space) {
            walker.gait.jump(JUMP_M);
        }
    }
}

/// The course of the pictures, ten seconds long: a walk ahead, one to the right, a run, and a stop.
pub(crate) fn course(secs: f32) -> Controls {
    let asked = |speed_mps: f32, turn_rate_radps: f32| Controls {
        speed_mps,
        turn_rate_radps,
        ..Controls::STAND
    };
    match secs {
        ..0.5 => Controls::STAND,
        ..4.0 => asked(WALK_MPS, 0.0),
        ..5.5 => asked(WALK_MPS, -0.6),
        ..8.5 => asked(RUN_MPS, 0.0),
        _ => Controls::STAND,
    }
}
