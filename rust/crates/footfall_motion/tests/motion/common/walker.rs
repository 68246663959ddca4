//! A walker of known steps: level hips, flat feet that stand exactly still, legs solved in closed form.

use footfall_core::{Clip, Joint, Pose, Side, Skeleton};
use glam::{Quat, Vec3};
use std::f32::consts::TAU;

/// Seconds from one landing of a foot to its next.
pub(crate) const STRIDE_SECS: f32 = 1.2;
/// Share of the stride for which a foot stands.
pub(crate) const STANCE: f32 = 0.62;
/// Metres a second.
pub(crate) const SPEED: f32 = 0.8;

/// When, in strides, the given foot lands for the first time (the left one at 0.2).
pub(crate) fn first_landing(side: Side) -> f32 {
    0.2 + 0.5 * side.index() as f32
}

/// Parameters of a walk. Lengths and speeds are those of the standard body; the walker's own are `size` times as much.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gait {
    pub(crate) stride_secs: f32,
    /// Share of the stride for which a foot stands.
    pub(crate) stance: f32,
    pub(crate) speed: f32,
    pub(crate) size: f32,
    /// Rotation of the heel over the flat toes by the time the foot lifts, radians.
    pub(crate) roll: f32,
    /// True when a foot swings off gently instead of at full speed.
    pub(crate) is_gentle: bool,
}

impl Gait {
    /// That of [`walker`].
    pub(crate) const PLAIN: Self = Self {
        stride_secs: STRIDE_SECS,
        stance: STANCE,
        speed: SPEED,
        size: 1.0,
        roll: 0.0,
        is_gentle: false,
    };

    /// Forward position and height of the toes' joint over its place on the ground, and how far the heel is raised, for a time in
    /// strides.
    fn foot_at(&self, side: Side, strides: f32) -> (f32, f32, f32) {
        let stride_m = self.size * self.speed * self.stride_secs;
        let since = strides - first_landing(side);
        let landing = since.floor();
        let phase = since - landing;
        // Halfway through the stance the hips are over the ankle.
        let landed_at = (landing + first_landing(side) + 0.5 * self.stance) * stride_m;
        if phase < self.stance {
            let raised = ((phase / self.stance - 0.6) / 0.4).max(0.0);
            (landed_at, 0.0, self.roll * raised * raised)
        } else {
            let swing = (phase - self.stance) / (1.0 - self.stance);
            let way = if self.is_gentle {
                swing * swing * (3.0 - 2.0 * swing)
            } else {
                swing
            };
            (
                landed_at + way * stride_m,
                0.1 * self.size * (TAU * 0.5 * swing).sin(),
                self.roll * (1.0 - swing) * (1.0 - swing),
            )
        }
    }

    /// `frames` frames of level walking along +Z, arms swinging with bent elbows.
    pub(crate) fn clip(&self, frame_rate_hz: f64, frames: usize) -> Clip {
        let skeleton = Skeleton::standard().scaled(self.size);
        let poses = (0..frames)
            .map(|frame| {
                let secs = frame as f32 / frame_rate_hz as f32;
                let strides = secs / self.stride_secs;
                let height = skeleton.hip_height() - 0.09 * self.size;
                let mut pose = Pose {
                    root_position: Vec3::new(0.0, height, self.size * self.speed * secs),
                    ..Pose::default()
                };
                for side in Side::BOTH {
                    let (forward, rise, raised) = self.foot_at(side, strides);
                    let hip = pose.root_position + skeleton.offset(side.upper_leg());
                    let toes = skeleton.offset(side.toes());
                    let flat = -skeleton.foot(side).heel.y;
                    let ankle = Vec3::new(0.0, flat + rise, forward) + toes
                        - Quat::from_rotation_x(raised) * toes;
                    bend_leg(&skeleton, &mut pose, side, ankle.z - hip.z, ankle.y - hip.y);
                    pose.rotations[side.foot().index()] *= Quat::from_rotation_x(raised);
                    pose.rotations[side.toes().index()] = Quat::from_rotation_x(-raised);
                    swing_arm(&mut pose, side, (strides - first_landing(side)) * TAU);
                }
                pose.rotations[Joint::Chest.index()] =
                    Quat::from_rotation_y(0.1 * (strides * TAU).sin());
                pose
            })
            .collect();
        Clip {
            skeleton,
            frame_rate_hz,
            poses,
        }
    }
}

/// `frames` frames of a walker with flat feet.
pub(crate) fn walker(frame_rate_hz: f64, frames: usize) -> Clip {
    Gait::PLAIN.clip(frame_rate_hz, frames)
}

pub(crate) fn bend_leg(skeleton: &Skeleton, pose: &mut Pose, side: Side, forward: f32, down: f32) {
    let thigh = skeleton.offset(side.lower_leg()).length();
    let shank = skeleton.offset(side.foot()).length();
    let reach = forward.hypot(down).min(thigh + shank - 1e-4);
    let at_hip = ((thigh * thigh + reach * reach - shank * shank) / (2.0 * thigh * reach)).acos();
    let bend = std::f32::consts::PI
        - ((thigh * thigh + shank * shank - reach * reach) / (2.0 * thigh * shank)).acos();
    let line = forward.atan2(-down);
    // Positive turns about +X swing the leg back.
    pose.rotations[side.upper_leg().index()] = Quat::from_rotation_x(-(line + at_hip));
    pose.rotations[side.lower_leg().index()] = Quat::from_rotation_x(bend);
    pose.rotations[side.foot().index()] = Quat::from_rotation_x(line + at_hip - bend);
}

fn swing_arm(pose: &mut Pose, side: Side, phase: f32) {
    let upper = side.upper_arm();
    let sign = side.sign();
    let hang = Quat::from_rotation_z(-1.3 * sign);
    pose.rotations[upper.index()] = Quat::from_rotation_x(0.4 * phase.cos()) * hang;
    pose.rotations[upper.index() + 1] = Quat::from_rotation_y(-sign * (0.5 + 0.2 * phase.cos()));
}

/// The mirror image of a clip: left and right change places.
pub(crate) fn mirrored(clip: &Clip) -> Clip {
    let mut mirrored = clip.clone();
    for (pose, original) in mirrored.poses.iter_mut().zip(&clip.poses) {
        pose.root_position.x = -original.root_position.x;
        for joint in Joint::ALL {
            let turn = original.rotation(joint.mirrored());
            pose.rotations[joint.index()] = Quat::from_xyzw(turn.x, -turn.y, -turn.z, turn.w);
        }
    }
    mirrored
}
