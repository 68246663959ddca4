//! The step on the ground: generated features become planted frames.

use super::arrival::Arrival;
use super::course::Course;
use super::cut::Cut;
use super::frame::PlantedFrame;
use super::generated::{GeneratedFrame, Stride};
use super::lean::Bend;
use super::placing::Placing;
use super::planter::Planter;
use super::planter_state::{Lean, PlanterState};
use super::strafe::{Strafe, decode_turned};
use crate::detail::Detail;
use crate::gait::Amplitude;
use crate::plan::StepShape;
use footfall_core::lanes::{self, COUNTING, f32x8};
use footfall_core::{Side, Skeleton};
use footfall_ik::Plant;
use footfall_model::layout;
use glam::Vec3;

/// The step on the ground, and the feet from which the next one continues. Allocates only in [`new`](Self::new).
#[derive(Debug)]
pub(crate) struct PlantedStep {
    skeleton: Skeleton,
    frame_secs: f32,
    /// Planter with the last places of the feet; `None` before the first step.
    planter: Option<Planter>,
    /// Place of the body at the end of the step.
    pub(crate) arrival: Arrival,
    /// Frames of the step at its own detail, one more than the step has; frames beyond are leftovers of others.
    pub(crate) frames: Vec<PlantedFrame>,
}

impl PlantedStep {
    /// Makes room for steps of at most `longest` frames at `frame_rate_hz`.
    pub(crate) fn new(skeleton: &Skeleton, frame_rate_hz: f64, longest: usize) -> Self {
        Self {
            skeleton: skeleton.clone(),
            frame_secs: (1.0 / frame_rate_hz) as f32,
            planter: None,
            arrival: Arrival::default(),
            frames: vec![PlantedFrame::default(); Detail::ground_room(longest) + 1],
        }
    }

    /// Makes the working memory of [`put`](Self::put), for steps of at most `longest` frames.
    pub(crate) fn generated(longest: usize) -> Vec<GeneratedFrame> {
        vec![GeneratedFrame::default(); Detail::ground_room(longest) + 1]
    }

    /// Forgets the feet: the next step is the first.
    pub(crate) fn clear(&mut self) {
        self.planter = None;
    }

    /// Continues from these feet.
    pub(crate) fn resume(&mut self, state: &PlanterState) {
        self.planter = Some(Planter::resume(&self.skeleton, self.frame_secs, state));
    }

    /// Returns the state with which the next step begins; `None` before the first.
    pub(crate) fn planter_state(&self) -> Option<PlanterState> {
        self.planter.as_ref().map(Planter::state)
    }

    /// Returns the last plant of this foot; `None` before the first step.
    pub(crate) fn plant(&self, side: Side) -> Option<&Plant> {
        self.planter.as_ref().map(|planter| planter.plant(side))
    }

    /// Returns the state from which the remainder continues if the step is cut at a frame; `None` if no foot is in the air there, and for steps
    /// in less than full detail. `begun` is the state with which the step began; a runner's foot has to stand for `bearing_frames` more.
    pub(crate) fn cut(
        &self,
        shape: &StepShape,
        (frame, bearing_frames): (usize, usize),
        begun: &PlanterState,
        placing: &Placing<'_>,
    ) -> Option<PlanterState> {
        let cut = Cut {
            skeleton: &self.skeleton,
            frame_secs: self.frame_secs,
            timing: &shape.timing,
            frames: self.frames.get(..=shape.timing.frames)?,
            frame,
            begun,
            ended: self.planter_state()?,
            turn_rate: placing.turn_rate,
            pull: placing.pull(shape.timing.frames as f32 * self.frame_secs),
        };
        let whole = shape.detail == Detail::Full && frame < shape.timing.frames;
        (whole && cut.is_in_swing(bearing_frames)).then(|| cut.state())
    }

    /// Returns the travel of the hips over the ground in the step.
    pub(crate) fn travel(&self, shape: &StepShape) -> Vec3 {
        let last = shape.ground_frames();
        let [from, to] = [0, last].map(|frame| self.frames[frame].pose.root_position);
        (to - from) * Vec3::new(1.0, 0.0, 1.0)
    }

    /// Puts a step on the ground: `rows` are the features of its frames and of the first frame of the next step. `generated` is working memory.
    pub(crate) fn put<'a>(
        &mut self,
        rows: impl Iterator<Item = &'a [f32]>,
        placing: &Placing<'_>,
        generated: &mut [GeneratedFrame],
    ) {
        let shape = placing.shape;
        let timing = shape.ground_timing();
        let detail = shape.detail.stride();
        let frame_secs = self.frame_secs * detail as f32;
        let stride = 1.0 + shape.amplitude.to * (shape.stride as f32 - 1.0);
        let before = self.planter.as_ref().map(Planter::state);
        let lean_before = before.map_or(Lean::default(), |state| state.lean);
        let (before, stride_before) =
            before.map_or((Strafe::NONE, stride), |state| (state.strafe, state.stride));
        let step_secs = frame_secs * timing.frames as f32;
        let bend = Bend::new(lean_before, &placing.pull(step_secs), step_secs);
        let strafe = if placing.turns_back() {
            // In the old direction still, over a stance as wide.
            before
        } else {
            Strafe::of(placing.velocity_mps, step_secs, &self.skeleton)
        };
        let end = strafe.at_end(timing.rests);
        // The legs of a step that ends standing keep its direction, under a pelvis that faces ahead in the end.
        let strafe = Strafe {
            turn: end.turn,
            ..strafe
        };
        let as_it_is = shape.amplitude == Amplitude::WALK && [before, strafe] == [Strafe::NONE; 2];
        let generated = &mut generated[..=timing.frames];
        let frames = &mut self.frames[..=timing.frames];
        let rows = rows.step_by(detail).enumerate();
        for (frame, (index, features)) in frames.iter_mut().zip(rows) {
            let rotations = &mut frame.pose.rotations;
            if as_it_is {
                layout::decode(features, rotations);
                continue;
            }
            let s = index as f32 / timing.frames as f32;
            let (middle, mut blended) = placing.grown(features, s);
            decode_turned(
                &mut blended,
                &middle,
                before.between(&strafe, [stride_before, stride], s),
                rotations,
            );
        }
        GeneratedFrame::fill(generated, frames, &self.skeleton, |index| {
            // The standing foot must not notice the beginning of another step.
            let s = (COUNTING + f32x8::splat(index as f32)) * (timing.frames as f32).recip();
            let share = lanes::smooth_step(s);
            let between = |from: f32, to: f32| share * (to - from) + f32x8::splat(from);
            Stride {
                scale: between(stride_before, stride),
                upright: between(before.uprightness(), end.uprightness()),
            }
        });
        let [_, facing] = placing.facing;
        let planter = self.planter.get_or_insert_with(|| {
            Planter::new(&self.skeleton, frame_secs, &generated[0], &timing, facing)
        });
        let ahead = [before, strafe] == [Strafe::NONE; 2];
        let course = Course {
            turn_rate: placing.turn_rate,
            facing: placing.facing,
            keeps_lengths: placing.keeps_lengths && ahead,
            lands_softly: !placing.keeps_lengths && !ahead,
            direction: placing.direction,
            change: placing.change(),
            displacement: placing.displacement,
            step_secs: step_secs / (1.0 - placing.passed),
        };
        planter.set_frame_secs(frame_secs);
        planter.set_stride(stride);
        planter.turn_step(
            generated,
            &timing,
            (strafe, [stride_before, stride], placing.way_m(step_secs)),
            facing - strafe.turn,
            frames,
        );
        planter.spread_turning(generated, &timing, placing.turn_rate);
        planter.lean_over(&bend, timing.leading, generated);
        planter.plant_step(generated, &timing, course, frames);
        planter.sink(&bend, frames);
        planter.look(frames);
        planter.solve_legs(generated, frames);
        self.arrival = Arrival {
            hips: frames[timing.frames].pose.root_position,
            ankles: Side::BOTH.map(|side| generated[timing.frames].legs[side.index()].target.ankle),
        };
    }
}
