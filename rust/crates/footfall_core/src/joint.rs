//! The 22 body joints of Godot's `SkeletonProfileHumanoid`.

/// Number of joints of the canonical body.
pub const JOINT_COUNT: usize = 22;

/// A joint of the canonical body, named as in Godot's `SkeletonProfileHumanoid`.
///
/// The order puts parents before children, so one forward pass over [`Joint::ALL`] can accumulate transforms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
#[expect(missing_docs, reason = "the names are the anatomy")]
pub enum Joint {
    Hips,
    Spine,
    Chest,
    UpperChest,
    Neck,
    Head,
    LeftShoulder,
    LeftUpperArm,
    LeftLowerArm,
    LeftHand,
    RightShoulder,
    RightUpperArm,
    RightLowerArm,
    RightHand,
    LeftUpperLeg,
    LeftLowerLeg,
    LeftFoot,
    LeftToes,
    RightUpperLeg,
    RightLowerLeg,
    RightFoot,
    RightToes,
}

use Joint::{
    Chest, Head, Hips, LeftFoot, LeftHand, LeftLowerArm, LeftLowerLeg, LeftShoulder, LeftToes,
    LeftUpperArm, LeftUpperLeg, Neck, RightFoot, RightHand, RightLowerArm, RightLowerLeg,
    RightShoulder, RightToes, RightUpperArm, RightUpperLeg, Spine, UpperChest,
};

impl Joint {
    /// Every joint, parents before children.
    pub const ALL: [Self; JOINT_COUNT] = [
        Hips,
        Spine,
        Chest,
        UpperChest,
        Neck,
        Head,
        LeftShoulder,
        LeftUpperArm,
        LeftLowerArm,
        LeftHand,
        RightShoulder,
        RightUpperArm,
        RightLowerArm,
        RightHand,
        LeftUpperLeg,
        LeftLowerLeg,
        LeftFoot,
        LeftToes,
        RightUpperLeg,
        RightLowerLeg,
        RightFoot,
        RightToes,
    ];

    /// Returns true when the joint is one of the hips and legs.
    pub fn is_of_lower_body(self) -> bool {
        self == Self::Hips || self.is_of_leg()
    }

    /// Returns true when the joint is one of the legs, without the hips.
    pub fn is_of_leg(self) -> bool {
        self >= Self::LeftUpperLeg
    }

    /// Returns true when the joint is one of the arms, shoulders included.
    pub fn is_of_arm(self) -> bool {
        (Self::LeftShoulder..Self::LeftUpperLeg).contains(&self)
    }

    /// Position in [`Joint::ALL`] and in every array of per-joint values.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The name in `SkeletonProfileHumanoid`, for example `LeftUpperLeg`.
    pub const fn name(self) -> &'static str {
        match self {
            Hips => "Hips",
            Spine => "Spine",
            Chest => "Chest",
            UpperChest => "UpperChest",
            Neck => "Neck",
            Head => "Head",
            LeftShoulder => "LeftShoulder",
            LeftUpperArm => "LeftUpperArm",
            LeftLowerArm => "LeftLowerArm",
            LeftHand => "LeftHand",
            RightShoulder => "RightShoulder",
            RightUpperArm => "RightUpperArm",
            RightLowerArm => "RightLowerArm",
            RightHand => "RightHand",
            LeftUpperLeg => "LeftUpperLeg",
            LeftLowerLeg => "LeftLowerLeg",
            LeftFoot => "LeftFoot",
            LeftToes => "LeftToes",
            RightUpperLeg => "RightUpperLeg",
            RightLowerLeg => "RightLowerLeg",
            RightFoot => "RightFoot",
            RightToes => "RightToes",
        }
    }

    /// The joint with this name, or `None`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|joint| joint.name() == name)
    }

    /// The joint that this one hangs from; `None` for the hips.
    pub const fn parent(self) -> Option<Self> {
        match self {
            Hips => None,
            Spine | LeftUpperLeg | RightUpperLeg => Some(Hips),
            Chest => Some(Spine),
            UpperChest => Some(Chest),
            Neck | LeftShoulder | RightShoulder => Some(UpperChest),
            Head => Some(Neck),
            LeftUpperArm => Some(LeftShoulder),
            LeftLowerArm => Some(LeftUpperArm),
            LeftHand => Some(LeftLowerArm),
            RightUpperArm => Some(RightShoulder),
            RightLowerArm => Some(RightUpperArm),
            RightHand => Some(RightLowerArm),
            LeftLowerLeg => Some(LeftUpperLeg),
            LeftFoot => Some(LeftLowerLeg),
            LeftToes => Some(LeftFoot),
            RightLowerLeg => Some(RightUpperLeg),
            RightFoot => Some(RightLowerLeg),
            RightToes => Some(RightFoot),
        }
    }

    /// The same joint on the other side of the body; a joint of the trunk is its own mirror image.
    #[must_use]
    pub const fn mirrored(self) -> Self {
        match self {
            Hips | Spine | Chest | UpperChest | Neck | Head => self,
            LeftShoulder => RightShoulder,
            LeftUpperArm => RightUpperArm,
            LeftLowerArm => RightLowerArm,
            LeftHand => RightHand,
            RightShoulder => LeftShoulder,
            RightUpperArm => LeftUpperArm,
            RightLowerArm => LeftLowerArm,
            RightHand => LeftHand,
            LeftUpperLeg => RightUpperLeg,
            LeftLowerLeg => RightLowerLeg,
            LeftFoot => RightFoot,
            LeftToes => RightToes,
            RightUpperLeg => LeftUpperLeg,
            RightLowerLeg => LeftLowerLeg,
            RightFoot => LeftFoot,
            RightToes => LeftToes,
        }
    }
}

/// Left or right, as the character sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
#[expect(missing_docs, reason = "left and right")]
pub enum Side {
    Left,
    Right,
}

impl Side {
    /// Left, then right.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// 0 for left, 1 for right: the position in every per-side array.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The other side.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// `left` or `right`, as in the files that we write.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// +1 for left and -1 for right: the sign of this side's x coordinates.
    pub const fn sign(self) -> f32 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// This side's `UpperLeg` (the hip joint).
    pub const fn upper_leg(self) -> Joint {
        match self {
            Self::Left => LeftUpperLeg,
            Self::Right => RightUpperLeg,
        }
    }

    /// This side's `UpperArm` (the shoulder joint).
    pub const fn upper_arm(self) -> Joint {
        match self {
            Self::Left => LeftUpperArm,
            Self::Right => RightUpperArm,
        }
    }

    /// This side's `LowerLeg` (the knee joint).
    pub const fn lower_leg(self) -> Joint {
        match self {
            Self::Left => LeftLowerLeg,
            Self::Right => RightLowerLeg,
        }
    }

    /// This side's `Foot` (the ankle joint).
    pub const fn foot(self) -> Joint {
        match self {
            Self::Left => LeftFoot,
            Self::Right => RightFoot,
        }
    }

    /// This side's `Toes` (the joint at the ball of the foot).
    pub const fn toes(self) -> Joint {
        match self {
            Self::Left => LeftToes,
            Self::Right => RightToes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_come_first_and_names_round_trip() {
        for (index, joint) in Joint::ALL.into_iter().enumerate() {
            assert_eq!(joint.index(), index);
            assert_eq!(Joint::from_name(joint.name()), Some(joint));
            assert_eq!(joint.mirrored().mirrored(), joint);
            if let Some(parent) = joint.parent() {
                assert!(parent < joint, "{joint:?} comes before its parent");
                assert_eq!(parent.mirrored(), joint.mirrored().parent().unwrap());
            }
        }
    }
}
