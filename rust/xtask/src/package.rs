//! `cargo verify package`: every crate that is meant for others, packaged and compiled from its package alone.
//!
//! Cargo's own check of a package builds all dependencies anew for each crate: five minutes on two cores for these. Here the packages are unpacked
//! side by side into a workspace that takes them for each other and shares the target folder, so that only they are checked. The whole way, once
//! before a release: `cargo package --workspace` with an `--exclude` for every crate that is not published; `cargo publish --dry-run` also asks the registry.

use crate::{paths, process};
use anyhow::{Result, bail};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Facts that a package's page in a registry shows.
const FACTS: [&str; 4] = ["description", "license", "readme", "rust_version"];

/// Packages, unpacks and checks.
///
/// # Errors
/// A crate whose manifest lacks something, or whose package does not compile by itself.
pub(crate) fn check() -> Result<()> {
    let metadata = process::metadata()?;
    let none = Vec::new();
    let packages = metadata["packages"].as_array().unwrap_or(&none);
    let (published, kept): (Vec<&Value>, Vec<&Value>) =
        packages.iter().partition(|package| is_published(package));
    for package in &published {
        if let Some(problem) = problem(package, &kept) {
            bail!("{}/Cargo.toml: {problem}", name(package));
        }
    }
    let mut cargo = process::cargo();
    cargo.args([
        "package",
        "--workspace",
        "--locked",
        "--offline",
        "--allow-dirty",
        "--no-verify",
    ]);
    for package in &kept {
        cargo.args(["--exclude", name(package)]);
    }
    process::read(&mut cargo)?;
    let folder = paths::target_folder().join("packaged");
    paths::make_empty(&folder)?;
    let mut folders = Vec::new();
    for package in &published {
        let version = package["version"].as_str().unwrap_or_default();
        let unpacked = format!("{}-{version}", name(package));
        let archive = paths::target_folder()
            .join("package")
            .join(format!("{unpacked}.crate"));
        // With times of their own: those in a package are always the same, and cargo would take a file that changed for the one it knows.
        process::read(
            Command::new("tar")
                .arg("xzmf")
                .arg(&archive)
                .arg("-C")
                .arg(&folder),
        )?;
        folders.push((name(package).to_owned(), unpacked));
    }
    let ours = fs::read_to_string(paths::workspace().join("Cargo.toml"))?;
    fs::write(folder.join("Cargo.toml"), workspace(&folders, &ours))?;
    fs::copy(
        paths::workspace().join("Cargo.lock"),
        folder.join("Cargo.lock"),
    )?;
    compile(&folder)?;
    eprintln!("{} packages compile by themselves", published.len());
    Ok(())
}

fn compile(folder: &Path) -> Result<()> {
    process::run(
        process::cargo()
            .current_dir(folder)
            .args(["check", "--quiet", "--offline", "--workspace"])
            .args(["--features", "footfall/live"])
            .env("CARGO_TARGET_DIR", paths::target_folder()),
    )
}

fn name(package: &Value) -> &str {
    package["name"].as_str().unwrap_or_default()
}

/// Returns whether a manifest lets a crate be published: it names no registries, or some.
fn is_published(package: &Value) -> bool {
    package["publish"]
        .as_array()
        .is_none_or(|to| !to.is_empty())
}

/// A fault for which a registry would refuse a package, or a lack that its readers would notice.
fn problem(package: &Value, kept: &[&Value]) -> Option<String> {
    let lists = ["keywords", "categories"];
    let no_fact = |fact: &&&str| package[**fact].as_str().is_none_or(str::is_empty);
    if let Some(fact) = FACTS.iter().find(no_fact) {
        return Some(format!("`{fact}` is missing"));
    }
    let no_list = |list: &&&str| package[**list].as_array().is_none_or(Vec::is_empty);
    if let Some(list) = lists.iter().find(no_list) {
        return Some(format!("`{list}` are missing"));
    }
    let dependencies = package["dependencies"].as_array().into_iter().flatten();
    dependencies
        // Without a path it comes from a registry; for tests without a version it is left out of the package.
        .filter(|dependency| dependency["path"].is_string())
        .filter(|dependency| dependency["kind"] != "dev" || dependency["req"] != "*")
        .find_map(|dependency| {
            let needed = name(dependency);
            if dependency["req"] == "*" {
                Some(format!("`{needed}` has a path and no version"))
            } else if kept.iter().any(|package| name(package) == needed) {
                Some(format!("`{needed}` is not published"))
            } else {
                None
            }
        })
}

/// The manifest of a workspace of packages that take each other for what they ask the registry for. Profiles are those of ours, so that what other crates were
/// built to serves again.
fn workspace(folders: &[(String, String)], ours: &str) -> String {
    let sources: Vec<String> = folders
        .iter()
        .map(|(name, folder)| format!("{name} = {{ path = \"{folder}\" }}\n"))
        .collect();
    let mut manifest = format!(
        "[workspace]\nresolver = \"3\"\nmembers = [\"*\"]\n\n[patch.crates-io]\n{}",
        sources.concat()
    );
    let mut in_profile = false;
    for line in ours.lines() {
        if line.starts_with('[') {
            in_profile = line.starts_with("[profile.") && !line.contains("footfall_");
            // Profiles of our tools would be of packages that are not there.
            in_profile &= !line.contains("xtask");
        }
        if in_profile {
            manifest.push_str(line);
            manifest.push('\n');
        }
    }
    manifest
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn package() -> Value {
        json!({
            "name": "a", "version": "1.0.0", "publish": null, "description": "What a does", "license": "MIT", "readme": "README.md",
            "rust_version": "1.94", "keywords": ["gait"], "categories": ["game-development"],
            "dependencies": [
                {"name": "b", "path": "/b", "req": "^1.0", "kind": null},
                {"name": "tests", "path": "/tests", "req": "*", "kind": "dev"},
                {"name": "serde", "path": null, "req": "^1", "kind": null},
            ],
        })
    }

    #[test]
    fn a_package_says_what_it_is_and_where_its_dependencies_come_from() {
        assert_eq!(problem(&package(), &[]), None);
        for fact in FACTS.into_iter().chain(["keywords", "categories"]) {
            let mut lacking = package();
            lacking[fact] = Value::Null;
            assert!(
                problem(&lacking, &[]).is_some_and(|p| p.contains(fact)),
                "{fact}"
            );
        }
        let mut lacking = package();
        lacking["dependencies"][0]["req"] = "*".into();
        assert!(problem(&lacking, &[]).is_some_and(|p| p.contains("no version")));
        let kept = json!({"name": "b"});
        assert!(problem(&package(), &[&kept]).is_some_and(|p| p.contains("not published")));
    }

    #[test]
    fn a_crate_that_is_not_to_be_published_is_left_out() {
        assert!(is_published(&package()));
        assert!(!is_published(&json!({"publish": []})));
    }

    #[test]
    fn the_workspace_of_packages_has_our_profiles_but_not_those_of_our_tools() {
        let ours = "[workspace]\nmembers = []\n[profile.dev]\nopt-level = 2\n[profile.dev.package.footfall_cli]\nopt-level = 1\n[profile.release]\ndebug = false\n[workspace.lints.rust]\nx = 1\n";
        let made = workspace(&[("a".into(), "a-1.0.0".into())], ours);
        assert!(made.contains(
            "a = { path = \"a-1.0.0\" }\n[profile.dev]\nopt-level = 2\n[profile.release]"
        ));
        assert!(
            !made.contains("footfall_cli") && !made.contains("x = 1"),
            "{made}"
        );
    }
}
