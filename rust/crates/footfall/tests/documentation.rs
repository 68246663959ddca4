//! Completeness of the pages: every name that a module re-exports is introduced by its page, and every function runs in a doctest.

use std::path::Path;

/// The names that a module re-exports.
fn exports(source: &str) -> Vec<&str> {
    let uses = source.split("\npub use ").skip(1);
    let lists = uses.filter_map(|rest| rest.split(';').next());
    let names = lists.flat_map(|list| list.split(['{', '}', ',', ' ', '\n']));
    // What remains of a path is its last part.
    let last = names.filter_map(|name| name.rsplit("::").next());
    last.filter(|name| !name.is_empty()).collect()
}

/// Text and code of the page above the re-exports.
fn page(source: &str) -> [String; 2] {
    let end = source.find("\npub use ").unwrap_or(source.len());
    let (mut parts, mut part) = ([String::new(), String::new()], 0);
    for line in source[..end].lines() {
        if line
            .trim_start_matches("//!")
            .trim_start()
            .starts_with("```")
        {
            part = 1 - part;
        }
        parts[part].push_str(line);
        parts[part].push('\n');
    }
    parts
}

/// The crate's page, and the modules that it declares, each with its source.
fn pages() -> (String, Vec<(String, String)>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("a source");
    let front = read("lib.rs");
    let declared = front
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
        .map(|module| (module.to_owned(), read(&format!("{module}.rs"))))
        .collect();
    (front, declared)
}

fn holds_word(text: &str, word: &str) -> bool {
    text.split(|c: char| !c.is_alphanumeric() && c != '_')
        .any(|part| part == word)
}

#[test]
fn every_export_is_introduced_and_every_function_is_run() {
    let (front, modules) = pages();
    assert!(modules.len() >= 8, "{}", modules.len());
    for (module, source) in &modules {
        assert!(
            front.contains(&format!("[`{module}`]")),
            "the crate's page does not name {module}"
        );
        let exports = exports(source);
        assert!(exports.len() >= 3, "{module}: {exports:?}");
        let [text, code] = page(source);
        for name in exports {
            let used = holds_word(&code, name);
            assert!(
                used || holds_word(&text, name),
                "{module}: the page does not mention {name}"
            );
            if name.starts_with(char::is_lowercase) {
                assert!(used, "{module}: no example uses {name}");
            }
        }
    }
}
