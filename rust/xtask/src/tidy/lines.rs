//! Rules on lines of text: beginnings of doc comments, and tests that are not run.

use super::Violation;
use std::path::Path;

/// Words that a sentence of a doc comment does not begin with: it names the thing, or says what the function does.
const QUESTIONS: [&str; 7] = ["How", "What", "Whether", "Where", "Who", "Which", "Tells"];

/// Beginnings of doc comments by language.
const MARKERS: [(&str, &[&str]); 2] = [("rs", &["///", "//!"]), ("gd", &["##"])];

/// Checks one file; a file of no known language passes.
pub(super) fn check(name: &str, text: &str) -> Vec<Violation> {
    let is_a = |language: &str| {
        Path::new(name)
            .extension()
            .is_some_and(|own| own == language)
    };
    let Some((language, markers)) = MARKERS.iter().find(|(language, _)| is_a(language)) else {
        return Vec::new();
    };
    let broken = |line: &str| {
        if *language == "rs" && line.starts_with("#[ignore") {
            return Some("`#[ignore]`: run the test, or leave it out".to_owned());
        }
        let word = markers
            .iter()
            .find_map(|marker| line.strip_prefix(marker))?;
        let word = word.split_whitespace().next()?;
        QUESTIONS.contains(&word).then(|| {
            format!(
                "`{word} …`: begin a doc comment with a noun or a verb, as in \"Speed of …\" or \"Returns …\""
            )
        })
    };
    let lines = text.lines().enumerate();
    lines
        .filter_map(|(index, line)| {
            Some(Violation {
                file: name.into(),
                line: index + 1,
                rule: broken(line.trim_start())?,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(name: &str, text: &str) -> Vec<usize> {
        let found = check(name, text);
        found.iter().map(|violation| violation.line).collect()
    }

    #[test]
    fn questions_are_found_in_doc_comments_alone() {
        let text = "//! What it is.\n\n/// Speed, m/s.\n    /// How fast it is.\n// What a plain comment says\nlet text = \"What\";\n/// Whatever it takes.\n";
        assert_eq!(lines("rust/crates/footfall_core/src/a.rs", text), [1, 4]);
        assert_eq!(lines("README.md", text), [0; 0]);
        let script =
            "extends Node\n## Speed, m/s.\n\t## Where it is.\n# What a plain comment says\n";
        assert_eq!(lines("demo_project/a.gd", script), [3]);
    }

    #[test]
    fn every_test_is_run() {
        let text = "#[test]\nfn a() {}\n#[test]\n#[ignore]\nfn b() {}\n    #[ignore = \"slow\"]\n";
        assert_eq!(lines("tests/rust/src/a.rs", text), [4, 6]);
        assert_eq!(lines("README.md", text), [0; 0]);
    }
}
