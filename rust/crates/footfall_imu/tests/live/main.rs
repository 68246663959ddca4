//! Sensors that are heard live: every form byte by byte, every way over a real port of this machine.

mod encode;
mod formats;
mod network;
mod phone;
mod robust;
#[cfg(unix)]
mod serial;
mod signal;
