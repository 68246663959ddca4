//! Aim: steps end where another walker's do.

use super::StepWindow;
use crate::footstep::Footstep;
use crate::ground::{Displacement, PlantedStep};
use crate::plan::StepShape;
use crate::source::buffers::StepBuffers;
use footfall_core::GroundTransform;
use footfall_core::rotation::{from_heading, wrap_angle};
use glam::Vec3;

/// Tolerance of the end of a step, metres and radians.
const SAME_PLACE_M: f32 = 0.002;
const SAME_HEADING_RAD: f32 = 0.004;

/// Largest displacement and turn by one step, metres and radians; a leap is longer.
const MOST_DISPLACEMENT_M: f32 = 0.2;
const MOST_LEAP_DISPLACEMENT_M: f32 = 0.6;
const MOST_TURN_RAD: f32 = 0.35;

/// Maximum number of trials: a turn and displaced hips both move the end of a step.
const TRIALS: usize = 3;

/// Bounds of the movement of a step's end per metre of displacement: in fast steps the leg swings farther, too.
const GAINS: [f32; 2] = [1.0, 4.0];

/// Aim of a step, relative to the start of the walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// Place of the landing foot, or of the resting walker, under the walker's heading.
    pub(crate) place: GroundTransform,
    pub(crate) rests: bool,
}

impl Aim {
    /// Returns the displacement from the end of a step to the aim.
    pub(crate) fn off(&self, leads: &GroundTransform) -> Displacement {
        Displacement {
            way: (self.place.position - leads.position).with_y(0.0),
            turn: wrap_angle(self.place.heading - leads.heading),
        }
    }
}

impl PlantedStep {
    /// Returns the place where the step ends, relative to the start of the walk: that of the landing foot, under the walker's heading, or that of a
    /// resting walker.
    pub(crate) fn aim(
        &self,
        plan_from_start: &GroundTransform,
        shape: &StepShape,
        rests: bool,
    ) -> GroundTransform {
        let frame = &self.frames[shape.ground_frames()];
        let end = plan_from_start.local(&GroundTransform {
            position: frame.ground_position,
            heading: frame.ground_heading,
        });
        let landing = shape.timing.leading.other();
        match self.plant(landing).filter(|_| !rests) {
            Some(plant) => GroundTransform {
                position: Footstep::seen_from(plan_from_start, landing, plant).position,
                ..end
            },
            None => end,
        }
    }
}

impl StepWindow {
    /// Displaces the current step, which has just been planned, towards its aim, as far as one step can.
    pub(crate) fn aim_at(
        &mut self,
        aim: &Aim,
        plan_from_start: &GroundTransform,
        buffers: &mut StepBuffers,
    ) {
        let rotation = from_heading(plan_from_start.heading);
        let most_m = if self.origin.request.leap_m.is_some() {
            MOST_LEAP_DISPLACEMENT_M
        } else {
            MOST_DISPLACEMENT_M
        };
        let mut trial: Option<Trial> = None;
        for _ in 0..TRIALS {
            let leads = self.planted().aim(plan_from_start, self.step(), aim.rests);
            let off = aim.off(&leads);
            let most = off.within(most_m, MOST_TURN_RAD);
            let next = match trial {
                None => Trial {
                    off: most.way,
                    led: most.way,
                    beyond: off.way - most.way,
                },
                Some(last) => last.next(off.way),
            };
            // The first trial already turns the body.
            let turn = if trial.is_none() { most.turn } else { 0.0 };
            let near = next.off.length() < SAME_PLACE_M && turn.abs() < SAME_HEADING_RAD;
            let more = Displacement {
                way: rotation * next.led,
                turn,
            };
            trial = Some(next);
            if near || !self.displace(more, buffers) {
                return;
            }
        }
    }
}

/// One trial of a displacement.
#[derive(Clone, Copy)]
struct Trial {
    /// Way to the aim, as far as one step can go.
    off: Vec3,
    /// Displacement of the hips.
    led: Vec3,
    /// Remaining way, left to later steps.
    beyond: Vec3,
}

impl Trial {
    /// Returns the next trial, given the way that is left.
    fn next(self, off: Vec3) -> Self {
        let off = off - self.beyond;
        Self {
            off,
            led: off / gain(self.led, self.off - off),
            beyond: self.beyond,
        }
    }
}

/// Returns the movement of the step's end along its displacement, as a multiple of it.
fn gain(led: Vec3, went: Vec3) -> f32 {
    let square = led.length_squared();
    if square < SAME_PLACE_M * SAME_PLACE_M {
        return 1.0;
    }
    let [least, most] = GAINS;
    (went.dot(led) / square).clamp(least, most)
}
