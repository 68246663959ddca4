//! Legs and hips of generated features before the body is placed on the ground.

use footfall_core::lanes::{LANES, Quatx8, Vec3x8, f32x8};
use footfall_core::{Joint, Pose, Side, Skeleton};
use footfall_ik::{FootTarget, RockerFoot, foot_heading, foot_pitch, foot_pitches, settled_pitch};
use glam::{Quat, Vec2, Vec3, Vec3Swizzles as _};

/// Least share of a leg's squared length that is left of it from the side.
const LEAST_HEIGHT: f32 = 0.25;

/// Greatest share of a leg's squared length by which its ankle is ahead of the hip joint, or behind it: no stride spreads the legs farther.
const MOST_SLANT: f32 = 0.45;

/// Stride, as a share of a walk's, below which feet are lifted less, and the parts of their lift and pitch that are left on the spot: people who step or turn on the spot lift flat feet
/// over knees bent by 35 to 45°, a walk's swing bends them by 65°.
const LIFTED_STRIDE: f32 = 0.9;
const SPOT_LIFT: f32 = 0.5;
const SPOT_PITCH: f32 = 0.1;

/// Reach of the legs in eight frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stride {
    /// Factor on their reach forwards and backwards.
    pub(crate) scale: f32x8,
    /// Straightness of landing and standing legs.
    pub(crate) upright: f32x8,
}

/// Lowering of the feet in eight frames of short strides.
struct Lowering {
    /// Parts of lift and pitch that are left.
    lift: f32x8,
    pitch: f32x8,
}

impl Lowering {
    /// Returns the lowering for strides of these shares of a walk's; `None` if none is short. Steps to the side and backwards, less than `upright`, keep their lift.
    fn of(stride: f32x8, upright: f32x8) -> Option<Self> {
        let short = stride.simd_lt(f32x8::splat(LIFTED_STRIDE));
        short.any().then(|| {
            let share = (stride * LIFTED_STRIDE.recip()).fast_min(f32x8::ONE);
            let spot = (f32x8::ONE - share * share) * upright;
            let left = |on_the_spot: f32| spot * (on_the_spot - 1.0) + f32x8::ONE;
            Self {
                lift: left(SPOT_LIFT),
                pitch: left(SPOT_PITCH),
            }
        })
    }

    /// Returns the squared lengths of lowered legs of these squared lengths; `straight` is the length of a straight one.
    fn lengthened(&self, squared: f32x8, straight: f32) -> f32x8 {
        let straight = f32x8::splat(straight);
        let length = straight - (straight - squared.sqrt()) * self.lift;
        length * length
    }

    /// Turns feet of these pitches to lower ones.
    fn flattened(&self, feet: Quatx8, pitch: &mut f32x8) -> Quatx8 {
        let before = *pitch;
        *pitch *= self.pitch;
        (feet * Quatx8::from_rotation_x(*pitch - before)).normalize()
    }
}

/// One generated frame, hips at the origin and heading removed.
#[derive(Clone, Debug, Default)]
pub(crate) struct GeneratedFrame {
    /// Rotation of the hips relative to the heading.
    pub(crate) hips: Quat,
    /// The legs, by side.
    pub(crate) legs: [GeneratedLeg; 2],
}

/// One leg of a generated frame, relative to the hips and the heading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GeneratedLeg {
    /// The hip joint, relative to the hips.
    pub(crate) hip: Vec3,
    /// The ankle, relative to the hips.
    pub(crate) ankle: Vec3,
    /// Rotation of the foot.
    pub(crate) foot: Quat,
    /// Its pitch (positive: heel up).
    pub(crate) free_pitch: f32,
    /// Pitch on the ground: settled, and smaller in short strides.
    pub(crate) pitch: f32,
    /// Target of the foot, on its plant or in the air; the planter fills it.
    pub(crate) target: FootTarget,
    /// Rise of the target's heel beyond the pitch, radians, for the leg to reach it; the planter fills it.
    pub(crate) rise: f32,
}

impl GeneratedLeg {
    /// Heading of the foot relative to the walker's.
    pub(crate) fn heading(&self) -> f32 {
        foot_heading(self.foot)
    }

    /// Returns the place of the ankle over the foot, were it flat.
    pub(super) fn flat_ankle(&self, foot: &RockerFoot) -> Vec3 {
        self.ankle - foot.roll(self.pitch)
    }

    /// Turns the leg about its hip joint so that the ankle moves to the left and ahead by `shift`.
    pub(crate) fn shift(&mut self, shift: Vec2) {
        let reach = self.ankle - self.hip;
        let level = reach.xz() + shift;
        let height = (reach.length_squared() - level.length_squared())
            .max(LEAST_HEIGHT * reach.length_squared());
        self.ankle = self.hip + Vec3::new(level.x, -height.sqrt(), level.y);
    }

    /// Moves the ankle, and pitches the foot to `free` in the air and to `standing` on the ground.
    pub(crate) fn put(&mut self, ankle: Vec3, free: f32, standing: f32) {
        self.ankle = ankle;
        let turned = self.foot * Quat::from_rotation_x(free - self.free_pitch);
        // The pitch of a foot whose toes hang straight down is less than its turn.
        let rest = free - foot_pitch(turned);
        self.foot = (turned * Quat::from_rotation_x(rest)).normalize();
        self.pitch = standing;
    }
}

impl Default for GeneratedLeg {
    fn default() -> Self {
        Self {
            hip: Vec3::ZERO,
            ankle: Vec3::ZERO,
            foot: Quat::IDENTITY,
            free_pitch: 0.0,
            pitch: 0.0,
            target: FootTarget {
                ankle: Vec3::ZERO,
                foot: Quat::IDENTITY,
                toes: Quat::IDENTITY,
            },
            rise: 0.0,
        }
    }
}

impl GeneratedFrame {
    /// Fills frames, eight at a time, from poses that hold generated local rotations (the hips' relative to the heading).
    /// `stride` returns the reach of the legs in eight frames from an index on.
    pub(crate) fn fill(
        frames: &mut [Self],
        poses: &[impl AsRef<Pose>],
        skeleton: &Skeleton,
        stride: impl Fn(usize) -> Stride,
    ) {
        let blocks = frames.chunks_mut(LANES).zip(poses.chunks(LANES));
        for (block, (frames, poses)) in blocks.enumerate() {
            let Stride { scale, upright } = stride(block * LANES);
            let of_poses = |joint: Joint| {
                Quatx8::gather(|lane| poses[lane.min(poses.len() - 1)].as_ref().rotation(joint))
            };
            let offset = |joint: Joint| Vec3x8::splat(skeleton.offset(joint));
            let hips = of_poses(Joint::Hips);
            let lowering = Lowering::of(scale, upright);
            for side in Side::BOTH {
                let thigh = hips * of_poses(side.upper_leg());
                let shank = thigh * of_poses(side.lower_leg());
                let mut foot = shank * of_poses(side.foot());
                let hip = hips * offset(side.upper_leg());
                let reach = thigh * offset(side.lower_leg()) + shank * offset(side.foot());
                let mut squared = reach.x * reach.x + reach.y * reach.y + reach.z * reach.z;
                let x = reach.x;
                let most = (squared * MOST_SLANT - x * x).fast_max(f32x8::ZERO).sqrt();
                let z = (reach.z * scale).fast_min(most).fast_max(-most);
                let mut free_pitch = foot_pitches(foot);
                // A shorter stride lands flatter and pushes off less.
                let pitch = settled_pitch(free_pitch * scale.fast_min(f32x8::ONE));
                if let Some(lowering) = &lowering {
                    let straight = skeleton.leg_length(side);
                    squared = lowering.lengthened(squared, straight);
                    foot = lowering.flattened(foot, &mut free_pitch);
                }
                let height = (squared - x * x - z * z).fast_max(squared * LEAST_HEIGHT);
                let y = -height.sqrt();
                let ankle = hip + Vec3x8 { x, y, z };
                let foot = foot.lanes();
                for (lane, frame) in frames.iter_mut().enumerate() {
                    let leg = &mut frame.legs[side.index()];
                    leg.hip = hip.lane(lane);
                    leg.ankle = ankle.lane(lane);
                    leg.foot = foot[lane];
                    leg.rise = 0.0;
                    leg.free_pitch = free_pitch.as_array()[lane];
                    leg.pitch = pitch.as_array()[lane];
                }
            }
            for (frame, pose) in frames.iter_mut().zip(poses) {
                frame.hips = pose.as_ref().rotation(Joint::Hips);
            }
        }
    }
}

/// Returns the place of a foot at the end of its generated leg.
pub(super) fn free_foot(
    generated: &GeneratedFrame,
    side: Side,
    hips: Vec3,
    level: Quat,
) -> FootTarget {
    let leg = &generated.legs[side.index()];
    let foot = level * leg.foot;
    FootTarget {
        ankle: hips + level * leg.ankle,
        foot,
        toes: foot,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::rotation::exp_map;
    use footfall_core::{ModelPose, forward_kinematics};

    #[test]
    fn legs_are_where_forward_kinematics_has_them() {
        let skeleton = Skeleton::standard();
        let poses: Vec<Pose> = (0..13)
            .map(|frame| {
                let mut pose = Pose::default();
                for (joint, rotation) in pose.rotations.iter_mut().enumerate() {
                    let turn = |axis: usize| ((frame * 7 + joint * 3 + axis) as f32).sin();
                    *rotation = exp_map(0.2 * Vec3::new(turn(0), turn(1), turn(2)));
                }
                pose
            })
            .collect();
        let mut frames = vec![GeneratedFrame::default(); poses.len()];
        let stride = Stride {
            scale: f32x8::splat(1.25),
            upright: f32x8::ONE,
        };
        GeneratedFrame::fill(&mut frames, &poses, &skeleton, |_| stride);
        for (frame, pose) in frames.iter().zip(&poses) {
            let mut model = ModelPose::default();
            forward_kinematics(&skeleton, pose, &mut model);
            for side in Side::BOTH {
                let leg = &frame.legs[side.index()];
                let hip = model.position(side.upper_leg());
                let straight = model.position(side.foot()) - hip;
                let mut reach = straight * Vec3::new(1.0, 0.0, 1.25);
                reach.y = -(straight.length_squared() - reach.length_squared()).sqrt();
                assert!(leg.hip.distance(hip) < 1e-6);
                assert!(leg.ankle.distance(hip + reach) < 1e-6);
                let forward = model.rotation(side.foot()) * Vec3::Z;
                assert!((leg.free_pitch + forward.y.asin()).abs() < 1e-5);
            }
        }
    }
}
