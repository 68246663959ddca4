//! Sites of inertial sensors on the body.

use crate::joint::{Joint, Side};
use glam::Vec3;

/// A place on the body for an inertial sensor.
///
/// Mounted `aligned`, the sensor's axes are parallel to the model's in the T-pose: x left, y up, z forward. They turn with the
/// joint from then on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Site {
    /// On the instep of the right foot.
    RightFoot,
    /// On the instep of the left foot.
    LeftFoot,
    /// On the right shank, just below the knee.
    RightKnee,
    /// On the left shank, just below the knee.
    LeftKnee,
    /// In the right pocket of the trousers.
    RightThigh,
    /// In the left pocket of the trousers.
    LeftThigh,
    /// In or on the right hand.
    RightHand,
    /// In or on the left hand.
    LeftHand,
    /// On the right wrist.
    RightForearm,
    /// On the left wrist.
    LeftForearm,
    /// On the lower back.
    Root,
    /// Between the eyes: a headset.
    Head,
}

impl Site {
    /// Every site.
    pub const ALL: [Self; 12] = [
        Self::RightFoot,
        Self::LeftFoot,
        Self::RightKnee,
        Self::LeftKnee,
        Self::RightThigh,
        Self::LeftThigh,
        Self::RightHand,
        Self::LeftHand,
        Self::RightForearm,
        Self::LeftForearm,
        Self::Root,
        Self::Head,
    ];

    /// The name on the command line and in files, for example `right_foot`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RightFoot => "right_foot",
            Self::LeftFoot => "left_foot",
            Self::RightKnee => "right_knee",
            Self::LeftKnee => "left_knee",
            Self::RightThigh => "right_thigh",
            Self::LeftThigh => "left_thigh",
            Self::RightHand => "right_hand",
            Self::LeftHand => "left_hand",
            Self::RightForearm => "right_forearm",
            Self::LeftForearm => "left_forearm",
            Self::Root => "root",
            Self::Head => "head",
        }
    }

    /// The site with this name, or `None`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|site| site.name() == name)
    }

    /// The side of the body; `None` for the lower back and the head.
    pub const fn side(self) -> Option<Side> {
        match self {
            Self::RightFoot
            | Self::RightKnee
            | Self::RightThigh
            | Self::RightHand
            | Self::RightForearm => Some(Side::Right),
            Self::LeftFoot
            | Self::LeftKnee
            | Self::LeftThigh
            | Self::LeftHand
            | Self::LeftForearm => Some(Side::Left),
            Self::Root | Self::Head => None,
        }
    }

    /// The same place on the other side of the body; `None` for the lower back and the head.
    pub const fn opposite(self) -> Option<Self> {
        Some(match self {
            Self::RightFoot => Self::LeftFoot,
            Self::LeftFoot => Self::RightFoot,
            Self::RightKnee => Self::LeftKnee,
            Self::LeftKnee => Self::RightKnee,
            Self::RightThigh => Self::LeftThigh,
            Self::LeftThigh => Self::RightThigh,
            Self::RightHand => Self::LeftHand,
            Self::LeftHand => Self::RightHand,
            Self::RightForearm => Self::LeftForearm,
            Self::LeftForearm => Self::RightForearm,
            Self::Root | Self::Head => return None,
        })
    }

    /// The joint with which the sensor turns.
    pub const fn joint(self) -> Joint {
        match self {
            Self::RightFoot => Joint::RightFoot,
            Self::LeftFoot => Joint::LeftFoot,
            Self::RightKnee => Joint::RightLowerLeg,
            Self::LeftKnee => Joint::LeftLowerLeg,
            Self::RightThigh => Joint::RightUpperLeg,
            Self::LeftThigh => Joint::LeftUpperLeg,
            Self::RightHand => Joint::RightHand,
            Self::LeftHand => Joint::LeftHand,
            Self::RightForearm => Joint::RightLowerArm,
            Self::LeftForearm => Joint::LeftLowerArm,
            Self::Root => Joint::Hips,
            Self::Head => Joint::Head,
        }
    }

    /// Returns the sensor's position in the joint's space on the canonical body, metres.
    pub fn position(self) -> Vec3 {
        let outwards = self.side().map_or(0.0, Side::sign);
        match self {
            Self::RightFoot | Self::LeftFoot => Vec3::new(0.0, -0.01, 0.07),
            Self::RightKnee | Self::LeftKnee => Vec3::new(0.0, -0.08, 0.05),
            Self::RightThigh | Self::LeftThigh => Vec3::new(0.05 * outwards, -0.15, 0.07),
            Self::RightHand | Self::LeftHand => Vec3::new(0.08 * outwards, 0.0, 0.0),
            Self::RightForearm | Self::LeftForearm => Vec3::new(0.21 * outwards, 0.02, 0.0),
            Self::Root => Vec3::new(0.0, 0.03, -0.11),
            Self::Head => Vec3::new(0.0, 0.08, 0.09),
        }
    }

    /// Returns true when the sensor sits on a foot, so that it comes to rest in every step.
    pub const fn is_foot(self) -> bool {
        matches!(self, Self::RightFoot | Self::LeftFoot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip_and_sites_lie_on_their_side() {
        for site in Site::ALL {
            assert_eq!(Site::from_name(site.name()), Some(site));
            let outwards = site.side().map_or(0.0, Side::sign) * site.position().x;
            assert!(outwards >= 0.0, "{}", site.name());
            let other = site.opposite();
            assert_eq!(
                other.map(Site::side),
                site.side().map(|own| Some(own.other()))
            );
            assert_eq!(other.and_then(Site::opposite).unwrap_or(site), site);
        }
        assert_eq!(Site::from_name("left_ear"), None);
    }
}
