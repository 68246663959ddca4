//! Passes an argument of `cargo xtask library` to the linker.

/// Set for libraries that are built as games ship them, and for Windows.
const ARGUMENT: &str = "FOOTFALL_LINK_ARG";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed={ARGUMENT}");
    if let Ok(argument) = std::env::var(ARGUMENT) {
        println!("cargo::rustc-link-arg-cdylib={argument}");
    }
}
