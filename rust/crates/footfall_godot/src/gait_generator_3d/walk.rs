//! One frame of the walk.

use super::GaitGenerator3D;
use super::gait_choice::name_of;
use super::moves::Flight;
use super::ownership::Ownership;
use super::session::WalkSession;
use crate::gait_model::NO_STYLES;
use crate::modifier::BodyModifier;
use crate::root_motion::frame_clock;
use footfall_synth::GeneratorConfig;
use godot::classes::{BoneMap, Engine, Skeleton3D};
use godot::prelude::*;

impl BodyModifier for GaitGenerator3D {
    type Session = WalkSession;

    fn character_path(&self) -> &NodePath {
        &self.character
    }

    fn bone_map_for(&self, _skeleton: &Gd<Skeleton3D>) -> Option<Gd<BoneMap>> {
        self.bone_map.clone()
    }

    fn last_problem(&mut self) -> &mut Option<String> {
        &mut self.announced.problem
    }

    fn take_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<WalkSession, String> {
        if let Some(problem) = self.rivalry(skeleton) {
            return Err(problem);
        }
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

    fn advance(&mut self, session: WalkSession, skeleton: Gd<Skeleton3D>, delta: f64) {
        self.walk(session, skeleton, delta);
    }

    fn interrupt(&mut self) {
        self.put_aside();
    }

    fn problems(&self) -> PackedStringArray {
        self.find_problems()
    }
}

impl GaitGenerator3D {
    /// A walk that begins where the character stands.
    pub(super) fn new_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<WalkSession, String> {
        let source = self.take_source()?;
        let (character, binding) = self.bind(skeleton)?;
        if self.passes_over_styles() {
            self.warn(NO_STYLES);
        }
        let config = self.config();
        self.redraw_way();
        let weights = self.style_weights.as_slice();
        let mut session = WalkSession::new(
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

    /// One frame: time passes, the character travels, bones are posed, footsteps are emitted.
    fn walk(&mut self, mut session: WalkSession, mut skeleton: Gd<Skeleton3D>, delta: f64) {
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
        self.advance_replica(&mut session, dt_secs);
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
        if self.ownership == Ownership::Away {
            self.rest(session);
            return;
        }
        let jumped = session.generator.jump_phase();
        let (travel, arrived, out) = if self.ownership == Ownership::Leaving {
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
        let silent = in_editor || self.ownership == Ownership::Leaving;
        let footsteps = if silent {
            Vec::new()
        } else {
            session.footsteps(&travel)
        };
        let foothold = session.next_foothold(&travel).filter(|_| !silent);
        let gait = session.generator.gait();
        let flight = Flight::between(jumped, session.generator.jump_phase());
        self.session = Some(session);
        self.emit_refusal();
        if arrived {
            self.signals().taken_over().emit();
        }
        if out {
            self.ownership = Ownership::Away;
            self.signals().handed_over().emit();
        }
        for (side, position) in &footsteps {
            let foot = StringName::from(side.name());
            self.signals().footstep().emit(&foot, *position);
        }
        if !silent {
            self.emit_flight(flight, &footsteps);
        }
        if gait != self.announced.gait && !silent {
            self.announced.gait = gait;
            self.signals().gait_changed().emit(&name_of(gait));
        }
        let side = foothold.map(|(side, ..)| side);
        if side != self.announced.landing {
            self.announced.landing = side;
            if let Some((side, position, secs)) = foothold {
                let foot = StringName::from(side.name());
                self.signals()
                    .foothold_planned()
                    .emit(&foot, position, f64::from(secs));
            }
        }
    }
}
