//! Body whose posture changes over feet with their own places.

use footfall_core::ease::soft_min;
use footfall_core::rotation::exp_map;
use footfall_core::{Joint, Pose, Side, Skeleton};
use footfall_ik::{
    FootTarget, Leg, Plant, RockerFoot, foot_heading, foot_pitch, reach_height, settled_pitch,
};
use footfall_model::BESIDE_COUNT;
use footfall_model::layout::feature_offset;
use glam::Vec3;

/// Posture relative to standing: see [`BESIDE_COUNT`].
pub(super) type Beside = [f32; BESIDE_COUNT];

/// Fractions of the straight leg from which heels rise in a push-off, and at most.
const STRETCHED: f32 = 0.95;
const MOST_STRETCHED: f32 = 0.988;

/// Stretch of the legs as their feet leave the ground and land, as a fraction: nearly straight knees snap there.
const BENT: f32 = 0.965;

/// The same for a leg in the air, which straightens more.
const STRETCHED_ALOFT: f32 = 0.975;
const MOST_STRETCHED_ALOFT: f32 = 0.993;

/// Steepest pitch of a foot on its toes, radians: steeper ones carry the ankle over the toes, where it moves far for little height. Number of
/// bisections of a pitch, to a ten-thousandth.
const STEEPEST: f32 = 1.0;
const HALVINGS: usize = 13;

/// Legs and feet of one body.
#[derive(Clone, Debug)]
pub(super) struct Body {
    legs: [Leg; 2],
    pub(super) feet: [RockerFoot; 2],
    hip_from_hips: [Vec3; 2],
    leg_lengths: [f32; 2],
    /// Mean length of the legs, metres.
    pub(super) leg_length: f32,
}

impl Body {
    pub(super) fn new(skeleton: &Skeleton) -> Self {
        Self {
            legs: Side::BOTH.map(|side| Leg::new(skeleton, side)),
            feet: Side::BOTH.map(|side| RockerFoot::new(skeleton, side)),
            hip_from_hips: Side::BOTH.map(|side| skeleton.offset(side.upper_leg())),
            leg_lengths: Side::BOTH.map(|side| skeleton.leg_length(side)),
            leg_length: skeleton.mean_leg_length(),
        }
    }

    /// Returns the places of a pose's feet.
    pub(super) fn feet(&self, pose: &Pose) -> [FootTarget; 2] {
        self.legs.each_ref().map(|leg| leg.foot_of(pose))
    }

    /// Applies a posture relative to standing to a standing pose.
    pub(super) fn turn(beside: &Beside, pose: &mut Pose) {
        for joint in Joint::ALL {
            let at = feature_offset(joint);
            let turn = exp_map(Vec3::new(beside[at], beside[at + 1], beside[at + 2]));
            pose.rotations[joint.index()] *= turn;
        }
    }

    /// Returns the plants of a standing pose's feet.
    pub(super) fn plants(&self, pose: &Pose) -> [Plant; 2] {
        let stood = self.feet(pose);
        core::array::from_fn(|side| {
            let FootTarget { ankle, foot, .. } = stood[side];
            self.feet[side].plant_under(ankle, foot_heading(foot), foot_pitch(foot))
        })
    }

    /// Returns feet on displaced plants, at the pitch of a pose but not on the heels. With a `rise` of 1, heels rise until the legs
    /// reach the hips without being straight; with 0, legs may be straight.
    pub(super) fn on_toes(
        &self,
        plants: &[Plant; 2],
        moved: Vec3,
        rise: f32,
        pose: &Pose,
    ) -> [FootTarget; 2] {
        let feet = self.feet(pose);
        core::array::from_fn(|side| {
            let foot = &self.feet[side];
            let plant = Plant {
                flat_ankle: plants[side].flat_ankle + moved,
                ..plants[side]
            };
            let pitch = settled_pitch(foot_pitch(feet[side].foot).max(0.0)).min(STEEPEST);
            let hip = pose.root_position + pose.rotation(Joint::Hips) * self.hip_from_hips[side];
            let distance = |pitch: f32| hip.distance(foot.stand(&plant, pitch).ankle);
            let length = self.leg_lengths[side];
            let stretched = distance(pitch) / length;
            let wanted = (stretched
                + rise * (yielded(stretched, [STRETCHED, MOST_STRETCHED]) - stretched))
                * length;
            let (mut low, mut high) = (pitch, STEEPEST);
            if rise > 0.0 && distance(low) > wanted {
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if distance(middle) > wanted {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
            }
            foot.stand(&plant, low)
        })
    }

    /// Returns the greatest height of the hips at which both legs, a little bent, reach feet on their toes, metres.
    pub(super) fn highest(&self, pose: &Pose, plants: &[Plant; 2]) -> f32 {
        let hips = pose.root_position;
        let limits = [0, 1].map(|side: usize| {
            let hip = pose.rotation(Joint::Hips) * self.hip_from_hips[side];
            let ankle = self.feet[side].stand(&plants[side], STEEPEST).ankle;
            let reach = self.leg_lengths[side];
            reach_height(hips, hip, ankle, reach, BENT).unwrap_or(hips.y)
        });
        limits[0].min(limits[1])
    }

    /// Returns the stretch of the legs to their feet, as fractions of the straight leg.
    pub(super) fn stretched(&self, pose: &Pose, targets: &[FootTarget; 2]) -> [f32; 2] {
        core::array::from_fn(|side| {
            let hip = pose.root_position + pose.rotation(Joint::Hips) * self.hip_from_hips[side];
            hip.distance(targets[side].ankle) / self.leg_lengths[side]
        })
    }

    /// Lowers the hips of a pose until no leg is stretched beyond a limit; heights nearer to it than a few times `softness`, metres, count in part.
    pub(super) fn lower_to(
        &self,
        pose: &mut Pose,
        targets: &[FootTarget; 2],
        stretched: [f32; 2],
        softness: f32,
    ) {
        for side in 0..2 {
            let hip = pose.rotation(Joint::Hips) * self.hip_from_hips[side];
            let (ankle, length) = (targets[side].ankle, self.leg_lengths[side]);
            let limit = reach_height(pose.root_position, hip, ankle, length, stretched[side]);
            let height = &mut pose.root_position.y;
            *height = limit.map_or(*height, |limit| soft_min(*height, limit, softness));
        }
    }

    /// Draws feet in the air towards the hips if the legs would be straight.
    pub(super) fn within_reach(&self, pose: &Pose, targets: &mut [FootTarget; 2]) {
        for (side, target) in targets.iter_mut().enumerate() {
            let hip = pose.root_position + pose.rotation(Joint::Hips) * self.hip_from_hips[side];
            let way = target.ankle - hip;
            let stretched = way.length() / self.leg_lengths[side];
            if stretched > STRETCHED_ALOFT {
                let bounds = [STRETCHED_ALOFT, MOST_STRETCHED_ALOFT];
                target.ankle = hip + way * (yielded(stretched, bounds) / stretched);
            }
        }
    }

    /// Solves the legs to their feet.
    pub(super) fn stand(&self, targets: &[FootTarget; 2], pose: &mut Pose) {
        let (hips, rotation) = (pose.root_position, pose.rotation(Joint::Hips));
        for (leg, target) in self.legs.iter().zip(targets) {
            leg.solve(hips, rotation, target, pose);
        }
    }
}

/// Limits the stretch of a leg, as a fraction of the straight leg: progressively from the first bound on, so that no knee
/// snaps, and never beyond the second.
fn yielded(fraction: f32, [from, most]: [f32; 2]) -> f32 {
    let beyond = (fraction - from).max(0.0);
    let room = most - from;
    fraction.min(from) + room * (1.0 - (-beyond / room).exp())
}
