//! The standing foot: it rolls over heel, ball and toe tip without sliding.
//!
//! A standing foot has a fixed heading and one degree of freedom, its pitch. With the toes up it turns about the back
//! edge of the heel; flat, it rests; with the heel up it turns about the toe joint while the toes stay flat; past the
//! toes' range it turns about their tip. Every pivot is a point of the ground, so a foot driven by pitch alone cannot
//! slide or sink.

use crate::leg::{FootTarget, FootTargetx8};
use core::f32::consts::FRAC_PI_3;
use core::ops::{Add, Div, Mul};
use footfall_core::GroundTransform;
use footfall_core::lanes::{Quatx8, Vec3x8, f32x8};
use footfall_core::rotation::from_heading;
use footfall_core::{FootShape, Side, Skeleton};
use glam::{Quat, Vec3};

/// Largest angle by which the toes bend up before the foot rises on their tips, radians.
const MAX_TOE_FLEXION: f32 = 0.9 * FRAC_PI_3;

/// Pitches much smaller than this count as flat, radians: captured soles are not level to a degree.
const FLAT_PITCH: f32 = 0.09;

/// Half the breadth of a sole under its heel, ball and toe tip, as shares of its length. Adults' feet are 0.27 of their length broad at the
/// heel and 0.38 at the ball (ANSUR II, Gordon et al. 2014); toes taper.
const HALF_BREADTHS: [f32; 3] = [0.135, 0.19, 0.12];

/// Place where a foot was put.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    /// Position of the ankle when the sole is flat on the ground, metres.
    pub flat_ankle: Vec3,
    /// Heading of the foot, radians.
    pub heading: f32,
}

impl Plant {
    /// The same foot of a walker who is at `to` instead of at `from`.
    #[must_use]
    pub fn moved(&self, from: &GroundTransform, to: &GroundTransform) -> Self {
        let turn = to.heading - from.heading;
        Self {
            flat_ankle: to.position + from_heading(turn) * (self.flat_ankle - from.position),
            heading: self.heading + turn,
        }
    }
}

/// The parts of a foot that the rocker needs, in the axes of the foot.
#[derive(Clone, Copy, Debug)]
pub struct RockerFoot {
    heel: Vec3,
    toe_joint: Vec3,
    ball: Vec3,
    toe_tip: Vec3,
}

impl RockerFoot {
    /// One foot of a body.
    pub fn new(skeleton: &Skeleton, side: Side) -> Self {
        let FootShape {
            heel,
            ball,
            toe_tip,
        } = *skeleton.foot(side);
        Self {
            heel,
            toe_joint: skeleton.offset(side.toes()),
            ball,
            toe_tip,
        }
    }

    /// Height of the ankle above the ground when the sole is flat.
    pub fn ankle_height(&self) -> f32 {
        -self.heel.y
    }

    /// The plant that has the ankle above this point of the ground at this pitch.
    pub fn plant_under(&self, ankle: Vec3, heading: f32, pitch: f32) -> Plant {
        let offset = from_heading(heading) * self.roll(pitch);
        Plant {
            flat_ankle: Vec3::new(ankle.x - offset.x, self.ankle_height(), ankle.z - offset.z),
            heading,
        }
    }

    /// Returns the target of a foot that stands on its plant at this pitch (positive: heel up).
    pub fn stand(&self, plant: &Plant, pitch: f32) -> FootTarget {
        self.stand_level(plant, from_heading(plant.heading), pitch)
    }

    /// As [`stand`](Self::stand), with the rotation of the plant's heading about +Y at hand.
    pub fn stand_level(&self, plant: &Plant, level: Quat, pitch: f32) -> FootTarget {
        self.stand_many(plant, level, f32x8::splat(pitch)).lane(0)
    }

    /// As [`stand_level`](Self::stand_level) at eight pitches of at most half a turn.
    pub fn stand_many(&self, plant: &Plant, level: Quat, pitch: f32x8) -> FootTargetx8 {
        let foot = Quatx8::from_rotation_x(pitch);
        let excess = pitch - f32x8::splat(MAX_TOE_FLEXION);
        let toes = Quatx8::from_rotation_x(excess.fast_max(f32x8::ZERO));
        let heel_up = pitch.simd_gt(f32x8::ZERO);
        let about_heel = Vec3x8::splat(self.heel) - pitched(foot, self.heel);
        let tip = Vec3x8::splat(self.toe_joint + self.toe_tip);
        let about_toes = tip - pitched(toes, self.toe_tip) - pitched(foot, self.toe_joint);
        let level = Level::of(level);
        FootTargetx8 {
            ankle: Vec3x8::splat(plant.flat_ankle) + level.turn(about_toes.or(about_heel, heel_up)),
            foot: level.turn_pitched(foot),
            toes: level.turn_pitched(toes.or(foot, heel_up)),
        }
    }

    /// The least pitches from `least` on, heel up with flat toes, at which the ankle is no farther than `reach` from a point `from_plant`, seen from the
    /// plant's flat ankle and in the axes of its heading; the pitches that come nearest to it, where none does.
    pub fn pitches_within_reach(&self, from_plant: Vec3x8, reach: f32x8, least: f32x8) -> f32x8 {
        let joint = self.toe_joint;
        let away = from_plant - Vec3x8::splat(joint);
        // The squared distance is that of both from the toe joint, and twice cosine · cos(pitch) + sine · sin(pitch).
        let cosine = away.y * joint.y + away.z * joint.z;
        let sine = away.z * joint.y - away.y * joint.z;
        let squares = away.length_squared() + f32x8::splat(joint.length_squared());
        let wanted = (reach * reach - squares) * 0.5 - away.x * joint.x;
        let most = (cosine * cosine + sine * sine).sqrt();
        let most = most.fast_max(f32x8::splat(f32::MIN_POSITIVE));
        let before = (-wanted / most)
            .fast_max(-f32x8::ONE)
            .fast_min(f32x8::ONE)
            .acos();
        let nearest = (-sine).atan2(-cosine);
        let highest = least.fast_max(f32x8::splat(MAX_TOE_FLEXION));
        (nearest - before).fast_max(least).fast_min(highest)
    }

    /// Displacement of the ankle at this pitch from its place over the flat foot, for a foot that points to +Z.
    pub fn roll(&self, pitch: f32) -> Vec3 {
        let flat = Plant {
            flat_ankle: Vec3::ZERO,
            heading: 0.0,
        };
        self.stand_level(&flat, Quat::IDENTITY, pitch).ankle
    }

    /// Height of the sole's lowest point, metres.
    pub fn lowest_point(&self, target: &FootTarget) -> f32 {
        self.lowest_points(&FootTargetx8::splat(target)).as_array()[0]
    }

    /// As [`lowest_point`](Self::lowest_point) of eight feet.
    pub fn lowest_points(&self, targets: &FootTargetx8) -> f32x8 {
        let height = |rotations: Quatx8, point: Vec3| (rotations * Vec3x8::splat(point)).y;
        let toe_joint = height(targets.foot, self.toe_joint);
        let heel = height(targets.foot, self.heel);
        let ball = toe_joint + height(targets.toes, self.ball);
        let tip = toe_joint + height(targets.toes, self.toe_tip);
        targets.ankle.y + heel.fast_min(ball).fast_min(tip)
    }

    /// Back edge of the heel, ball and toe tip of a flat sole, from the ground under the ankle and in the axes of the foot.
    pub fn sole_points(&self) -> [Vec3; 3] {
        let flat = |point: Vec3| Vec3::new(point.x, 0.0, point.z);
        [
            flat(self.heel),
            flat(self.toe_joint + self.ball),
            flat(self.toe_joint + self.toe_tip),
        ]
    }

    /// Half the breadth of the sole at its [points](Self::sole_points), metres.
    pub fn half_breadths(&self) -> [f32; 3] {
        let [heel, _, tip] = self.sole_points();
        HALF_BREADTHS.map(|share| share * (tip.z - heel.z))
    }

    /// The rim of a flat sole to the left and to the right of its [points](Self::sole_points), in the same axes.
    pub fn sole_rim(&self) -> [[Vec3; 2]; 3] {
        beside(self.sole_points(), self.half_breadths(), [Vec3::X; 3])
    }

    /// [That rim](Self::sole_rim) of a foot that does not lie flat, to the left and to the right of its [points](Self::points).
    pub fn rim(&self, target: &FootTarget) -> [[Vec3; 2]; 3] {
        let [foot, toes] = [target.foot, target.toes].map(|rotation| rotation * Vec3::X);
        beside(
            self.points(target),
            self.half_breadths(),
            [foot, toes, toes],
        )
    }

    /// The middle of a flat sole, ahead of the ankle.
    pub fn sole_middle(&self) -> Vec3 {
        let [heel, _, tip] = self.sole_points();
        Vec3::Z * (0.5 * (heel.z + tip.z))
    }

    /// Displacement of the ankle at this pitch from its place over the flat foot, for a foot in the air that points to +Z and keeps the
    /// middle of its sole in place.
    pub fn tilt(&self, pitch: f32) -> Vec3 {
        let middle = self.sole_middle() - Vec3::Y * self.ankle_height();
        middle - Quat::from_rotation_x(pitch) * middle
    }

    /// [Those points](Self::sole_points) of a foot that does not lie flat.
    pub fn points(&self, target: &FootTarget) -> [Vec3; 3] {
        let toe_joint = target.ankle + target.foot * self.toe_joint;
        [
            target.ankle + target.foot * self.heel,
            toe_joint + target.toes * self.ball,
            toe_joint + target.toes * self.toe_tip,
        ]
    }

    /// The ground under the ankle of a flat foot: where a footprint is drawn.
    pub fn footprint(plant: &Plant) -> Vec3 {
        Vec3::new(plant.flat_ankle.x, 0.0, plant.flat_ankle.z)
    }
}

/// A rotation about +Y: products with it are what they are with any rotation, without what is multiplied by zero.
#[derive(Clone, Copy)]
struct Level {
    y: f32x8,
    w: f32x8,
}

impl Level {
    fn of(rotation: Quat) -> Self {
        Self {
            y: f32x8::splat(rotation.y),
            w: f32x8::splat(rotation.w),
        }
    }

    fn turn(self, vector: Vec3x8) -> Vec3x8 {
        let Vec3x8 { x, y, z } = vector;
        let [turned_x, turned_z] = [self.y * z, -(self.y * x)];
        let [twice_x, twice_z] = [turned_x + turned_x, turned_z + turned_z];
        Vec3x8 {
            x: x + twice_x * self.w + self.y * twice_z,
            y,
            z: z + twice_z * self.w - self.y * twice_x,
        }
    }

    /// After rotations about +X.
    fn turn_pitched(self, rotation_x: Quatx8) -> Quatx8 {
        let Quatx8 { x, w, .. } = rotation_x;
        Quatx8 {
            x: x * self.w,
            y: self.y * w,
            z: -(self.y * x),
            w: self.w * w,
        }
    }
}

/// The places to the left and to the right of points, at their breadths.
fn beside(points: [Vec3; 3], breadths: [f32; 3], left: [Vec3; 3]) -> [[Vec3; 2]; 3] {
    core::array::from_fn(|index| {
        let aside = left[index] * breadths[index];
        [points[index] + aside, points[index] - aside]
    })
}

/// A point of the foot, turned about +X.
fn pitched(rotation_x: Quatx8, point: Vec3) -> Vec3x8 {
    let Quatx8 { x, w, .. } = rotation_x;
    let (sine, cosine) = (x * w * 2.0, w * w - x * x);
    Vec3x8 {
        x: f32x8::splat(point.x),
        y: cosine * point.y - sine * point.z,
        z: sine * point.y + cosine * point.z,
    }
}

/// A captured or generated foot pitch, or eight, with small angles pulled to zero, so that a foot that means to be flat is flat.
pub fn settled_pitch<T>(pitch: T) -> T
where
    T: Copy + From<f32> + Add<Output = T> + Mul<Output = T> + Div<Output = T>,
{
    let squared = pitch * pitch;
    pitch * squared / (squared + T::from(FLAT_PITCH * FLAT_PITCH))
}

/// Pitch (positive: heel up) of a foot from its rotation.
pub fn foot_pitch(rotation: Quat) -> f32 {
    let forward = rotation * Vec3::Z;
    (-forward.y).clamp(-1.0, 1.0).asin()
}

/// As [`foot_pitch`] of eight feet.
pub fn foot_pitches(rotations: Quatx8) -> f32x8 {
    let forward = rotations * Vec3x8::splat(Vec3::Z);
    (-forward.y)
        .fast_max(-f32x8::ONE)
        .fast_min(f32x8::ONE)
        .asin()
}

/// Heading of a foot from its rotation.
pub fn foot_heading(rotation: Quat) -> f32 {
    let forward = rotation * Vec3::Z;
    forward.x.atan2(forward.z)
}

/// Heading and pitch of a foot whose toes may point straight down, where its forward axis has no heading: by its sideways axis.
pub(crate) fn foot_attitude(rotation: Quat) -> (f32, f32) {
    let left = rotation * Vec3::X;
    let heading = (-left.z).atan2(left.x);
    let forward = from_heading(-heading) * rotation * Vec3::Z;
    (heading, (-forward.y).atan2(forward.z))
}

#[cfg(test)]
mod tests;
