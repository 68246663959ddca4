//! Planter: feet, legs and the state that is carried from step to step.

use super::generated::GeneratedFrame;
use super::planter_state::PlanterState;
use crate::plan::StepTiming;
use footfall_core::rotation::from_heading;
use footfall_core::{Side, Skeleton};
use footfall_ik::{Leg, Plant, RockerFoot};
use glam::Vec3;

/// Planter of one walker; its parts are in the files beside this one.
#[derive(Clone, Debug)]
pub(crate) struct Planter {
    pub(super) feet: [RockerFoot; 2],
    pub(super) legs: [Leg; 2],
    pub(super) leg_lengths: [f32; 2],
    pub(super) frame_secs: f32,
    pub(super) state: PlanterState,
}

impl Planter {
    /// Puts the first frame on the ground: both feet down, hips above the origin, under this heading. The bearing leg determines the height of the
    /// hips: in a run the landing one.
    pub(crate) fn new(
        skeleton: &Skeleton,
        frame_secs: f32,
        first: &GeneratedFrame,
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
        let state = PlanterState::first(plants, heading);
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

    /// Continues from a [`state`](Self::state).
    pub(crate) fn resume(skeleton: &Skeleton, frame_secs: f32, state: &PlanterState) -> Self {
        Self {
            feet: Side::BOTH.map(|side| RockerFoot::new(skeleton, side)),
            legs: Side::BOTH.map(|side| Leg::new(skeleton, side)),
            leg_lengths: Side::BOTH.map(|side| skeleton.leg_length(side)),
            frame_secs,
            state: *state,
        }
    }

    /// Sets the time between two frames, seconds.
    pub(crate) fn set_frame_secs(&mut self, frame_secs: f32) {
        self.frame_secs = frame_secs;
    }

    /// Sets the factor on the legs' reach at the end of the next step.
    pub(crate) fn set_stride(&mut self, stride: f32) {
        self.state.stride = stride;
    }

    /// Returns the state with which the next step begins.
    pub(crate) fn state(&self) -> PlanterState {
        self.state
    }

    /// Returns the last plant of this foot.
    pub(crate) fn plant(&self, side: Side) -> &Plant {
        &self.state.plants[side.index()]
    }
}
