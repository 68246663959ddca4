//! Plants one step after another.

use super::course::Course;
use super::frame::PlantedFrame;
use super::generated::{RawFrame, free_foot};
use super::lean::Lean;
use super::planter_state::PlanterState;
use super::strafe::{Strafe, Turner};
use super::swing::Swing;
use crate::plan::StepTiming;
use footfall_core::rotation::from_heading;
use footfall_core::{Side, Skeleton};
use footfall_ik::{Leg, Plant, RockerFoot};
use glam::{Vec2, Vec3};

/// Carries plants, hips and heading from step to step.
#[derive(Clone, Debug)]
pub(crate) struct Planter {
    pub(super) feet: [RockerFoot; 2],
    pub(super) legs: [Leg; 2],
    pub(super) leg_lengths: [f32; 2],
    pub(super) frame_secs: f32,
    pub(super) state: PlanterState,
}

impl Planter {
    /// Puts the first frame on the ground: both feet down, hips above the origin, under this heading. The hips are as high as the leg has them that bears
    /// the body: in a run the one that lands.
    pub(crate) fn new(
        skeleton: &Skeleton,
        frame_secs: f32,
        first: &RawFrame,
        timing: &StepTiming,
        heading: f32,
    ) -> Self {
        let level = from_heading(heading);
        let feet = Side::BOTH.map(|side| RockerFoot::new(skeleton, side));
        let plants = Side::BOTH.map(|side| {
            let leg = &first.legs[side.index()];
            let foot = &feet[side.index()];
            foot.plant_under(level * leg.ankle, heading + leg.heading(), leg.pitch)
        });
        let state = PlanterState {
            plants,
            hips: Vec3::ZERO,
            hips_velocity: None,
            heading,
            turn_rate: 0.0,
            ground_position: Vec3::ZERO,
            ground_velocity: None,
            stride: 1.0,
            strafe: Strafe::NONE,
            balance: Vec2::ZERO,
            airborne: None,
            lean: Lean::default(),
        };
        let mut planter = Self::resume(skeleton, frame_secs, &state);
        let standing = match timing.take_off {
            Some(_) => timing.leading,
            None => timing.leading.other(),
        };
        let foot = planter.feet[standing.index()]
            .stand(planter.plant(standing), first.legs[standing.index()].pitch);
        let hips = foot.ankle - level * first.legs[standing.index()].ankle;
        planter.state.hips = Vec3::new(0.0, hips.y, 0.0);
        planter
    }

    /// Goes on from a [`state`](Self::state).
    pub(crate) fn resume(skeleton: &Skeleton, frame_secs: f32, state: &PlanterState) -> Self {
        Self {
            feet: Side::BOTH.map(|side| RockerFoot::new(skeleton, side)),
            legs: Side::BOTH.map(|side| Leg::new(skeleton, side)),
            leg_lengths: Side::BOTH.map(|side| skeleton.leg_length(side)),
            frame_secs,
            state: *state,
        }
    }

    /// From here on frames are so far apart, seconds.
    pub(crate) fn set_frame_secs(&mut self, frame_secs: f32) {
        self.frame_secs = frame_secs;
    }

    /// At the end of the next step the legs' reach has this factor on it.
    pub(crate) fn set_stride(&mut self, stride: f32) {
        self.state.stride = stride;
    }

    /// State that the next step begins with.
    pub(crate) fn state(&self) -> PlanterState {
        self.state
    }

    /// Turns a step that goes forwards to where it is to go; forwards it goes along +Z under the heading `own_facing`. A step in full walk leads `wanted_m` far, metres.
    pub(crate) fn turn_step(
        &mut self,
        raw: &mut [RawFrame],
        timing: &StepTiming,
        (strafe, wanted_m): (Strafe, Option<f32>),
        own_facing: f32,
        out: &mut [PlantedFrame],
    ) {
        let before = self.state.strafe;
        if [before, strafe] != [Strafe::NONE; 2] {
            let leg_length = self.leg_lengths[timing.leading.index()];
            let strafe = strafe.lengthened(self.flat_way(timing, raw, own_facing), wanted_m);
            // A step that ends a walk brings the feet together.
            let strafe = if timing.rests {
                strafe
            } else {
                strafe.spread(raw, leg_length)
            };
            self.state.strafe = strafe;
            let turner = Turner {
                feet: &self.feet,
                leg_length,
                own_facing,
            };
            turner.turn_step(raw, out, timing, [&before, &strafe]);
        }
    }

    /// Way of the hips over the standing foot in a step forwards, were that foot flat throughout, metres.
    fn flat_way(&self, timing: &StepTiming, raw: &[RawFrame], own_facing: f32) -> f32 {
        let side = timing.leading.index();
        let level = from_heading(own_facing);
        let ahead = |frame: usize| {
            let leg = &raw[frame].legs[side];
            (level * (leg.ankle - self.feet[side].roll(leg.pitch))).z
        };
        ahead(0) - ahead(timing.frames)
    }

    /// Last plant of this foot.
    pub(crate) fn plant(&self, side: Side) -> &Plant {
        &self.state.plants[side.index()]
    }

    /// Puts a step on the ground. `raw` and `out` have one frame more than the step: the next initial contact, which is the
    /// first frame of the next step. The poses in `out` hold the generated local rotations.
    ///
    /// The trailing foot leaves the ground at `timing.terminal`, or earlier when the generated leg takes it away, and in a run the leading foot at
    /// `timing.take_off`; returns the timing as it came out.
    pub(crate) fn plant_step(
        &mut self,
        raw: &mut [RawFrame],
        timing: &StepTiming,
        course: Course,
        out: &mut [PlantedFrame],
    ) -> StepTiming {
        let airborne = self.state.airborne.take();
        let timing = &StepTiming {
            terminal: if airborne.is_some() {
                0
            } else {
                timing.terminal
            },
            airborne: airborne.is_some(),
            ..*timing
        };
        let course = Course {
            keeps_lengths: course.keeps_lengths && timing.take_off.is_none(),
            ..course
        };
        self.balance(raw, timing, course);
        self.fill_stances(raw, timing);
        self.travel(raw, timing, course, out);
        let timing = &StepTiming {
            terminal: self.release(raw, timing, out),
            ..*timing
        };
        if course.keeps_lengths {
            // What a heel can give, the hips need not.
            self.raise_heels(raw, timing, out);
        }
        self.bear(raw, timing, out);
        if timing.take_off.is_none() || !timing.airborne {
            self.even_height(raw, timing, out);
        }
        if timing.take_off.is_some() {
            self.fly(raw, timing, out);
        }
        self.raise_heels(raw, timing, out);
        let [before, last] = [timing.frames - 1, timing.frames].map(|f| out[f].pose.root_position);
        self.state.hips = last;
        self.state.hips_velocity = Some((last - before) / self.frame_secs);
        let timing = &StepTiming {
            terminal: self.let_go(raw, timing, out),
            take_off: self.leave(raw, timing, out),
            ..*timing
        };
        let last = &out[timing.frames];
        let (hips, heading) = (last.pose.root_position, last.heading);
        let trailing = timing.leading.other();
        let next_plant = self.next_plant(raw, timing, hips, heading, course);
        let mut ends = self.swing_ends(raw, timing, out, &next_plant);
        if let Some(airborne) = &airborne {
            [ends[0], ends[1]] = self.airborne_ends(airborne, raw, timing, out);
        }
        let before = timing.frames - 1;
        let (hips, level) = (out[before].pose.root_position, out[before].level);
        let arrival = free_foot(&raw[before], trailing, hips, level).ankle;
        let swing = Swing::new(&ends, arrival, timing, self.frame_secs);
        let first = if timing.airborne {
            0
        } else {
            timing.terminal + 1
        };
        self.fill_swing(raw, trailing, first..timing.frames, &swing, out);
        self.depart(raw, timing, out);
        raw[timing.frames].legs[trailing.index()].target = ends[2].0;
        for side in Side::BOTH {
            let target = |index: usize| &raw[index].legs[side.index()].target;
            self.legs[side.index()].solve_many(out, target);
        }
        self.state.plants[trailing.index()] = next_plant;
        *timing
    }
}
