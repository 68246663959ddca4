//! Bodies and their motion: joints, lengths, poses, clips, and the joints of a game's rig.
//!
//! A [`Skeleton`] holds the lengths of one body: an offset per [`Joint`] and a [`FootShape`] per [`Side`]. A [`Pose`] holds its rotations. [`forward_kinematics`] computes a
//! [`ModelPose`] from both, with the position of every joint.
//!
//! ```
//! use footfall::body::{Joint, ModelPose, Pose, Skeleton, forward_kinematics};
//! use footfall::glam::Quat;
//!
//! let body = Skeleton::standard();
//! body.check()?;
//! let mut pose = Pose::rest(&body);
//! pose.rotations[Joint::LeftUpperArm.index()] = Quat::from_rotation_z(1.2);
//! let mut model = ModelPose::default();
//! forward_kinematics(&body, &pose, &mut model);
//! // The arm went up: the hand is above the shoulder.
//! assert!(model.position(Joint::LeftHand).y > model.position(Joint::LeftUpperArm).y + 0.4);
//! # Ok::<(), footfall::body::SkeletonError>(())
//! ```
//!
//! [`SkeletonError`] names a leg or a foot without length. [`JOINT_COUNT`] is the number of joints, 22.
//!
//! A [`Clip`] is motion at a fixed rate.
//!
//! ```
//! use footfall::body::{Clip, Pose, Skeleton};
//!
//! let skeleton = Skeleton::standard();
//! let mut raised = Pose::rest(&skeleton);
//! raised.root_position.y += 1.0;
//! let poses = vec![Pose::rest(&skeleton), raised];
//! let jump = Clip { skeleton, frame_rate_hz: 2.0, poses };
//! let half = jump.pose_at(0.25).expect("the clip has frames");
//! assert!((half.root_position.y - jump.poses[0].root_position.y - 0.5).abs() < 1e-6);
//! assert_eq!(jump.resampled(60.0).poses.len(), 31);
//! ```
//!
//! A game's own skeleton is a [`Rig`]: the names and parents of its bones. [`recognise`] returns a [`Recognition`]: the best matching family,
//! the [`Placement`] of the joints, and a [`Doubt`] for each joint that it left out.
//!
//! ```
//! use footfall::body::{Joint, Rig, recognise};
//!
//! let bones = [
//!     ("mixamorig:Hips", None),
//!     ("mixamorig:LeftUpLeg", Some(0)),
//!     ("mixamorig:LeftLeg", Some(1)),
//!     ("mixamorig:LeftFoot", Some(2)),
//!     ("mixamorig:RightUpLeg", Some(0)),
//!     ("mixamorig:RightLeg", Some(4)),
//!     ("mixamorig:RightFoot", Some(5)),
//!     ("mixamorig:Spine", Some(0)),
//! ];
//! let rig = Rig::new(bones.map(|(name, parent)| (name.to_owned(), parent)));
//! let found = recognise(&rig);
//! assert_eq!(found.placement.joint(Joint::LeftLowerLeg), Some(2));
//! assert_eq!(found.placement.joint(Joint::LeftToes), None);
//! ```
//!
//! [`from_heading`] and [`heading`] convert a heading about the vertical to a rotation and back.
//!
//! ```
//! use footfall::body::{from_heading, heading};
//!
//! assert!((heading(from_heading(0.7)) - 0.7).abs() < 1e-6);
//! ```

pub use footfall_core::rig::{Doubt, Placement, Recognition, recognise};
pub use footfall_core::rotation::{from_heading, heading};
pub use footfall_core::{
    Clip, FootShape, JOINT_COUNT, Joint, ModelPose, Pose, Rig, Side, Skeleton, SkeletonError,
    forward_kinematics,
};
