//! Transitions between motions: no jump, and standing feet stay in place.
//!
//! A [`Handover`] starts from two frames of the motion that ends and two of the motion that follows, each as a [`Moving`]. [`standing_feet`] detects the standing feet of
//! an animation without contacts.
//!
//! ```
//! use footfall::body::{Joint, Pose, Skeleton};
//! use footfall::glam::Quat;
//! use footfall::handover::{Handover, Moving, standing_feet};
//!
//! let body = Skeleton::standard();
//! let idle = Pose::rest(&body);
//! let mut waving = idle.clone();
//! waving.rotations[Joint::LeftUpperArm.index()] = Quat::from_rotation_z(1.2);
//!
//! let dt_secs = 1.0 / 60.0;
//! let stands = standing_feet(&body, &idle, &idle, dt_secs, [true; 2]);
//! assert_eq!(stands, [true; 2]);
//! let from = Moving { before: &waving, now: &waving, stands };
//! let to = Moving { before: &idle, now: &idle, stands };
//! let mut handover = Handover::new(&body, &from, &to, dt_secs, 0.4);
//!
//! let arm = |pose: &Pose| pose.rotation(Joint::LeftUpperArm).angle_between(Quat::IDENTITY);
//! let mut angle = arm(&waving);
//! while !handover.is_over() {
//!     let mut pose = idle.clone(); // The next frame of the motion that goes on.
//!     handover.step(dt_secs, stands, true, &mut pose);
//!     assert!((angle - arm(&pose)).abs() < 0.2, "no frame jumps");
//!     angle = arm(&pose);
//! }
//! assert!(angle < 1e-3);
//! ```

pub use footfall_ik::handover::{Handover, Moving, standing_feet};
