//! Whole pipelines across crates: from recordings and models to walkers, and from samples to bodies.
//!
//! One program, for linking is what a test that crosses all crates costs most. Tests that count what is allocated are programs of their own.

mod arms;
mod bad_input;
mod climbs;
mod confidence;
mod evaluator;
mod golden;
mod handover;
mod hills;
mod legs;
mod model_versions;
mod moves;
mod placement;
mod pocket;
mod slip_agreement;
mod stairs;
mod standing;
mod switches;
mod told_apart;
mod travel;
mod two_sensors;
mod worn;
