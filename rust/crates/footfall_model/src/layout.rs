//! Encoding of a pose as a vector of features, and decoding.
//!
//! A frame has [`FEATURE_COUNT`] static features: the exponential map of every joint's local rotation, three numbers a
//! joint in the order of [`Joint::ALL`]; the hips' with the walker's heading removed (Tilmanne et al. 2012, section 4).
//! An observation appends the first and second time differences (equations 2 and 3): statics, Δ, Δ².

use core::ops::Neg;
use footfall_core::rotation::{exp_maps, from_heading, log_map, log_map_near};
use footfall_core::{JOINT_COUNT, Joint, Pose};
use glam::{Quat, Vec3};

/// Static features of one frame.
pub const FEATURE_COUNT: usize = 3 * JOINT_COUNT;

/// Static and dynamic features of one frame.
pub const OBSERVATION_COUNT: usize = 3 * FEATURE_COUNT;

/// Returns the first of a joint's three features.
pub const fn feature_offset(joint: Joint) -> usize {
    3 * joint.index()
}

/// Writes the static features of a pose to `out` (length [`FEATURE_COUNT`]).
///
/// `heading` is the walker's heading, removed from the hips. With `previous`, the features of the frame before, each
/// joint takes the equivalent vector nearest to it, so that a series stays continuous.
///
/// # Panics
/// When a slice is shorter than [`FEATURE_COUNT`].
pub fn encode(pose: &Pose, heading: f32, previous: Option<&[f64]>, out: &mut [f64]) {
    for joint in Joint::ALL {
        let offset = feature_offset(joint);
        let rotation = match joint {
            Joint::Hips => from_heading(-heading) * pose.rotation(joint),
            _ => pose.rotation(joint),
        };
        let vector = match previous {
            Some(previous) => log_map_near(rotation, read_vector(previous, offset)),
            None => log_map(rotation),
        };
        out[offset..offset + 3].copy_from_slice(&vector.as_dvec3().to_array());
    }
}

/// Local rotations from static features; the hips' are relative to the heading.
///
/// # Panics
/// When `features` is shorter than [`FEATURE_COUNT`].
pub fn decode(features: &[f32], rotations: &mut [Quat; JOINT_COUNT]) {
    exp_maps(&features[..FEATURE_COUNT], rotations);
}

/// Mirrors static or dynamic features of one frame left to right, in place.
///
/// A rotation vector mirrored in the plane x = 0 keeps its x component and changes the sign of y and z; left and right
/// joints change places.
///
/// # Panics
/// When `features` is not a whole number of frames of [`FEATURE_COUNT`].
pub fn mirror<T: Copy + Neg<Output = T>>(features: &mut [T]) {
    assert!(
        features.len().is_multiple_of(FEATURE_COUNT),
        "features come in blocks of {FEATURE_COUNT}"
    );
    for block in features.chunks_exact_mut(FEATURE_COUNT) {
        for joint in Joint::ALL {
            let (own, other) = (feature_offset(joint), feature_offset(joint.mirrored()));
            if own < other {
                for axis in 0..3 {
                    block.swap(own + axis, other + axis);
                }
            }
        }
        for vector in block.chunks_exact_mut(3) {
            vector[1] = -vector[1];
            vector[2] = -vector[2];
        }
    }
}

fn read_vector(features: &[f64], offset: usize) -> Vec3 {
    Vec3::new(
        features[offset] as f32,
        features[offset + 1] as f32,
        features[offset + 2] as f32,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::rotation::exp_map;
    use footfall_core::{ModelPose, Skeleton, forward_kinematics};
    use proptest::prelude::*;

    fn any_pose() -> impl Strategy<Value = Pose> {
        proptest::collection::vec(-1.4_f32..1.4, FEATURE_COUNT).prop_map(|values| {
            let mut pose = Pose::default();
            for (rotation, value) in pose.rotations.iter_mut().zip(values.chunks_exact(3)) {
                *rotation = exp_map(Vec3::from_slice(value));
            }
            pose
        })
    }

    proptest! {
        #[test]
        fn decoding_undoes_encoding(pose in any_pose(), heading in -3.0_f32..3.0) {
            let mut features = [0.0; FEATURE_COUNT];
            encode(&pose, heading, None, &mut features);
            let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
            decode(&features.map(|value| value as f32), &mut rotations);
            rotations[0] = from_heading(heading) * rotations[0];
            for (decoded, original) in rotations.iter().zip(&pose.rotations) {
                prop_assert!(decoded.angle_between(*original) < 2e-3);
            }
        }

        #[test]
        fn mirrored_features_are_the_mirrored_body(pose in any_pose()) {
            let skeleton = Skeleton::standard();
            let mut features = [0.0; FEATURE_COUNT];
            encode(&pose, 0.0, None, &mut features);
            mirror(&mut features);
            let mut mirrored = Pose::default();
            decode(&features.map(|value| value as f32), &mut mirrored.rotations);
            let (mut model, mut mirrored_model) = (ModelPose::default(), ModelPose::default());
            forward_kinematics(&skeleton, &pose, &mut model);
            forward_kinematics(&skeleton, &mirrored, &mut mirrored_model);
            for joint in Joint::ALL {
                let mut expected = model.position(joint.mirrored());
                expected.x = -expected.x;
                prop_assert!(mirrored_model.position(joint).distance(expected) < 1e-3);
            }
        }
    }
}
