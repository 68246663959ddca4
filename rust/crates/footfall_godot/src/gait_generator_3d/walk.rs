//! One frame of the walk.

use super::GaitGenerator3D;
use super::gait_choice::name_of;
use super::moves::Flight;
use super::reign::Reign;
use super::session::Session;
use crate::convert;
use crate::gait_model::NO_STYLES;
use crate::report;
use crate::root_motion::frame_clock;
use crate::skeleton_binding::SkeletonBinding;
use footfall_synth::GeneratorConfig;
use godot::classes::{Engine, Skeleton3D};
use godot::prelude::*;

impl GaitGenerator3D {
    /// Lets a frame pass. It may come before `ready`, outside a frame, and more than once a frame; then `delta` is 0.
    pub(super) fn pass_frame(&mut self, delta: f64) {
        let Some(skeleton) = self.base().get_skeleton() else {
            return;
        };
        if !skeleton.is_inside_tree() || convert::is_flat(skeleton.get_global_transform()) {
            return;
        }
        if let Some(problem) = self.rivalry(&skeleton) {
            self.report(problem);
            return;
        }
        match self.take_session(&skeleton) {
            Ok(session) => self.walk(session, skeleton, delta),
            // Without time passing the node may still be about to get what it lacks.
            Err(problem) if delta > 0.0 => self.report(problem),
            Err(_) => {}
        }
    }

    /// The walk under way, or a new one where there is none, the model was replaced or the body changed.
    pub(super) fn take_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<Session, String> {
        let source = self.take_source()?;
        if let Some(mut session) = self.session.take() {
            if session.is_for(&source, skeleton) {
                return Ok(session);
            }
            // A character that is being reparented is seen on its way, too: its walk goes on from wherever that ends.
            self.session = Some(session);
            self.put_aside();
        }
        self.new_session(skeleton)
    }

    /// A walk that begins where the character stands.
    pub(super) fn new_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<Session, String> {
        let source = self.take_source()?;
        let (character, binding) = self.bind(skeleton)?;
        if self.passes_over_styles() {
            report::tell(&self.base_mut(), NO_STYLES);
        }
        let config = self.config();
        self.redraw_way();
        let weights = self.style_weights.as_slice();
        let mut session = Session::new(
            &source,
            weights,
            character,
            binding,
            &config,
            self.controls(),
        )?;
        self.resume(&mut session, skeleton);
        Ok(session)
    }

    /// Configuration of the walk: its seed, its phase and its place.
    pub(super) fn config(&self) -> GeneratorConfig {
        if let Some(config) = self.replica_config() {
            return config;
        }
        let (seed, begin) = if self.seed == 0 {
            (self.own_seed(), self.own_phase())
        } else {
            (self.seed.cast_unsigned(), 0.0)
        };
        GeneratorConfig {
            seed,
            phase: (self.phase.rem_euclid(1.0) as f32 + begin).rem_euclid(1.0),
            variation: self.variation as f32,
        }
    }

    pub(super) fn bind(
        &self,
        skeleton: &Gd<Skeleton3D>,
    ) -> Result<(Gd<Node3D>, SkeletonBinding), String> {
        let character = self.find_character(skeleton)?;
        let binding = SkeletonBinding::new(skeleton, &character, self.bone_map.as_ref())
            .map_err(|error| error.to_string())?;
        Ok((character, binding))
    }

    /// One frame: time passes, the character travels, bones are posed, footsteps are emitted.
    pub(super) fn walk(&mut self, mut session: Session, mut skeleton: Gd<Skeleton3D>, delta: f64) {
        self.told.problem = None;
        let in_editor = Engine::singleton().is_editor_hint();
        let holds = if in_editor {
            self.is_preview_paused()
        } else {
            // The skeleton calls its modifiers whatever their own process mode is.
            !self.playing || !self.base().can_process()
        };
        let dt_secs = if holds { 0.0 } else { delta.max(0.0) };
        let travels = self.root_motion && !in_editor;
        let weights = self.layer_weights();
        self.pass_replica(&mut session, dt_secs);
        let detail = self.choose_detail(&session, delta);
        session.generator.set_detail(detail);
        session
            .generator
            .set_standing_motion(self.standing_motion as f32);
        if let Some(state) = self.pending.state.take()
            && let Err(problem) = session.restore(state.as_slice())
        {
            let node = self.base().get_path();
            godot_warn!("{node}: the state was refused: {problem}");
        }
        if let Some(secs) = self.pending.seek.take() {
            session.skip(secs, self.controls());
        }
        if let Err(problem) = self.fulfil(&mut session, &skeleton, delta.max(0.0)) {
            self.report(problem);
        }
        if self.reign == Reign::Away {
            self.rest(session);
            return;
        }
        let jumped = session.generator.jump_phase();
        let (travel, arrived, out) = if self.reign == Reign::Leaving {
            let (travel, out) = session.go_out(&skeleton, delta.max(0.0));
            (travel, false, out)
        } else {
            let controls = self.controls();
            let travel = match self.replica.follower() {
                Some(follower) => session.follow(dt_secs, follower),
                None => session.advance(dt_secs, controls),
            };
            self.remember_velocity(&travel, dt_secs);
            (travel, session.has_arrived(), false)
        };
        let influence = self.base().get_influence().clamp(0.0, 1.0);
        let travel = travel.scaled(influence);
        let delta = session.traveller.local_delta(&travel);
        self.travelled.add(delta, frame_clock());
        {
            // Scripts may answer to what happens here and come back to this node: no borrow may be held.
            let _released = self.base_mut();
            if travels {
                session.traveller.move_character(&travel);
            }
            session.write(&mut skeleton, &weights);
        }
        let silent = in_editor || self.reign == Reign::Leaving;
        let footsteps = if silent {
            Vec::new()
        } else {
            session.footsteps(&travel)
        };
        let foothold = session.next_foothold(&travel).filter(|_| !silent);
        let gait = session.generator.gait();
        let flight = Flight::between(jumped, session.generator.jump_phase());
        self.session = Some(session);
        self.tell_refusal();
        if arrived {
            self.signals().taken_over().emit();
        }
        if out {
            self.reign = Reign::Away;
            self.signals().handed_over().emit();
        }
        for (side, position) in &footsteps {
            let foot = StringName::from(side.name());
            self.signals().footstep().emit(&foot, *position);
        }
        if !silent {
            self.tell_flight(flight, &footsteps);
        }
        if gait != self.told.gait && !silent {
            self.told.gait = gait;
            self.signals().gait_changed().emit(&name_of(gait));
        }
        let side = foothold.map(|(side, ..)| side);
        if side != self.told.landing {
            self.told.landing = side;
            if let Some((side, position, secs)) = foothold {
                let foot = StringName::from(side.name());
                self.signals()
                    .foothold_planned()
                    .emit(&foot, position, f64::from(secs));
            }
        }
    }
}
