//! Rules on files: which may be in the repository, and names that no text file may hold.

use super::Violation;

/// The design's folders and files at the top, beside dot files.
const TOP_LEVEL: [&str; 8] = [
    "README.md",
    "CONTRIBUTING.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "addons",
    "demo_project",
    "tests",
    "rust",
];
const LARGEST_BYTES: u64 = 2_000_000;
/// Folders that exist on one machine only. In pieces, so that this file passes its own rule.
const MACHINE_FOLDERS: [&str; 5] = [
    concat!("/", "work/"),
    concat!("/", "root/"),
    concat!("/", "home/"),
    concat!("/", "tmp/"),
    concat!("/", "Users/"),
];

/// Every entry at the top that the design does not know, once.
pub(super) fn top_level(names: &[&str]) -> Vec<Violation> {
    let mut strange: Vec<&str> = names
        .iter()
        .filter_map(|name| name.split('/').next())
        .filter(|entry| !entry.starts_with('.') && !TOP_LEVEL.contains(entry))
        .collect();
    strange.sort_unstable();
    strange.dedup();
    let rule = "the design has no such entry at the top of the repository";
    strange
        .into_iter()
        .map(|entry| Violation {
            file: entry.into(),
            line: 0,
            rule: rule.into(),
        })
        .collect()
}

/// A file that is too large for a repository.
pub(super) fn size(name: &str, bytes: u64) -> Option<Violation> {
    (bytes > LARGEST_BYTES).then(|| Violation {
        file: name.into(),
        line: 0,
        rule: format!("{bytes} bytes: files in the repository have at most {LARGEST_BYTES}"),
    })
}

/// Lines that name a folder of one machine.
pub(super) fn machine_paths(name: &str, text: &str) -> Vec<Violation> {
    let named = |line: &str| {
        MACHINE_FOLDERS
            .into_iter()
            .find(|folder| begins_path(line, folder))
    };
    text.lines()
        .enumerate()
        .filter_map(|(index, line)| {
            let rule = format!(
                "`{}`: a folder of one machine; use a relative path or an option",
                named(line)?
            );
            Some(Violation {
                file: name.into(),
                line: index + 1,
                rule,
            })
        })
        .collect()
}

/// Returns true when the folder stands at the beginning of a path: `res://work/` and `src/work/` are other things.
fn begins_path(line: &str, folder: &str) -> bool {
    line.match_indices(folder).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        !before.is_some_and(|c| {
            c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '/' | '}' | '~' | '*' | ')')
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strange_entries_are_named_once() {
        let found = top_level(&[
            "README.md",
            ".github/workflows/ci.yml",
            "notes/a.md",
            "notes/b.md",
            "rust/x.rs",
            "a.txt",
        ]);
        let files: Vec<&str> = found
            .iter()
            .map(|violation| violation.file.as_str())
            .collect();
        assert_eq!(files, ["a.txt", "notes"]);
    }

    #[test]
    fn large_files_are_refused() {
        assert!(size("a.glb", LARGEST_BYTES + 1).is_some());
        assert!(size("a.glb", LARGEST_BYTES).is_none());
    }

    #[test]
    fn folders_of_one_machine_are_refused() {
        for folder in MACHINE_FOLDERS {
            let found = machine_paths("a.md", &format!("fine\nsee `{folder}x`\n"));
            assert_eq!(found.len(), 1, "{folder}");
            assert_eq!(found[0].line, 2);
        }
        let home = MACHINE_FOLDERS[2];
        assert!(
            machine_paths(
                "a.md",
                &format!("https://a.example{home}x, src{home}y, .{home}z")
            )
            .is_empty()
        );
    }
}
