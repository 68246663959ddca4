//! `ImuReconstructor3D`: a character that sensors drive.

mod calibration;
mod methods;
mod session;
mod worn;

use crate::bones;
use crate::character;
use crate::convert;
use crate::imu_model::{ImuModel, NO_MODEL};
use crate::imu_source;
use crate::report;
use crate::root_motion::{RootMotion, frame_clock};
use crate::shipped::{self, Fallback};
use crate::skeleton_binding::SkeletonBinding;
use crate::travel::Traveller;
use footfall_core::{Behaviour, Pose, Side};
use footfall_model::imu_model::MAX_SENSORS;
use footfall_recon::{CalibrationGuide, Prepared, ReconConfig, Reconstructor, SensorState};
use footfall_synth::GroundTransform;
use glam::Vec3;
use godot::classes::{
    BoneMap, Engine, ISkeletonModifier3D, Resource, Skeleton3D, SkeletonModifier3D,
};
use godot::prelude::*;
use session::{Session, standing};
use std::sync::Arc;
use worn::Worn;

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
    session: Option<Session>,
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

#[godot_api]
impl ISkeletonModifier3D for ImuReconstructor3D {
    fn process_modification_with_delta(&mut self, delta: f64) {
        let Some(skeleton) = self.base().get_skeleton() else {
            return;
        };
        if convert::is_flat(skeleton.get_global_transform()) {
            return;
        }
        match self.take_session(&skeleton) {
            Ok(session) => self.drive(session, &skeleton, delta),
            Err(problem) => {
                if self.reported.as_ref() != Some(&problem) {
                    report::tell(&self.base_mut(), &problem);
                    self.reported = Some(problem);
                }
            }
        }
    }

    fn get_configuration_warnings(&self) -> PackedStringArray {
        self.problems()
    }
}

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
        self.model =
            shipped::instead_of_new(model, shipped::RIGHT_FOOT, |model| model.bind().is_new());
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
        bones::complete(bone_map.as_ref());
        self.bone_map = bone_map;
        self.restart();
    }
}

impl ImuReconstructor3D {
    fn worn_mut(&mut self, sensor: i64) -> Option<&mut Worn> {
        let sensor = usize::try_from(sensor).ok()?;
        self.session.as_mut()?.sensors.get_mut(sensor)
    }

    fn problems(&self) -> PackedStringArray {
        let mut problems = PackedStringArray::new();
        for problem in self
            .prepared()
            .err()
            .into_iter()
            .chain(self.source_problems())
        {
            problems.push(&GString::from(&problem));
        }
        match self.base().get_skeleton() {
            None => problems.push(&bones::no_skeleton(&self.to_gd().upcast())),
            Some(skeleton) if skeleton.is_inside_tree() => {
                if let Err(problem) = self.bind(&skeleton) {
                    problems.push(&GString::from(&problem));
                }
            }
            Some(_) => {}
        }
        problems
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
        let used = self
            .fallback
            .model(self.model.as_ref(), shipped::RIGHT_FOOT);
        let model = used.ok_or(NO_MODEL)?;
        let prepared = model.bind().prepared();
        prepared.map_err(|error| format!("The sensor model cannot be used: {error}"))
    }

    fn bind(&self, skeleton: &Gd<Skeleton3D>) -> Result<(Gd<Node3D>, SkeletonBinding), String> {
        let node = self.base().clone().upcast::<Node>();
        let character = character::find(&node, skeleton, &self.character)?;
        let binding = SkeletonBinding::new(skeleton, &character, self.bone_map.as_ref())
            .map_err(|error| error.to_string())?;
        Ok((character, binding))
    }

    fn take_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<Session, String> {
        let prepared = self.prepared()?;
        if let Some(mut session) = self.session.take()
            && Arc::ptr_eq(&session.prepared, &prepared)
            && session.traveller.is_for(skeleton)
        {
            return Ok(session);
        }
        let (character, binding) = self.bind(skeleton)?;
        for problem in self.source_problems() {
            report::tell(&self.base_mut(), &problem);
        }
        let mut reconstructor =
            Reconstructor::new(&prepared, &binding.body, &ReconConfig::default())
                .map_err(|error| error.to_string())?;
        let standing = standing(&reconstructor);
        let finds_mountings = self.mounting == ImuMounting::Auto;
        if finds_mountings {
            (0..MAX_SENSORS).for_each(|sensor| reconstructor.forget_mounting(sensor));
        }
        let origin = GroundTransform {
            position: Vec3::ZERO,
            heading: 0.0,
        };
        Ok(Session {
            pose: Pose::rest(&binding.body),
            traveller: Traveller::new(character, binding, origin),
            standing,
            reconstructor,
            prepared,
            sensors: Default::default(),
            finds_mountings,
            behaviour: Behaviour::Stand,
            guide: (finds_mountings && core::mem::take(&mut self.calibrates))
                .then(CalibrationGuide::default),
            asked: None,
            problems: [None; MAX_SENSORS],
            state: SensorState::Waiting,
        })
    }

    /// One frame: samples are heard, the character travels, bones are posed, signals are emitted.
    fn drive(&mut self, mut session: Session, skeleton: &Gd<Skeleton3D>, delta: f64) {
        self.reported = None;
        let in_editor = Engine::singleton().is_editor_hint();
        let delta = if in_editor { 0.0 } else { delta.max(0.0) };
        let sources = [self.source.clone(), self.second_source.clone()];
        let listener = self.base().clone().upcast();
        for (sensor, source) in sources.iter().enumerate() {
            if let Some(source) = source.as_ref().filter(|_| !in_editor) {
                session.hear(sensor, imu_source::hear(source, &listener), delta);
            }
        }
        session.look();
        session.reconstructor.step(delta as f32, &mut session.pose);
        let landings = session.reconstructor.landings();
        let (position, heading) = session.reconstructor.split(&mut session.pose);
        if session.reconstructor.sensor_state() == SensorState::Waiting {
            session.pose.clone_from(&session.standing);
        }
        let influence = self.base().get_influence().clamp(0.0, 1.0);
        let travel = session
            .traveller
            .go_to(GroundTransform { position, heading })
            .scaled(influence);
        let delta = session.traveller.local_delta(&travel);
        self.travelled.add(delta, frame_clock());
        let now = session.traveller.start_from_ground();
        let world_from_start = travel.world_from_current() * now.inverse();
        let travels = self.root_motion && !in_editor;
        {
            // Scripts may answer to what happens here and come back to this node: no borrow may be held.
            let _released = self.base_mut();
            if travels {
                session.traveller.move_character(&travel);
            }
            session.traveller.binding.write(skeleton, &session.pose);
        }
        let state = session.reconstructor.sensor_state();
        let behaviour = session.reconstructor.behaviour();
        let told = (session.state, session.behaviour);
        (session.state, session.behaviour) = (state, behaviour);
        let news = session.news();
        self.session = Some(session);
        for (side, landing) in Side::BOTH.into_iter().zip(landings) {
            if let Some(landing) = landing {
                let place = convert::vector3(world_from_start.transform_point3(landing));
                sources.iter().flatten().for_each(imu_source::footstep);
                self.signals()
                    .footstep()
                    .emit(&StringName::from(side.name()), place);
            }
        }
        if told.0 != state && state == SensorState::Lost {
            self.signals().sensor_lost().emit();
        }
        if told.0 != state && state == SensorState::Tracking {
            self.signals().sensor_found().emit();
        }
        if told.1 != behaviour {
            let name = StringName::from(behaviour.name());
            self.signals().behaviour_changed().emit(&name);
        }
        self.tell(&news);
    }
}
