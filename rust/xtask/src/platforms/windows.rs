//! Windows on x86-64: cross-built, and loaded under Wine by a host that calls its entry point.

use super::table::{Column, Row};
use super::wine::Wine;
use super::{Settings, build, host};
use crate::binary::{Binary, Import};
use crate::cross::Zig;
use crate::{paths, process};
use anyhow::{Result, ensure};
use std::collections::{BTreeMap, BTreeSet};

const ZIG_TARGET: &str = "x86_64-windows-gnu";
/// The only library of Windows that Debian's Wine lacks, and what the library asks of it: random numbers. Windows has both since version 7.
const LACKING: (&str, &str) = ("bcryptprimitives.dll", "ProcessPrng");
/// The library's source for Wine, from the workspace.
const LACKING_SOURCE: &str = "xtask/src/platforms/bcryptprimitives.c";

pub(super) fn check(row: &mut Row, settings: &Settings, target: &str) -> Result<()> {
    let library = build(row, settings, target)?;
    row.begin(Column::Symbols);
    let binary = Binary::read(&library)?;
    binary.has_entry_point()?;
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        let reason = "Wine is had on Linux on x86-64 only";
        row.open(Column::Symbols, reason);
        row.open(Column::Run, reason);
        return Ok(());
    }
    let wine = Wine::provision()?;
    let offered = offered(&wine, &binary.libraries)?;
    let count = binary.asks_only_for(|import| offers(&offered, import))?;
    row.done(&format!(
        "{count}, of {} libraries of Windows",
        binary.libraries.len()
    ));
    row.begin(Column::Run);
    let host = host::compile(ZIG_TARGET, ".exe")?;
    // Wine finds it beside the program that it starts.
    process::read(
        Zig::provision()?
            .command()
            .args([
                "cc", "-target", ZIG_TARGET, "-shared", "-O1", "-Wall", "-Werror",
            ])
            .arg(paths::workspace().join(LACKING_SOURCE))
            .args(["-ladvapi32", "-o"])
            .arg(host.with_file_name(LACKING.0)),
    )?;
    let said = host::ask(|| wine.program(&host), &library)?;
    row.done(&format!("{said}, under Wine; no Godot for Windows here"));
    Ok(())
}

/// Names that each library of Windows has, as far as Wine has them.
fn offered(
    wine: &Wine,
    libraries: &BTreeSet<String>,
) -> Result<BTreeMap<String, BTreeSet<String>>> {
    let mut offered = BTreeMap::new();
    for name in libraries {
        let names = if name == LACKING.0 {
            [LACKING.1.to_owned()].into()
        } else {
            let file = wine.library(implementation(name));
            ensure!(
                file.is_file(),
                "{name} is no library of Windows, or Wine has none"
            );
            Binary::read(&file)?.exports
        };
        offered.insert(name.clone(), names);
    }
    Ok(offered)
}

/// The library behind one of the sets of names into which Windows splits its own (`api-ms-win-…`).
fn implementation(name: &str) -> &str {
    if name.starts_with("api-ms-win-core-") {
        "kernelbase.dll"
    } else if name.starts_with("api-ms-win-crt-") {
        "ucrtbase.dll"
    } else {
        name
    }
}

fn offers(offered: &BTreeMap<String, BTreeSet<String>>, import: &Import) -> bool {
    offered
        .get(&import.library)
        .is_some_and(|names| names.contains(&import.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_looked_for_in_the_library_that_they_are_asked_of() {
        let offered = [("a.dll".to_owned(), BTreeSet::from(["f".to_owned()]))].into();
        let asked = |library: &str, name: &str| Import {
            library: library.into(),
            name: name.into(),
            version: String::new(),
            weak: false,
        };
        assert!(offers(&offered, &asked("a.dll", "f")));
        assert!(!offers(&offered, &asked("b.dll", "f")));
        assert!(!offers(&offered, &asked("a.dll", "g")));
        assert_eq!(
            implementation("api-ms-win-core-synch-l1-2-0.dll"),
            "kernelbase.dll"
        );
        assert_eq!(implementation("ws2_32.dll"), "ws2_32.dll");
    }
}
