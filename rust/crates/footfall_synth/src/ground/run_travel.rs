//! Travel in a run: the speed of the hips over the ground, from landing to landing.
//!
//! Hips that follow the generated leg over a fixed foot sway by half a metre a second, gain speed where runners brake, and carry the final velocity
//! into the flight, so that every step flies off in another direction. A runner's hips follow the direction of the run: they sway a little towards the
//! bearing foot, are braked as it lands and accelerated as it leaves (Cavagna et al., The sources of external work in level walking and running, 1976).

use super::bounce::Push;
use super::course::Course;
use super::frame::PlantedFrame;
use super::planter::Planter;
use crate::plan::StepTiming;
use core::f32::consts::TAU;
use footfall_core::Side;
use footfall_core::ease::hermite;
use footfall_core::rotation::from_heading;
use glam::Vec3;

/// Speed of the hips towards the foot that lands, and away from it as it takes off, m/s: 0.05 to 0.15 in the runs of O3DE's actor and of CMU 9 and 35.
const SWAY_MPS: f32 = 0.07;

/// Loss of speed at a quarter of the step, and gain at three quarters, as a share of the mean: 0.03 in the actor's runs, 0.09 in the others'.
const BRAKING: f32 = 0.06;

impl Planter {
    /// Moves the hips along the direction of the run, from flight to flight, and evenly aside in its first stance. The effect of a [change of speed](super::SpeedChange) along it is kept.
    pub(super) fn thrust(&self, timing: &StepTiming, course: Course, out: &mut [PlantedFrame]) {
        let (Some(take_off), Some(direction)) = (timing.take_off, course.direction) else {
            return;
        };
        let Some(velocity) = self.state.hips_velocity else {
            return;
        };
        let flight = &out[usize::midpoint(take_off, timing.frames)];
        let along = from_heading(flight.ground_heading + direction) * Vec3::Z;
        let left = Vec3::new(along.z, 0.0, -along.x);
        if !self.runs_on(timing) {
            if !self.leaps(timing) {
                straighten(left, velocity * self.frame_secs, &mut out[..=take_off + 1]);
            }
            return;
        }
        let begin = out[0].pose.root_position;
        let way = along.dot(out[timing.frames].pose.root_position - begin);
        let frames = timing.frames as f32;
        let pace = way / frames;
        let towards = match timing.leading {
            Side::Left => SWAY_MPS,
            Side::Right => -SWAY_MPS,
        };
        let borne = timing.borne as f32;
        let whole = borne + frames;
        let phase = |time: f32| TAU * (borne + time) / whole;
        let before = velocity.with_y(0.0) * self.frame_secs;
        let after = along * pace - left * (towards * self.frame_secs);
        let stance = Stance {
            before: before + along * (BRAKING * pace * phase(0.0).sin()),
            after,
            push: Push {
                borne,
                left: take_off as f32,
                early: 0.0,
            },
        };
        let kept = course.change.weight;
        let cycle = way * (whole / frames);
        for (index, frame) in out.iter_mut().enumerate() {
            let time = index as f32;
            let braked = BRAKING * cycle / TAU * (phase(time).cos() - phase(0.0).cos());
            let hips = &mut frame.pose.root_position;
            let moved = begin + stance.way(time) + along * braked - *hips;
            *hips += left * left.dot(moved) + along * ((1.0 - kept) * along.dot(moved));
        }
    }
}

/// Moves the hips in the first stance of a run aside, on a cubic from their velocity to that of the flight, metres per frame, and from place to place. Hips
/// that settle onto the path above a foot that has landed in a sharp turn are thrown aside within three frames. `stance` ends with the first frame of the flight.
fn straighten(left: Vec3, velocity: Vec3, stance: &mut [PlantedFrame]) {
    let frames = stance.len() - 2;
    let aside = |frame: usize| left.dot(stance[frame].pose.root_position);
    let (from, to) = (aside(0), aside(frames));
    let ends = [left.dot(velocity), aside(frames + 1) - to].map(|pace| pace * frames as f32);
    for (index, frame) in stance[..frames].iter_mut().enumerate() {
        let hips = &mut frame.pose.root_position;
        let s = index as f32 / frames as f32;
        *hips += left * (hermite(from, ends[0], to, ends[1], s) - left.dot(*hips));
    }
}

/// Travel of a body pushed by its leg with half a sine wave, and then in flight, in frames.
struct Stance {
    /// Velocities at the beginning and the end of the stance, metres per frame.
    before: Vec3,
    after: Vec3,
    push: Push,
}

impl Stance {
    fn way(&self, time: f32) -> Vec3 {
        let bears = time.min(self.push.left);
        self.before * bears
            + (self.after - self.before) * self.push.displacement(bears)
            + self.after * (time - bears)
    }
}
