//! Corpora that cannot be learned from, or hardly: what is wrong, and what to do.

use crate::common::footfall;
use footfall_tests::data::own_file;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

fn corpus(folder: &Path, rows: &[(&str, &str)]) {
    let mut table = "path,category,style,subject\n".to_owned();
    for (name, subject) in rows {
        if own_file(name).is_file() {
            fs::copy(own_file(name), folder.join(name)).expect("a copy");
        }
        writeln!(table, "{name},walk,neutral,{subject}").expect("a string takes all text");
    }
    fs::write(folder.join("index.csv"), table).expect("an index");
}

#[test]
fn a_corpus_of_one_subject_trains_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    corpus(
        folder.path(),
        &[("walker_1_slow.bvh", "one"), ("walker_1_fast.bvh", "one")],
    );
    let run = footfall(
        folder.path(),
        &[
            "train",
            "--corpus",
            "index.csv",
            "-o",
            "walk.footfall",
            "--json",
        ],
    );
    let report = run.json();
    assert_eq!(report["subjects"], 1);
    let warning = report["warnings"][0].as_str().unwrap();
    assert!(
        warning.contains("one subject") && warning.contains("add recordings"),
        "{warning}"
    );
    assert!(
        run.stderr.contains(&format!("warning: {warning}")),
        "{}",
        run.stderr
    );
    assert!(folder.path().join("walk.footfall").is_file());
}

#[test]
fn a_corpus_without_steps() {
    let folder = tempfile::tempdir().unwrap();
    // A body that stands: the first frame of a walk, many times.
    let text = fs::read_to_string(own_file("walker_1_slow.bvh")).unwrap();
    let (head, rows) = text.split_once("Frame Time:").unwrap();
    let head = head.rsplit_once("Frames:").unwrap().0;
    let (rate, rows) = rows.split_once('\n').unwrap();
    let first = rows.lines().next().unwrap();
    let still = format!(
        "{head}Frames: 90\nFrame Time:{rate}\n{}",
        format!("{first}\n").repeat(90)
    );
    fs::write(folder.path().join("still.bvh"), still).unwrap();
    corpus(folder.path(), &[("still.bvh", "one")]);
    footfall(
        folder.path(),
        &["train", "--corpus", "index.csv", "-o", "walk.footfall"],
    )
    .fails_with(&["index.csv", "step", "--where"]);
    assert!(!folder.path().join("walk.footfall").exists());
    let contacts = footfall(folder.path(), &["contacts", "still.bvh", "--json"]).json();
    assert_eq!(contacts["steps"].as_array().unwrap().len(), 0);
    assert_eq!(contacts["events"].as_array().unwrap().len(), 0);
    let facts = footfall(folder.path(), &["inspect", "still.bvh"]);
    assert!(facts.stdout.contains("none"), "{}", facts.stdout);
}

#[test]
fn a_corpus_that_nothing_matches_or_that_is_broken() {
    let folder = tempfile::tempdir().unwrap();
    corpus(
        folder.path(),
        &[("walker_1_slow.bvh", "one"), ("absent.bvh", "two")],
    );
    let train = |condition: &str| {
        footfall(
            folder.path(),
            &[
                "train",
                "--corpus",
                "index.csv",
                "--where",
                condition,
                "-o",
                "walk.footfall",
            ],
        )
    };
    train("category=run").fails_with(&["index.csv", "category", "walk"]);
    train("mood=glad").fails_with(&["mood", "category"]);
    train("subject=two").fails_with(&["absent.bvh"]);
    // One broken recording among good ones is reported, not fatal.
    let run = train("category=walk");
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stderr.contains("warning: ") && run.stderr.contains("absent.bvh"),
        "{}",
        run.stderr
    );
    fs::write(
        folder.path().join("index.csv"),
        "path,style\nx.bvh,neutral\n",
    )
    .unwrap();
    train("style=neutral").fails_with(&["index.csv", "line 1", "category"]);
    assert_eq!(
        footfall(
            folder.path(),
            &[
                "train",
                "--corpus",
                "index.csv",
                "--fps",
                "5",
                "-o",
                "w.footfall"
            ]
        )
        .code,
        1
    );
}
