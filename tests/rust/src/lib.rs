//! Helpers that the integration tests share: where the recordings are, a walk's quality judged from its BVH file alone,
//! and text goldens.

pub mod data;
pub mod evaluator;
pub mod golden;
