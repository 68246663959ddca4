//! Rules on the text of doc comments.

use super::Violation;
use super::source::is_a;

/// Words that a sentence of a doc comment does not begin with: it names the thing, or says what the function does.
const QUESTIONS: [&str; 7] = ["How", "What", "Whether", "Where", "Who", "Which", "Tells"];

/// Beginnings of doc comments by language.
const MARKERS: [(&str, &[&str]); 2] = [("rs", &["///", "//!"]), ("gd", &["##"])];

/// Checks the doc comments of one file; a file without doc comments of a known language passes.
pub(super) fn check(name: &str, text: &str) -> Vec<Violation> {
    let Some((_, markers)) = MARKERS.iter().find(|(extension, _)| is_a(name, extension)) else {
        return Vec::new();
    };
    let lines = text.lines().enumerate();
    lines
        .filter_map(|(index, line)| {
            let line = line.trim_start();
            let mut comments = markers.iter().filter_map(|marker| line.strip_prefix(marker));
            let word = comments.next()?.split_whitespace().next()?;
            QUESTIONS.contains(&word).then(|| Violation {
                file: name.into(),
                line: index + 1,
                rule: format!(
                    "`{word} …`: begin a doc comment with a noun or a verb, as in \"Speed of …\" or \"Returns …\""
                ),
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn questions_are_found_in_doc_comments_alone() {
        let text = "//! What it is.\n\n/// Speed, m/s.\n    /// How fast it is.\n// What a plain comment says\nlet text = \"What\";\n/// Whatever it takes.\n";
        let lines = |name: &str, text: &str| -> Vec<usize> {
            check(name, text)
                .iter()
                .map(|violation| violation.line)
                .collect()
        };
        assert_eq!(lines("rust/crates/footfall_core/src/a.rs", text), [1, 4]);
        assert_eq!(lines("README.md", text), [0; 0]);
        let script =
            "extends Node\n## Speed, m/s.\n\t## Where it is.\n# What a plain comment says\n";
        assert_eq!(lines("demo_project/a.gd", script), [3]);
    }
}
