//! Pitch of pelvis, trunk and head: by which skeletons differ whose bones have other directions, and people who lean.

use crate::level_heads::turn_feature;
use footfall_core::rotation::from_heading;
use footfall_core::{Clip, JOINT_COUNT, Joint, Pose, rotation};
use footfall_model::{GaitModel, layout};
use footfall_motion::steps::Step;
use glam::{Quat, Vec3};

/// Pelvis and trunk, and then the head, in the order of the chain.
pub(crate) const CHAIN: [Joint; 6] = [
    Joint::Hips,
    Joint::Spine,
    Joint::Chest,
    Joint::UpperChest,
    Joint::Neck,
    Joint::Head,
];

/// Places of the pelvis and of the first joint of the head in the [`CHAIN`].
pub(crate) const PELVIS: usize = 0;
pub(crate) const NECK: usize = 4;

/// Pitch of every joint of the [`CHAIN`], downwards, radians.
pub(crate) type Pitches = [f32; CHAIN.len()];

/// Sum of pitches over frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum {
    pitches: Pitches,
    frames: f32,
    /// Steps with these frames.
    pub(crate) steps: usize,
}

impl Sum {
    /// Adds a step.
    pub(crate) fn add(&mut self, clip: &Clip, step: &Step) {
        for pose in &clip.poses[step.first..step.end] {
            for (sum, own) in self.pitches.iter_mut().zip(pitches(&pose.rotations)) {
                *sum += own;
            }
            self.frames += 1.0;
        }
        self.steps += 1;
    }

    /// Returns the mean.
    pub(crate) fn mean(&self) -> Pitches {
        self.pitches.map(|sum| sum / self.frames.max(1.0))
    }
}

/// Returns the mean pitches of an average walk.
pub(crate) fn average(walk: &GaitModel) -> Pitches {
    of_features(&walk.mean_features())
}

/// Returns the pitches of a row of features.
pub(crate) fn of_features(features: &[f64]) -> Pitches {
    let features: Vec<f32> = features.iter().map(|value| *value as f32).collect();
    let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
    layout::decode(&features, &mut rotations);
    pitches(&rotations)
}

/// Returns the pitches of a pose.
pub(crate) fn pitches(rotations: &[Quat; JOINT_COUNT]) -> Pitches {
    let mut global = from_heading(-rotation::heading(rotations[Joint::Hips.index()]));
    CHAIN.map(|joint| {
        global *= rotations[joint.index()];
        -(global * Vec3::Z).y.clamp(-1.0, 1.0).asin()
    })
}

/// Returns the turns that bring the trunk alone from pitches to others: pelvis and head keep their directions.
pub(crate) fn trunk_turns(from: &Pitches, to: &Pitches) -> Pitches {
    let mut turns = difference(to, from);
    turns[PELVIS] = 0.0;
    turns[NECK..].fill(0.0);
    turns
}

/// Turns each joint of the chain in features about its own X axis; all others keep their directions.
pub(crate) fn turn(features: &mut [f64], turns: &Pitches) {
    for joint in Joint::ALL {
        let parent = joint
            .parent()
            .map_or(Quat::IDENTITY, |of| turn_of(turns, of));
        turn_feature(features, joint, parent.inverse(), turn_of(turns, joint));
    }
}

/// As [`turn`], of a pose whose pelvis keeps its direction.
pub(crate) fn turn_pose(pose: &mut Pose, turns: &Pitches) {
    for joint in Joint::ALL {
        let parent = joint
            .parent()
            .map_or(Quat::IDENTITY, |of| turn_of(turns, of));
        let rotation = &mut pose.rotations[joint.index()];
        *rotation = (parent.inverse() * *rotation * turn_of(turns, joint)).normalize();
    }
}

fn turn_of(turns: &Pitches, joint: Joint) -> Quat {
    let index = CHAIN.iter().position(|own| *own == joint);
    index.map_or(Quat::IDENTITY, |index| Quat::from_rotation_x(turns[index]))
}

/// Returns the mean of pitches.
pub(crate) fn mean(all: impl Iterator<Item = Pitches>) -> Pitches {
    let (mut total, mut count) = (Pitches::default(), 0.0_f32);
    for own in all {
        total = sum(&total, &own);
        count += 1.0;
    }
    total.map(|total| total / count.max(1.0))
}

/// Returns the sums of pitches.
pub(crate) fn sum(a: &Pitches, b: &Pitches) -> Pitches {
    core::array::from_fn(|index| a[index] + b[index])
}

/// Returns the differences of pitches.
pub(crate) fn difference(a: &Pitches, b: &Pitches) -> Pitches {
    core::array::from_fn(|index| a[index] - b[index])
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::adapt::tests::clips;
    use footfall_core::{ModelPose, Skeleton};
    use footfall_model::FEATURE_COUNT;

    pub(crate) fn turned(pose: &Pose, turns: &Pitches) -> Pose {
        let mut features = [0.0; FEATURE_COUNT];
        layout::encode(pose, 0.0, None, &mut features);
        turn(&mut features, turns);
        let mut turned = pose.clone();
        layout::decode(&features.map(|value| value as f32), &mut turned.rotations);
        turned
    }

    const TURNS: Pitches = [-0.1, -0.2, -0.3, -0.4, 0.1, 0.2];

    #[test]
    fn legs_and_arms_keep_their_directions() {
        let skeleton = Skeleton::standard();
        for before in &clips("path=walker_1_*")[0].clip().poses {
            let poses = [before.clone(), turned(before, &TURNS)];
            let [before, after] = poses.map(|pose| ModelPose::of(&skeleton, &pose));
            for joint in Joint::ALL {
                let turned = before.rotation(joint).angle_between(after.rotation(joint));
                assert_eq!(turned > 0.01, CHAIN.contains(&joint), "{joint:?} {turned}");
            }
        }
    }
}
