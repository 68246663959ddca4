//! Sensors that are heard live: every form byte by byte, every way over a real port of this machine.

#![expect(clippy::unwrap_used, reason = "helpers of tests, which may panic")]
#![expect(
    clippy::disallowed_methods,
    reason = "data over ports takes time, and only the clock shows that none comes"
)]
#![expect(
    clippy::result_large_err,
    reason = "the form of tungstenite's callback"
)]

mod browser;
mod encode;
mod formats;
mod network;
mod phone;
mod robust;
#[cfg(unix)]
mod serial;
mod signal;
