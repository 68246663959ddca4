//! Feet of a crowd's walker: initial contacts, and coming landings.

use super::CrowdWalker;
use super::own::OwnWalk;
use crate::footstep::Footstep;
use crate::ground::landings;
use footfall_ik::Plant;
use footfall_ik::placement::Landing;

impl CrowdWalker {
    /// Returns the initial contact during the last [`step`](Self::step), relative to the start of the walk.
    pub fn footstep(&self) -> Option<&Footstep> {
        self.footstep.as_ref()
    }

    /// Returns the next landing of the swinging foot, in the character's current space, and the seconds until then. `None` for a walker
    /// that rests or shares steps.
    pub fn next_footstep(&self) -> Option<(Footstep, f32)> {
        let own = self.own.as_ref()?;
        (self.stroll.is_none() && !self.repeating)
            .then(|| own.next_footstep())
            .flatten()
    }

    /// Returns the next landing of each foot and the body's place then, for callers that place feet on real ground.
    pub fn landings(&self) -> [Option<Landing>; 2] {
        let Some(own) = self.own.as_ref().filter(|_| self.stroll.is_none()) else {
            return [None; 2];
        };
        let from = own.plan_from_character();
        landings(self.next_footstep(), &from, &own.ending.arrival)
    }

    /// Returns the contacts of the left and the right foot.
    pub fn feet_in_contact(&self) -> [bool; 2] {
        match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.contacts(self.styled.0.shared()),
            (None, Some(own)) => own.contacts_at(own.position),
            (None, None) => [true; 2],
        }
    }
}

impl OwnWalk {
    fn next_footstep(&self) -> Option<(Footstep, f32)> {
        if self.is_standing() {
            return None;
        }
        let timing = &self.shape.timing;
        let side = timing.leading.other();
        let plant = self.ending.next.planter.as_ref()?.plants[side.index()];
        let footstep = Footstep::seen_from(&self.plan_from_character(), side, &plant);
        Some((footstep, self.secs_to_next_step()))
    }

    /// Returns the footstep of the foot that lands as the step ends.
    pub(super) fn closing_footstep(&self) -> Option<Footstep> {
        let side = self.shape.timing.leading.other();
        let plant = self.ending.next.planter.as_ref()?.plants[side.index()];
        Some(Footstep::seen_from(&self.plan_from_start, side, &plant))
    }

    /// Returns the contacts this many frames after the step began.
    pub(super) fn contacts_at(&self, position: f32) -> [bool; 2] {
        let (frame, weight) = self.frame_at(position);
        self.frames.places[frame + usize::from(weight >= 0.5)].contact
    }

    /// Returns the plant of the leading foot of the step that was just generated.
    pub(super) fn landing_of_step(&self) -> Option<Plant> {
        let feet = self.ending.next.planter.as_ref()?;
        Some(feet.plants[self.shape.timing.leading.index()])
    }

    /// Returns the footstep for the leading foot's landing on this plant.
    pub(super) fn footstep_at(&self, landing: Option<Plant>) -> Option<Footstep> {
        let side = self.shape.timing.leading;
        landing.map(|plant| Footstep::seen_from(&self.plan_from_start, side, &plant))
    }
}
