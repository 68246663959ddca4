//! Braked travel: the way of the hips in a step in which a runner slows down.
//!
//! Generated legs carry the hips as far as in an even step of this pace. Hips that come in faster would have to fall below the speed of the step to end there,
//! and those of a quick step of a run would leave it as fast as they came. People brake evenly over such a step, so that its way is that of the mean of both speeds.

use super::course::Course;
use super::frame::PlantedFrame;
use super::planter::Planter;
use crate::plan::StepTiming;
use core::f32::consts::FRAC_PI_2;
use footfall_core::ease::smooth_step;
use glam::Vec3;

/// Speeds of the hips from which the way changes, and from which it changes fully, m/s: those of runs.
const RUNS_MPS: [f32; 2] = [1.6, 2.2];

/// Loss of speed from which the way changes fully, m/s.
const LOSS_MPS: f32 = 0.6;

/// Turn rate at which the way is as generated, rad/s: hips go round a foot.
const TURNS_RADPS: f32 = FRAC_PI_2;

/// Largest change of the way, as a share of the leg's length.
const MOST: f32 = 0.22;

impl Planter {
    /// Lengthens or shortens the way of hips that brake from a run, towards the end of the step. A step that ends a walk brings the hips above the feet as ever.
    pub(super) fn brake(&self, timing: &StepTiming, course: Course, out: &mut [PlantedFrame]) {
        let Some(velocity) = self.state.hips_velocity.filter(|_| !timing.rests) else {
            return;
        };
        let way = (out[timing.frames].pose.root_position - out[0].pose.root_position)
            * Vec3::new(1.0, 0.0, 1.0);
        let along = way.normalize_or_zero();
        let (begins, ends) = (along.dot(velocity), course.change.speed_mps);
        let runs = smooth_step((begins - RUNS_MPS[0]) / (RUNS_MPS[1] - RUNS_MPS[0]));
        let brakes = smooth_step((begins - ends) / LOSS_MPS);
        let straight = 1.0 - smooth_step(course.turn_rate.abs() / TURNS_RADPS);
        let share = course.change.weight * runs * brakes * straight;
        if share <= 0.0 {
            return;
        }
        let secs = timing.frames as f32 * self.frame_secs;
        let most = MOST * self.leg_lengths[timing.leading.index()];
        let lacks = 0.5 * (begins + ends) * secs - along.dot(way);
        let moved = along * (share * lacks.clamp(-most, most));
        for (index, frame) in out[..=timing.frames].iter_mut().enumerate() {
            frame.pose.root_position += moved * smooth_step(index as f32 / timing.frames as f32);
        }
    }
}
