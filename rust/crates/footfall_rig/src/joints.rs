//! Assignment of a rig's bones to joints: by the user's map, by the joints' names, or as recognised.

use crate::rest_body::is_optional;
use footfall_core::rig::{Placement, Recognition, recognise};
use footfall_core::{JOINT_COUNT, Joint, Rig};

/// User's map: the bone of each joint; `Some(None)` for a named bone that does not exist, `None` for a joint that is not mapped.
pub type MappedBones = [Option<Option<usize>>; JOINT_COUNT];

/// Joints without a bone.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the rig {}; map these joints to bones by hand", self.findings())]
pub struct MissingJoints {
    /// The joints.
    pub joints: Vec<Joint>,
    /// Closest family of rigs.
    pub family: String,
    /// Reasons for leaving out bones with these names.
    pub doubts: Vec<String>,
}

impl MissingJoints {
    /// Returns the missing joints and the reasons, as the end of a sentence about the rig: `lacks Hips; its bones are closest to …`.
    pub fn findings(&self) -> String {
        let joints: Vec<&str> = self.joints.iter().map(|joint| joint.name()).collect();
        let family = format!("its bones are closest to those of {} rigs", self.family);
        let mut parts = vec![format!("lacks {}", joints.join(", ")), family];
        parts.extend(self.doubts.iter().cloned());
        parts.join("; ")
    }
}

/// Finds the bone of each joint. Optional joints may be `None`.
///
/// Bones in the map take precedence. The others are found by the joints' names if these cover all required joints; otherwise the whole rig is recognised, since in many
/// families a `Spine` is not the joint of that name.
///
/// # Errors
/// Required joints without a bone.
pub fn joint_bones(
    rig: &Rig,
    mapped: &MappedBones,
) -> Result<[Option<usize>; JOINT_COUNT], MissingJoints> {
    let with = |others: &[Option<usize>; JOINT_COUNT]| {
        let mut bones = mapped.map(Option::flatten);
        for joint in Joint::ALL {
            let (index, other) = (joint.index(), others[joint.index()]);
            if mapped[index].is_none() && other.is_some() && !bones.contains(&other) {
                bones[index] = other;
            }
        }
        bones
    };
    let named = |joint: Joint| rig.names().iter().position(|name| name == joint.name());
    let bones = with(&Joint::ALL.map(named));
    if missing(&bones).is_empty() {
        return Ok(bones);
    }
    let Recognition {
        family,
        placement,
        doubts,
    } = recognise(rig);
    let mut joints = placement.joints;
    if arms_hang_from_neck(rig, &placement) {
        joints[Joint::Neck.index()] = None;
    }
    let bones = with(&joints);
    let missing = missing(&bones);
    if missing.is_empty() {
        return Ok(bones);
    }
    Err(MissingJoints {
        joints: missing,
        family,
        doubts: doubts.iter().map(|doubt| doubt.describe(rig)).collect(),
    })
}

/// Returns true if the neck carries the arms, as in 3ds Max's Biped: it then belongs to the trunk, since a turning neck must not turn the arms.
fn arms_hang_from_neck(rig: &Rig, placement: &Placement) -> bool {
    let neck = placement.joint(Joint::Neck);
    let arms = [Joint::LeftUpperArm, Joint::RightUpperArm].map(|arm| placement.joint(arm));
    neck.is_some_and(|neck| {
        arms.into_iter()
            .flatten()
            .any(|arm| rig.is_below(arm, neck))
    })
}

/// Required joints without a bone.
fn missing(bones: &[Option<usize>; JOINT_COUNT]) -> Vec<Joint> {
    let needed = Joint::ALL.into_iter().filter(|joint| !is_optional(*joint));
    needed
        .filter(|joint| bones[joint.index()].is_none())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rig with the joints' own names.
    fn humanoid() -> Vec<(String, Option<usize>)> {
        let parent = |joint: Joint| joint.parent().map(Joint::index);
        Joint::ALL
            .map(|joint| (joint.name().to_owned(), parent(joint)))
            .to_vec()
    }

    #[test]
    fn names_of_the_profile_hold_and_the_map_goes_before_them() {
        let mut bones = humanoid();
        let rig = Rig::new(bones.clone());
        let identity = Joint::ALL.map(|joint| Some(joint.index()));
        assert_eq!(joint_bones(&rig, &[None; JOINT_COUNT]), Ok(identity));

        let head = Joint::Head.index();
        bones.push(("helmet".into(), Some(head)));
        let rig = Rig::new(bones);
        let mut mapped: MappedBones = [None; JOINT_COUNT];
        mapped[head] = Some(Some(JOINT_COUNT));
        let mut expected = identity;
        expected[head] = Some(JOINT_COUNT);
        assert_eq!(joint_bones(&rig, &mapped), Ok(expected));
    }

    #[test]
    fn an_error_of_the_map_is_not_mended_and_is_named() {
        let rig = Rig::new(humanoid());
        let mut mapped: MappedBones = [None; JOINT_COUNT];
        mapped[Joint::LeftFoot.index()] = Some(None);
        let error = joint_bones(&rig, &mapped).unwrap_err();
        assert_eq!(error.joints, [Joint::LeftFoot]);
        let text = error.to_string();
        assert!(text.starts_with("the rig lacks LeftFoot; "), "{text}");
        // What a character can do without may be mapped to nothing.
        mapped[Joint::LeftFoot.index()] = None;
        mapped[Joint::Neck.index()] = Some(None);
        let bones = joint_bones(&rig, &mapped).unwrap();
        assert_eq!(bones[Joint::Neck.index()], None);
    }

    #[test]
    fn a_neck_that_carries_the_arms_is_a_part_of_the_trunk() {
        let named = |(name, parent): (String, Option<usize>)| {
            let arm = matches!(name.as_str(), "LeftShoulder" | "RightShoulder");
            let parent = if arm {
                Some(Joint::Neck.index())
            } else {
                parent
            };
            (format!("Bip01 {name}"), parent)
        };
        let rig = Rig::new(humanoid().into_iter().map(named));
        let bones = joint_bones(&rig, &[None; JOINT_COUNT]).unwrap();
        assert_eq!(bones[Joint::Neck.index()], None);
        assert_eq!(bones[Joint::Head.index()], Some(Joint::Head.index()));
    }
}
