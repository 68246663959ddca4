//! Helpers that the integration tests share: where the recordings are, a walk's quality judged from its BVH file alone,
//! text goldens, ground from formulas and climbs over it, recordings of real feet, walkers and models of sensors on them, and a browser.

pub mod browser;
pub mod climb;
pub mod data;
pub mod evaluator;
pub mod golden;
pub mod real_feet;
pub mod skips;
pub mod terrain;
pub mod walkers;
