//! One frame of feet on the ground.

use super::session::PlacementSession;
use super::{FootPlacement3D, RISE_SECS, generator_beside};
use crate::convert;
use footfall_core::Side;
use footfall_ik::placement::PlacementInput;
use godot::classes::{Engine, Skeleton3D};
use godot::prelude::*;

impl FootPlacement3D {
    /// One frame: the pose is read, put on the ground and written.
    pub(super) fn place(
        &mut self,
        mut session: PlacementSession,
        skeleton: Gd<Skeleton3D>,
        delta: f64,
    ) {
        let space = skeleton
            .get_world_3d()
            .and_then(|world| world.get_direct_space_state());
        let Some(space) = space else {
            self.session = Some(session);
            return;
        };
        let dt_secs = if delta.is_finite() {
            delta.max(0.0) as f32
        } else {
            0.0
        };
        let in_editor = Engine::singleton().is_editor_hint();
        let influence = self.base().get_influence().clamp(0.0, 1.0);
        let generator = generator_beside(&skeleton).filter(|generator| generator.is_active());
        let soars = generator.as_ref().is_some_and(|it| it.bind().soars());
        let airborne = self.in_air || soars;
        if self.follow_ground && !in_editor && !airborne && dt_secs > 0.0 {
            let share = influence * (1.0 - (-dt_secs / RISE_SECS).exp());
            let up = convert::frame(session.character.get_global_transform()).up();
            let rise = convert::vector3(up * (share * session.placer.ground_offset_m()));
            if rise != Vector3::ZERO {
                let place = session.character.get_global_position() + rise;
                session.character.set_global_position(place);
            }
        }
        let mut input = PlacementInput {
            world_from_floor: session.world_from_floor(),
            contacts: None,
            landings: [None; 2],
            airborne,
        };
        if let Some(mut generator) = generator {
            let mut generator = generator.bind_mut();
            if let Some((contacts, landings)) = generator.feet() {
                input.contacts = Some(contacts);
                input.landings = landings;
            }
            let slowed = if self.adapt_speed {
                1.0 - influence * (1.0 - session.placer.pace())
            } else {
                1.0
            };
            let is_steep = self.adapt_speed && influence > 0.0 && session.placer.is_steep();
            generator.slow_down(slowed, is_steep);
            generator.set_grade(influence * session.placer.way_grade());
            if session.placer.pace() < 1.0 {
                // On a grade its foothold has been chosen.
                generator.keep_step();
            }
            let mut ground = session.ground.now(space.clone());
            if !in_editor
                && self.adjust_footholds
                && let Some(share) = session.placer.step_share(&input, &mut ground)
            {
                generator.stretch_step(share);
                if let Some((_, landings)) = generator.feet() {
                    input.landings = landings;
                }
            }
        }
        if let Some((contacts, landings)) = self.fed.take() {
            input.contacts = Some(contacts);
            input.landings = landings;
        }
        session.placer.set_config(&self.config());
        session.binding.read_legs(&skeleton, &mut session.pose);
        let mut ground = session.ground.now(space);
        session
            .placer
            .step(dt_secs, &input, &mut ground, &mut session.pose);
        session.binding.write_legs(&skeleton, &session.pose);
        let feet = *session.placer.feet();
        self.session = Some(session);
        let host = skeleton.upcast::<Node>();
        self.marks.show(self.debug_draw, &host, &feet);
        if in_editor {
            return;
        }
        for (side, placed) in Side::BOTH.into_iter().zip(feet) {
            let foot = StringName::from(side.name());
            if placed.landed {
                let position = convert::vector3(placed.sole.position);
                let normal = convert::vector3(placed.sole.up());
                self.signals().foot_planted().emit(&foot, position, normal);
            } else if placed.left {
                self.signals().foot_lifted().emit(&foot);
            }
        }
    }
}
