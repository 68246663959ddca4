//! macOS, arm64 and x86-64 in one file: linked without Apple's SDK. Nothing here runs it.

use super::table::{Column, Row};
use super::{Settings, build};
use crate::binary::{self, Binary};
use crate::cross::{self, Zig};
use anyhow::{Context as _, Result, ensure};
use std::collections::BTreeSet;
use std::fs;

/// The system's library, from zig's own; its names are Apple's list.
const SYSTEM: &str = "libc/darwin/libSystem.tbd";

pub(super) fn check(row: &mut Row, settings: &Settings, target: &str) -> Result<()> {
    row.open(Column::Run, "there is no macOS");
    let library = build(row, settings, target)?;
    row.begin(Column::Symbols);
    let file = Zig::provision()?.library().join(SYSTEM);
    let system =
        fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
    let mut known = names(&system);
    known.extend(cross::macos_names());
    let bytes = fs::read(&library).with_context(|| format!("cannot read {}", library.display()))?;
    let slices = binary::slices(&bytes)?;
    let mut seen = Vec::new();
    for slice in &slices {
        let binary = binary::parse(slice)?;
        let count = judge(&binary, &known)?;
        let name = if binary.architecture == "Aarch64" {
            "arm64"
        } else {
            "x86-64"
        };
        seen.push(format!("{name} {count}"));
    }
    ensure!(
        slices.len() == 2,
        "it holds {} of two architectures",
        slices.len()
    );
    row.done(&format!(
        "{}, of libSystem and two frameworks",
        seen.join(", ")
    ));
    Ok(())
}

/// Places of the system's libraries; zig's libiconv, which the crate `libc` links, is two of macOS.
const PLACES: [&str; 4] = [
    "/usr/lib/libSystem.",
    "/usr/lib/libcharset.",
    "/usr/lib/libiconv.",
    "/System/Library/Frameworks/",
];

/// Checks one architecture; returns how many names it asks for.
fn judge(binary: &Binary, known: &BTreeSet<String>) -> Result<usize> {
    binary.has_entry_point()?;
    for library in &binary.libraries {
        ensure!(
            PLACES.iter().any(|place| library.starts_with(place)),
            "it asks for {library}, which is not the system's"
        );
    }
    binary.asks_only_for(|import| known.contains(&import.name))
}

/// Names in a stub library of Apple's text format: words that begin with an underscore.
fn names(text: &str) -> BTreeSet<String> {
    text.split(|letter: char| letter.is_whitespace() || ",[]'\"".contains(letter))
        .filter(|word| word.starts_with('_') || *word == "dyld_stub_binder")
        .map(str::to_owned)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::binary::Import;

    fn binary(library: &str, name: &str) -> Binary {
        Binary {
            architecture: "Aarch64".into(),
            libraries: [library.to_owned()].into(),
            imports: [Import {
                library: library.into(),
                name: name.into(),
                version: String::new(),
                weak: false,
            }]
            .into(),
            exports: ["_footfall_init".to_owned()].into(),
        }
    }

    #[test]
    fn names_and_places_have_to_be_the_systems() {
        let known = names("symbols: [ _malloc, '_free$X',\n  dyld_stub_binder ]\nother: word");
        assert_eq!(known.len(), 3);
        let system = "/usr/lib/libSystem.B.dylib";
        assert_eq!(judge(&binary(system, "_malloc"), &known).unwrap(), 1);
        assert!(judge(&binary(system, "_strange"), &known).is_err());
        assert!(judge(&binary("/opt/lib/libx.dylib", "_malloc"), &known).is_err());
    }
}
