//! A walker whose knees bend as people's do, and the same one as a badly fitted skeleton shows them.

use super::walker::bend_leg;
use footfall_core::{Clip, Joint, ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_motion::bvh::{BvhFile, clip_to_bvh};
use glam::{EulerRot, Quat, Vec3};

const STRIDE_SECS: f32 = 1.1;
const STRIDE_M: f32 = 1.25;
const STANCE: f32 = 0.62;

/// Flexion over the first half of the stride, degrees, at every twentieth of a stride.
const KNEE: [f32; 11] = [
    5.0, 12.0, 18.0, 20.0, 19.0, 16.0, 12.0, 10.0, 9.0, 11.0, 15.0,
];

/// Distance from hip joint to ankle at a share of the stride.
fn leg_length_at(skeleton: &Skeleton, share: f32) -> f32 {
    let at = (share * 20.0).clamp(0.0, 9.999);
    let (index, rest) = (at as usize, at.fract());
    let flexion = (KNEE[index] + rest * (KNEE[index + 1] - KNEE[index])).to_radians();
    skeleton.leg_length(Side::Left) * (0.5 * flexion).cos()
}

/// Height of the hip joints over a flat foot's ankle.
fn hip_height_at(skeleton: &Skeleton, share: f32) -> f32 {
    let aside = (share - 0.25) * STRIDE_M;
    let length = leg_length_at(skeleton, share);
    (length * length - aside * aside).sqrt()
}

/// Forward position and height of an ankle above its height on the flat foot, `strides` after its first landing.
fn ankle_at(skeleton: &Skeleton, strides: f32) -> (f32, f32) {
    // The ankle rises late in stance so that the hips neither jump nor sink when the other leg takes over.
    let rise_at = |share: f32| {
        let whole = hip_height_at(skeleton, 0.0) - hip_height_at(skeleton, 0.5);
        whole * ((share - 0.3) / 0.2).max(0.0)
    };
    let landing = strides.floor();
    let share = strides - landing;
    let landed = (landing + 0.25) * STRIDE_M;
    if share < STANCE {
        return (landed, rise_at(share));
    }
    let swing = (share - STANCE) / (1.0 - STANCE);
    let from = rise_at(STANCE);
    let smooth = swing * swing * (3.0 - 2.0 * swing);
    let lifted = 0.1 * (std::f32::consts::PI * swing).sin() + from * (1.0 - swing);
    (landed + smooth * STRIDE_M, lifted)
}

/// Frames of level walking along +Z with the knees of people, bent `crouch` metres deeper.
pub(crate) fn natural_walker(frame_rate_hz: f64, frames: usize, crouch: f32) -> Clip {
    let skeleton = Skeleton::standard();
    let ankle_height = -skeleton.foot(Side::Left).heel.y;
    let hip_drop = skeleton.offset(Side::Left.upper_leg()).y;
    let poses = (0..frames).map(|frame| {
        let strides = frame as f32 / frame_rate_hz as f32 / STRIDE_SECS;
        let lead = (2.0 * strides).floor() / 2.0;
        let hips = ankle_height + hip_height_at(&skeleton, strides - lead) - hip_drop - crouch;
        let mut pose = Pose {
            root_position: Vec3::new(0.0, hips, strides * STRIDE_M),
            ..Pose::default()
        };
        for side in Side::BOTH {
            let offset = 0.5 * side.index() as f32;
            let (along, rise) = ankle_at(&skeleton, strides + offset);
            let hip = pose.root_position + skeleton.offset(side.upper_leg());
            let forward = along - offset * STRIDE_M - hip.z;
            bend_leg(
                &skeleton,
                &mut pose,
                side,
                forward,
                ankle_height + rise - hip.y,
            );
        }
        pose
    });
    Clip {
        poses: poses.collect(),
        skeleton,
        frame_rate_hz,
    }
}

/// The walker as a skeleton shows them whose hip joints lie `offset` (in the pelvis' axes, metres) from where they are:
/// ankles and feet stay, thigh and shank keep their lengths, the knee makes up for it.
pub(crate) fn misfitted(clip: &Clip, offset: Vec3) -> BvhFile {
    let mut wrong = clip.clone();
    for side in Side::BOTH {
        wrong.skeleton.offsets[side.upper_leg().index()] += offset;
    }
    let mut model = ModelPose::default();
    for (pose, right) in wrong.poses.iter_mut().zip(&clip.poses) {
        forward_kinematics(&clip.skeleton, right, &mut model);
        for side in Side::BOTH {
            let hip = right.root_position
                + right.rotation(Joint::Hips) * wrong.skeleton.offset(side.upper_leg());
            let to_ankle = model.position(side.foot()) - hip;
            bend_leg(&wrong.skeleton, pose, side, to_ankle.z, to_ankle.y);
            // The foot keeps its turn in space.
            let above = pose.rotation(side.upper_leg()) * pose.rotation(side.lower_leg());
            pose.rotations[side.foot().index()] = above.inverse() * model.rotation(side.foot());
        }
    }
    clip_to_bvh(&wrong)
}

/// Flexion of a knee in a frame, degrees.
pub(crate) fn knee_degrees(clip: &Clip, frame: usize, side: Side) -> f32 {
    let turn = clip.poses[frame].rotation(side.lower_leg());
    let (x, _, _) = turn.to_euler(EulerRot::XYZ);
    Quat::from_rotation_x(x).to_scaled_axis().x.to_degrees()
}
