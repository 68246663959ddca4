//! `cargo xtask addon`: one archive that a user unpacks into a Godot project.

use crate::library::{self, Options};
use crate::{paths, process, progress};
use anyhow::{Context as _, Result, bail};
use sha2::{Digest as _, Sha256};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;

/// Files without which an add-on is not complete, from `addons/footfall`.
const NEEDED: [&str; 6] = [
    "footfall.gdextension",
    "plugin.cfg",
    "LICENSE",
    "README.md",
    "models/locomotion.footfall",
    "controller/gait_character_3d.tscn",
];

/// Files of the archive besides the add-on's own.
const THIRD_PARTY: &str = "addons/footfall/THIRD_PARTY.md";
const CHECKSUMS: &str = "addons/footfall/SHA256SUMS";

/// Writes `rust/target/footfall-addon.zip`, with this machine's library in both flavours, or with `packed` with those of
/// all platforms, which must be in `bin/` already.
///
/// # Errors
/// When the build fails or the add-on is not complete.
pub(crate) fn command(packed: bool) -> Result<()> {
    if !packed {
        library::build(&Options {
            all: true,
            ..Options::default()
        })?;
    }
    let addon = paths::addon();
    for name in NEEDED {
        if !addon.join(name).is_file() {
            bail!("the add-on is not complete: addons/footfall/{name} is missing");
        }
    }
    let missing = missing_libraries(&addon)?;
    if packed && !missing.is_empty() {
        bail!("the add-on is not complete: {} missing", missing.join(", "));
    }
    for name in missing {
        eprintln!("not in the archive, since it is not built here: {name}");
    }
    let archive = paths::target_folder().join("footfall-addon.zip");
    let files = self::archive(&archive)?;
    let sums = archive.with_extension("zip.sha256");
    let bytes = fs::read(&archive).with_context(|| format!("cannot read {}", archive.display()))?;
    fs::write(&sums, format!("{}  footfall-addon.zip\n", sha256(&bytes)))
        .with_context(|| format!("cannot write {}", sums.display()))?;
    eprintln!("{} ({files} files)", archive.display());
    Ok(())
}

/// Writes the add-on, with the libraries that `bin/` holds, into an archive; returns how many files that is.
///
/// # Errors
/// When a file cannot be read or written.
pub(crate) fn archive(archive: &Path) -> Result<usize> {
    if let Some(folder) = archive.parent() {
        fs::create_dir_all(folder)
            .with_context(|| format!("cannot create {}", folder.display()))?;
    }
    pack(&paths::addon(), archive, &third_party()?)
}

/// Text about the crates that the library is built from besides this project, and their terms.
///
/// # Errors
/// When cargo fails.
pub(crate) fn third_party() -> Result<String> {
    let tree = process::read(process::cargo().args([
        "tree",
        "--locked",
        "--package",
        "footfall_godot",
        "--features",
        "footfall_godot/editor",
        "--edges",
        "normal",
        "--target",
        "all",
        "--prefix",
        "none",
        "--format",
        "{p}|{l}|{r}",
    ]))?;
    Ok(notices(&tree))
}

/// The recordings that shipped models learned from.
const DATA: &str = "The models in `models/` are trained on recordings under these terms; none of the recordings is in this archive.\n\n\
    | recordings | terms | source |\n| --- | --- | --- |\n\
    | CMU Graphics Lab Motion Capture Database | free for any use; created with funding from NSF EIA-0196217 | mocap.cs.cmu.edu |\n\
    | O3DE Motion Matching gem | Apache-2.0 OR MIT | github.com/o3de/o3de |\n\
    | ReActIdle | MIT, Copyright (c) 2025 RSAIT | github.com/Enekoassets/ReActIdle |\n";

/// A table of crates from `cargo tree`, each once; those without a source of their own are this project's.
fn notices(tree: &str) -> String {
    let rows: BTreeSet<String> = tree
        .lines()
        .filter_map(|line| {
            let mut parts = line.trim_end_matches(" (*)").split('|');
            let (name, licence, source) = (parts.next()?, parts.next()?, parts.next()?);
            let own = name.contains(" (") && !name.contains("proc-macro");
            let name = name.trim_end_matches(" (proc-macro)");
            (!own && !licence.is_empty()).then(|| format!("| {name} | {licence} | {source} |"))
        })
        .collect();
    let rows: Vec<String> = rows.into_iter().collect();
    format!(
        "# Third-party notices\n\n\
         The library in `bin/` contains these crates. Each may be used under the terms beside it; their texts are at the sources.\n\n\
         | crate | terms | source |\n| --- | --- | --- |\n{}\n\n{DATA}",
        rows.join("\n")
    )
}

/// A checksum as `sha256sum` prints it.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

/// The libraries that the `.gdextension` file names but `bin/` does not hold.
fn missing_libraries(addon: &Path) -> Result<Vec<String>> {
    let text = fs::read_to_string(addon.join("footfall.gdextension"))
        .context("cannot read footfall.gdextension")?;
    Ok(named_libraries(&text)
        .into_iter()
        .filter(|name| !addon.join(name).is_file())
        .collect())
}

fn named_libraries(gdextension: &str) -> Vec<String> {
    let mut names: Vec<String> = gdextension
        .split('"')
        .filter_map(|quoted| {
            let name = quoted
                .strip_prefix("res://addons/footfall/")
                .unwrap_or(quoted);
            name.starts_with("bin/").then(|| name.to_owned())
        })
        .collect();
    names.sort();
    names.dedup();
    names
}

/// Writes every file of the add-on, in order and without times, so that equal add-ons give equal archives; then the notices, and the
/// checksums of all of them.
fn pack(addon: &Path, archive: &Path, notices: &str) -> Result<usize> {
    let mut files = Vec::new();
    collect(addon, &mut files)?;
    files.sort();
    let bar = progress::count(files.len() as u64, "packing the add-on");
    let partial = archive.with_extension("zip.partial");
    let output =
        File::create(&partial).with_context(|| format!("cannot write {}", partial.display()))?;
    let mut zip = zip::ZipWriter::new(BufWriter::new(output));
    let options = SimpleFileOptions::default()
        .last_modified_time(zip::DateTime::default())
        .unix_permissions(0o644);
    let mut sums = Vec::new();
    for file in &files {
        let inside = file
            .strip_prefix(addon)
            .context("a file outside the add-on")?;
        let name = Path::new("addons/footfall")
            .join(inside)
            .display()
            .to_string()
            .replace('\\', "/");
        let bytes = fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
        sums.push(format!("{}  {name}", sha256(&bytes)));
        zip.start_file(name, options)?;
        zip.write_all(&bytes)?;
        bar.inc(1);
    }
    sums.push(format!("{}  {THIRD_PARTY}", sha256(notices.as_bytes())));
    zip.start_file(THIRD_PARTY, options)?;
    zip.write_all(notices.as_bytes())?;
    zip.start_file(CHECKSUMS, options)?;
    zip.write_all(format!("{}\n", sums.join("\n")).as_bytes())?;
    zip.finish()?.flush()?;
    bar.finish_and_clear();
    fs::rename(&partial, archive)
        .with_context(|| format!("cannot create {}", archive.display()))?;
    Ok(files.len() + 2)
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    for entry in
        fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?
    {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path
            .extension()
            .is_none_or(|extension| extension != "fresh")
        {
            files.push(path);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libraries_are_read_from_the_gdextension_file() {
        let text = "[configuration]\nentry_symbol = \"x\"\n[libraries]\nlinux.debug = \"res://addons/footfall/bin/a/b.so\"\n\
                    linux.release = \"bin/a/c.so\"\nlinux.editor = \"bin/a/c.so\"\n";
        assert_eq!(named_libraries(text), ["bin/a/b.so", "bin/a/c.so"]);
    }

    #[test]
    fn notices_name_every_crate_once_and_not_our_own() {
        let tree = "footfall_core v0.1.0 (/somewhere)|MIT OR Apache-2.0|\nglam v0.32.1|MIT OR Apache-2.0|https://a\n\
                    glam v0.32.1|MIT OR Apache-2.0|https://a (*)\nserde_derive v1.0.0 (proc-macro)|MIT|https://b\n";
        let text = notices(tree);
        assert!(text.contains("ReActIdle"), "the recordings are named");
        assert_eq!(text.matches("glam").count(), 1);
        assert!(text.contains("| serde_derive v1.0.0 | MIT | https://b |"));
        assert!(!text.contains("footfall_core"));
    }

    #[test]
    fn checksums_are_those_of_sha256sum() {
        let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        assert_eq!(sha256(b""), empty);
    }

    #[test]
    fn an_archive_holds_every_file_under_the_add_ons_folder_and_is_the_same_twice() {
        let folder = std::env::temp_dir().join(format!("footfall_addon_{}", std::process::id()));
        let addon = folder.join("addon");
        fs::create_dir_all(addon.join("bin/x")).unwrap();
        fs::write(addon.join("plugin.cfg"), "[plugin]").unwrap();
        fs::write(addon.join("bin/x/lib.so"), [7_u8; 5000]).unwrap();
        fs::write(addon.join("bin/x/lib.fresh"), "half").unwrap();
        let (first, second) = (folder.join("a.zip"), folder.join("b.zip"));
        assert_eq!(pack(&addon, &first, "notices").unwrap(), 4);
        pack(&addon, &second, "notices").unwrap();
        assert_eq!(fs::read(&first).unwrap(), fs::read(&second).unwrap());
        let mut zip = zip::ZipArchive::new(File::open(&first).unwrap()).unwrap();
        assert_eq!(
            zip.by_index(0).unwrap().name().unwrap(),
            "addons/footfall/bin/x/lib.so"
        );
        assert_eq!(
            zip.by_name("addons/footfall/bin/x/lib.so").unwrap().size(),
            5000
        );
        assert!(zip.by_name("addons/footfall/plugin.cfg").is_ok());
        let sums = std::io::read_to_string(zip.by_name(CHECKSUMS).unwrap()).unwrap();
        // What `printf notices | sha256sum` prints.
        let notices = sha256(b"notices");
        assert!(
            sums.contains(&format!("{notices}  {THIRD_PARTY}")),
            "{sums}"
        );
        assert_eq!(sums.lines().count(), 3);
        fs::remove_dir_all(folder).unwrap();
    }
}
