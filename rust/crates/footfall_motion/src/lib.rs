//! Offline: BVH files, retargeting, contacts, steps and corpora.
//!
//! Modules in the order of data flow: [`bvh`] reads text to joints and channels; [`retarget`] makes a clip on the canonical
//! body, with the hip joints where [`hip_centres`] and the head as [`head_carriage`] finds them; [`contacts`] of its feet with the ground; [`steps`] of its walks; [`recording`] combines these for one file, with
//! [corrections](contact_file) by hand; and [`corpus`] reads many files at once.
//! [`switches`] detects contacts from joint angles only, [`sensor_switches`] from a foot sensor; [`published_events`] is the reference for both. [`virtual_imu`]
//! simulates sensors on the body, [`phases`] cuts any locomotion at its contacts and extrema, and [`jumps`] finds two-footed jumps.
//! [`figure`] represents a body by capsules, for drawing. [`gltf`] reads and writes clips by way of [`skeletal`], and [`game_clip`] makes recordings of in-place and looping clips.

pub mod bvh;
pub mod contact_file;
pub mod contacts;
pub mod corpus;
pub mod figure;
pub mod files;
pub mod game_clip;
pub mod gltf;
pub mod head_carriage;
pub mod hip_centres;
pub mod index_row;
pub mod jumps;
pub mod phases;
pub mod published_events;
pub mod recording;
pub mod retarget;
pub mod sensor_switches;
pub mod skeletal;
pub mod skeleton_fit;
pub mod steps;
pub mod switches;
pub mod virtual_imu;
pub mod walking_evidence;
