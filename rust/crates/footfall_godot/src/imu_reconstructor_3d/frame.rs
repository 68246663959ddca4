//! One frame of a character that sensors drive.

use super::session::{SensorSession, standing};
use super::{ImuMounting, ImuReconstructor3D};
use crate::modifier::BodyModifier;
use crate::root_motion::frame_clock;
use crate::travel::Traveller;
use crate::{convert, imu_source};
use footfall_core::{Behaviour, Pose, Side};
use footfall_model::imu_model::MAX_SENSORS;
use footfall_recon::{CalibrationGuide, Prepared, ReconConfig, Reconstructor, SensorState};
use footfall_synth::GroundTransform;
use glam::Vec3;
use godot::classes::{BoneMap, Engine, Skeleton3D};
use godot::prelude::*;
use std::sync::Arc;

impl BodyModifier for ImuReconstructor3D {
    type Session = SensorSession;

    fn character_path(&self) -> &NodePath {
        &self.character
    }

    fn bone_map_for(&self, _skeleton: &Gd<Skeleton3D>) -> Option<Gd<BoneMap>> {
        self.bone_map.clone()
    }

    fn last_problem(&mut self) -> &mut Option<String> {
        &mut self.reported
    }

    fn take_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<SensorSession, String> {
        let prepared = self.prepared()?;
        let is_moved = core::mem::take(&mut self.is_moved);
        let Some(mut session) = self.session.take() else {
            return self.new_session(skeleton, prepared);
        };
        let fits = Arc::ptr_eq(&session.prepared, &prepared)
            && session.traveller.is_for(skeleton)
            && (!is_moved || self.travels_as(&session, skeleton));
        if fits {
            return Ok(session);
        }
        match self.new_session(skeleton, prepared) {
            Ok(mut new) => {
                new.take_over(session);
                Ok(new)
            }
            Err(problem) => {
                // A character that is being reparented is out of place for a moment: its sensors stay.
                self.session = Some(session);
                Err(problem)
            }
        }
    }

    fn advance(&mut self, session: SensorSession, skeleton: Gd<Skeleton3D>, delta: f64) {
        self.drive(session, &skeleton, delta);
    }

    fn interrupt(&mut self) {
        self.reported = None;
        self.is_moved = true;
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
        if let Some(problem) = self.skeleton_problem() {
            problems.push(&problem);
        }
        problems
    }
}

impl ImuReconstructor3D {
    /// Returns whether the node that travels, and the body that carries it, are still those of a session.
    fn travels_as(&self, session: &SensorSession, skeleton: &Gd<Skeleton3D>) -> bool {
        let character = self.find_character(skeleton);
        character.is_ok_and(|character| session.traveller.carries(&character))
    }

    fn new_session(
        &mut self,
        skeleton: &Gd<Skeleton3D>,
        prepared: Arc<Prepared>,
    ) -> Result<SensorSession, String> {
        let (character, binding) = self.bind(skeleton)?;
        for problem in self.source_problems() {
            self.warn(&problem);
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
        Ok(SensorSession {
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

    /// One frame: takes samples, moves the character, poses bones, emits signals.
    fn drive(&mut self, mut session: SensorSession, skeleton: &Gd<Skeleton3D>, delta: f64) {
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
        let before = (session.state, session.behaviour);
        (session.state, session.behaviour) = (state, behaviour);
        let changes = session.changes();
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
        if before.0 != state && state == SensorState::Lost {
            self.signals().sensor_lost().emit();
        }
        if before.0 != state && state == SensorState::Tracking {
            self.signals().sensor_found().emit();
        }
        if before.1 != behaviour {
            let name = StringName::from(behaviour.name());
            self.signals().behaviour_changed().emit(&name);
        }
        self.emit_changes(&changes);
    }
}
