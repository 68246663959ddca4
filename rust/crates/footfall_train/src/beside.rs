//! Postures beside standing: what jumps and crouches are learned as.

use crate::standing::spread_chains;
use footfall_core::rotation::{blend_near, from_heading, heading, log_map};
use footfall_core::{JOINT_COUNT, Joint, ModelPose, Pose, Side, Skeleton};
use footfall_model::layout::{decode, feature_offset, mirror};
use footfall_model::{BESIDE_COUNT, FEATURE_COUNT, StandingModel};
use glam::{Quat, Vec3};

/// Arms as a model carries them standing. People carry them in different ways: arms that go as far from there as somebody's go from another posture cross each other and the body.
#[derive(Clone, Debug)]
pub(crate) struct Arms {
    rotations: [Quat; JOINT_COUNT],
}

impl Arms {
    /// The arms of a model that stands like this.
    pub(crate) fn of(standing: &StandingModel) -> Self {
        let features: Vec<f32> = standing.posture.iter().map(|value| *value as f32).collect();
        let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
        decode(&features, &mut rotations);
        Self { rotations }
    }
}

/// A posture seen from where the body faces.
#[derive(Clone, Debug)]
pub(crate) struct Upright {
    /// The pose without its heading.
    pose: Pose,
    /// The middle between the ankles, seen alike.
    ankles: Vec3,
}

impl Upright {
    /// The posture of a body.
    pub(crate) fn new(skeleton: &Skeleton, pose: &Pose) -> Self {
        let body = ModelPose::of(skeleton, pose);
        let level = from_heading(-heading(pose.rotation(Joint::Hips)));
        let [left, right] = Side::BOTH.map(|side| body.position(side.foot()));
        let mut pose = pose.clone();
        let hips = Joint::Hips.index();
        pose.rotations[hips] = (level * pose.rotations[hips]).normalize();
        pose.root_position = level * pose.root_position;
        Self {
            pose,
            ankles: level * (0.5 * (left + right)),
        }
    }

    /// Between this posture and another.
    pub(crate) fn towards(&self, other: &Self, share: f32) -> Self {
        Self {
            pose: self.pose.interpolate(&other.pose, share),
            ankles: self.ankles.lerp(other.ankles, share),
        }
    }

    /// The mean of postures; `None` of none.
    pub(crate) fn mean(postures: &[Self]) -> Option<Self> {
        let (first, rest) = postures.split_first()?;
        let mut mean = first.clone();
        for (index, posture) in rest.iter().enumerate() {
            let share = 1.0 / (index + 2) as f32;
            let rotations = mean.pose.rotations.iter_mut();
            for (rotation, other) in rotations.zip(posture.pose.rotations) {
                *rotation = blend_near(*rotation, other, share).0;
            }
            let hips = posture.pose.root_position;
            mean.pose.root_position = mean.pose.root_position.lerp(hips, share);
            mean.ankles = mean.ankles.lerp(posture.ankles, share);
        }
        Some(mean)
    }

    /// Gives the posture a share of the arms of a model.
    pub(crate) fn carry_arms(&mut self, arms: &Arms, share: f32) {
        for joint in Joint::ALL.into_iter().filter(|joint| joint.is_of_arm()) {
            let index = joint.index();
            let own = &mut self.pose.rotations[index];
            *own = own.slerp(arms.rotations[index], share);
        }
    }

    /// Height of the hips, metres.
    pub(crate) fn height(&self) -> f32 {
        self.pose.root_position.y
    }

    /// Difference of this posture from another one, with its feet on the ground: [`BESIDE_COUNT`] numbers for legs of this length.
    pub(crate) fn beside(&self, standing: &Self, leg: f32) -> Vec<f64> {
        let mut row = vec![0.0; BESIDE_COUNT];
        for joint in Joint::ALL {
            let turn: Quat = standing.pose.rotation(joint).inverse() * self.pose.rotation(joint);
            let vector = log_map(turn).as_dvec3().to_array();
            row[feature_offset(joint)..][..3].copy_from_slice(&vector);
        }
        spread_chains(&mut row);
        let ahead = |posture: &Self| posture.pose.root_position.z - posture.ankles.z;
        row[FEATURE_COUNT] = f64::from((self.height() - standing.height()) / leg);
        row[FEATURE_COUNT + 1] = f64::from((ahead(self) - ahead(standing)) / leg);
        row
    }
}

/// The mean of a row and of the mirrored body's.
pub(crate) fn symmetric(row: &[f64]) -> Vec<f64> {
    let mut mirrored = row.to_vec();
    mirror(&mut mirrored[..FEATURE_COUNT]);
    row.iter()
        .zip(mirrored)
        .map(|(row, mirrored)| 0.5 * (row + mirrored))
        .collect()
}
