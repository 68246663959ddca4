//! Landing: the place at which a foot comes down, and how straight its leg is.

use super::course::Course;
use super::generated::GeneratedFrame;
use super::planter::Planter;
use super::reach::within_reach;
use super::support::MAX_STANCE_EXTENSION;
use crate::plan::StepTiming;
use footfall_core::Side;
use footfall_core::rotation::from_heading;
use footfall_ik::{Plant, reach_height};
use glam::Vec3;

/// Fraction of the straight leg with which a foot lands at most: what is left keeps the pelvis from dropping at once. A step forwards lands straighter than
/// one to the side, and one backwards, which lands on its toes, over a bent knee.
const LANDING_EXTENSION: f32 = 0.985;
const LANDING_FORWARDS: f32 = 0.011;
const LANDING_BACKWARDS: f32 = 0.005;
/// Part of the turn of a foot that comes down flat by which it is turned as it lands, between how it lands and how it lies; and the most of that turn, radians.
const TURNED_SHARE: f32 = 0.6;
const MOST_TURN: f32 = 0.2;
/// Hips that fall faster than this, m/s, land on a leg that is less straight by this share of it, by m/s: it has to bend at once.
const EASY_FALL_MPS: f32 = 0.2;
const LANDING_BY_FALL: f32 = 0.03;
/// Hips that fall faster than runners' do, m/s, land on a knee that gives: less straight by this share, by m/s.
const HARD_FALL_MPS: f32 = 1.3;
const LANDING_BY_HARD_FALL: f32 = 0.012;

impl Planter {
    /// Plant of the trailing foot at the end of the step.
    pub(super) fn next_plant(
        &self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        hips: Vec3,
        heading: f32,
        course: Course,
    ) -> Plant {
        let side = timing.leading.other();
        let leg = &generated[timing.frames].legs[side.index()];
        let level = from_heading(heading);
        let (hip, ankle) = (hips + level * leg.hip, hips + level * leg.ankle);
        // The foot points to where the body will have turned by the middle of its stance.
        let lead = 0.5 * course.turn_rate * course.step_secs;
        let foot = &self.feet[side.index()];
        let heading = heading + lead + leg.heading() + self.turn_to_flat(generated, timing);
        let mut plant = foot.plant_under(ankle, heading, leg.pitch);
        let reach = self.landing_extension() * self.leg_lengths[side.index()];
        plant.flat_ankle += within_reach(foot.stand(&plant, leg.pitch).ankle - hip, reach);
        plant
    }

    /// Turn of the trailing foot from its landing to how it stands, radians: heels strike with the toes still pointing outwards, and a planted foot does not turn,
    /// so it lands nearly as it would lie flat. The foot that stands shows the turn, mirrored, unless the step begins in its stance.
    fn turn_to_flat(&self, generated: &[GeneratedFrame], timing: &StepTiming) -> f32 {
        if timing.airborne {
            return 0.0;
        }
        let heading = |frame: usize| generated[frame].legs[timing.leading.index()].heading();
        let flat = timing.frames / 5..=timing.frames / 2;
        let count = flat.clone().count() as f32;
        let turn = flat.map(heading).sum::<f32>() / count - heading(0);
        let share = TURNED_SHARE * self.state.strafe.uprightness();
        -share * turn.clamp(-MOST_TURN, MOST_TURN)
    }

    /// Fraction of the straight leg with which a foot lands at most.
    pub(super) fn landing_extension(&self) -> f32 {
        let strafe = &self.state.strafe;
        let backwards = (-strafe.forwardness).max(0.0);
        let fall = self.state.hips_velocity.map_or(0.0, |velocity| -velocity.y);
        let bent = LANDING_BY_FALL * (fall - EASY_FALL_MPS).clamp(0.0, EASY_FALL_MPS)
            + LANDING_BY_HARD_FALL * (fall - HARD_FALL_MPS).max(0.0);
        LANDING_EXTENSION + LANDING_FORWARDS * strafe.uprightness()
            - LANDING_BACKWARDS * backwards
            - bent
    }

    /// Greatest height of the hips at which a leg reaches the foot that it lands where it was generated.
    pub(super) fn landing_limit(&self, generated: &GeneratedFrame, side: Side) -> f32 {
        let leg = &generated.legs[side.index()];
        let generated = self.landing_height(generated, side);
        // As seen from hips at no height.
        let ankle = leg.ankle + Vec3::Y * generated;
        let length = self.leg_lengths[side.index()];
        let reached = reach_height(Vec3::ZERO, leg.hip, ankle, length, MAX_STANCE_EXTENSION);
        reached.map_or(generated, |reached| reached.max(generated))
    }
}
