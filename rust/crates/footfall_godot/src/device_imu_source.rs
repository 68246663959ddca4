//! `DeviceImuSource`: the sensors of the phone that the game itself runs on.

use crate::convert;
use footfall_imu::live::device::now_secs;
use footfall_imu::{GRAVITY_MPS2, ImuSample};
use godot::classes::{IResource, Input, Resource};
use godot::prelude::*;

/// Platforms give gravity in m/s² or in units of itself; its length decides which.
const LEAST_MPS2: f32 = 3.0;

/// Reads the sensors of the phone that runs the game, through Godot's `Input`.
///
/// Turn `input_devices/sensors/enable_accelerometer`, `enable_gravity` and `enable_gyroscope` on in the project settings. Godot delivers the last measurement once a
/// frame: keep 60 frames per second or more. Units and signs are the same on Android and iOS. Keep the screen orientation fixed.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct DeviceImuSource {
    base: Base<Resource>,
}

#[godot_api]
impl IResource for DeviceImuSource {}

#[godot_api]
impl DeviceImuSource {
    /// Returns `true` if this device delivers motion. If not, it has no sensors, or the project settings turn them off.
    #[func]
    fn is_available() -> bool {
        measure().is_some()
    }
}

/// Measurement of this device now; `None` without sensors.
pub(crate) fn measure() -> Option<ImuSample> {
    let input = Input::singleton();
    let acceleration = input.get_accelerometer();
    if acceleration == Vector3::ZERO {
        return None;
    }
    let gravity = input.get_gravity();
    let length = if gravity == Vector3::ZERO {
        acceleration.length()
    } else {
        gravity.length()
    };
    let scale = if length < LEAST_MPS2 {
        GRAVITY_MPS2
    } else {
        1.0
    };
    // Godot's accelerometer points the way of gravity on every platform; specific force points against it.
    Some(ImuSample {
        time_secs: now_secs(),
        force: convert::vec3(-acceleration) * scale,
        rate: convert::vec3(input.get_gyroscope()),
    })
}
