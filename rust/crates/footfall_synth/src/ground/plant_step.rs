//! Planting of a step, part by part: balance, stances, travel, height, flight, the next plant, the swing, and the legs.

use super::course::Course;
use super::frame::PlantedFrame;
use super::generated::{GeneratedFrame, free_foot};
use super::planter::Planter;
use super::strafe::{Strafe, Turner};
use super::swing::Swing;
use super::turning::spread;
use crate::plan::StepTiming;
use footfall_core::Side;
use footfall_core::rotation::from_heading;

impl Planter {
    /// Turns a forward step to the direction of travel. Under the heading `own_facing` the forward step goes along +Z. `strides` are the factors on the legs' reach before the step
    /// and after it. A step inside a walk covers `wanted_m` metres.
    pub(crate) fn turn_step(
        &mut self,
        generated: &mut [GeneratedFrame],
        timing: &StepTiming,
        (strafe, strides, wanted_m): (Strafe, [f32; 2], Option<f32>),
        own_facing: f32,
        out: &mut [PlantedFrame],
    ) {
        let before = self.state.strafe;
        if [before, strafe] != [Strafe::NONE; 2] {
            let leg_length = self.leg_lengths[timing.leading.index()];
            // The rest of a step says little about the length of a whole one.
            let wanted_m = wanted_m.filter(|_| self.state.airborne.is_none());
            let strafe = strafe.lengthened(self.flat_way(timing, generated, own_facing), wanted_m);
            // A step that ends a walk brings the feet together.
            let strafe = if timing.rests {
                strafe
            } else {
                strafe.spread(generated, leg_length)
            };
            self.state.strafe = strafe.at_end(timing.rests);
            let turner = Turner {
                feet: &self.feet,
                leg_length,
                own_facing,
                strides,
            };
            let timing = self.begun(timing);
            turner.turn_step(generated, out, &timing, [&before, &strafe]);
        }
    }

    /// Returns the timing of a step that begins with its trailing foot in the air or on the ground.
    fn begun(&self, timing: &StepTiming) -> StepTiming {
        let airborne = self.state.airborne.is_some();
        StepTiming {
            terminal: if airborne { 0 } else { timing.terminal },
            airborne,
            ..*timing
        }
    }

    /// Returns the travel of the hips over the standing foot in a forward step, if that foot were flat throughout, metres.
    fn flat_way(&self, timing: &StepTiming, generated: &[GeneratedFrame], own_facing: f32) -> f32 {
        let side = timing.leading.index();
        let level = from_heading(own_facing);
        let ahead = |frame: usize| {
            let leg = &generated[frame].legs[side];
            (level * leg.flat_ankle(&self.feet[side])).z
        };
        ahead(0) - ahead(timing.frames)
    }

    /// Puts a step on the ground. `generated` and `out` have one frame more than the step: the next initial contact, which is the
    /// first frame of the next step. The poses in `out` hold the generated local rotations.
    ///
    /// The trailing foot leaves the ground at `timing.terminal`, or earlier when the generated leg takes it away, and in a run the leading foot at
    /// `timing.take_off`. Returns the resulting timing.
    pub(crate) fn plant_step(
        &mut self,
        generated: &mut [GeneratedFrame],
        timing: &StepTiming,
        course: Course,
        out: &mut [PlantedFrame],
    ) -> StepTiming {
        let timing = &self.begun(timing);
        let airborne = self.state.airborne.take();
        let course = Course {
            keeps_lengths: course.keeps_lengths && timing.take_off.is_none(),
            ..course
        };
        self.balance(generated, timing, course);
        self.fill_stances(generated, timing);
        self.travel(generated, timing, course, out);
        let timing = &StepTiming {
            terminal: self.release(generated, timing, out),
            ..*timing
        };
        if course.keeps_lengths || timing.sets_off {
            // A raised heel spares the hips.
            self.raise_heels(generated, timing, out);
        }
        self.bear(generated, timing, out);
        if timing.take_off.is_none() || !timing.airborne {
            self.even_height(generated, timing, out);
        }
        if timing.take_off.is_some() {
            self.fly(generated, timing, out);
        }
        self.raise_heels(generated, timing, out);
        let [before, last] = [timing.frames - 1, timing.frames].map(|f| out[f].pose.root_position);
        self.state.hips = last;
        self.state.hips_velocity = Some((last - before) / self.frame_secs);
        let timing = &StepTiming {
            terminal: self.let_go(generated, timing, out),
            take_off: self.leave(generated, timing, out),
            ..*timing
        };
        let last = &out[timing.frames];
        let (hips, heading) = (last.pose.root_position, last.heading);
        let trailing = timing.leading.other();
        let next_plant = self.next_plant(generated, timing, hips, heading, course);
        let mut ends = self.swing_ends(generated, timing, out, &next_plant);
        if let Some(airborne) = &airborne {
            [ends[0], ends[1]] = self.airborne_ends(airborne, generated, timing, out);
        }
        let before = timing.frames - 1;
        let (hips, level) = (out[before].pose.root_position, out[before].level);
        let arrival = free_foot(&generated[before], trailing, hips, level).ankle;
        let swing = Swing::new(&ends, arrival, timing, self.frame_secs, course.lands_softly);
        let first = if timing.airborne {
            0
        } else {
            timing.terminal + 1
        };
        self.fill_swing(generated, trailing, first..timing.frames, &swing, out);
        self.depart(generated, timing, out);
        generated[timing.frames].legs[trailing.index()].target = ends[2].0;
        self.state.plants[trailing.index()] = next_plant;
        self.state.spread = spread(&self.state);
        *timing
    }

    /// Turns the legs of a step's frames to their feet.
    pub(crate) fn solve_legs(&self, generated: &[GeneratedFrame], out: &mut [PlantedFrame]) {
        for side in Side::BOTH {
            let target = |index: usize| &generated[index].legs[side.index()].target;
            self.legs[side.index()].solve_many(out, target);
        }
    }
}
