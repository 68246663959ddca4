//! `ImuReconstructor3D`: a character that sensors drive.

mod calibration;
mod frame;
mod methods;
mod session;
mod worn_sensor;

use crate::bones;
use crate::imu_model::ImuModel;
use crate::imu_source;
use crate::modifier::{BodyModifier as _, engine_calls};
use crate::root_motion::RootMotion;
use crate::shipped::{self, Fallback};
use footfall_recon::Prepared;
use godot::classes::{BoneMap, ISkeletonModifier3D, Resource, Skeleton3D, SkeletonModifier3D};
use godot::prelude::*;
use session::SensorSession;
use std::sync::Arc;
use worn_sensor::WornSensor;

/// Drives a whole character from one or two inertial sensors on a person: walking, running, jumping, hopping, sidestepping.
///
/// Add it under a `Skeleton3D` with humanoid bones. Set its `model` for the place where the sensor is worn, and its `source`; or push samples of
/// any sensor by `push_sample`. The pose is that of recorded people whose sensors would have measured the same. Standing feet stay in place.
///
/// Bones are found as by `GaitGenerator3D`. In the editor the character stands.
#[derive(GodotClass)]
#[class(tool, init, base = SkeletonModifier3D)]
pub(crate) struct ImuReconstructor3D {
    /// The sensor model: a `.footimu` file.
    ///
    /// A node added in the editor starts with `addons/footfall/models/right_foot.footimu`. The same model is used if this is empty.
    #[export]
    #[var(set = set_model, usage_flags = [DEFAULT, EDITOR_INSTANTIATE_OBJECT])]
    model: Option<Gd<ImuModel>>,

    /// Source of the samples: a `PhoneImuSource`, `SerialImuSource`, `NetworkImuSource`, `DeviceImuSource`, `NodeImuSource` or `ReplayImuSource`. Live sources open in the game, not in the
    /// editor, and drive one node each. Leave it empty if a script pushes samples.
    #[export]
    #[var(hint = RESOURCE_TYPE, hint_string = imu_source::CLASSES)]
    source: Option<Gd<Resource>>,

    /// Source of the second sensor's samples, for a model of two sensors.
    #[export]
    #[var(hint = RESOURCE_TYPE, hint_string = imu_source::CLASSES)]
    second_source: Option<Gd<Resource>>,

    /// Mounting of the sensors on the person.
    #[export]
    #[var(set = set_mounting)]
    mounting: ImuMounting,

    /// If `true`, the body's travel moves the character. If `false`, the character stays in place, and `get_root_motion_delta()` returns the travel.
    #[export]
    #[init(val = true)]
    root_motion: bool,

    /// The `Node3D` that travels, above the `Skeleton3D`. If empty, it is found as by `GaitGenerator3D`.
    #[export(node_path = ("Node3D"))]
    #[var(set = set_character)]
    character: NodePath,

    /// Assignment of bones to the joints of the profile, for rigs that are not recognised. It takes precedence over bone names.
    #[export]
    #[var(set = set_bone_map)]
    bone_map: Option<Gd<BoneMap>>,

    /// The body under way; `None` until the next frame that can start it.
    session: Option<SensorSession>,
    /// True until the next frame after the nodes around this one have changed.
    is_moved: bool,
    /// True when a calibration is to begin with the next session.
    calibrates: bool,
    /// The add-on's own sensor model, where `model` is empty.
    fallback: Fallback<ImuModel>,
    /// Problem that was last reported, so that it is reported once.
    reported: Option<String>,
    travelled: RootMotion,
    base: Base<SkeletonModifier3D>,
}

/// Mounting of a sensor.
#[derive(GodotConvert, Var, Export, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[godot(via = i64)]
#[repr(i32)]
pub(crate) enum ImuMounting {
    /// Any orientation: about four seconds of motion calibrate its axes. Until then the character stands.
    #[default]
    Auto = 0,
    /// Axes parallel to the body's in the T-pose: x to the left, y up, z forward.
    Aligned = 1,
}

engine_calls!(ImuReconstructor3D);

#[godot_api]
impl ImuReconstructor3D {
    /// `mounting`: the sensors may have any orientation; motion calibrates them.
    #[constant]
    const AUTO: i32 = ImuMounting::Auto as i32;
    /// `mounting`: the sensors' axes are parallel to the body's in the T-pose.
    #[constant]
    const ALIGNED: i32 = ImuMounting::Aligned as i32;

    /// Emitted when a foot lands: `foot` is `left` or `right`, `position` is in global space.
    #[signal]
    fn footstep(foot: StringName, position: Vector3);

    /// Emitted when the behaviour changes: `stand`, `walk`, `run`, `jump`, `hop` or `sidestep`.
    #[signal]
    fn behaviour_changed(behaviour: StringName);

    /// Emitted after half a second without samples. The body continues as is probable.
    #[signal]
    fn sensor_lost();

    /// Emitted when samples arrive, for the first time or again.
    #[signal]
    fn sensor_found();

    /// Emitted when the problem of a sensor or of its mounting changes: a name as from `get_sensor_problem()`, and a message that says what to do. Both are empty when
    /// the problem is solved.
    #[signal]
    fn sensor_problem_changed(sensor: i64, problem: StringName, message: GString);

    /// Emitted when the calibration reaches another step: its name as from `get_calibration_step()`, and a message for the player.
    #[signal]
    fn calibration_changed(step: StringName, message: GString);

    #[func]
    fn set_model(&mut self, model: Option<Gd<ImuModel>>) {
        self.model = shipped::instead_of_new(model);
        self.restart();
    }

    #[func]
    fn set_mounting(&mut self, mounting: ImuMounting) {
        self.mounting = mounting;
        self.restart();
    }

    #[func]
    fn set_character(&mut self, character: NodePath) {
        self.character = character;
        self.restart();
    }

    #[func]
    fn set_bone_map(&mut self, bone_map: Option<Gd<BoneMap>>) {
        self.bone_map = bones::completed(bone_map);
        self.restart();
    }
}

impl ImuReconstructor3D {
    fn sensor_mut(&mut self, sensor: i64) -> Option<&mut WornSensor> {
        let sensor = usize::try_from(sensor).ok()?;
        self.session.as_mut()?.sensors.get_mut(sensor)
    }

    /// Problems with the sources' settings.
    fn source_problems(&self) -> Vec<String> {
        let sources = [&self.source, &self.second_source];
        let sources = sources.into_iter().flatten();
        let listener = self.base().clone().upcast();
        sources
            .filter_map(|source| imu_source::problem(source, &listener))
            .collect()
    }

    fn restart(&mut self) {
        self.session = None;
        self.reported = None;
        self.base_mut().update_configuration_warnings();
    }

    fn prepared(&self) -> Result<Arc<Prepared>, String> {
        let model = self.fallback.model(self.model.as_ref())?;
        let prepared = model.bind().prepared();
        prepared.map_err(|error| format!("The sensor model cannot be used: {error}"))
    }
}
