//! The standing foot: one point of its sole stays where it is, whatever the pitch.

use footfall_core::rotation::from_heading;
use footfall_core::{Side, Skeleton};
use footfall_ik::FootTarget;
use glam::{Quat, Vec3};

/// Smaller pitches than about this count as flat, radians: captured soles are not level to a degree.
const FLAT_PITCH: f32 = 0.09;
/// How far the toes bend up before the foot rises on their tips, radians.
const MOST_TOE_BEND: f32 = 0.94;

/// Where a foot was put: the ankle over a flat sole, and the heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plant {
    pub(crate) flat_ankle: Vec3,
    pub(crate) heading: f32,
}

/// The parts of a foot, in its own axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot {
    heel: Vec3,
    toe_joint: Vec3,
    ball: Vec3,
    toe_tip: Vec3,
}

impl Foot {
    pub(crate) fn new(skeleton: &Skeleton, side: Side) -> Self {
        let shape = skeleton.foot(side);
        Self {
            heel: shape.heel,
            toe_joint: skeleton.offset(side.toes()),
            ball: shape.ball,
            toe_tip: shape.toe_tip,
        }
    }

    /// The foot on its plant at a pitch (positive: heel up): it rolls over the heel, the toe joint and at last the tip of the
    /// toes, and none of them moves meanwhile.
    pub(crate) fn stand(&self, plant: &Plant, pitch: f32) -> FootTarget {
        let level = from_heading(plant.heading);
        let foot = level * Quat::from_rotation_x(pitch);
        if pitch <= 0.0 {
            let heel = plant.flat_ankle + level * self.heel;
            return FootTarget {
                ankle: heel - foot * self.heel,
                foot,
                toes: foot,
            };
        }
        let toes = level * Quat::from_rotation_x((pitch - MOST_TOE_BEND).max(0.0));
        let tip = plant.flat_ankle + level * (self.toe_joint + self.toe_tip);
        let toe_joint = tip - toes * self.toe_tip;
        FootTarget {
            ankle: toe_joint - foot * self.toe_joint,
            foot,
            toes,
        }
    }

    /// The plant of a foot that has its ankle over this point at this pitch.
    pub(crate) fn plant_under(&self, ankle: Vec3, heading: f32, pitch: f32) -> Plant {
        let mut plant = Plant {
            flat_ankle: Vec3::new(0.0, -self.heel.y, 0.0),
            heading,
        };
        let offset = self.stand(&plant, pitch).ankle;
        plant.flat_ankle.x = ankle.x - offset.x;
        plant.flat_ankle.z = ankle.z - offset.z;
        plant
    }

    /// Height of the lowest point of the sole.
    pub(crate) fn lowest(&self, target: &FootTarget) -> f32 {
        let toe_joint = target.ankle + target.foot * self.toe_joint;
        let heel = target.ankle + target.foot * self.heel;
        let ball = toe_joint + target.toes * self.ball;
        let tip = toe_joint + target.toes * self.toe_tip;
        heel.y.min(ball.y).min(tip.y)
    }
}

/// A captured pitch with small angles pulled to zero, so that a foot that means to be flat is flat.
pub(crate) fn settled(pitch: f32) -> f32 {
    pitch * pitch * pitch / (pitch * pitch + FLAT_PITCH * FLAT_PITCH)
}

/// Pitch (positive: heel up) and heading of a foot.
pub(crate) fn pitch_and_heading(rotation: Quat) -> (f32, f32) {
    let forward = rotation * Vec3::Z;
    (
        (-forward.y).clamp(-1.0, 1.0).asin(),
        forward.x.atan2(forward.z),
    )
}
