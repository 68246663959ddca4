//! Queue of received steps.

use super::update::{Planned, WalkUpdate};
use crate::controls::Controls;
use crate::generator::GaitGenerator;
use crate::source::Aim;
use footfall_core::GroundTransform;

/// Maximum number of waiting steps; the oldest is dropped.
const ROOM: usize = 8;

/// A step, or the remainder of one, as the sender planned it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planning {
    pub(super) planned: Planned,
    /// Sender's time of planning, seconds.
    pub(super) at_secs: f64,
    pub(super) controls: Controls,
    pub(super) rise_m: f32,
    /// True when the step brings the feet together or is one of a run that slows down.
    pub(super) brakes: bool,
    /// Place where the step ends, in the shared space.
    aim: GroundTransform,
    /// True if that is the place of a resting walker.
    rests: bool,
}

/// Creates a queue, which does not allocate later.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Queue {
    waiting: [Option<Planning>; ROOM],
    count: usize,
    /// Last received step, possibly taken already.
    last: Option<Planned>,
}

impl Planning {
    /// Makes the step of an update that was sent at a sender's time.
    pub(super) fn of(update: &WalkUpdate, sent_secs: f64, frame_rate_hz: f32) -> Self {
        Self {
            planned: update.planned,
            at_secs: sent_secs - f64::from(update.age_frames) / f64::from(frame_rate_hz),
            controls: update.controls,
            rise_m: update.rise_m,
            brakes: update.brakes,
            aim: update.aim,
            rests: update.rests,
        }
    }

    /// Takes the end from a later update of the same step, which terrain or a wall may have changed.
    pub(super) fn correct(&mut self, later: &Self) {
        if self.rests == later.rests {
            self.aim = later.aim;
        }
    }

    /// Sets the end to the place of the resting walker.
    pub(super) fn rest(&mut self, place: GroundTransform) {
        (self.aim, self.rests) = (place, true);
    }

    /// Returns the aim of the step, for a walk with this start.
    pub(super) fn aim(&self, shared_from_start: &GroundTransform) -> Aim {
        Aim {
            place: shared_from_start.local(&self.aim),
            rests: self.rests,
        }
    }

    /// Returns the start of a walk whose step ends where this one does.
    pub(super) fn start(&self, generator: &GaitGenerator) -> GroundTransform {
        let own = generator.start_from_aim(self.rests);
        self.aim.global(&own.local(&GroundTransform::default()))
    }
}

impl Queue {
    /// Appends a step, or corrects the last one if it is the same. Returns true when it is the last received one and was taken already.
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

    /// Returns the oldest waiting step.
    pub(super) fn next(&self) -> Option<&Planning> {
        self.waiting[0].as_ref()
    }

    /// Returns the newest waiting step.
    pub(super) fn newest(&self) -> Option<&Planning> {
        self.waiting[self.count.checked_sub(1)?].as_ref()
    }

    /// Takes the oldest waiting step.
    pub(super) fn take(&mut self) -> Option<Planning> {
        let taken = self.waiting[0].take()?;
        self.waiting.rotate_left(1);
        self.count -= 1;
        Some(taken)
    }

    /// Drops all waiting steps.
    pub(super) fn pass_all(&mut self) {
        self.waiting = [None; ROOM];
        self.count = 0;
    }
}
