//! Plants one step after another.

use super::displacement::Aside;
use super::generated::{RawFrame, RawLeg};
use super::lean::Lean;
use super::planter_state::PlanterState;
use super::reach::yielding;
use super::speed_change::SpeedChange;
use super::strafe::{Strafe, Turner};
use super::swing::Swing;
use crate::plan::timing::StepTiming;
use core::ops::Range;
use footfall_core::lanes::{LANES, Quatx8, Vec3x8, f32x8};
use footfall_core::rotation::from_heading;
use footfall_core::{Pose, Side, Skeleton};
use footfall_ik::{FootTarget, FootTargetx8, Leg, Plant, RockerFoot};
use glam::{Quat, Vec2, Vec3};

/// Share of the straight leg to which a swinging leg can be stretched.
const SWING_EXTENSION: f32 = 0.9993;

/// One frame of a walk on the ground.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlantedFrame {
    /// The pose in the space where the walk began.
    pub(crate) pose: Pose,
    /// Place of the walker on the ground: its travel without sway.
    pub(crate) ground_position: Vec3,
    /// Heading of the walker, radians, and the rotation by it; continuous within a step.
    pub(crate) ground_heading: f32,
    pub(crate) plan_from_ground: Quat,
    /// Heading under which the generated features are put, radians, and the rotation by it.
    pub(crate) heading: f32,
    pub(crate) level: Quat,
    /// Contacts of the left and the right foot.
    pub(crate) contact: [bool; 2],
}

/// Carries plants, hips and heading from step to step.
#[derive(Clone, Debug)]
pub(crate) struct Planter {
    pub(super) feet: [RockerFoot; 2],
    pub(super) legs: [Leg; 2],
    pub(super) leg_lengths: [f32; 2],
    pub(super) frame_secs: f32,
    pub(super) state: PlanterState,
}

impl AsRef<Pose> for PlantedFrame {
    fn as_ref(&self) -> &Pose {
        &self.pose
    }
}

impl AsMut<Pose> for PlantedFrame {
    fn as_mut(&mut self) -> &mut Pose {
        &mut self.pose
    }
}

/// Course of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Course {
    /// Turning at its end, rad/s.
    pub(crate) turn_rate: f32,
    /// Headings of the features from where the walker faces, before the step and after it, radians.
    pub(crate) facing: [f32; 2],
    /// True where standing legs are to be as long as generated; those of a step that ends in flight are not.
    pub(crate) keeps_lengths: bool,
    /// Direction of a run from where the walker faces, radians, positive to the left; none where the generated legs choose it.
    pub(crate) direction: Option<f32>,
    /// Change of speed within it.
    pub(crate) change: SpeedChange,
    /// Displacement of its end.
    pub(crate) aside: Aside,
    /// Duration of the whole step, seconds.
    pub(crate) step_secs: f32,
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

    /// Fills where each foot stands while it may: on its plant, under the plant's heading, at the generated pitch.
    pub(super) fn fill_stances(&self, raw: &mut [RawFrame], timing: &StepTiming) {
        let trailing = timing.leading.other();
        let stances = [
            (timing.leading, Some(timing.frames)),
            (trailing, (!timing.airborne).then_some(timing.terminal)),
        ];
        for (side, last) in stances {
            let Some(last) = last else { continue };
            self.stand(side, &mut raw[..=last], |leg| Some(leg.pitch));
        }
    }

    /// Stands a foot on its plant, under the plant's heading, in those frames in which `pitch` gives it a pitch.
    pub(super) fn stand(
        &self,
        side: Side,
        raw: &mut [RawFrame],
        pitch: impl Fn(&RawLeg) -> Option<f32>,
    ) {
        let plant = self.plant(side);
        let level = from_heading(plant.heading);
        for frames in raw.chunks_mut(LANES) {
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

    /// Fills where a foot is on its way in some frames, eight at a time.
    pub(super) fn fill_swing(
        &self,
        raw: &mut [RawFrame],
        side: Side,
        within: Range<usize>,
        swing: &Swing,
        frames: &[PlantedFrame],
    ) {
        let side = side.index();
        let extensions = [self.landing_extension(), SWING_EXTENSION]
            .map(|share| f32x8::splat(share * self.leg_lengths[side]));
        let end = within.end;
        for index in within.step_by(LANES) {
            let at = |lane: usize| (index + lane).min(end - 1);
            let level = Quatx8::gather(|lane| frames[at(lane)].level);
            let hips = Vec3x8::gather(|lane| frames[at(lane)].pose.root_position);
            let leg = |lane: usize| &raw[at(lane)].legs[side];
            let foot = level * Quatx8::gather(|lane| leg(lane).foot);
            let free = FootTargetx8 {
                ankle: hips + level * Vec3x8::gather(|lane| leg(lane).ankle),
                foot,
                toes: foot,
            };
            let hip = hips + level * Vec3x8::gather(|lane| leg(lane).hip);
            let mut target = swing.guide(index, &free, &self.feet[side]);
            let ankle = target.ankle - hip;
            let yielded = ankle * yielding(ankle.length(), extensions);
            target.ankle = hip + ankle + (yielded - ankle) * swing.freed(index);
            let frames = &mut raw[index..end.min(index + LANES)];
            for (frame, target) in frames.iter_mut().zip(target.lanes()) {
                frame.legs[side].target = target;
            }
        }
    }

    /// Planted and free places of the trailing foot, at the ends of its swing.
    pub(super) fn swing_ends(
        &self,
        raw: &[RawFrame],
        timing: &StepTiming,
        frames: &[PlantedFrame],
        next_plant: &Plant,
    ) -> [(FootTarget, FootTarget); 3] {
        let side = timing.leading.other();
        let foot = &self.feet[side.index()];
        let before = timing.terminal.saturating_sub(1);
        [before, timing.terminal, timing.frames].map(|index| {
            let frame = &frames[index];
            let leg = &raw[index].legs[side.index()];
            let planted = if index == timing.frames {
                foot.stand(next_plant, leg.pitch)
            } else {
                leg.target
            };
            let free = free_foot(&raw[index], side, frame.pose.root_position, frame.level);
            (planted, free)
        })
    }
}

/// Place of a foot whose leg is as generated.
pub(super) fn free_foot(raw: &RawFrame, side: Side, hips: Vec3, level: Quat) -> FootTarget {
    let leg = &raw.legs[side.index()];
    let foot = level * leg.foot;
    FootTarget {
        ankle: hips + level * leg.ankle,
        foot,
        toes: foot,
    }
}
