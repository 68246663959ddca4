//! Steps that were heard of and are still to be made.

use super::update::{Planned, WalkUpdate};
use crate::controls::Controls;
use crate::generator::GaitGenerator;
use crate::source::Aim;
use footfall_core::GroundTransform;

/// Steps that wait at most; the oldest gives way.
const ROOM: usize = 8;

/// A step, or the rest of one, as the sender planned it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planning {
    pub(super) planned: Planned,
    /// The sender's time when it did, seconds.
    pub(super) at_secs: f64,
    pub(super) controls: Controls,
    pub(super) rise_m: f32,
    /// Place where the step leads, in the shared space.
    aim: GroundTransform,
    /// True where that is the place of a walker who rests.
    rests: bool,
}

/// A queue that allocates nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Queue {
    waiting: [Option<Planning>; ROOM],
    count: usize,
    /// The last that came, which may have been taken since.
    last: Option<Planned>,
}

impl Planning {
    /// The step that an update tells of, sent at a time of the sender's.
    pub(super) fn of(update: &WalkUpdate, sent_secs: f64, frame_rate_hz: f32) -> Self {
        Self {
            planned: update.planned,
            at_secs: sent_secs - f64::from(update.age_frames) / f64::from(frame_rate_hz),
            controls: update.controls,
            rise_m: update.rise_m,
            aim: update.aim,
            rests: update.rests,
        }
    }

    /// Leads where the same step is said to lead later: the ground or a wall may have led the walker elsewhere.
    pub(super) fn correct(&mut self, later: &Self) {
        if self.rests == later.rests {
            self.aim = later.aim;
        }
    }

    /// Leads to the place where the walker has come to rest.
    pub(super) fn rest(&mut self, place: GroundTransform) {
        (self.aim, self.rests) = (place, true);
    }

    /// Aim of the step, for a walk that began there.
    pub(super) fn aim(&self, shared_from_start: &GroundTransform) -> Aim {
        Aim {
            place: shared_from_start.local(&self.aim),
            rests: self.rests,
        }
    }

    /// Place where the walk has to begin for its step to lead where this one does.
    pub(super) fn start(&self, generator: &GaitGenerator) -> GroundTransform {
        let own = generator.start_from_aim(self.rests);
        self.aim.global(&own.local(&GroundTransform::default()))
    }
}

impl Queue {
    /// Puts a step behind the others, or corrects the last of them when it is the same. Returns true when it is the last that came, and was taken already.
    pub(super) fn hear(&mut self, planning: Planning) -> bool {
        if self.last == Some(planning.planned) {
            let Some(last) = self.count.checked_sub(1) else {
                return true;
            };
            if let Some(waiting) = &mut self.waiting[last] {
                waiting.correct(&planning);
            }
            return false;
        }
        self.last = Some(planning.planned);
        if self.count == ROOM {
            self.take();
        }
        self.waiting[self.count] = Some(planning);
        self.count += 1;
        false
    }

    /// The step that waits longest.
    pub(super) fn next(&self) -> Option<&Planning> {
        self.waiting[0].as_ref()
    }

    /// The one that came last of those that wait.
    pub(super) fn newest(&self) -> Option<&Planning> {
        self.waiting[self.count.checked_sub(1)?].as_ref()
    }

    /// Takes the step that waits longest.
    pub(super) fn take(&mut self) -> Option<Planning> {
        let taken = self.waiting[0].take()?;
        self.waiting.rotate_left(1);
        self.count -= 1;
        Some(taken)
    }

    /// Takes all that wait.
    pub(super) fn pass_all(&mut self) {
        self.waiting = [None; ROOM];
        self.count = 0;
    }
}
