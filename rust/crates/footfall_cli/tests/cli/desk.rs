//! Conveniences of the command line: completions, manuals, a check-up.

use crate::common::footfall;
use std::path::Path;

#[test]
fn every_shell_gets_completions_that_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let done = footfall(Path::new("."), &["completions", shell]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        for word in ["reconstruct", "standing", "studio"] {
            assert!(done.stdout.contains(word), "{shell} lacks {word}");
        }
    }
    let unknown = footfall(Path::new("."), &["completions", "csh"]);
    assert_eq!(unknown.code, 2);
    assert_eq!(
        unknown.stderr.trim_end().lines().count(),
        1,
        "{}",
        unknown.stderr
    );
}

#[test]
fn every_command_has_a_page_of_the_manual() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("man");
    let done = footfall(
        Path::new("."),
        &["manual", &pages.display().to_string(), "--json"],
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let report = done.json();
    let listed = report["pages"].as_array().unwrap();
    assert_eq!(listed.len(), std::fs::read_dir(&pages).unwrap().count());
    let page = std::fs::read_to_string(pages.join("footfall-imu-reconstruct.1")).unwrap();
    assert!(page.starts_with(".ie") || page.contains(".TH"), "{page}");
    assert!(page.contains("Examples"), "the examples are left out");
}

#[test]
fn the_check_up_tells_what_to_do_about_everything_that_is_missing() {
    let done = footfall(Path::new("."), &["doctor", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&done.stdout).unwrap();
    let findings = report["findings"].as_array().unwrap();
    assert!(findings.len() >= 6);
    let mut is_bad = false;
    for finding in findings {
        let state = finding["state"].as_str().unwrap();
        is_bad |= state == "bad";
        assert!(["good", "missing", "bad"].contains(&state));
        let has_next = !finding["next"].as_str().unwrap().is_empty();
        assert_eq!(has_next, state != "good", "{finding}");
    }
    assert_eq!(done.code, i32::from(is_bad), "{}", done.stderr);
}

#[test]
fn a_studio_that_finds_nothing_to_open_says_so() {
    let done = footfall(Path::new("."), &["studio", "no/such.bvh"]);
    done.fails_with(&["no/such.bvh", "there is no file"]);
}
