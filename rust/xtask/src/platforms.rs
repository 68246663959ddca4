//! `cargo xtask platforms`: the library for exported games, built for each platform and checked as far as this machine can.
//!
//! One table comes of it, in which a platform that cannot be had is entered with the reason. Whatever a check needs besides Rust is fetched into the
//! cache outside the repository, once.

mod android;
mod host;
mod linux_arm64;
mod linux_x86_64;
mod macos;
mod table;
mod tried;
mod windows;
mod wine;

use crate::library::{self, Flavour, Options};
use anyhow::{Context as _, Result, bail};
use clap::Args;
use std::fs;
use std::path::PathBuf;
use table::{Column, Row};

/// Platforms to check, and the kind of build.
#[derive(Args, Debug)]
pub(crate) struct Settings {
    /// Only these; all when absent. A part of a name stands for all that have it: `windows`, `arm64`.
    names: Vec<String>,
    /// Build the libraries as they are released: minutes more for each.
    #[arg(long)]
    shipped: bool,
    /// Build nothing: check the libraries that are in `addons/footfall/bin`.
    #[arg(long, conflicts_with = "shipped")]
    packed: bool,
}

/// A platform of the table.
struct Platform {
    name: &'static str,
    /// Target, as `cargo xtask library --cross` takes it.
    target: &'static str,
    /// Users get a library for it: a check that fails is an error of this command.
    promised: bool,
    check: fn(&mut Row, &Settings, &str) -> Result<()>,
}

const PLATFORMS: [Platform; 8] = [
    Platform {
        name: "linux-x86_64",
        target: "x86_64-unknown-linux-gnu.2.31",
        promised: true,
        check: linux_x86_64::check,
    },
    Platform {
        name: "linux-arm64",
        target: "aarch64-unknown-linux-gnu.2.31",
        promised: true,
        check: linux_arm64::check,
    },
    Platform {
        name: "windows-x86_64",
        target: "x86_64-pc-windows-gnu",
        promised: true,
        check: windows::check,
    },
    Platform {
        name: "macos-universal",
        target: library::MACOS_UNIVERSAL,
        promised: true,
        check: macos::check,
    },
    Platform {
        name: "android-arm64",
        target: "aarch64-linux-android",
        promised: true,
        check: android::check,
    },
    Platform {
        name: "android-x86_64",
        target: "x86_64-linux-android",
        promised: true,
        check: android::check,
    },
    Platform {
        name: "web",
        target: "wasm32-unknown-emscripten",
        promised: false,
        check: tried::check_web,
    },
    Platform {
        name: "ios",
        target: "aarch64-apple-ios",
        promised: false,
        check: tried::check_ios,
    },
];

/// Builds and checks, and prints the table.
///
/// # Errors
/// When there is no such platform, or when one that is promised fails.
pub(crate) fn command(settings: &Settings) -> Result<()> {
    let mut rows = Vec::new();
    for platform in chosen(&settings.names)? {
        eprintln!("{} …", platform.name);
        let mut row = Row::new(platform.name, platform.promised);
        if let Err(error) = (platform.check)(&mut row, settings, platform.target) {
            eprintln!("{}: {error:#}", platform.name);
            row.failed(&error);
        }
        rows.push(row);
    }
    print!("{}", table::table(&rows));
    let broken: Vec<&str> = rows
        .iter()
        .filter(|row| row.breaks_a_promise())
        .map(Row::name)
        .collect();
    if !broken.is_empty() {
        bail!("promised, and not as it should be: {}", broken.join(", "));
    }
    Ok(())
}

/// Name and target of every platform for which users get a library.
pub(crate) fn promised() -> impl Iterator<Item = (&'static str, &'static str)> {
    let promised = PLATFORMS.iter().filter(|platform| platform.promised);
    promised.map(|platform| (platform.name, platform.target))
}

fn chosen(names: &[String]) -> Result<Vec<&'static Platform>> {
    let all = || PLATFORMS.iter().map(|platform| platform.name);
    for name in names {
        if !all().any(|platform| platform.contains(name.as_str())) {
            let all: Vec<&str> = all().collect();
            bail!("there is no platform {name}: {}", all.join(", "));
        }
    }
    let wanted = |platform: &&Platform| {
        names.is_empty()
            || names
                .iter()
                .any(|name| platform.name.contains(name.as_str()))
    };
    Ok(PLATFORMS.iter().filter(wanted).collect())
}

/// Builds the library for exported games, and enters its size.
fn build(row: &mut Row, settings: &Settings, target: &str) -> Result<PathBuf> {
    row.begin(Column::Built);
    let library = library(settings, Flavour::Game, target)?;
    let bytes = fs::metadata(&library)
        .with_context(|| format!("there is no {}", library.display()))?
        .len();
    row.done(match settings {
        Settings { packed: true, .. } => "elsewhere",
        Settings { shipped: true, .. } => "as released",
        Settings { .. } => "yes",
    });
    row.begin(Column::Linked);
    row.done(&format!("{:.1} MB", bytes as f64 / 1e6));
    Ok(library)
}

/// A library in `addons/footfall/bin`, built unless it is to be taken as it is there.
fn library(settings: &Settings, flavour: Flavour, target: &str) -> Result<PathBuf> {
    if settings.packed {
        return library::place(flavour, target);
    }
    let options = Options {
        all: true,
        shipped: settings.shipped,
        target: Some(target.to_owned()),
        cross: true,
        ..Options::default()
    };
    library::build_flavour(flavour, &options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_names_choose_platforms() {
        let names = |wanted: &[&str]| -> Vec<&str> {
            let wanted: Vec<String> = wanted.iter().map(|&name| name.to_owned()).collect();
            let chosen = chosen(&wanted).unwrap();
            chosen.iter().map(|platform| platform.name).collect()
        };
        assert_eq!(names(&[]).len(), PLATFORMS.len());
        assert_eq!(names(&["arm64"]), ["linux-arm64", "android-arm64"]);
        assert_eq!(names(&["web", "windows"]), ["windows-x86_64", "web"]);
        let error = chosen(&["amiga".into()]).err().unwrap().to_string();
        assert!(
            error.contains("amiga") && error.contains("linux-arm64"),
            "{error}"
        );
    }
}
