//! Rest in a crowd: poses of standing motion, computed ahead.

use super::frames::{CrowdFrames, CrowdPose, FrameBuffers};
use crate::detail::Detail;
use crate::ground::PlantedFrame;
use crate::standing::{Life, Moment};
use footfall_core::Skeleton;

/// Number of poses computed ahead, and time between them in full detail, seconds.
const AHEAD: usize = 8;
const APART_SECS: f32 = 0.1;

/// A resting walker.
#[derive(Debug)]
pub(super) struct Rest {
    /// Pose in which the walker stopped.
    pub(super) still: PlantedFrame,
    frames: CrowdFrames,
    /// Time of the first pose in the walker's standing motion, and time between poses, seconds; `None` before the first.
    begin_secs: f64,
    apart_secs: Option<f32>,
}

/// Buffers for the computation of poses.
#[derive(Debug)]
pub(super) struct RestBuffers {
    pub(super) planted: Vec<PlantedFrame>,
    pub(super) frames: FrameBuffers,
}

impl RestBuffers {
    /// Makes buffers for steps of at most `longest` frames.
    pub(super) fn new(longest: usize) -> Self {
        Self {
            planted: Vec::with_capacity(Detail::ground_room(longest) + 1),
            frames: FrameBuffers::default(),
        }
    }
}

impl Rest {
    /// Begins a rest in the last frame of a step that ends standing.
    pub(super) fn new(still: &PlantedFrame) -> Self {
        Self {
            still: still.clone(),
            frames: CrowdFrames::default(),
            begin_secs: 0.0,
            apart_secs: None,
        }
    }

    /// Begins another rest.
    pub(super) fn begin(&mut self, still: &PlantedFrame) {
        self.still.clone_from(still);
        self.apart_secs = None;
    }

    /// Computes new poses if those around a moment have run out.
    pub(super) fn reach(
        &mut self,
        life: &Life,
        detail: Detail,
        skeleton: &Skeleton,
        buffers: &mut RestBuffers,
    ) {
        if self.place(&life.moment).is_some() {
            return;
        }
        let apart_secs = APART_SECS * detail.stride() as f32;
        buffers.planted.resize(AHEAD + 1, PlantedFrame::default());
        for (frame, index) in buffers.planted.iter_mut().zip(0_u16..) {
            frame.clone_from(&self.still);
            let moment = life.moment.after(f32::from(index) * apart_secs, true);
            life.move_pose(&moment, frame.plan_from_ground, &mut frame.pose);
        }
        let RestBuffers { planted, frames } = buffers;
        self.frames.set(planted, skeleton, frames);
        self.begin_secs = life.moment.secs;
        self.apart_secs = Some(apart_secs);
    }

    /// Writes the pose of a moment; returns false if it is not available.
    pub(super) fn pose(&self, moment: &Moment, out: &mut CrowdPose) -> bool {
        let place = self.place(moment);
        if let Some((frame, weight)) = place {
            self.frames.blend(frame, weight, out);
        }
        place.is_some()
    }

    /// Returns the index of the pose before a moment, and the weight of the next one.
    fn place(&self, moment: &Moment) -> Option<(usize, f32)> {
        let position = (moment.secs - self.begin_secs) as f32 / self.apart_secs?;
        let frame = position.floor();
        (0.0..AHEAD as f32)
            .contains(&position)
            .then_some((frame as usize, position - frame))
    }
}

/// Adds the fading standing motion to the frames of a step that begins standing.
pub(super) fn leave(life: &Life, frames: &mut [PlantedFrame], apart_secs: f32) {
    for (frame, index) in frames.iter_mut().zip(0_u16..) {
        let moment = life.moment.after(f32::from(index) * apart_secs, false);
        life.move_pose(&moment, frame.plan_from_ground, &mut frame.pose);
    }
}
