//! Tests that do not run here, and what they miss.

use std::io::Write as _;

/// Variable that names the file to which skipped tests are added, a line each: `cargo verify` sets it and lists them at its end.
const LIST: &str = "FOOTFALL_SKIPPED";

/// Notes on stderr, and in the list that `cargo verify` shows, that a test is skipped.
#[expect(clippy::print_stderr, reason = "a skipped test has to say so")]
pub fn note(test: &str, reason: &str) {
    eprintln!("{test}: skipped, {reason}");
    let Some(path) = std::env::var_os(LIST) else {
        return;
    };
    let list = std::fs::OpenOptions::new()
        .create(true)
        .append(true)
        .open(&path);
    // One write a line: tests run side by side.
    let line = format!("{test}\t{reason}\n");
    if let Err(error) = list.and_then(|mut list| list.write_all(line.as_bytes())) {
        eprintln!("{}: cannot note it: {error}", path.display());
    }
}

/// Name of the test that runs in this thread.
pub fn current_test() -> String {
    let thread = std::thread::current();
    thread.name().unwrap_or("a test").to_owned()
}
