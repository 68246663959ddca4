//! Methods of the node that scripts call.

use super::worn_sensor::WornSensor;
use super::{ImuMounting, ImuReconstructor3D};
use crate::convert;
use crate::modifier::BodyModifier as _;
use crate::root_motion;
use footfall_core::Behaviour;
use footfall_imu::ImuSample;
use godot::classes::ProjectSettings;
use godot::prelude::*;

#[godot_api(secondary)]
impl ImuReconstructor3D {
    /// Adds a sample of a sensor: 0, or 1 for the second site of the model. `time` is the sensor's clock in seconds, `force` its specific
    /// force in m/s² (including gravity), `rate` its angular rate in rad/s, both in the sensor's own axes.
    ///
    /// Late, repeated and non-finite samples are dropped.
    #[func]
    fn push_sample(&mut self, sensor: i64, time: f64, force: Vector3, rate: Vector3) {
        let sample = ImuSample {
            time_secs: time,
            force: convert::vec3(force),
            rate: convert::vec3(rate),
        };
        if let (Some(session), Ok(sensor)) = (&mut self.session, usize::try_from(sensor)) {
            session.push(sensor, sample);
        }
    }

    /// Takes the direction in which the character faces now as straight ahead of the person.
    #[func]
    fn reset_heading(&mut self) {
        if let Some(session) = &mut self.session {
            let heading = session.reconstructor.heading();
            session.reconstructor.reset_heading(heading);
        }
    }

    /// Turns the body to the left by an angle in radians, for steering by stick where the player cannot turn.
    #[func]
    fn turn(&mut self, angle: f64) {
        if let Some(session) = &mut self.session {
            let heading = session.reconstructor.heading() + angle as f32;
            session.reconstructor.reset_heading(heading);
        }
    }

    /// Discards the mounting of the sensors and calibrates it again, after the sensors have moved. The character stands until samples arrive.
    #[func]
    fn forget_mounting(&mut self) {
        if let Some(session) = &mut self.session {
            session.forget_mountings();
        }
    }

    /// Returns the age of the live sensors' newest sample when the pose is made, in seconds; 0 for other sources.
    #[func]
    fn get_latency(&self) -> f64 {
        let sensors = self.session.iter().flat_map(|session| &session.sensors);
        sensors.map(WornSensor::latency_secs).fold(0.0, f64::max)
    }

    /// Records a sensor's samples from now on into a file that a `ReplayImuSource` plays. Returns `true` if the file can be created.
    #[func]
    fn start_recording(&mut self, path: GString, #[opt(default = 0)] sensor: i64) -> bool {
        let path = String::from(path);
        let path = ProjectSettings::singleton().globalize_path(path.as_str());
        let sensor = self.sensor_mut(sensor);
        sensor.is_some_and(|sensor| sensor.start_recording(&path.to_string()))
    }

    /// Ends a recording and renames its temporary file. Returns `true` if all of it was written.
    #[func]
    fn stop_recording(&mut self, #[opt(default = 0)] sensor: i64) -> bool {
        self.sensor_mut(sensor)
            .is_some_and(WornSensor::stop_recording)
    }

    /// Returns the body's behaviour: `stand`, `walk`, `run`, `jump`, `hop` or `sidestep`.
    #[func]
    fn get_behaviour(&self) -> StringName {
        let behaviour = self
            .session
            .as_ref()
            .map_or(Behaviour::Stand, |s| s.behaviour);
        StringName::from(behaviour.name())
    }

    /// Returns the model's confidence, 0 to 1: the probability that the wearer's motion is among the motions the model learned. 0 without
    /// samples.
    ///
    /// Walking gives about 0.85. Below 0.1, as with a sensor that is shaken, worn elsewhere or mounted in another orientation, the body stands.
    #[func]
    fn get_confidence(&self) -> f64 {
        let session = self.session.as_ref();
        session.map_or(0.0, |s| f64::from(s.reconstructor.confidence()))
    }

    /// Returns the certainty of a sensor's mounting, 0 to 1; 0 before it is known.
    #[func]
    fn get_mounting_certainty(&self, sensor: i64) -> f64 {
        if self.mounting == ImuMounting::Aligned {
            return 1.0;
        }
        let sensor = usize::try_from(sensor).unwrap_or(usize::MAX);
        let sensor = self.session.as_ref().and_then(|s| s.sensors.get(sensor));
        let mounting = sensor.and_then(|sensor| sensor.mounting);
        mounting.map_or(0.0, |mounting| f64::from(mounting.certainty))
    }

    /// Returns the body's travel in the character's own space since the previous frame, as `get_root_motion_delta()` of `GaitGenerator3D`.
    #[func]
    fn get_root_motion_delta(&mut self) -> Transform3D {
        let skeleton = self.base().get_skeleton();
        root_motion::delta_for(&mut self.travelled, skeleton)
    }

    /// Returns the problems that keep the character from being driven, each with what to do next, and those of the connected sensors; empty if there are none.
    ///
    /// The editor shows the first ones as configuration warnings.
    #[func]
    fn get_problems(&self) -> PackedStringArray {
        let mut problems = self.problems();
        let sensors = self.session.iter().flat_map(|session| session.problems);
        for problem in sensors.flatten() {
            problems.push(&GString::from(&problem.to_string()));
        }
        problems
    }
}
