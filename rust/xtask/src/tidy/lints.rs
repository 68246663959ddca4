//! Rules on Clippy's settings: the workspace's lints apply in every crate, and all crates without access to the system share one set of limits.

use super::Violation;

/// Crates whose results depend on their arguments alone.
const PURE: [&str; 7] = [
    "footfall_core",
    "footfall_prob",
    "footfall_model",
    "footfall_synth",
    "footfall_recon",
    "footfall_ik",
    "footfall_rig",
];

/// Checks the manifests and limits of all crates; `read` gives the text of a file of the repository.
pub(super) fn check(names: &[&str], read: impl Fn(&str) -> Option<String>) -> Vec<Violation> {
    let mut violations = Vec::new();
    let mut report = |file: &str, rule: &str| {
        violations.push(Violation {
            file: file.into(),
            line: 0,
            rule: rule.into(),
        });
    };
    let is_member = |name: &&&str| {
        let folder = name.strip_suffix("/Cargo.toml");
        let parts = folder.map(|folder| folder.split('/').collect::<Vec<_>>());
        parts.is_some_and(|parts| {
            matches!(
                parts[..],
                ["rust", "crates", _] | ["rust", "xtask"] | ["tests", "rust"]
            )
        })
    };
    for name in names.iter().filter(is_member) {
        if !read(name).is_some_and(|text| text.contains("[lints]\nworkspace = true")) {
            report(
                name,
                "`[lints]` does not take those of the workspace: print_stdout, todo and others hold through it",
            );
        }
    }
    let limits = |owner: &str| format!("rust/crates/{owner}/clippy.toml");
    let first = read(&limits(PURE[0])).unwrap_or_default();
    for owner in PURE {
        if first.is_empty() || read(&limits(owner)).as_deref() != Some(&first) {
            let rule = format!(
                "not the limits of {}: copy its clippy.toml (invariant 3)",
                PURE[0]
            );
            report(&limits(owner), &rule);
        }
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(manifest: &str, limits: impl Fn(&str) -> Option<String>) -> Vec<String> {
        let names = [
            "rust/Cargo.toml",
            "rust/crates/footfall_ik/Cargo.toml",
            "rust/fuzz/Cargo.toml",
        ];
        let read = |name: &str| {
            if name.ends_with("clippy.toml") {
                limits(name)
            } else {
                Some(manifest.to_owned())
            }
        };
        let found = check(&names, read);
        found.into_iter().map(|violation| violation.file).collect()
    }

    #[test]
    fn members_take_the_lints_of_the_workspace() {
        let same = |_: &str| Some("limits".to_owned());
        assert_eq!(checked("[lints]\nworkspace = true\n", same), [""; 0]);
        let without = checked("[package]\n", same);
        assert_eq!(without, ["rust/crates/footfall_ik/Cargo.toml"]);
    }

    #[test]
    fn crates_that_touch_nothing_outside_have_equal_limits() {
        let lints = "[lints]\nworkspace = true\n";
        let one_off = |name: &str| {
            Some(
                if name.contains("_ik/") {
                    "fewer"
                } else {
                    "limits"
                }
                .to_owned(),
            )
        };
        assert_eq!(
            checked(lints, one_off),
            ["rust/crates/footfall_ik/clippy.toml"]
        );
        assert_eq!(checked(lints, |_| None).len(), PURE.len());
    }
}
