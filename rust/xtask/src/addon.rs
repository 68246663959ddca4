//! `cargo xtask addon`: one archive that a user unpacks into a Godot project.

use crate::library::{self, Options};
use crate::{paths, progress};
use anyhow::{Context as _, Result, bail};
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use zip::write::SimpleFileOptions;

/// What an add-on is not complete without, from `addons/footfall`.
const NEEDED: [&str; 5] = [
    "footfall.gdextension",
    "plugin.cfg",
    "LICENSE",
    "README.md",
    "models/walk.footfall",
];

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
    let files = pack(&addon, &archive)?;
    eprintln!("{} ({files} files)", archive.display());
    Ok(())
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

/// Writes every file of the add-on, in order and without times, so that equal add-ons give equal archives.
fn pack(addon: &Path, archive: &Path) -> Result<usize> {
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
    for file in &files {
        let inside = file
            .strip_prefix(addon)
            .context("a file outside the add-on")?;
        let name = Path::new("addons/footfall")
            .join(inside)
            .display()
            .to_string()
            .replace('\\', "/");
        zip.start_file(name, options)?;
        zip.write_all(&fs::read(file).with_context(|| format!("cannot read {}", file.display()))?)?;
        bar.inc(1);
    }
    zip.finish()?.flush()?;
    bar.finish_and_clear();
    fs::rename(&partial, archive)
        .with_context(|| format!("cannot create {}", archive.display()))?;
    Ok(files.len())
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
    fn an_archive_holds_every_file_under_the_add_ons_folder_and_is_the_same_twice() {
        let folder = std::env::temp_dir().join(format!("footfall_addon_{}", std::process::id()));
        let addon = folder.join("addon");
        fs::create_dir_all(addon.join("bin/x")).unwrap();
        fs::write(addon.join("plugin.cfg"), "[plugin]").unwrap();
        fs::write(addon.join("bin/x/lib.so"), [7_u8; 5000]).unwrap();
        fs::write(addon.join("bin/x/lib.fresh"), "half").unwrap();
        let (first, second) = (folder.join("a.zip"), folder.join("b.zip"));
        assert_eq!(pack(&addon, &first).unwrap(), 2);
        pack(&addon, &second).unwrap();
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
        fs::remove_dir_all(folder).unwrap();
    }
}
