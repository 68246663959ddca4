//! `cargo xtask golden`: results that are kept in `tests/golden` and compared, or renewed on purpose.

use crate::process;
use anyhow::Result;

/// Compares with the kept results, or keeps the new ones.
///
/// # Errors
/// When a result differs.
pub(crate) fn command(update: bool) -> Result<()> {
    let mut cargo = process::cargo();
    cargo.args([
        "test",
        "--locked",
        "--package",
        "footfall_tests",
        "--test",
        "pipelines",
        "golden::",
    ]);
    if update {
        cargo.env("FOOTFALL_UPDATE_GOLDEN", "1");
    }
    process::run(&mut cargo)?;
    if update {
        eprintln!("tests/golden is updated; read `git diff tests/golden` before you commit it");
    }
    Ok(())
}
