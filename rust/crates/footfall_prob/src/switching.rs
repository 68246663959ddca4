//! When a system changes: state jumps of a linear system, found without knowing its parameters.
//!
//! While a linear system runs undisturbed, its future outputs are a linear function of its past ones. What of the future is
//! not, the residual of a projection, is small except around a jump of the state: there it peaks
//! (*Gait as a switching dynamical system*, section 3.1, equations 4 to 9).
//!
//! In reading order: [`ProjectionResidual`] (a whole recording), [`peaks`] and [`choose_window`]; [`StreamingResidual`] for live
//! data; [`SimplestWalker`], a walking machine whose switches are known.

mod peaks;
mod residual;
mod simplest_walker;
mod streaming;

pub use peaks::{PeakConfig, choose_window, median, peaks};
pub use residual::ProjectionResidual;
pub use simplest_walker::{SimplestWalker, WalkerRecord};
pub use streaming::StreamingResidual;
