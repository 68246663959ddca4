//! Linux on x86-64: built for an old C library, loaded and run here.

use super::table::{Column, Row};
use super::{Settings, build, host};
use crate::binary::Binary;
use anyhow::{Result, ensure};
use std::process::Command;

/// The oldest glibc that the libraries for Linux run with: that of Debian 11, Ubuntu 20.04 and Steam's runtime *sniper*. The targets name it.
const GLIBC: (u32, u32) = (2, 31);
/// The only libraries that they ask for, all of them glibc's.
const LIBRARIES: [&str; 5] = ["libc.", "libm.", "libdl.", "libpthread.", "ld-linux-"];

pub(super) fn check(row: &mut Row, settings: &Settings, target: &str) -> Result<()> {
    let library = build(row, settings, target)?;
    symbols(row, &Binary::read(&library)?)?;
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        row.begin(Column::Run);
        let host = host::compile("x86_64-linux-gnu.2.31", "")?;
        let said = host::ask(|| Command::new(&host), &library)?;
        row.done(&format!("{said}; `cargo verify` runs all in Godot"));
    } else {
        row.open(Column::Run, "this machine runs no Linux on x86-64");
    }
    Ok(())
}

/// Checks what a library for Linux asks of its system.
pub(super) fn symbols(row: &mut Row, library: &Binary) -> Result<()> {
    row.begin(Column::Symbols);
    library.has_entry_point()?;
    for name in &library.libraries {
        ensure!(
            LIBRARIES.iter().any(|known| name.starts_with(known)),
            "it asks for {name}, which not every Linux has"
        );
    }
    let newest = newest_glibc(library);
    ensure!(
        newest <= GLIBC,
        "it asks for glibc {}.{}, newer than {}.{}",
        newest.0,
        newest.1,
        GLIBC.0,
        GLIBC.1
    );
    let count = library.asks_only_for(|import| import.version.starts_with("GLIBC_"))?;
    row.done(&format!(
        "{count}, of glibc 2.17 to {}.{}",
        newest.0, newest.1
    ));
    Ok(())
}

/// The newest version of glibc among the names that loading needs.
fn newest_glibc(library: &Binary) -> (u32, u32) {
    let version = |text: &str| {
        let (major, minor) = text.strip_prefix("GLIBC_")?.split_once('.')?;
        let minor = minor.split('.').next()?;
        Some((major.parse().ok()?, minor.parse().ok()?))
    };
    let needed = library.imports.iter().filter(|import| !import.weak);
    needed
        .filter_map(|import| version(&import.version))
        .max()
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::binary::Import;

    fn library(versions: &[(&str, bool)], needed: &str) -> Binary {
        Binary {
            architecture: "X86_64".into(),
            libraries: [needed.to_owned()].into(),
            imports: versions
                .iter()
                .map(|&(version, weak)| Import {
                    library: "libc.so.6".into(),
                    name: format!("name of {version}"),
                    version: version.into(),
                    weak,
                })
                .collect(),
            exports: ["footfall_init".to_owned()].into(),
        }
    }

    #[test]
    fn newer_names_and_other_libraries_are_refused() {
        let judged = |versions: &[(&str, bool)], needed: &str| {
            symbols(&mut Row::new("linux", true), &library(versions, needed))
        };
        let old = [("GLIBC_2.17", false), ("GLIBC_2.2.5", false)];
        judged(&old, "libc.so.6").unwrap();
        let weak = [("GLIBC_2.31", false), ("GLIBC_2.39", true)];
        judged(&weak, "libc.so.6").unwrap();
        let error = judged(&[("GLIBC_2.34", false)], "libc.so.6").unwrap_err();
        assert!(error.to_string().contains("glibc 2.34"), "{error}");
        let error = judged(&old, "libudev.so.1").unwrap_err().to_string();
        assert!(error.contains("libudev.so.1"), "{error}");
        let error = judged(&[("", false)], "libc.so.6").unwrap_err().to_string();
        assert!(error.contains("does not offer"), "{error}");
    }
}
