//! `cargo xtask godot`: a Godot of at least 4.6, found or fetched.
//!
//! Looked for in this order: the variable `GODOT`, the PATH, the cache. Failing these it is fetched into the cache: from the
//! machine's own package archive on Debian ([`apt`]), as the official release elsewhere ([`official`]).

mod apt;
mod official;

use crate::{fetch, paths, process};
use anyhow::{Context as _, Result, bail};
use std::env;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The oldest Godot that has what the add-on uses, as (major, minor).
const OLDEST: (u32, u32) = (4, 6);
/// Raised when the cache is laid out in another way, so that an older one is made anew.
const LAYOUT: &str = "footfall godot cache 2";

/// A Godot that runs on this machine.
#[derive(Debug, Clone)]
pub(crate) struct Engine {
    /// Program to start.
    pub(crate) program: PathBuf,
    /// Version that it reports, such as `4.6.3.stable`.
    pub(crate) version: String,
    /// The export template for this platform's release builds, where it came along.
    pub(crate) release_template: Option<PathBuf>,
}

/// Prints the path of the engine, or of its release export template, as the last line of stdout.
///
/// # Errors
/// When no Godot can be had, or it came without a template.
pub(crate) fn command(template: bool) -> Result<()> {
    let engine = provision()?;
    eprintln!("Godot {}", engine.version);
    if template {
        let template = engine.release_template.context(
            "this Godot came without an export template: install it in the editor (Editor → Manage Export Templates)",
        )?;
        println!("{}", template.display());
    } else {
        println!("{}", engine.program.display());
    }
    Ok(())
}

/// Finds Godot, or fetches it.
///
/// # Errors
/// When `GODOT` names something unusable, or when Godot is neither found nor downloadable; the message says what to do.
pub(crate) fn provision() -> Result<Engine> {
    if let Some(named) = env::var_os("GODOT").filter(|value| !value.is_empty()) {
        let program = PathBuf::from(named);
        return probe(&program, None).with_context(|| format!("GODOT names {}", program.display()));
    }
    for name in ["godot", "godot4"] {
        let Some(program) = paths::on_path(&[name]) else {
            continue;
        };
        match probe(&program, None) {
            Ok(engine) => return Ok(engine),
            Err(error) => eprintln!("passing over {}: {error:#}", program.display()),
        }
    }
    let cache = paths::godot_cache()?;
    fs::create_dir_all(&cache).with_context(|| format!("cannot create {}", cache.display()))?;
    // Two runs at once would spoil each other's half-made files; the second one waits and then finds all done.
    let lock = File::create(cache.join("lock"))
        .with_context(|| format!("cannot write into {}", cache.display()))?;
    lock.lock()
        .with_context(|| format!("cannot lock {}", cache.display()))?;
    if let Some(engine) = cached(&cache) {
        return Ok(engine);
    }
    let program = fetch(&cache)?;
    let engine =
        probe(&program, template_of(&cache)).context("the downloaded Godot does not run")?;
    let marker = format!("{LAYOUT}\n{}\n{}\n", engine.version, program.display());
    fs::write(cache.join("finished"), marker)
        .with_context(|| format!("cannot write into {}", cache.display()))?;
    Ok(engine)
}

/// Engine that an earlier run left in the cache, when that run was finished and the engine still starts.
fn cached(cache: &Path) -> Option<Engine> {
    let marker = fs::read_to_string(cache.join("finished")).ok()?;
    let program = program_in_marker(&marker)?;
    let template = template_of(cache);
    if template.is_some()
        && let Err(reason) = apt::refresh(cache)
    {
        eprintln!("downloading Godot again: {reason:#}");
        return None;
    }
    probe(&program, template).ok()
}

fn program_in_marker(marker: &str) -> Option<PathBuf> {
    let mut lines = marker.lines();
    (lines.next()? == LAYOUT).then_some(())?;
    lines.nth(1).map(PathBuf::from)
}

/// A command that starts a game that was exported with this engine's own template.
///
/// # Errors
/// When a game that was exported with Debian's template cannot be made to start here.
pub(crate) fn exported_game(engine: &Engine, game: &Path) -> Result<Command> {
    if is_debians(engine)? {
        apt::game(&paths::godot_cache()?, game)
    } else {
        Ok(Command::new(game))
    }
}

/// Returns whether games that are exported with this engine's template need Debian's libraries, as the official ones do not.
///
/// # Errors
/// When there is no cache.
pub(crate) fn is_debians(engine: &Engine) -> Result<bool> {
    let template = template_of(&paths::godot_cache()?);
    Ok(template.is_some() && engine.release_template == template)
}

/// Files of a Godot for arm64, for an emulator; fetched into the cache. Godot itself is `usr/bin/godot` below the folder that is returned.
///
/// # Errors
/// When Debian's archive, or one for arm64 in it, cannot be had.
pub(crate) fn arm64() -> Result<PathBuf> {
    let folder = fetch::once("godot-arm64", LAYOUT, |folder| apt::arm64(folder).map(drop))?;
    Ok(folder.join("root"))
}

fn template_of(cache: &Path) -> Option<PathBuf> {
    Some(cache.join(apt::RELEASE_TEMPLATE)).filter(|file| file.is_file())
}

/// Fetches Godot into the cache and returns what to start.
fn fetch(cache: &Path) -> Result<PathBuf> {
    let from_apt = match apt::Archive::find(cache) {
        Ok(archive) => apt::fetch(&archive, cache),
        Err(reason) => Err(reason),
    };
    let apt_reason = match from_apt {
        Ok(program) => return Ok(program),
        Err(reason) => format!("{reason:#}"),
    };
    eprintln!("not from the package archive: {apt_reason}");
    official::fetch(cache).map_err(|official_reason| {
        anyhow::anyhow!(
            "there is no Godot {}.{} or newer on this machine, and none could be downloaded.\n  \
             package archive: {apt_reason}\n  official release: {official_reason:#}\n\
             Get it from godotengine.org, then put `godot` on the PATH or let the variable GODOT name it.",
            OLDEST.0,
            OLDEST.1
        )
    })
}

/// Asks a program whether it is a Godot that is new enough.
fn probe(program: &Path, release_template: Option<PathBuf>) -> Result<Engine> {
    let said = process::read(Command::new(program).args(["--headless", "--version"]))?;
    // Debian's build may say other things first.
    let version = said
        .lines()
        .map(str::trim)
        .rfind(|line| parsed(line).is_some());
    let Some(version) = version else {
        bail!(
            "`{} --version` does not print a version, but {said:?}",
            program.display()
        );
    };
    if parsed(version) < Some(OLDEST) {
        bail!(
            "it is Godot {version}, and at least {}.{} is needed",
            OLDEST.0,
            OLDEST.1
        );
    }
    Ok(Engine {
        program: program.to_path_buf(),
        version: version.to_owned(),
        release_template,
    })
}

/// Major and minor of a version such as `4.6.3.stable.custom_build`.
fn parsed(version: &str) -> Option<(u32, u32)> {
    let mut parts = version.split('.');
    Some((
        parts.next()?.parse().ok()?,
        parts.next()?.split('-').next()?.parse().ok()?,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_and_ordered() {
        assert_eq!(parsed("4.6.3.stable.debian"), Some((4, 6)));
        assert_eq!(parsed("4.7-dev2.official"), Some((4, 7)));
        assert_eq!(parsed("ALSA lib something"), None);
        assert!(parsed("3.6.stable") < Some(OLDEST) && parsed("4.10.stable") > Some(OLDEST));
    }

    #[test]
    fn a_marker_of_another_layout_counts_for_nothing() {
        let marker = format!("{LAYOUT}\n4.6.3.stable\ncache/godot\n");
        assert_eq!(
            program_in_marker(&marker),
            Some(PathBuf::from("cache/godot"))
        );
        assert_eq!(
            program_in_marker("footfall godot cache 0\n4.6\ncache/godot\n"),
            None
        );
        assert_eq!(program_in_marker(""), None);
    }

    #[cfg(unix)]
    #[test]
    fn an_old_or_strange_program_is_refused_with_its_reason() {
        use std::os::unix::fs::PermissionsExt as _;
        let file = env::temp_dir().join(format!("footfall_godot_{}", std::process::id()));
        for (answer, reason) in [
            ("4.5.1.stable", "at least 4.6"),
            ("hello", "does not print a version"),
        ] {
            fs::write(&file, format!("#!/bin/sh\necho {answer}\n")).unwrap();
            fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
            let error = probe(&file, None).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
        }
        fs::remove_file(file).unwrap();
    }
}
