//! Probability and inference on slices: Gaussians, HSMM, MLPG, global variance.
//!
//! Pure functions from slices to records: no input or output, no clock, no randomness. Matrices are
//! row-major slices with their shape in the documentation of each argument; probabilities are f64.
//!
//! In suggested reading order: [`gaussian`] and [`duration`] (the parts of a state), [`hsmm`] (assignment of
//! frames to states); then, from states back to motion, [`windows`], [`mlpg`] and
//! [`global_variance`]. [`regression`] adapts a model with few frames; [`clustering`] finds contexts that share a model. [`switching`]
//! detects changes of a system, [`subspace`] identifies it.

pub mod clustering;
pub mod duration;
pub mod error;
pub mod gaussian;
pub mod global_variance;
pub mod hsmm;
pub mod mlpg;
pub mod regression;
pub mod subspace;
pub mod switching;
pub mod windows;
#[doc(hidden)]
pub mod workload;

pub use error::ProbError;
