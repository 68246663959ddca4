//! A crowd's walker at rest: a moment of standing at a time, worked out ahead.

use super::frames::{CrowdFrames, CrowdPose, FrameBuffers};
use crate::detail::Detail;
use crate::ground::PlantedFrame;
use crate::standing::{Life, Moment};
use footfall_core::Skeleton;

/// Poses that are worked out ahead, and how far apart they are in full detail, seconds.
const AHEAD: usize = 8;
const APART_SECS: f32 = 0.1;

/// Somebody who rests.
#[derive(Debug)]
pub(super) struct Rest {
    /// The pose in which the walker came to a stand.
    pub(super) still: PlantedFrame,
    frames: CrowdFrames,
    /// When the poses begin in the walker's life, and how far apart they are, seconds; nothing before the first.
    begin_secs: f64,
    apart_secs: Option<f32>,
}

/// Buffers in which poses are worked out.
#[derive(Debug)]
pub(super) struct RestBuffers {
    pub(super) planted: Vec<PlantedFrame>,
    pub(super) frames: FrameBuffers,
}

impl RestBuffers {
    /// With room for steps of at most `longest` frames.
    pub(super) fn new(longest: usize) -> Self {
        Self {
            planted: Vec::with_capacity(Detail::ground_room(longest) + 1),
            frames: FrameBuffers::default(),
        }
    }
}

impl Rest {
    /// In the last frame of a step that ends in a stand.
    pub(super) fn new(still: &PlantedFrame) -> Self {
        Self {
            still: still.clone(),
            frames: CrowdFrames::default(),
            begin_secs: 0.0,
            apart_secs: None,
        }
    }

    /// The same for one who came to a stand again.
    pub(super) fn begin(&mut self, still: &PlantedFrame) {
        self.still.clone_from(still);
        self.apart_secs = None;
    }

    /// Has the poses around a moment, working out new ones where they have run out.
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

    /// Writes the pose of a moment; whether it has it.
    pub(super) fn pose(&self, moment: &Moment, out: &mut CrowdPose) -> bool {
        let place = self.place(moment);
        if let Some((frame, weight)) = place {
            self.frames.blend(frame, weight, out);
        }
        place.is_some()
    }

    /// The pose before a moment, and the weight of the one after it.
    fn place(&self, moment: &Moment) -> Option<(usize, f32)> {
        let position = (moment.secs - self.begin_secs) as f32 / self.apart_secs?;
        let frame = position.floor();
        (0.0..AHEAD as f32)
            .contains(&position)
            .then_some((frame as usize, position - frame))
    }
}

/// Moves the frames of a step that begins in a stand by what is left of the life there.
pub(super) fn leave(life: &Life, frames: &mut [PlantedFrame], apart_secs: f32) {
    for (frame, index) in frames.iter_mut().zip(0_u16..) {
        let moment = life.moment.after(f32::from(index) * apart_secs, false);
        life.move_pose(&moment, frame.plan_from_ground, &mut frame.pose);
    }
}
