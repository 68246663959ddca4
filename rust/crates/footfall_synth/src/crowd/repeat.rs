//! Steps that are walked again, for walkers far away.

use super::CrowdWalker;
use super::frames::CrowdFrames;
use crate::controls::Controls;
use crate::plan::StepShape;
use crate::standing::Amplitude;
use footfall_core::GroundTransform;
use footfall_core::rotation::from_heading;
use footfall_ik::Plant;

/// Place and turn of a step that is walked again.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Base {
    place: GroundTransform,
    /// Turn from its first frame to its last, radians, about the middle of the step.
    turn: f32,
}

/// A step that can be walked again.
#[derive(Debug)]
pub(super) struct Before {
    pub(super) frames: CrowdFrames,
    pub(super) shape: StepShape,
    /// Plant of the foot whose landing began it.
    pub(super) landing: Option<Plant>,
}

impl Base {
    /// The base under which a step whose first frame this is starts at `start` and turns by `turn`.
    fn starting(start: &GroundTransform, first: &GroundTransform, turn: f32) -> Self {
        // On the whole it goes in the direction that it has in the middle of its turn.
        let heading = start.heading - first.heading + 0.5 * turn;
        Self {
            place: GroundTransform {
                position: start.position - from_heading(heading) * first.position,
                heading,
            },
            turn,
        }
    }

    /// Place of a frame of the step, of which this share is over.
    pub(super) fn at(&self, place: &GroundTransform, share: f32) -> GroundTransform {
        GroundTransform {
            position: self.place.position + from_heading(self.place.heading) * place.position,
            heading: self.place.heading + place.heading + self.turn * (share - 0.5),
        }
    }
}

impl CrowdWalker {
    /// Walks the step before the current one again, if that is wanted and can be.
    pub(super) fn repeat_step(&mut self, controls: Controls) -> bool {
        let wanted = self.odd || (self.repeating && !controls.is_standing());
        let walks = self.shape.amplitude == Amplitude::WALK;
        let end = self.end();
        let Some(before) = self
            .before
            .as_mut()
            .filter(|before| wanted && walks && before.shape.amplitude == Amplitude::WALK)
        else {
            return false;
        };
        core::mem::swap(&mut before.frames, &mut self.frames);
        core::mem::swap(&mut before.shape, &mut self.shape);
        core::mem::swap(&mut before.landing, &mut self.landing);
        self.odd = !self.odd;
        let secs = self.shape.timing.frames as f32 / self.frame_rate_hz;
        let turn = controls.turn_rate() * secs;
        let first = self.frames.places.first();
        let first = first.map(|first| first.place).unwrap_or_default();
        self.base = Base::starting(&end, &first, turn);
        let landing = self.landing.map(|plant| plant.moved(&first, &end));
        self.footstep = self.footstep_at(landing);
        true
    }
}
