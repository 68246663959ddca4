//! Reading many recordings by an index.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use crate::common::walker::walker;
use footfall_motion::bvh::{clip_to_bvh, write_file};
use footfall_motion::contact_file::ContactFile;
use footfall_motion::corpus::{Corpus, CorpusError, Where};
use footfall_motion::recording::Recording;
use std::fs;
use std::path::{Path, PathBuf};

const INDEX: &str = "\
path,category,style,subject,notes
walks/a.bvh,walk,neutral,one,\"good, and more\"
walks/b.bvh,walk,sad,two,
walks/broken.bvh,walk,neutral,two,cut off
walks/missing.bvh,run,neutral,two,not there
";

fn corpus_folder(index: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let walks = folder.path().join("walks");
    fs::create_dir(&walks).unwrap();
    let file = clip_to_bvh(&walker(60.0, 300));
    for name in ["a.bvh", "b.bvh", "broken.bvh"] {
        write_file(&file, walks.join(name)).unwrap();
    }
    let text = fs::read_to_string(walks.join("a.bvh")).unwrap();
    fs::write(walks.join("broken.bvh"), &text[..text.len() / 2]).unwrap();
    let path = folder.path().join("index.csv");
    fs::write(&path, index).unwrap();
    (folder, path)
}

fn read(index: &Path, conditions: &[&str]) -> Result<Corpus, CorpusError> {
    let conditions: Vec<Where> = conditions
        .iter()
        .map(|text| text.parse().unwrap())
        .collect();
    Corpus::read(index, &conditions)
}

#[test]
fn good_clips_are_read_and_broken_ones_told() {
    let (_folder, index) = corpus_folder(INDEX);
    let corpus = read(&index, &[]).unwrap();
    assert_eq!(corpus.clips.len(), 2);
    assert_eq!(corpus.report.selected, 4);
    let [broken, missing] = &corpus.report.skipped[..] else {
        panic!("{:?}", corpus.report)
    };
    assert!(broken.reason.contains("broken.bvh") && broken.reason.contains("line"));
    assert!(missing.reason.contains("missing.bvh") && missing.line == 5);
    let clip = &corpus.clips[0];
    assert_eq!((clip.row.style(), clip.row.subject()), ("neutral", "one"));
    assert_eq!(clip.row.column("notes"), Some("good, and more"));
    assert_eq!(clip.walks.len(), 1);
    assert!(clip.walks[0].steps.len() > 5);
}

#[test]
fn all_conditions_must_hold() {
    let (_folder, index) = corpus_folder(INDEX);
    let corpus = read(&index, &["category=walk", "style=s*"]).unwrap();
    assert_eq!(corpus.clips.len(), 1);
    assert!(corpus.clips[0].row.path.ends_with("walks/b.bvh"));
    assert_eq!(read(&index, &["path=walks/a*"]).unwrap().clips.len(), 1);
}

#[test]
fn errors_name_file_line_and_column() {
    let (_folder, index) = corpus_folder(INDEX);
    let error = |conditions: &[&str]| read(&index, conditions).unwrap_err().to_string();
    let text = error(&["category=walk", "style=happy"]);
    assert!(
        text.contains("style=happy") && text.contains("neutral, sad"),
        "{text}"
    );
    assert!(error(&["mood=sad"]).contains("\"mood\""));
    let text = error(&["path=*broken*"]);
    assert!(
        text.contains("none of the 1") && text.contains("broken.bvh"),
        "{text}"
    );
    for (index_text, words) in [
        ("path,category,style\na,b,c\n", ["line 1", "subject"]),
        (
            "path,category,style,subject\na,b,c,d\nx,y,,z\n",
            ["line 3", "style"],
        ),
        ("path,category,style,subject\na,b\n", ["line", "2"]),
        ("path,category,style,subject\n", ["no row", "path"]),
    ] {
        let (_folder, index) = corpus_folder(index_text);
        let text = read(&index, &[]).unwrap_err().to_string();
        for word in words.into_iter().chain(["index.csv"]) {
            assert!(text.contains(word), "{text}");
        }
    }
    assert!(
        read(Path::new("nowhere/index.csv"), &[])
            .unwrap_err()
            .to_string()
            .contains("nowhere")
    );
}

#[test]
fn the_recordings_are_a_corpus() {
    let Some(folder) = crate::common::data_folder() else {
        return;
    };
    let corpus = read(
        &folder.join("index.csv"),
        &["path=cmu/*", "category=neutral_walk"],
    )
    .unwrap();
    assert_eq!(corpus.clips.len(), 39);
    assert!(corpus.report.skipped.is_empty());
    let steps: usize = corpus
        .clips
        .iter()
        .flat_map(|clip| &clip.walks)
        .map(|walk| walk.steps.len())
        .sum();
    println!("{steps} steps");
    assert!(steps > 150);
}

#[test]
fn contacts_that_a_person_corrected_are_taken_instead_of_the_detected_ones() {
    let (folder, index) = corpus_folder(INDEX);
    let clip = folder.path().join("walks/a.bvh");
    let before = read(&index, &["subject=one"]).unwrap().clips.remove(0);
    let mut stances = before.contacts.feet.clone().map(|foot| foot.stances);
    stances[0].remove(2);
    let corrected = before.contacts.with_stances(stances.clone());
    ContactFile::new(&corrected, &before.walks)
        .write(&ContactFile::beside(&clip))
        .unwrap();
    let after = read(&index, &["subject=one"]).unwrap().clips.remove(0);
    assert_eq!(
        after.contacts.feet.clone().map(|foot| foot.stances),
        stances
    );
    let steps = |clip: &Recording| clip.walks.iter().map(|w| w.steps.len()).sum::<usize>();
    assert!(
        steps(&after) < steps(&before),
        "a step without its contact is none"
    );
    // The other recording has none and is as it was.
    assert!(!ContactFile::beside(&folder.path().join("walks/b.bvh")).exists());
}

#[test]
fn corrections_that_do_not_fit_leave_the_recording_out_and_say_why() {
    let (folder, index) = corpus_folder(INDEX);
    let clip = folder.path().join("walks/a.bvh");
    for (text, said) in [
        ("{", "not what"),
        (
            r#"{"fps":60,"frames":5,"left":[],"right":[],"events":[]}"#,
            "5 frames",
        ),
        (
            r#"{"fps":60,"frames":300,"left":[[9,4]],"right":[],"events":[]}"#,
            "[9, 4]",
        ),
        (
            r#"{"fps":60,"frames":300,"left":[],"right":[[4,9],[9,12]],"events":[]}"#,
            "[9, 12]",
        ),
    ] {
        fs::write(ContactFile::beside(&clip), text).unwrap();
        let error = read(&index, &["subject=one"]).unwrap_err().to_string();
        assert!(
            error.contains("a.bvh.labels.json") && error.contains(said),
            "{error}"
        );
    }
}
