//! Progress bars on stderr. They hide themselves when stderr is no terminal; then one plain line says what happens.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal as _;

fn bar(total: u64, message: &str, template: &str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        eprintln!("{message} …");
        return ProgressBar::hidden();
    }
    let style =
        ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
    bar.set_style(style);
    bar.set_message(message.to_owned());
    bar
}

/// A bar that counts bytes.
pub(crate) fn bytes(total: u64, message: &str) -> ProgressBar {
    bar(
        total,
        message,
        "{msg} [{bar:30}] {bytes}/{total_bytes} {bytes_per_sec} {eta}",
    )
}

/// A bar that counts things.
pub(crate) fn count(total: u64, message: &str) -> ProgressBar {
    bar(total, message, "{msg} [{bar:30}] {pos}/{len}")
}
