//! Pose at the current time: between two planted frames, with all motion above the steps.

use super::GaitGenerator;
use crate::config::MAX_DT_SECS;
use crate::controls::Controls;
use crate::ground::PlantedFrame;
use footfall_core::rotation::{blend_near, from_heading};
use footfall_core::{GroundTransform, Joint, Pose};
use glam::Quat;

/// Share of a frame within which a time counts as on the frame: time adds up with rounding.
const SAME_FRAME: f32 = 1e-2;

impl GaitGenerator {
    /// Writes the current pose, with all motion above the steps; `dt_secs` have passed.
    pub(crate) fn show(&mut self, dt_secs: f32, controls: &Controls, out: &mut Pose) {
        let between = self.frames();
        let plan_from_character = ground_between(between);
        let (frame, next, weight) = between;
        let (facing, _) = blend_near(frame.plan_from_ground, next.plan_from_ground, weight);
        let character_from_plan = facing.conjugate();
        // Between two frames a foot stands only if it does in both.
        let contact = core::array::from_fn(|side| {
            (frame.contact[side] || weight > 1.0 - SAME_FRAME)
                && (next.contact[side] || weight < SAME_FRAME)
        });
        frame.pose.interpolate_near(&next.pose, weight, out);
        out.root_position =
            character_from_plan * (out.root_position - plan_from_character.position);
        let root = Joint::Hips.index();
        out.rotations[root] = (character_from_plan * out.rotations[root]).normalize();
        self.live(dt_secs, out);
        self.contact = contact;
        self.pass_moves(dt_secs.clamp(0.0, MAX_DT_SECS), controls);
        self.start_from_character = self.plan_from_start.local(&plan_from_character);
        if let Some(flown) = self.moves.as_ref().and_then(|moves| moves.move_pose(out)) {
            let faced = from_heading(self.start_from_character.heading);
            self.start_from_character.position += faced * flown.place;
            self.contact = contact.map(|bears| bears && flown.bears);
        }
    }

    /// Adds the motion of a walker that stands, or has just begun to walk.
    fn live(&mut self, dt_secs: f32, out: &mut Pose) {
        let stands = self.is_standing();
        let Some(life) = &mut self.life else { return };
        if dt_secs > 0.0 {
            life.step(dt_secs.min(MAX_DT_SECS), stands);
        }
        if !life.is_still() {
            life.move_pose(&life.moment, Quat::IDENTITY, out);
        }
    }

    /// Updates the character's place without advancing time.
    pub(crate) fn tell_place(&mut self) {
        self.footsteps.clear();
        self.start_from_character = self.plan_from_start.local(&self.plan_from_character());
    }

    /// Returns the frames before and after the current time, and the weight of the later one.
    fn frames(&self) -> (&PlantedFrame, &PlantedFrame, f32) {
        let frames = &self.steps.source().planted().frames;
        let step = self.shape();
        let last = step.ground_frames() - 1;
        let position = self.position / step.detail.stride() as f32;
        // A cast rounds towards zero, and a position is not below it.
        let first = (position as usize).min(last);
        let weight = position - first as f32;
        (&frames[first], &frames[first + 1], weight)
    }

    pub(crate) fn plan_from_character(&self) -> GroundTransform {
        ground_between(self.frames())
    }
}

/// Returns the place of the walker between two frames, with the weight of the later one.
fn ground_between((frame, next, weight): (&PlantedFrame, &PlantedFrame, f32)) -> GroundTransform {
    GroundTransform {
        position: frame.ground_position.lerp(next.ground_position, weight),
        heading: frame.ground_heading + weight * (next.ground_heading - frame.ground_heading),
    }
}
