//! One frame of the walk.

use super::GaitGenerator3D;
use super::session::Session;
use crate::skeleton_binding::SkeletonBinding;
use footfall_synth::{Controls, GeneratorConfig};
use godot::classes::{Engine, Skeleton3D};
use godot::prelude::*;

impl GaitGenerator3D {
    /// The walk under way, or a new one where there is none, the model was replaced or the body changed.
    pub(super) fn take_session(&mut self, skeleton: &Gd<Skeleton3D>) -> Result<Session, String> {
        let source = self.take_source()?;
        if let Some(session) = self.session.take()
            && session.is_for(&source, skeleton)
        {
            return Ok(session);
        }
        let (character, binding) = self.bind(skeleton)?;
        let config = self.config();
        self.redraw_way();
        let weights = self.style_weights.as_slice();
        Session::new(
            &source,
            weights,
            character,
            binding,
            &config,
            self.controls(),
        )
    }

    /// Which walk of the model's it is.
    pub(super) fn config(&self) -> GeneratorConfig {
        GeneratorConfig {
            seed: self.seed.cast_unsigned(),
            phase: self.phase.rem_euclid(1.0) as f32,
            variation: self.variation as f32,
        }
    }

    pub(super) fn controls(&self) -> Controls {
        Controls {
            speed_mps: self.speed as f32 * self.slowed,
            turn_rate_radps: self.turn_rate as f32,
            direction_rad: self.direction as f32,
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

    /// One frame: time passes, the character travels, bones are posed, footsteps are told.
    pub(super) fn walk(&mut self, mut session: Session, mut skeleton: Gd<Skeleton3D>, delta: f64) {
        self.reported = None;
        let in_editor = Engine::singleton().is_editor_hint();
        let holds = if in_editor {
            self.is_preview_paused()
        } else {
            !self.playing
        };
        let dt_secs = if holds { 0.0 } else { delta.max(0.0) };
        let travels = self.root_motion && !in_editor;
        session
            .generator
            .set_style_weights(self.style_weights.as_slice());
        session.generator.set_detail(self.detail.into());
        if let Some(state) = self.pending_state.take()
            && let Err(problem) = session.restore(state.as_slice())
        {
            let node = self.base().get_path();
            godot_warn!("{node}: the state is refused: {problem}");
        }
        if let Some(secs) = self.pending_seek.take() {
            session.skip(secs, self.controls());
        }
        let travel = session.advance(dt_secs, self.controls());
        self.root_motion_delta = session.traveller.local_delta(&travel);
        {
            // Scripts may answer to what happens here and come back to this node: no borrow may be held.
            let _released = self.base_mut();
            if travels {
                session.traveller.move_character(&travel);
            }
            session.write(&mut skeleton);
        }
        let footsteps = if in_editor {
            Vec::new()
        } else {
            session.footsteps(&travel)
        };
        let foothold = session.next_foothold(&travel).filter(|_| !in_editor);
        self.session = Some(session);
        for (side, position) in footsteps {
            let foot = StringName::from(side.name());
            self.signals().footstep().emit(&foot, position);
        }
        let side = foothold.map(|(side, ..)| side);
        if side != self.announced {
            self.announced = side;
            if let Some((side, position, secs)) = foothold {
                let foot = StringName::from(side.name());
                self.signals()
                    .foothold_planned()
                    .emit(&foot, position, f64::from(secs));
            }
        }
    }
}
