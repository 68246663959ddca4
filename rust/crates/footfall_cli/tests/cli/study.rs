//! The study's page in a real browser. Skipped where Chromium is not installed.

use crate::common::footfall;
use crate::evaluate::write_pair;
use footfall_tests::browser::chromium;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Takes part in the study as a person does: plays, answers by key or by click, goes back once, downloads.
const PARTICIPANT: &str = include_str!("study_participant.js");

/// The document after the page's scripts have run.
fn visit(chromium: &Path, profile: &Path, page: &Path) -> String {
    let output = Command::new(chromium)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--mute-audio",
        ])
        .args([
            "--no-first-run",
            "--window-size=900,900",
            "--virtual-time-budget=60000",
            "--dump-dom",
        ])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("Chromium starts");
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        dom.contains("</html>"),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    dom
}

/// Visible part of the page: its scripts hold the same words.
fn main_of(dom: &str) -> &str {
    let (_, rest) = dom.split_once("<main id=\"main\">").expect("a main part");
    rest.split("</main>").next().unwrap_or_default()
}

/// Report that the participant left in the document.
fn report(dom: &str) -> Value {
    // The last one: the script that makes it names it too.
    let (_, rest) = dom
        .rsplit_once("<pre id=\"report\">")
        .unwrap_or_else(|| panic!("no report in {dom:.3000}"));
    let text = rest.split("</pre>").next().unwrap_or_default();
    let text = text
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&amp;", "&");
    serde_json::from_str(&text).expect("the report is JSON")
}

fn write_study(folder: &Path) -> PathBuf {
    write_pair(folder);
    let arguments = [
        "study",
        "--real",
        "real.csv",
        "--synthesised",
        "made.csv",
        "--title",
        "Slow & <fast>",
        "-o",
        "study.html",
        "--json",
    ];
    let facts = footfall(folder, &arguments).json();
    assert_eq!(facts["pairs"], 2, "{facts}");
    assert_eq!(facts["styles"], serde_json::json!(["fast", "slow"]));
    folder.join("study.html")
}

#[test]
fn the_page_stands_alone_and_carries_no_folder_of_this_machine() {
    let folder = tempfile::tempdir().unwrap();
    let page = fs::read_to_string(write_study(folder.path())).unwrap();
    assert!(page.contains("<title>Slow &amp; &lt;fast&gt;</title>"));
    let data = footfall_tests::data::own_file("");
    assert!(!page.contains(data.to_str().unwrap()));
    for outside in ["http:", "https:", "src=", "@import"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.len() < 600_000, "{} bytes", page.len());
}

#[test]
fn every_test_can_be_answered_and_the_answers_come_out() {
    let Some(chromium) = chromium("study") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let page = write_study(folder.path());
    let driven = folder.path().join("driven.html");
    let html = fs::read_to_string(&page).unwrap();
    fs::write(
        &driven,
        html.replace("</body>", &format!("<script>{PARTICIPANT}</script></body>")),
    )
    .unwrap();
    let profile = folder.path().join("profile");

    let report = report(&visit(&chromium, &profile, &driven));
    assert_eq!(report["errors"], serde_json::json!([]));
    // Two styles, real and synthesised, with and without displacement; pairs of both styles in both ways.
    let given = report["given"].as_array().unwrap();
    assert_eq!(given.len(), 8 + 8 + 4, "{report}");
    let stored: Value = serde_json::from_str(report["stored"].as_str().unwrap()).unwrap();
    let answers = stored["answers"].as_array().unwrap();
    assert_eq!(answers.len(), given.len());
    for (answer, given) in answers.iter().zip(given) {
        assert_eq!(&answer["answer"], given);
    }

    let csv = report["csv"].as_str().unwrap();
    assert!(
        report["file"].as_str().unwrap().contains(".csv"),
        "{report}"
    );
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|column| *column == name).unwrap();
    let values = |test: &str, name: &str| -> BTreeSet<&str> {
        let of_test = rows[1..].iter().filter(|row| row[column("test")] == test);
        of_test.map(|row| row[column(name)]).collect()
    };
    assert_eq!(rows.len(), 1 + given.len(), "{csv}");
    for (row, given) in rows[1..].iter().zip(given) {
        assert_eq!(row.len(), rows[0].len(), "{row:?}");
        assert_eq!(row[column("answer")], given.as_str().unwrap());
        assert_eq!(row[column("plays")], "1");
        let right = match row[column("test")] {
            "natural" if row[column("answer")] == "real" => {
                ["no", "yes"][usize::from(row[column("source")] == "real")]
            }
            "natural" if row[column("answer")] == "synthetic" => {
                ["yes", "no"][usize::from(row[column("source")] == "real")]
            }
            "style" => ["no", "yes"][usize::from(row[column("style")] == row[column("answer")])],
            _ => "",
        };
        assert_eq!(row[column("right")], right, "{row:?}");
    }
    for test in ["natural", "style"] {
        assert_eq!(values(test, "source"), ["real", "synthesised"].into());
        assert_eq!(values(test, "style"), ["fast", "slow"].into());
        assert_eq!(values(test, "displacement"), ["displaced", "static"].into());
    }
    let grades = values("alike", "grade");
    assert!(
        grades
            .iter()
            .all(|grade| ["0", "1", "2", "3", "4"].contains(grade)),
        "{grades:?}"
    );
    assert!(
        values("alike", "source")
            .iter()
            .all(|pair| pair.contains('|') && pair.contains("real"))
    );

    // Who comes back finds the answers.
    let again = visit(&chromium, &profile, &page);
    assert!(main_of(&again).contains("Thank you"), "{}", main_of(&again));
    assert!(main_of(&again).contains("id=\"download\""));
    // Who has not been here begins anew.
    let fresh = visit(&chromium, &folder.path().join("other"), &page);
    assert!(
        main_of(&fresh).contains("id=\"begin\""),
        "{}",
        main_of(&fresh)
    );
}
