//! Landings that the animation announces, and the steps that lead there.

use crate::placement::aim::Step;
use crate::placement::effort::slowed_by;
use crate::placement::foot::Scene;
use crate::placement::frame::Frame;
use crate::placement::terrain::Terrain;
use crate::placement::{FootPlacer, PlacementConfig, PlacementInput};
use glam::Vec3;

/// Steps that have to be longer or shorter by less are right as they are.
const SAME_SHARE: f32 = 0.02;
/// Grade above which a run becomes a walk.
const STEEP: f32 = 0.25;

/// Time before a landing from which a contact is taken for it, seconds: an animation may report a contact some frames early.
const NOW_SECS: f32 = 0.05;

/// Place where the animation will put a foot, relative to the animation's floor now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// The flat sole: origin on the floor under the ankle, +Z to the toes.
    pub flat: Frame,
    /// Time until it lands, seconds.
    pub secs: f32,
    /// Positions of the hips and both ankles then, metres.
    pub hips: Vec3,
    /// The left ankle and the right.
    pub ankles: [Vec3; 2],
}

impl Landing {
    /// Returns true for the landing of a contact that is due or reported already.
    pub(super) fn is_now(&self) -> bool {
        self.secs < NOW_SECS
    }
}

impl FootPlacer {
    /// Share of its speed that a walker keeps on the ground under it and on that ahead.
    pub fn pace(&self) -> f32 {
        slowed_by(self.grade).min(slowed_by(self.grade_ahead))
    }

    /// Returns true where nobody runs: on stairs and on grades of more than a quarter, under the walker or ahead.
    pub fn is_steep(&self) -> bool {
        self.grade.abs().max(self.grade_ahead.abs()) > STEEP
    }

    /// Grade of the way: of the ground under the feet and of that ahead, in equal parts; rise by run, positive uphill.
    pub fn way_grade(&self) -> f32 {
        0.5 * (self.grade + self.grade_ahead)
    }

    /// Length that the step that has just begun needs for its foot to find ground within reach, as a share of its own; `None` for a step
    /// that is right as it is. For walks that can change their steps: pass the new landing to [`step`](Self::step) once they have.
    pub fn step_share(
        &mut self,
        input: &PlacementInput,
        terrain: &mut impl Terrain,
    ) -> Option<f32> {
        let next = input.landings.iter().position(Option::is_some);
        if next == self.aimed || input.airborne {
            return None;
        }
        self.aimed = next;
        let (config, mut feet) = (self.config, self.feet);
        let mut scene = self.scene(0.0, input, terrain, &config);
        let step = self.next_step(&mut scene, input, next?, true)?;
        let aim = step.aim(&mut scene);
        feet[next?].set_plan(aim.as_ref());
        self.feet = feet;
        let aim = aim?;
        self.grade_ahead = aim.grade;
        ((aim.share - 1.0).abs() > SAME_SHARE).then_some(aim.share)
    }

    pub(super) fn scene<'a, T: Terrain>(
        &self,
        dt_secs: f32,
        input: &PlacementInput,
        terrain: &'a mut T,
        config: &'a PlacementConfig,
    ) -> Scene<'a, T> {
        let floor = input.world_from_floor;
        Scene {
            terrain,
            world_from_floor: floor,
            config,
            soles_m: self.memory.map_or([0.0; 2], |memory| {
                let [left, right] = memory.soles.map(|sole| floor.local_point(sole.position).y);
                [left.min(right), left.max(right)]
            }),
            dt_secs,
        }
    }

    /// The next step of this foot, where the animation knows it and the other foot has ground to stand on.
    pub(super) fn next_step<'a, T: Terrain>(
        &'a self,
        scene: &mut Scene<'_, T>,
        input: &'a PlacementInput,
        index: usize,
        may_stretch: bool,
    ) -> Option<Step<'a>> {
        let landing = input.landings[index].as_ref()?;
        let other = &self.feet[1 - index];
        let planned = other.plan.map(|plan| plan.foothold);
        let held = other
            .hold
            .or(planned.filter(|_| input.landings[1 - index].is_none()));
        let standing = held.and_then(|hold| hold.world_from_sole(scene.terrain));
        let standing = standing.or_else(|| {
            let ankle = landing.ankles[1 - index];
            let (height, _) = scene.ground(ankle)?;
            let place = Vec3::new(ankle.x, height, ankle.z);
            Some(Frame {
                position: scene.world_from_floor.point(place),
                ..scene.world_from_floor
            })
        })?;
        Some(Step {
            standing,
            landing,
            rocker: &self.rockers[index],
            leg_m: self.leg_lengths[index],
            grade: self.grade,
            may_stretch,
        })
    }
}
