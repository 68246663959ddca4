//! Cut of a step in its swing, from which its remainder continues.

use super::frame::PlantedFrame;
use super::lean::{Bend, Pull};
use super::look::Glance;
use super::planter_state::{Airborne, PlanterState};
use super::travel::TURN_ONSET;
use crate::plan::StepTiming;
use footfall_core::ease::smooth_step;
use footfall_core::{Joint, Side, Skeleton};
use footfall_ik::FootTarget;
use glam::Vec3;

/// Frame at which a step is cut, and the data with which the step was planted.
pub(crate) struct Cut<'a> {
    pub(crate) skeleton: &'a Skeleton,
    pub(crate) frame_secs: f32,
    pub(crate) timing: &'a StepTiming,
    pub(crate) frames: &'a [PlantedFrame],
    pub(crate) frame: usize,
    /// State at the beginning of the step, state with which the next one would begin, and turn rate at the end.
    pub(crate) begun: &'a PlanterState,
    pub(crate) ended: PlanterState,
    pub(crate) turn_rate: f32,
    pub(crate) pull: Pull,
}

impl Cut<'_> {
    /// Returns true when one foot stands and the other is in the air, in this frame and in the previous one. A runner's foot has to stand for `bearing_frames` more: it
    /// leaves before its time where its leg does not reach.
    pub(crate) fn is_in_swing(&self, bearing_frames: usize) -> bool {
        let (standing, swinging) = (self.timing.leading, self.timing.leading.other());
        let ahead = self.timing.take_off.map_or(0, |_| bearing_frames);
        let contact = |side: Side| move |frame: &PlantedFrame| frame.contact[side.index()];
        self.frame > 0
            && self
                .frames
                .get(self.frame - 1..=self.frame + ahead)
                .is_some_and(|frames| {
                    frames.iter().all(contact(standing))
                        && !frames[..2].iter().any(contact(swinging))
                })
    }

    /// Returns the state for a step that begins here, with one foot in the air.
    pub(crate) fn state(&self) -> PlanterState {
        let [before, now] = [self.frame - 1, self.frame].map(|frame| &self.frames[frame]);
        let step_secs = self.timing.frames as f32 * self.frame_secs;
        let bend = Bend::new(self.begun.lean, &self.pull, step_secs);
        let leg_length = self.skeleton.mean_leg_length();
        // Where the hips would have been so many frames ago, had they not sunk.
        let hips = |ago: usize| {
            let frame = self.frame - ago;
            let depth = bend.at(frame as f32 / self.timing.frames as f32).depth();
            self.frames[frame].pose.root_position + leg_length * depth * Vec3::Y
        };
        let s = self.frame as f32 / self.timing.frames as f32;
        let share = smooth_step(s);
        // The leg of a runner accelerates the hips so much that half a frame counts.
        let way = if self.timing.take_off.is_some() && self.frame > 1 {
            1.5 * hips(0) - 2.0 * hips(1) + 0.5 * hips(2)
        } else {
            hips(0) - hips(1)
        };
        let swinging = self.timing.leading.other();
        let strides = [self.begun.stride, self.ended.stride];
        PlanterState {
            plants: self.begun.plants,
            hips: hips(0),
            hips_velocity: Some(way / self.frame_secs),
            heading: now.heading,
            turn_rate: self.begun.turn_rate
                + smooth_step(s / TURN_ONSET) * (self.turn_rate - self.begun.turn_rate),
            ground_position: now.ground_position,
            ground_velocity: Some((now.ground_position - before.ground_position) / self.frame_secs),
            stride: self.begun.stride + share * (self.ended.stride - self.begun.stride),
            spread: self.begun.spread + share * (self.ended.spread - self.begun.spread),
            strafe: self.begun.strafe.between(&self.ended.strafe, strides, s),
            balance: self.begun.balance.lerp(self.ended.balance, share),
            lean: bend.at(s),
            look: Glance::new(self.begun.look, &self.ended).at(self.frame as f32 * self.frame_secs),
            airborne: Some(Airborne {
                now: self.foot(now, swinging),
                before: self.foot(before, swinging),
                frame_secs: self.frame_secs,
            }),
        }
    }

    /// Place of a pose's foot.
    fn foot(&self, frame: &PlantedFrame, side: Side) -> FootTarget {
        let pose = &frame.pose;
        let (mut place, mut rotation) = (pose.root_position, pose.rotation(Joint::Hips));
        for joint in [side.upper_leg(), side.lower_leg(), side.foot()] {
            place += rotation * self.skeleton.offset(joint);
            rotation *= pose.rotation(joint);
        }
        FootTarget {
            ankle: place,
            foot: rotation,
            toes: rotation * pose.rotation(side.toes()),
        }
    }
}
