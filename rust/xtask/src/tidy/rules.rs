//! Rules on the text of Rust sources.

use super::Violation;
use super::source::{code_only, is_a, without_tests};

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
/// Crates that talk to a user.
const TOOLS: [&str; 3] = ["footfall_cli", "footfall_studio", "xtask"];

/// Names that make a function depend on more than its arguments.
const IMPURE: [(&str, &str); 20] = [
    ("std::time", "the clock"),
    ("Instant::now", "the clock"),
    ("SystemTime", "the clock"),
    ("std::fs", "files"),
    ("fs::read", "files"),
    ("fs::write", "files"),
    ("File::open", "files"),
    ("File::create", "files"),
    ("std::env", "the environment"),
    ("env::var", "the environment"),
    ("std::process", "other programs"),
    ("std::net", "the network"),
    ("io::stdin", "the terminal"),
    ("rand::rng", "global randomness"),
    ("rand::random", "global randomness"),
    ("thread_rng", "global randomness"),
    ("from_entropy", "global randomness"),
    ("from_os_rng", "global randomness"),
    ("OsRng", "global randomness"),
    ("getrandom", "global randomness"),
];
const PRINTS: [&str; 5] = ["println!", "print!", "eprintln!", "eprint!", "dbg!"];
const UNFINISHED: [&str; 3] = ["todo!", "unimplemented!", "#[ignore"];

/// Checks one file; what is no Rust source passes.
pub(super) fn check(name: &str, text: &str) -> Vec<Violation> {
    if !is_a(name, "rs") {
        return Vec::new();
    }
    let code = code_only(text);
    let mut violations = Vec::new();
    let mut report = |code: &str, needle: &str, rule: &str| {
        for (index, _) in code
            .lines()
            .enumerate()
            .filter(|(_, line)| holds(line, needle))
        {
            violations.push(Violation {
                file: name.into(),
                line: index + 1,
                rule: rule.into(),
            });
        }
    };
    for needle in UNFINISHED {
        report(
            &code,
            needle,
            &format!("`{needle}`: finish it, or leave it out"),
        );
    }
    let Some(owner) = crate_of(name).filter(|_| !is_for_tests(name)) else {
        return violations;
    };
    let code = without_tests(&code);
    if PURE.contains(&owner) {
        for (needle, what) in IMPURE {
            let rule = format!(
                "`{needle}`: {owner} may not touch {what} (invariant 3); let the caller pass it in"
            );
            report(&code, needle, &rule);
        }
    }
    if !TOOLS.contains(&owner) {
        for needle in PRINTS {
            report(
                &code,
                needle,
                &format!(
                    "`{needle}`: only the tools print (invariant 2); return a value or an error"
                ),
            );
        }
        report(
            &code,
            "anyhow",
            "`anyhow`: only the tools name it (invariant 2); use the crate's own error",
        );
    }
    violations
}

/// Returns whether a line holds a needle that is no part of a longer word.
fn holds(line: &str, needle: &str) -> bool {
    let word = |character: Option<char>| character.is_some_and(|c| c.is_alphanumeric() || c == '_');
    line.match_indices(needle).any(|(at, _)| {
        let begins_word = needle.starts_with(|c: char| c.is_alphanumeric());
        let ends_word = needle.ends_with(|c: char| c.is_alphanumeric());
        let grows_left = begins_word && word(line[..at].chars().next_back());
        let grows_right = ends_word && word(line[at + needle.len()..].chars().next());
        !grows_left && !grows_right
    })
}

/// The crate that a source of the workspace belongs to.
fn crate_of(name: &str) -> Option<&str> {
    if name.starts_with("rust/xtask/") {
        return Some("xtask");
    }
    name.strip_prefix("rust/crates/")?.split('/').next()
}

/// Integration tests, benches, examples, fuzz targets and test modules in files of their own.
fn is_for_tests(name: &str) -> bool {
    name.ends_with("/tests.rs")
        || ["/tests/", "/benches/", "/examples/", "/fuzz/"]
            .iter()
            .any(|folder| name.contains(folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(name: &str, text: &str) -> Vec<usize> {
        check(name, text)
            .iter()
            .map(|violation| violation.line)
            .collect()
    }

    #[test]
    fn pure_crates_touch_no_outer_world() {
        let name = "rust/crates/footfall_synth/src/lib.rs";
        for (needle, _) in IMPURE {
            assert!(
                !lines(name, &format!("fn f() {{\n {needle}(); }}")).is_empty(),
                "{needle} passes"
            );
        }
        assert_eq!(
            lines(
                name,
                "use std::fs;\n#[cfg(test)]\nmod tests {\n use std::env; }\n"
            ),
            [1]
        );
        assert!(lines("rust/crates/footfall_synth/tests/a.rs", "use std::fs;").is_empty());
        assert!(lines("rust/crates/footfall_motion/src/lib.rs", "use std::fs;").is_empty());
        assert!(
            lines(
                name,
                "/// As `std::fs` does.\nfn f() { constants::fs::reads() }"
            )
            .is_empty()
        );
    }

    #[test]
    fn only_tools_print_and_name_anyhow() {
        for needle in PRINTS {
            let text = format!("fn f() {{ {needle}(\"x\") }}");
            assert_eq!(
                lines("rust/crates/footfall_train/src/a.rs", &text),
                [1],
                "{needle}"
            );
            assert!(lines("rust/crates/footfall_cli/src/a.rs", &text).is_empty());
        }
        assert_eq!(
            lines(
                "rust/crates/footfall_motion/src/a.rs",
                "use anyhow::Result;"
            ),
            [1]
        );
        assert!(lines("rust/xtask/src/main.rs", "use anyhow::Result;").is_empty());
    }

    #[test]
    fn nothing_is_left_unfinished_even_in_tests() {
        let unfinished = [
            "fn f() { todo!() }",
            "fn f() { unimplemented!(\"x\") }",
            "#[ignore]\nfn f() {}",
            "#[ignore = \"slow\"]\nfn f() {}",
        ];
        for text in unfinished {
            assert_eq!(lines("tests/rust/src/a.rs", text), [1], "{text}");
        }
        assert!(lines("tests/rust/src/a.rs", "// todo!() is what we never write\n").is_empty());
        assert!(lines("README.md", "todo!()").is_empty());
    }
}
