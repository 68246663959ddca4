//! [`Clip`] to a file of the canonical body.

use super::{BvhFile, BvhJoint, Channel};
use footfall_core::{Clip, Joint, Side, Skeleton};
use glam::{EulerRot, Quat, Vec3};

/// From wrist to fingertips, of the length of the forearm; the canonical body itself ends at the wrist.
const HAND_OF_FOREARM: f32 = 0.72;

/// The file of a clip: the 22 joints under their names, metres, Y up, a T-pose at zero rotations.
///
/// End Sites stand at the toe tips, the top of the head and the fingertips. The root has six channels, the other joints
/// three rotations. The root's `OFFSET` is zero, as some readers add it to the position channels and some replace it.
pub fn clip_to_bvh(clip: &Clip) -> BvhFile {
    let joints = Joint::ALL
        .into_iter()
        .map(|joint| canonical_joint(&clip.skeleton, joint))
        .collect();
    let mut values = Vec::with_capacity(clip.poses.len() * (3 + 3 * Joint::ALL.len()));
    for pose in &clip.poses {
        values.extend(
            pose.root_position
                .to_array()
                .map(|value| rounded(value, 1e6)),
        );
        for rotation in pose.rotations {
            values.extend(degrees_zxy(rotation).map(|value| rounded(value, 1e5)));
        }
    }
    BvhFile {
        joints,
        frame_time_secs: 1.0 / clip.frame_rate_hz,
        frame_count: clip.poses.len(),
        values,
    }
}

fn canonical_joint(skeleton: &Skeleton, joint: Joint) -> BvhJoint {
    let end_sites = match joint {
        Joint::Head => vec![skeleton.head_top],
        Joint::LeftToes => vec![skeleton.foot(Side::Left).toe_tip],
        Joint::RightToes => vec![skeleton.foot(Side::Right).toe_tip],
        Joint::LeftHand | Joint::RightHand => vec![skeleton.offset(joint) * HAND_OF_FOREARM],
        _ => Vec::new(),
    };
    let rotations = [Channel::ZRotation, Channel::XRotation, Channel::YRotation];
    let positions = [Channel::XPosition, Channel::YPosition, Channel::ZPosition];
    BvhJoint {
        name: joint.name().to_owned(),
        parent: joint.parent().map(Joint::index),
        offset: match joint.parent() {
            None => Vec3::ZERO,
            Some(_) => skeleton.offset(joint),
        },
        channels: match joint.parent() {
            None => [positions, rotations].concat(),
            Some(_) => rotations.to_vec(),
        },
        end_sites,
    }
}

/// Angles of Rz · Rx · Ry in degrees, in that order.
fn degrees_zxy(rotation: Quat) -> [f32; 3] {
    let (z, x, y) = rotation.to_euler(EulerRot::ZXY);
    [z, x, y].map(f32::to_degrees)
}

/// Drops the digits that are noise, and the sign of zero, to keep files small.
fn rounded(value: f32, per_unit: f64) -> f32 {
    ((f64::from(value) * per_unit).round() / per_unit) as f32 + 0.0
}
