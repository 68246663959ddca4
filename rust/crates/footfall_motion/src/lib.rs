//! Offline: BVH files, retargeting, contacts, steps and corpora.
//!
//! Modules in the order in which data flows: [`bvh`] text to joints and channels, [`retarget`] to a clip on the canonical
//! body with the hip joints where [`hip_centres`] finds them, [`contacts`] of its feet with the ground, [`steps`] of its walks; [`recording`], all of these for one file, with
//! the [corrections](contact_file) that a person made; and [`corpus`], many files at once.
//! [`switches`] are contacts from joint angles alone, [`sensor_switches`] from a sensor on a foot; [`published_events`] judge them. [`virtual_imu`]
//! measures what a sensor on the body would have, [`phases`] cuts any locomotion at its contacts and extremes, and [`jumps`] finds jumps off both feet.
//! [`figure`] is a body as capsules, for code that draws it; [`gltf`] takes clips to and from other programs by way of [`skeletal`], and [`game_clip`] makes recordings of clips that walk in place or loop.

pub mod bvh;
pub mod contact_file;
pub mod contacts;
pub mod corpus;
pub mod figure;
pub mod files;
pub mod game_clip;
pub mod gltf;
pub mod hip_centres;
pub mod index_row;
pub mod jumps;
pub mod phases;
pub mod published_events;
pub mod recording;
pub mod retarget;
pub mod sensor_switches;
pub mod skeletal;
pub mod steps;
pub mod switches;
pub mod virtual_imu;
