//! The studio without a window: what is on it, what it does, how it looks.

mod raster;
mod views;
mod work;
#[expect(clippy::unwrap_used, reason = "a test helper that fails the test")]
mod world;
