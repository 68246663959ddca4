//! Recording of shared steps, without chance.

use super::frames::CrowdPose;
use super::own::OwnWalk;
use super::workshop::Workshop;
use crate::footstep::Footstep;
use crate::ground::PlantedFrame;
use crate::plan::Planner;
use crate::standing::Life;
use footfall_core::GroundTransform;

impl OwnWalk {
    /// Takes only mean steps from now on.
    pub(super) fn take_mean_steps(&mut self) {
        self.even = true;
        for draw in &mut self.ending.draws {
            *draw = Planner::mean_draw(draw.side);
        }
    }

    /// Stands for this long, at the end of its step.
    pub(super) fn rest_for(&mut self, secs: f32, workshop: &mut Workshop) {
        self.position = self.shape.timing.frames as f32;
        self.live(secs, workshop);
    }

    /// Returns the pose in which it stands still, and its standing motion.
    pub(super) fn still(&self) -> Option<(PlantedFrame, Life)> {
        let still = self.rest.as_ref()?.still.clone();
        Some((still, self.life.clone()?))
    }

    /// Returns the duration of its step, seconds.
    pub(super) fn step_secs(&self) -> f32 {
        self.shape.timing.frames as f32 / self.frame_rate_hz
    }

    /// Writes the pose this many frames after the step began.
    pub(super) fn pose_at(&self, position: f32, out: &mut CrowdPose) {
        let (frame, weight) = self.frame_at(position);
        self.frames.blend(frame, weight, out);
    }

    /// Returns the initial contact of the step, relative to a place of the plan.
    pub(super) fn landing_from(&self, place: &GroundTransform) -> Option<Footstep> {
        let side = self.shape.timing.leading;
        let landing = self.landing_of_step()?;
        Some(Footstep::seen_from(place, side, &landing))
    }
}
