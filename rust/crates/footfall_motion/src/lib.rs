//! Offline: BVH files, retargeting, contacts, steps and corpora.
//!
//! Modules in the order in which data flows: [`bvh`] text to joints and channels, [`retarget`] to a clip on the canonical
//! body, [`contacts`] of its feet with the ground, [`steps`] of its walks, and [`corpus`], many files at once.

pub mod bvh;
pub mod contacts;
pub mod corpus;
pub mod retarget;
pub mod steps;
pub mod switches;
