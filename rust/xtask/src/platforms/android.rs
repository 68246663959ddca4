//! Android: linked without its NDK. Nothing here runs it.

use super::table::{Column, Row};
use super::{Settings, build};
use crate::binary::Binary;
use crate::cross::android_offers;
use anyhow::{Result, ensure};

/// Libraries that an app may ask of Android's C library.
const LIBRARIES: [&str; 4] = ["libc.so", "libm.so", "libdl.so", "liblog.so"];

pub(super) fn check(row: &mut Row, settings: &Settings, target: &str) -> Result<()> {
    row.open(Column::Run, "there is no Android");
    let library = build(row, settings, target)?;
    row.begin(Column::Symbols);
    let binary = Binary::read(&library)?;
    binary.has_entry_point()?;
    for name in &binary.libraries {
        ensure!(
            LIBRARIES.contains(&name.as_str()),
            "it asks for {name}, which Android does not offer to apps"
        );
    }
    let offered = android_offers(target)?;
    let count = binary.asks_only_for(|import| offered.contains(&import.name))?;
    row.done(&format!(
        "{count}, each of which the official Godot asks for too or Android's list has"
    ));
    Ok(())
}
