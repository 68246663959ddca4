//! Steps that are made to lead where another walker's do.

use super::super::buffers::StepBuffers;
use super::StepWindow;
use crate::footstep::Footstep;
use crate::ground::{Displacement, PlantedStep};
use crate::plan::StepShape;
use footfall_core::GroundTransform;
use footfall_core::rotation::{from_heading, wrap_angle};
use glam::Vec3;

/// A step ends as planned when it ends so near, metres and radians.
const SAME_PLACE_M: f32 = 0.002;
const SAME_HEADING_RAD: f32 = 0.004;

/// Way and turn that one step corrects at most, metres and radians.
const MOST_DISPLACEMENT_M: f32 = 0.2;
const MOST_TURN_RAD: f32 = 0.35;

/// Trials in which a step is made to end where it should: a turn moves its end, too, and so does a hip that is led aside.
const TRIALS: usize = 3;

/// Least and greatest way of a step's end for a metre that it is led aside: in fast steps the leg swings farther, too.
const GAINS: [f32; 2] = [1.0, 4.0];

/// Aim of a step, seen from where the walk began.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// Place of the foot that lands, or of the walker who rests, under the walker's heading.
    pub(crate) place: GroundTransform,
    pub(crate) rests: bool,
}

impl Aim {
    /// Way and turn to the aim from where a step leads.
    pub(crate) fn off(&self, leads: &GroundTransform) -> Displacement {
        Displacement {
            way: (self.place.position - leads.position).with_y(0.0),
            turn: wrap_angle(self.place.heading - leads.heading),
        }
    }
}

impl PlantedStep {
    /// Place where the step on it leads, from where the walk began: that of the foot that lands, under the walker's heading. That of a walker who rests is where
    /// it stands.
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
    /// Has the current step, which has just been planned, lead where it should, as far as one step can.
    pub(crate) fn aim_at(
        &mut self,
        aim: &Aim,
        plan_from_start: &GroundTransform,
        buffers: &mut StepBuffers,
    ) {
        let rotation = from_heading(plan_from_start.heading);
        let mut trial: Option<Trial> = None;
        for _ in 0..TRIALS {
            let leads = self.planted().aim(plan_from_start, self.step(), aim.rests);
            let off = aim.off(&leads);
            let most = off.within(MOST_DISPLACEMENT_M, MOST_TURN_RAD);
            let next = match trial {
                None => Trial {
                    off: most.way,
                    led: most.way,
                    beyond: off.way - most.way,
                },
                Some(last) => last.next(off.way),
            };
            // Where the body turns to, it is after the first trial.
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

/// A step that is led aside for its end to be where it should.
#[derive(Clone, Copy)]
struct Trial {
    /// Way to there, as far as one step can.
    off: Vec3,
    /// Way by which the hips are led aside for it.
    led: Vec3,
    /// Rest of the way, which is left to the steps after it.
    beyond: Vec3,
}

impl Trial {
    /// The trial after this one, with the whole way that it has left.
    fn next(self, off: Vec3) -> Self {
        let off = off - self.beyond;
        Self {
            off,
            led: off / gain(self.led, self.off - off),
            beyond: self.beyond,
        }
    }
}

/// Way of the step's end along that which it was led aside, as a multiple of it.
fn gain(led: Vec3, went: Vec3) -> f32 {
    let square = led.length_squared();
    if square < SAME_PLACE_M * SAME_PLACE_M {
        return 1.0;
    }
    let [least, most] = GAINS;
    (went.dot(led) / square).clamp(least, most)
}
