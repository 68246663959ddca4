//! Permitted dependencies between crates, checked with `cargo metadata`.

use super::Violation;
use serde_json::Value;
use std::collections::BTreeSet;

/// Crates that games ship.
const RUNTIME: [&str; 10] = [
    "footfall_core",
    "footfall_prob",
    "footfall_model",
    "footfall_synth",
    "footfall_imu",
    "footfall_recon",
    "footfall_ik",
    "footfall_rig",
    "footfall",
    "footfall_godot",
];
/// Crates for work at the desk.
const OFFLINE: [&str; 2] = ["footfall_motion", "footfall_train"];
/// Crates that may use `anyhow`.
const TOOLS: [&str; 4] = [
    "footfall_cli",
    "footfall_mannequin",
    "footfall_studio",
    "xtask",
];

/// One line of a crate's dependencies.
struct Dependency<'a> {
    name: &'a str,
    optional: bool,
    for_tests: bool,
}

/// Checks the packages of a workspace.
pub(super) fn check(metadata: &Value) -> Vec<Violation> {
    let none = Vec::new();
    let packages = metadata["packages"].as_array().unwrap_or(&none);
    let mut violations = Vec::new();
    for package in packages {
        let name = package["name"].as_str().unwrap_or_default();
        let mut report = |rule: String| {
            violations.push(Violation {
                file: format!("{name}/Cargo.toml"),
                line: 0,
                rule,
            });
        };
        for dependency in dependencies(package) {
            if dependency.name == "godot" && name != "footfall_godot" {
                report("only footfall_godot depends on `godot` (invariant 2)".into());
            }
            if dependency.name == "anyhow" && !TOOLS.contains(&name) {
                report("only the tools depend on `anyhow` (invariant 2)".into());
            }
        }
        if RUNTIME.contains(&name) {
            for offline in reached(packages, package).intersection(&OFFLINE.into()) {
                report(format!(
                    "a runtime crate may not reach {offline} (invariant 1)"
                ));
            }
            for rule in outside_editor(package) {
                report(rule);
            }
        }
    }
    violations
}

fn dependencies(package: &Value) -> impl Iterator<Item = Dependency<'_>> {
    package["dependencies"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|dependency| Dependency {
            name: dependency["name"].as_str().unwrap_or_default(),
            optional: dependency["optional"].as_bool().unwrap_or_default(),
            for_tests: dependency["kind"] == "dev",
        })
}

/// Every crate that a package always needs, directly or through others of the workspace.
fn reached<'a>(packages: &'a [Value], package: &'a Value) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open = vec![package];
    while let Some(package) = open.pop() {
        for dependency in
            dependencies(package).filter(|dependency| !dependency.optional && !dependency.for_tests)
        {
            if reached.insert(dependency.name) {
                open.extend(
                    packages
                        .iter()
                        .filter(|other| other["name"] == dependency.name),
                );
            }
        }
    }
    reached
}

/// Optional offline crates that something else than the feature `editor` switches on.
fn outside_editor(package: &Value) -> Vec<String> {
    let name = package["name"].as_str().unwrap_or_default();
    let optional: Vec<&str> = dependencies(package)
        .filter(|dependency| dependency.optional && OFFLINE.contains(&dependency.name))
        .map(|dependency| dependency.name)
        .collect();
    let mut broken = Vec::new();
    for (feature, parts) in package["features"].as_object().into_iter().flatten() {
        for part in parts
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
        {
            let switched = part
                .trim_start_matches("dep:")
                .split(['/', '?'])
                .next()
                .unwrap_or_default();
            if optional.contains(&switched) && !(name == "footfall_godot" && feature == "editor") {
                broken.push(format!("feature `{feature}` brings {switched}: only footfall_godot's `editor` may (invariant 1)"));
            }
            if feature == "default" && part == "editor" {
                broken.push("`editor` may not be a default feature (invariant 1): exported games are built without".into());
            }
        }
    }
    broken
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn package(name: &str, needs: &[&str]) -> Value {
        let needs: Vec<Value> = needs
            .iter()
            .map(|name| json!({"name": name, "kind": null, "optional": false}))
            .collect();
        json!({"name": name, "dependencies": needs, "features": {}})
    }

    fn rules(packages: &[Value]) -> Vec<String> {
        check(&json!({"packages": packages}))
            .iter()
            .map(ToString::to_string)
            .collect()
    }

    #[test]
    fn runtime_crates_reach_no_offline_crate_even_through_others() {
        let found = rules(&[
            package("footfall_synth", &["footfall_model"]),
            package("footfall_model", &["footfall_train"]),
            package("footfall_train", &["footfall_motion"]),
        ]);
        assert_eq!(found.len(), 4, "{found:?}");
        assert!(
            found[0].starts_with("footfall_synth/Cargo.toml")
                && found[0].contains("footfall_motion")
        );
        assert_eq!(rules(&[package("footfall", &["footfall_train"])]).len(), 1);
        let mut tested = package("footfall_synth", &["footfall_motion"]);
        tested["dependencies"][0]["kind"] = "dev".into();
        assert!(rules(&[tested]).is_empty());
        assert!(rules(&[package("footfall_cli", &["footfall_train", "anyhow"])]).is_empty());
    }

    #[test]
    fn the_nodes_reach_offline_crates_behind_editor_only() {
        let mut nodes = package("footfall_godot", &["footfall_motion", "godot"]);
        nodes["dependencies"][0]["optional"] = true.into();
        nodes["features"] = json!({"editor": ["dep:footfall_motion", "godot/register-docs"]});
        assert!(rules(&[nodes.clone()]).is_empty());
        nodes["features"]["preview"] = json!(["dep:footfall_motion"]);
        assert_eq!(rules(&[nodes.clone()]).len(), 1);
        nodes["features"] = json!({"default": ["editor"], "editor": ["dep:footfall_motion"]});
        assert_eq!(rules(&[nodes]).len(), 1);
        assert_eq!(
            rules(&[package("footfall_godot", &["footfall_motion"])]).len(),
            1
        );
    }

    #[test]
    fn the_engine_and_anyhow_have_their_owners() {
        assert_eq!(rules(&[package("footfall_synth", &["godot"])]).len(), 1);
        assert_eq!(rules(&[package("footfall_motion", &["anyhow"])]).len(), 1);
        assert!(
            rules(&[
                package("footfall_godot", &["godot"]),
                package("xtask", &["anyhow"])
            ])
            .is_empty()
        );
    }
}
