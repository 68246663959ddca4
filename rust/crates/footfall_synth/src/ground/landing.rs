//! Landing: the place of the next plant, and the straightness of the landing leg.

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

/// Largest fraction of the straight leg at landing; the remainder keeps the pelvis from dropping at once. A forward step lands straighter than
/// one to the side; a backward step lands on the toes, over a bent knee.
const LANDING_EXTENSION: f32 = 0.985;
const LANDING_FORWARDS: f32 = 0.0115;
const LANDING_BACKWARDS: f32 = 0.005;
/// Share of the turn between the landing and the flat foot by which a foot is turned at landing, and the largest such turn, radians.
const TURNED_SHARE: f32 = 0.6;
const MOST_TURN: f32 = 0.2;
/// Speed of a fall, m/s, beyond which the landing leg is less straight, and the decrease per m/s: the leg has to bend at once.
const EASY_FALL_MPS: f32 = 0.2;
const LANDING_BY_FALL: f32 = 0.03;
/// Speed of a fall beyond that of runners, m/s, from which the knee yields, and the decrease per m/s.
const HARD_FALL_MPS: f32 = 1.3;
const LANDING_BY_HARD_FALL: f32 = 0.012;

impl Planter {
    /// Returns the plant of the trailing foot at the end of the step.
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
        let heading = heading
            + lead
            + leg.heading()
            + self.turn_to_flat(generated, timing)
            + self.toes_out(side, course);
        let mut plant = foot.plant_under(ankle, heading, leg.pitch);
        let reach = self.landing_extension() * self.leg_lengths[side.index()];
        plant.flat_ankle += within_reach(foot.stand(&plant, leg.pitch).ankle - hip, reach);
        plant
    }

    /// Returns the turn of the trailing foot from landing to standing, radians. Heels strike with the toes still pointing outwards, and a planted foot does not turn,
    /// so it lands nearly with its flat heading. The standing foot shows the turn, mirrored, unless the step begins in its stance.
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
        let fall = self.state.hips_velocity.map_or(0.0, |velocity| -velocity.y);
        let bent = LANDING_BY_FALL * (fall - EASY_FALL_MPS).clamp(0.0, EASY_FALL_MPS)
            + LANDING_BY_HARD_FALL * (fall - HARD_FALL_MPS).max(0.0);
        LANDING_EXTENSION + LANDING_FORWARDS * strafe.uprightness()
            - LANDING_BACKWARDS * strafe.backwardness()
            - bent
    }

    /// Returns the greatest height of the hips at which a leg reaches its foot in the generated landing place.
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
