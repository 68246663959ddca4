//! Helpers that the integration tests share: where the recordings are, a walk's quality judged from its BVH file alone,
//! text goldens, and ground from formulas.

pub mod data;
pub mod evaluator;
pub mod golden;
pub mod terrain;
