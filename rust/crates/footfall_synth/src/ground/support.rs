//! Support: stances of the bearing feet, and the height of the hips that their legs allow.

use super::frame::PlantedFrame;
use super::generated::{GeneratedFrame, GeneratedLeg, free_foot};
use super::planter::Planter;
use crate::plan::StepTiming;
use footfall_core::Side;
use footfall_core::ease::soft_min;
use footfall_core::lanes::{LANES, f32x8};
use footfall_core::rotation::from_heading;
use footfall_ik::reach_height;
use glam::Vec3;

/// Fraction of the straight leg that a standing leg uses at most before the pelvis drops.
pub(super) const MAX_STANCE_EXTENSION: f32 = 0.998;

/// Fraction of the straight leg beyond which a leaving foot is not held: its knee would snap straight.
pub(super) const LET_GO_EXTENSION: f32 = 0.998;

/// Distance over which the pelvis yields to that limit, metres.
const REACH_SOFTNESS_M: f32 = 0.003;

/// Time over which a leaving leg's reach ceases to limit the pelvis, seconds.
const REACH_FADE_SECS: f32 = 0.07;

/// Time constant with which the pelvis comes up again when such a leg lets go, seconds.
const REACH_RELEASE_SECS: f32 = 0.05;

/// Distance between the generated ankle and the standing foot's beyond which the foot leaves the ground, as a
/// share of the leg's length.
const RELEASE_SHARE: f32 = 0.03;

/// Shares of the straight leg beyond which a leaving foot is released in steps forwards, whose heels rise, and in steps backwards, whose leaving leg is ahead and would draw the hips down; and the
/// likeness to a walk backwards from which on it is the second.
const LEAVING_EXTENSION: [f32; 2] = [1.1, 0.985];
const LEAVES_BACKWARDS: f32 = 0.67;

/// Share of the leg's length by which a foot is ahead of its hip while its heel bears, toes up, and the greatest pitch by which they are up there, radians. Behind the hip no heel bears: such
/// a foot lies flat, and its heel can rise.
const HEEL_BEARS_AHEAD: f32 = 0.1;
const TOES_UP: f32 = 0.5;

/// Pitch of a flat foot that has not passed its heel yet, radians: its heel is not to rise.
const FLAT: f32 = -f32::EPSILON;

impl Planter {
    /// Fills the targets of both feet in their stances: on the plant, under its heading, at the generated pitch.
    pub(super) fn fill_stances(&self, generated: &mut [GeneratedFrame], timing: &StepTiming) {
        let trailing = timing.leading.other();
        let stances = [
            (timing.leading, Some(timing.frames)),
            (trailing, (!timing.airborne).then_some(timing.terminal)),
        ];
        for (side, last) in stances {
            let Some(last) = last else { continue };
            let ahead_m = HEEL_BEARS_AHEAD * self.leg_lengths[side.index()];
            leave_heel(&mut generated[..=last], side, ahead_m);
            pass_flat(&mut generated[..=last], side);
            self.stand(side, &mut generated[..=last], |leg| Some(leg.pitch));
        }
    }

    /// Puts a foot on its plant, under the plant's heading, in the frames for which `pitch` returns a pitch.
    pub(super) fn stand(
        &self,
        side: Side,
        generated: &mut [GeneratedFrame],
        pitch: impl Fn(&GeneratedLeg) -> Option<f32>,
    ) {
        let plant = self.plant(side);
        let level = from_heading(plant.heading);
        for frames in generated.chunks_mut(LANES) {
            let mut pitches = [None; LANES];
            for (lane, frame) in pitches.iter_mut().zip(&*frames) {
                *lane = pitch(&frame.legs[side.index()]);
            }
            let Some(any) = pitches.iter().find_map(|pitch| *pitch) else {
                continue;
            };
            let lanes = f32x8::new(pitches.map(|pitch| pitch.unwrap_or(any)));
            let stances = self.feet[side.index()].stand_many(plant, level, lanes);
            let stances = stances.lanes().into_iter().zip(pitches);
            for (frame, (stance, pitch)) in frames.iter_mut().zip(stances) {
                if pitch.is_some() {
                    frame.legs[side.index()].target = stance;
                }
            }
        }
    }

    /// Returns the last frame up to `timing.terminal` in which the trailing foot can stay in place.
    pub(super) fn release(
        &self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        frames: &[PlantedFrame],
    ) -> usize {
        let trailing = timing.leading.other();
        let length = self.leg_lengths[trailing.index()];
        let allowance = RELEASE_SHARE * length;
        let [forwards, backwards] = LEAVING_EXTENSION;
        let share = (self.state.strafe.backwardness() / LEAVES_BACKWARDS).min(1.0);
        let reach = length * (forwards + share * (backwards - forwards));
        (2..=timing.terminal)
            .find(|index| {
                let frame = &frames[*index];
                let free = free_foot(
                    &generated[*index],
                    trailing,
                    frame.pose.root_position,
                    frame.level,
                );
                let leg = &generated[*index].legs[trailing.index()];
                let ankle = leg.target.ankle;
                let hip = frame.pose.root_position + frame.level * leg.hip;
                free.ankle.distance(ankle) > allowance || hip.distance(ankle) > reach
            })
            .map_or(timing.terminal, |beyond| beyond - 1)
    }

    /// Fills the contacts, and lowers the hips, softly, to where every standing leg reaches its ankle.
    pub(super) fn bear(
        &self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        frames: &mut [PlantedFrame],
    ) {
        let fade_frames = REACH_FADE_SECS / self.frame_secs;
        let landing = Landing::of(generated, timing, frames);
        let trailing = timing.leading.other();
        let release = (-self.frame_secs / REACH_RELEASE_SECS).exp();
        let mut drop = 0.0_f32;
        for (index, (frame, generated)) in frames.iter_mut().zip(generated).enumerate() {
            let hips = frame.pose.root_position;
            let bears = timing.trailing_bears(index);
            frame.contact[timing.leading.index()] = timing.leading_bears(index);
            frame.contact[trailing.index()] = bears || index == timing.frames;
            // A leg releases the pelvis smoothly, even if its contact is almost over as the step begins.
            drop *= release;
            if bears && let Some(limit) = self.reach_limit(trailing, hips, generated, frame) {
                let fade = if index == 0 {
                    0.0
                } else {
                    let onset = index as f32 / timing.terminal as f32;
                    let remaining = (timing.terminal - index) as f32;
                    onset * (1.0 - remaining / fade_frames).max(0.0)
                };
                let length = self.leg_lengths[trailing.index()];
                let yielding =
                    soft_min(hips.y, limit + 0.1 * length * fade * fade, REACH_SOFTNESS_M);
                drop = drop.max(hips.y - yielding);
            }
            frame.pose.root_position.y -= drop;
            if timing.leading_bears(index)
                && let Some(limit) = self.reach_limit(timing.leading, hips, generated, frame)
            {
                let height = &mut frame.pose.root_position.y;
                *height = soft_min(*height, limit, REACH_SOFTNESS_M);
            }
            if !bears && timing.rests {
                self.settle(landing, index, timing, frame);
            }
        }
    }

    /// Returns the greatest height of the hips at which this leg reaches its foot; `None` when the foot is out of reach sideways at any
    /// height: then the solver stretches the leg, and the pelvis keeps a human height.
    pub(super) fn reach_limit(
        &self,
        side: Side,
        hips: Vec3,
        generated: &GeneratedFrame,
        frame: &PlantedFrame,
    ) -> Option<f32> {
        let leg = &generated.legs[side.index()];
        let length = self.leg_lengths[side.index()];
        let hip = frame.level * leg.hip;
        reach_height(hips, hip, leg.target.ankle, length, MAX_STANCE_EXTENSION)
    }

    /// Lowers the hips to where the landing leg will have them once it bears with the other.
    fn settle(
        &self,
        landing: Landing,
        index: usize,
        timing: &StepTiming,
        frame: &mut PlantedFrame,
    ) {
        let length = self.leg_lengths[timing.leading.other().index()];
        let Landing { hips, hip, ankle } = landing;
        let Some(limit) = reach_height(hips, hip, ankle, length, MAX_STANCE_EXTENSION) else {
            return;
        };
        let swing = (timing.frames - timing.terminal) as f32;
        let remaining = (timing.frames - index) as f32 / swing;
        let height = &mut frame.pose.root_position.y;
        *height = soft_min(
            *height,
            limit + 0.1 * length * remaining * remaining,
            REACH_SOFTNESS_M,
        );
    }

    /// Ends the trailing foot's contact where its leg, stretched, does not reach any more; returns its last frame.
    pub(super) fn let_go(
        &self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        frames: &mut [PlantedFrame],
    ) -> usize {
        let trailing = timing.leading.other();
        let reach = LET_GO_EXTENSION * self.leg_lengths[trailing.index()];
        let beyond = (1..=timing.terminal).find(|index| {
            let frame = &frames[*index];
            let leg = &generated[*index].legs[trailing.index()];
            let hip = frame.level * leg.hip;
            let ankle = leg.target.ankle;
            (frame.pose.root_position + hip).distance(ankle) > reach
        });
        let Some(beyond) = beyond else {
            return timing.terminal;
        };
        for frame in &mut frames[beyond..=timing.terminal] {
            frame.contact[trailing.index()] = false;
        }
        beyond - 1
    }
}

/// Landing of a leg at the end of a step.
#[derive(Clone, Copy)]
struct Landing {
    hips: Vec3,
    /// The hip joint, from the hips.
    hip: Vec3,
    ankle: Vec3,
}

impl Landing {
    fn of(generated: &[GeneratedFrame], timing: &StepTiming, frames: &[PlantedFrame]) -> Self {
        let (generated, frame) = (&generated[timing.frames], &frames[timing.frames]);
        let side = timing.leading.other();
        let hips = frame.pose.root_position;
        Self {
            hips,
            hip: frame.level * generated.legs[side.index()].hip,
            ankle: free_foot(generated, side, hips, frame.level).ankle,
        }
    }
}

/// Lays a standing foot flat by the time at which its hip has passed over it. In the first flat frame its heel does not rise yet.
fn leave_heel(generated: &mut [GeneratedFrame], side: Side, ahead_m: f32) {
    let mut before = 0.0;
    for frame in generated {
        let leg = &mut frame.legs[side.index()];
        let ahead = ((leg.ankle.z - leg.hip.z) / ahead_m).max(0.0);
        if ahead < 1.0 {
            leg.pitch = leg.pitch.max(-TOES_UP * ahead);
        }
        if before < FLAT && leg.pitch == 0.0 {
            leg.pitch = FLAT;
        }
        before = leg.pitch;
    }
}

/// Lays a standing foot flat in the frame in which it passes from heel to ball, or back: it would slide between the two pivots. The first and the last frame belong to
/// other steps, too.
fn pass_flat(generated: &mut [GeneratedFrame], side: Side) {
    let side = side.index();
    let last = generated.len() - 1;
    for index in 1..=last {
        let [before, now] = [index - 1, index].map(|at| generated[at].legs[side].pitch);
        // A heel that need not rise may, if its leg lacks reach.
        if before * now < 0.0 || before == 0.0 && now < FLAT {
            let nearer = if before.abs() < now.abs() {
                index - 1
            } else {
                index
            };
            generated[nearer.clamp(1, (last - 1).max(1))].legs[side].pitch = FLAT;
        }
    }
}
