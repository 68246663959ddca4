//! `cargo xtask csharp`: typed wrappers for C#, made from what the library registers, compared, compiled and tried.
//!
//! C# knows nothing of classes that an extension brings. The wrappers stand in `addons/footfall/csharp`, where a game's own project finds them.

mod class;
mod comments;
mod compiled;
mod documents;
mod names;
mod reference;
mod types;
mod writer;

use crate::paths;
use anyhow::{Context as _, Result, bail};
use reference::Reference;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use types::Types;

/// Makes the wrappers, or checks them.
///
/// # Errors
/// As [`check`]; when the library cannot be asked or a file not be written.
pub(crate) fn command(only_check: bool) -> Result<()> {
    if only_check {
        return check();
    }
    let folder = folder();
    let made = made(&Reference::ask()?)?;
    for name in there()?.keys().filter(|name| !made.contains_key(*name)) {
        let file = folder.join(name);
        fs::remove_file(&file).with_context(|| format!("cannot remove {}", file.display()))?;
    }
    for (name, text) in &made {
        let file = folder.join(name);
        fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
    }
    eprintln!("{} files in {}", made.len(), folder.display());
    Ok(())
}

/// Checks that the wrappers are those of the library as it is now, and that they do what they should.
///
/// # Errors
/// Checks the wrappers; the error names the one that is out of date, does not compile or fails.
pub(crate) fn check() -> Result<()> {
    let reference = Reference::ask()?;
    let (made, there) = (made(&reference)?, there()?);
    let mut names: Vec<&String> = made.keys().chain(there.keys()).collect();
    names.sort_unstable();
    names.dedup();
    names.retain(|name| made.get(*name) != there.get(*name));
    if !names.is_empty() {
        let names: Vec<&str> = names.into_iter().map(String::as_str).collect();
        bail!(
            "out of date in {}: {}. Run `cargo xtask csharp`",
            folder().display(),
            names.join(", ")
        );
    }
    eprintln!("{} files of wrappers for C# are up to date", made.len());
    compiled::check(&reference)
}

fn folder() -> PathBuf {
    paths::addon().join("csharp")
}

/// Every file that the reference gives, by name.
fn made(reference: &Reference) -> Result<BTreeMap<String, String>> {
    let types = Types {
        enums: types::enums(reference)?,
        reference,
    };
    let mut files = BTreeMap::new();
    for class in &reference.classes {
        let text = class::class_file(class, &types)?;
        files.insert(format!("{}.cs", class.name), text);
    }
    for (name, one) in &types.enums {
        files.insert(format!("{name}.cs"), class::enum_file(name, one));
    }
    Ok(files)
}

/// Every file that was made and is there; those written by hand lack the mark.
fn there() -> Result<BTreeMap<String, String>> {
    let folder = folder();
    let mut files = BTreeMap::new();
    for entry in
        fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?
    {
        let file = entry?.path();
        if file.extension().is_none_or(|extension| extension != "cs") {
            continue;
        }
        let text =
            fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        if let Some(name) = file.file_name()
            && text.starts_with(writer::MARK)
        {
            files.insert(name.to_string_lossy().into_owned(), text);
        }
    }
    Ok(files)
}
