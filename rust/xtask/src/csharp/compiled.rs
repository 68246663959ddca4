//! The wrappers compiled against a stand-in for the engine's C# API, and tried.
//!
//! The real API comes from a registry of its own; `tests/csharp/Godot.cs` declares what the wrappers use of it and notes what reaches the engine.

use super::reference::Reference;
use super::types::OBJECT;
use crate::mono::Mono;
use crate::{paths, process};
use anyhow::{Context as _, Result};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Compiles the wrappers, the code of their README and the tests, and runs these. Without a compiler it says so and passes.
///
/// # Errors
/// Compiles the wrappers and runs their tests. An error is the complaint of the compiler or of a test.
pub(super) fn check(reference: &Reference) -> Result<()> {
    let mono = match Mono::provision() {
        Ok(mono) => mono,
        Err(reason) => {
            eprintln!(
                "skipped: the wrappers for C# are not compiled, for there is no Mono: {reason:#}"
            );
            return Ok(());
        }
    };
    let folder = paths::target_folder().join("csharp");
    fs::create_dir_all(&folder).with_context(|| format!("cannot create {}", folder.display()))?;
    let program = folder.join("wrappers.exe");
    let (examples, engine) = (folder.join("Readme.cs"), folder.join("Engine.cs"));
    let members = folder.join("members.txt");
    write(&examples, &examples_of_readme()?)?;
    write(&members, &listed(reference))?;
    let tests = paths::repository_root().join("tests/csharp");
    let declared = fs::read_to_string(tests.join("Godot.cs")).context("tests/csharp/Godot.cs")?;
    write(&engine, &engine_classes(reference, &declared))?;
    process::read(
        mono.compiler()
            .args(["-langversion:latest", "-warn:4", "-warnaserror", "-nologo"])
            .arg(format!("-doc:{}", folder.join("wrappers.xml").display()))
            // Tests and the stand-in need no documentation.
            .arg("-nowarn:1591")
            .arg(format!("-out:{}", program.display()))
            .args(sources(&super::folder())?)
            .args(sources(&tests)?)
            .args([&examples, &engine]),
    )?;
    let said = process::read(mono.program(&program).arg(&members))?;
    eprint!("{said}");
    Ok(())
}

fn write(file: &Path, text: &str) -> Result<()> {
    fs::write(file, text).with_context(|| format!("cannot write {}", file.display()))
}

fn sources(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in
        fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?
    {
        let file = entry?.path();
        if file.extension().is_some_and(|extension| extension == "cs") {
            files.push(file);
        }
    }
    files.sort_unstable();
    Ok(files)
}

/// The C# that the README shows.
fn examples_of_readme() -> Result<String> {
    let file = super::folder().join("README.md");
    let text =
        fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
    Ok(text
        .split("```csharp\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .collect())
}

/// Classes of the engine that wrappers name and the stand-in does not declare.
fn engine_classes(reference: &Reference, declared: &str) -> String {
    let mut classes = BTreeMap::new();
    for class in &reference.classes {
        let objects = class.slots().filter(|slot| slot.variant == OBJECT);
        classes.extend(objects.filter_map(|slot| Some((slot.class()?, "Resource"))));
    }
    for class in &reference.classes {
        classes.insert(&class.base, "Node3D");
    }
    classes.retain(|name, _| {
        reference.class(name).is_none() && !declared.contains(&format!("class {name} "))
    });
    let lines = classes.iter();
    let lines = lines.map(|(name, base)| format!("    public class {name} : {base} {{ }}\n"));
    format!("namespace Godot\n{{\n{}}}\n", lines.collect::<String>())
}

/// Members of all classes, one a line, so that the tests see that each is reached.
fn listed(reference: &Reference) -> String {
    let mut lines = String::new();
    for class in &reference.classes {
        let kinds = [
            ("property", class.property_names()),
            ("method", class.method_names()),
            ("signal", class.signal_names()),
        ];
        for (kind, names) in kinds {
            for name in names {
                lines.extend([&class.name, " ", kind, " ", name, "\n"]);
            }
        }
    }
    lines
}
