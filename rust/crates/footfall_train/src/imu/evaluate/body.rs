//! Bodies as they are compared: joints relative to the hips, headings brought together.

use footfall_core::rotation::{from_heading, heading};
use footfall_core::{JOINT_COUNT, Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_model::imu_model::BODY_COUNT;
use footfall_recon::body::pose_of;
use glam::Vec3;

/// Joints that are compared first when the nearest of many bodies is looked for.
const FIRST_JOINTS: usize = 8;

/// Places of all joints relative to the hips, with the hips' heading removed, metres.
pub(super) type Body = [Vec3; JOINT_COUNT];

/// Pose of a row of a chain or a model.
pub(super) fn pose_of_row(row: &[f32]) -> Pose {
    let mut body = [0.0; BODY_COUNT];
    body.copy_from_slice(row);
    let mut pose = Pose::default();
    pose_of(&body, 1.0, &mut pose);
    pose
}

pub(super) fn body(pose: &Pose, skeleton: &Skeleton) -> Body {
    let mut model = ModelPose::default();
    forward_kinematics(skeleton, pose, &mut model);
    let level = from_heading(-heading(pose.rotation(Joint::Hips)));
    let hips = model.position(Joint::Hips);
    model.positions.map(|position| level * (position - hips))
}

/// Mean distance of the joints, centimetres.
pub(super) fn distance_cm(a: &Body, b: &Body) -> f64 {
    cm(sum(a, b, 0..JOINT_COUNT))
}

/// Mean distance of the joints to the nearest of some bodies, centimetres; infinite without one.
pub(super) fn nearest_cm(bodies: &[Body], truth: &Body) -> f64 {
    let mut nearest = f32::INFINITY;
    for body in bodies {
        let first = sum(body, truth, 0..FIRST_JOINTS);
        if first < nearest {
            nearest = nearest.min(first + sum(body, truth, FIRST_JOINTS..JOINT_COUNT));
        }
    }
    cm(nearest)
}

/// Accelerations of a body from frame to frame, without the first and the last: root mean square over the joints, m/s².
pub(super) fn accelerations(bodies: &[Body], frame_rate_hz: f64) -> Vec<f64> {
    let frames = bodies.windows(3).map(|frames| {
        let joints = frames[0].iter().zip(&frames[1]).zip(&frames[2]);
        let squares = joints.map(|((a, b), c)| f64::from((*a - 2.0 * *b + *c).length_squared()));
        (squares.sum::<f64>() / JOINT_COUNT as f64).sqrt() * frame_rate_hz.powi(2)
    });
    frames.collect()
}

fn sum(a: &Body, b: &Body, joints: core::ops::Range<usize>) -> f32 {
    let pairs = a[joints.clone()].iter().zip(&b[joints]);
    pairs.map(|(a, b)| a.distance(*b)).sum()
}

fn cm(sum_m: f32) -> f64 {
    100.0 * f64::from(sum_m) / JOINT_COUNT as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn the_nearest_body_is_the_nearest_of_all() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let mut draw = || -> Body {
            core::array::from_fn(|_| Vec3::from_array([(); 3].map(|()| random.random())))
        };
        let bodies: Vec<Body> = (0..200).map(|_| draw()).collect();
        for _ in 0..50 {
            let truth = draw();
            let all = bodies.iter().map(|body| distance_cm(body, &truth));
            let least = all.fold(f64::INFINITY, f64::min);
            assert!((nearest_cm(&bodies, &truth) - least).abs() < 1e-4);
        }
        assert!(nearest_cm(&[], &bodies[0]).is_infinite());
    }

    #[test]
    fn a_jump_is_its_own_acceleration() {
        let at = |x: f32| [Vec3::X * x; JOINT_COUNT];
        let mut bodies: Vec<Body> = (0..10).map(|n| at(0.1 * n as f32)).collect();
        assert!(accelerations(&bodies, 30.0).iter().all(|a| *a < 1e-3));
        for body in &mut bodies[5..] {
            *body = body.map(|place| place + Vec3::X);
        }
        let greatest = accelerations(&bodies, 30.0).into_iter().fold(0.0, f64::max);
        assert!((greatest - 900.0).abs() < 1e-2, "{greatest}");
    }
}
