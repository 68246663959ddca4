//! Rules on the text of doc comments.

use super::Violation;
use std::path::Path;

/// Words that a sentence of a doc comment does not begin with: it names the thing, or says what the function does.
const QUESTIONS: [&str; 7] = ["How", "What", "Whether", "Where", "Who", "Which", "Tells"];

/// Checks the doc comments of one file; a file that is no Rust source passes.
pub(super) fn check(name: &str, text: &str) -> Vec<Violation> {
    if Path::new(name)
        .extension()
        .is_none_or(|extension| extension != "rs")
    {
        return Vec::new();
    }
    let lines = text.lines().enumerate();
    lines
        .filter_map(|(index, line)| {
            let line = line.trim_start();
            let comment = line.strip_prefix("///").or(line.strip_prefix("//!"))?;
            let word = comment.split_whitespace().next()?;
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
        let lines = |name: &str| -> Vec<usize> {
            check(name, text)
                .iter()
                .map(|violation| violation.line)
                .collect()
        };
        assert_eq!(lines("rust/crates/footfall_core/src/a.rs"), [1, 4]);
        assert_eq!(lines("README.md"), [0; 0]);
    }
}
