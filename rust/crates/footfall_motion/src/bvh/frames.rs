//! Forward kinematics of a file as it stands.

use super::{BvhFile, Channel};
use glam::{Quat, Vec3};

/// Positions and rotations of a file's joints, in the file's space and unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointTransforms {
    /// Position of each joint.
    pub positions: Vec<Vec3>,
    /// `file_from_joint` rotation of each joint.
    pub rotations: Vec<Quat>,
}

/// All rotations zero and every joint at its offset.
pub fn rest_transforms(file: &BvhFile) -> JointTransforms {
    let mut out = JointTransforms::default();
    for joint in &file.joints {
        let parent = joint
            .parent
            .map_or(Vec3::ZERO, |parent| out.positions[parent]);
        out.positions.push(parent + joint.offset);
        out.rotations.push(Quat::IDENTITY);
    }
    out
}

impl BvhFile {
    /// Places every joint in one frame; a frame that does not exist leaves the rest pose.
    ///
    /// Position channels replace the joint's offset, axis by axis. Rotation channels multiply from left to right:
    /// `Zrotation Xrotation Yrotation` means Rz · Rx · Ry on a column vector.
    pub fn place_joints(&self, frame: usize, out: &mut JointTransforms) {
        out.positions.clear();
        out.rotations.clear();
        let mut values = self.frame(frame).iter().copied();
        for joint in &self.joints {
            let mut offset = joint.offset;
            let mut rotation = Quat::IDENTITY;
            for channel in &joint.channels {
                let Some(value) = values.next() else { break };
                match channel {
                    Channel::XPosition => offset.x = value,
                    Channel::YPosition => offset.y = value,
                    Channel::ZPosition => offset.z = value,
                    Channel::XRotation => rotation *= Quat::from_rotation_x(value.to_radians()),
                    Channel::YRotation => rotation *= Quat::from_rotation_y(value.to_radians()),
                    Channel::ZRotation => rotation *= Quat::from_rotation_z(value.to_radians()),
                }
            }
            let (position, rotation) = match joint.parent {
                None => (offset, rotation),
                Some(parent) => (
                    out.positions[parent] + out.rotations[parent] * offset,
                    (out.rotations[parent] * rotation).normalize(),
                ),
            };
            out.positions.push(position);
            out.rotations.push(rotation);
        }
    }
}
