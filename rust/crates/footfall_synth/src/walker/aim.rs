//! Steps that are made to lead where another walker's do.

use super::Walker;
use crate::footstep::Footstep;
use crate::plan::StepShape;
use crate::planting::Aside;
use crate::stage::Stage;
use crate::workbench::Workbench;
use footfall_core::GroundTransform;
use footfall_core::rotation::{from_heading, wrap_angle};

/// A step ends as planned when it ends so near, metres and radians.
const SAME_PLACE_M: f32 = 0.002;
const SAME_HEADING_RAD: f32 = 0.004;

/// Way and turn that one step corrects at most, metres and radians.
const MOST_ASIDE_M: f32 = 0.2;
const MOST_TURN_RAD: f32 = 0.35;

/// Trials in which a step is made to end where it should: a turn moves its end, too.
const TRIALS: usize = 2;

/// Aim of a step, seen from where the walk began.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// Place of the foot that lands, or of the walker who rests, under the walker's heading.
    pub(crate) place: GroundTransform,
    pub(crate) rests: bool,
}

impl Aim {
    /// Way and turn to the aim from where a step leads.
    pub(crate) fn off(&self, leads: &GroundTransform) -> Aside {
        Aside {
            way: (self.place.position - leads.position).with_y(0.0),
            turn: wrap_angle(self.place.heading - leads.heading),
        }
    }
}

impl Stage {
    /// Place where the step on it leads, from where the walk began: that of the foot that lands, under the walker's heading. That of a walker who rests is where
    /// it stands.
    pub(crate) fn aim(
        &self,
        plan_from_start: &GroundTransform,
        shape: &StepShape,
        rests: bool,
    ) -> GroundTransform {
        let frame = &self.frames[shape.ground_timing().frames];
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

impl Walker {
    /// Has the current step, which has just been planned, lead where it should, as far as one step can.
    pub(crate) fn aim_at(
        &mut self,
        aim: &Aim,
        plan_from_start: &GroundTransform,
        bench: &mut Workbench,
    ) {
        let rotation = from_heading(plan_from_start.heading);
        let mut turn = None;
        for _ in 0..TRIALS {
            let leads = self.stage().aim(plan_from_start, self.step(), aim.rests);
            let off = aim.off(&leads).within(MOST_ASIDE_M, MOST_TURN_RAD);
            // Where the body turns to, it is after the first trial.
            let turn = turn.replace(0.0).unwrap_or(off.turn);
            let near = off.way.length() < SAME_PLACE_M && turn.abs() < SAME_HEADING_RAD;
            let more = Aside {
                way: rotation * off.way,
                turn,
            };
            if near || !self.step_aside(more, bench) {
                return;
            }
        }
    }
}
