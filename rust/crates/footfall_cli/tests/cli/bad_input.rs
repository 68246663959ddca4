//! Every bad input of the product's contract: exit code 1, one line that names file, line or joint and what to do.

use crate::common::footfall;
use footfall_tests::data::{own_file, repository};
use std::fmt::Write as _;
use std::fs;
use tempfile::TempDir;

const GOOD: &str = "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0 0\n  CHANNELS 3 Xrotation Yrotation Zrotation\n  \
    End Site\n  {\n    OFFSET 0 1 0\n  }\n}\nMOTION\nFrames: 2\nFrame Time: 0.02\n0 0 0\n1 2 3\n";

fn folder_with(name: &str, text: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join(name), text).expect("the folder takes files");
    folder
}

/// Every command that reads a recording says the same about a broken one, and writes nothing.
fn broken_recording_is_refused(text: &str, parts: &[&str]) {
    let folder = folder_with("bad.bvh", text);
    for arguments in [
        &["inspect", "bad.bvh"][..],
        &["contacts", "bad.bvh", "--json"],
        &["retarget", "bad.bvh", "-o", "out.bvh"],
        &["sheet", "bad.bvh", "-o", "out.png"],
    ] {
        let run = footfall(folder.path(), arguments);
        run.fails_with(&["bad.bvh"]);
        run.fails_with(parts);
        assert_eq!(
            fs::read_dir(folder.path()).expect("a folder").count(),
            1,
            "{arguments:?} left a file"
        );
    }
}

#[test]
fn a_truncated_recording() {
    broken_recording_is_refused(&GOOD.replace("\n1 2 3\n", "\n1 2"), &["line 15"]);
    broken_recording_is_refused(&GOOD[..40], &["line"]);
    broken_recording_is_refused("", &["line 1"]);
}

#[test]
fn a_file_that_is_no_recording() {
    broken_recording_is_refused("PNG\u{1}\u{2} not motion at all", &["line 1", "HIERARCHY"]);
}

#[test]
fn a_number_that_is_none() {
    broken_recording_is_refused(&GOOD.replace("1 2 3", "1 nan 3"), &["line 15", "nan"]);
    broken_recording_is_refused(&GOOD.replace("1 2 3", "1 inf 3"), &["line 15", "inf"]);
}

#[test]
fn a_recording_without_frames() {
    let text = GOOD
        .replace("Frames: 2", "Frames: 0")
        .replace("0 0 0\n1 2 3\n", "");
    broken_recording_is_refused(&text, &["line 12", "number of frames"]);
}

#[test]
fn a_wrong_channel_count() {
    broken_recording_is_refused(
        &GOOD.replace("CHANNELS 3", "CHANNELS 4"),
        &["line 6", "channel 4"],
    );
    broken_recording_is_refused(&GOOD.replace("\n0 0 0\n1", "\n0 0 0 0\n1"), &["line 14"]);
}

#[test]
fn a_skeleton_that_lacks_joints() {
    let folder = folder_with("pole.bvh", GOOD);
    for arguments in [
        &["contacts", "pole.bvh"][..],
        &["retarget", "pole.bvh", "-o", "out.bvh"],
        &["sheet", "pole.bvh", "-o", "out.png"],
    ] {
        footfall(folder.path(), arguments).fails_with(&["pole.bvh", "LeftUpperLeg", "--map"]);
    }
    fs::write(
        folder.path().join("names.toml"),
        "Hips = 'Hips'\nLeftWing = 'x'\n",
    )
    .unwrap();
    footfall(
        folder.path(),
        &["contacts", "pole.bvh", "--map", "names.toml"],
    )
    .fails_with(&["names.toml", "LeftWing"]);
    footfall(
        folder.path(),
        &["contacts", "pole.bvh", "--map", "absent.toml"],
    )
    .fails_with(&["absent.toml"]);
}

#[test]
fn an_unknown_skeleton_walks_with_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(own_file("walker_1_slow.bvh")).unwrap();
    // Names that no family has.
    let mut strange = text;
    let mut map = String::new();
    for (index, joint) in footfall_tests::data::JOINT_NAMES.iter().enumerate() {
        for keyword in ["ROOT", "JOINT"] {
            strange = strange.replace(
                &format!("{keyword} {joint}\n"),
                &format!("{keyword} q{index}\n"),
            );
        }
        writeln!(map, "{joint} = \"q{index}\"").unwrap();
    }
    fs::write(folder.path().join("strange.bvh"), strange).unwrap();
    fs::write(folder.path().join("names.toml"), map).unwrap();
    footfall(folder.path(), &["contacts", "strange.bvh"]).fails_with(&["LeftUpperLeg", "q"]);
    let placed = footfall(
        folder.path(),
        &["contacts", "strange.bvh", "--map", "names.toml", "--json"],
    );
    let known = own_file("walker_1_slow.bvh");
    let known = footfall(
        folder.path(),
        &["contacts", known.to_str().unwrap(), "--json"],
    );
    assert_eq!(placed.json(), known.json());
}

#[test]
fn a_missing_file() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["inspect", "none.bvh"][..],
        &["contacts", "none.bvh"],
        &["retarget", "none.bvh", "-o", "out.bvh"],
        &["sheet", "none.bvh", "-o", "out.png"],
        &["train", "--corpus", "none.csv", "-o", "out.footfall"],
        &["synth", "--model", "none.footfall", "-o", "out.bvh"],
        &["bench", "--model", "none.footfall"],
    ] {
        footfall(folder.path(), arguments).fails_with(&["none."]);
    }
}

#[test]
fn a_model_that_is_damaged_newer_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = fs::read(repository().join("tests/model_versions/v1.footfall")).unwrap();
    let mut damaged = bytes.clone();
    damaged[bytes.len() / 2] ^= 1;
    let mut newer = bytes.clone();
    newer[8..12].copy_from_slice(&99_u32.to_le_bytes());
    for (name, content, parts) in [
        ("damaged.footfall", &damaged[..], &["damaged"][..]),
        ("newer.footfall", &newer[..], &["99", "update Footfall"]),
        ("short.footfall", &bytes[..bytes.len() / 3], &["cut short"]),
        (
            "text.footfall",
            b"hello there, not a model",
            &["not a Footfall model"],
        ),
    ] {
        fs::write(folder.path().join(name), content).unwrap();
        for arguments in [
            &["inspect", name][..],
            &["synth", "--model", name, "-o", "out.bvh"],
        ] {
            let run = footfall(folder.path(), arguments);
            run.fails_with(&[name]);
            run.fails_with(parts);
        }
    }
    assert!(!folder.path().join("out.bvh").exists());
}

#[test]
fn an_output_that_is_the_input_is_refused_and_the_input_stays() {
    let folder = folder_with(
        "in.bvh",
        &fs::read_to_string(own_file("walker_1_slow.bvh")).unwrap(),
    );
    let before = fs::read(folder.path().join("in.bvh")).unwrap();
    for arguments in [
        &["retarget", "in.bvh", "-o", "in.bvh"][..],
        &["retarget", "in.bvh", "-o", "./in.bvh"],
        &["sheet", "in.bvh", "-o", "in.bvh"],
    ] {
        footfall(folder.path(), arguments).fails_with(&["in.bvh", "is the input"]);
    }
    assert_eq!(fs::read(folder.path().join("in.bvh")).unwrap(), before);
    footfall(
        folder.path(),
        &["retarget", "in.bvh", "-o", "no/folder/out.bvh"],
    )
    .fails_with(&["no/folder/out.bvh", "folder exists"]);
}

#[test]
fn arguments_that_make_no_sense_are_one_line_and_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, part) in [
        (&["walk"][..], "walk"),
        (&["retarget", "in.bvh"], "--output"),
        (
            &[
                "synth",
                "--model",
                "m.footfall",
                "--steps",
                "0",
                "-o",
                "x.bvh",
            ],
            "--steps",
        ),
        (
            &[
                "train",
                "--corpus",
                "i.csv",
                "--where",
                "walk",
                "-o",
                "x.footfall",
            ],
            "column=value",
        ),
        (
            &["sheet", "a.bvh", "-o", "x.png", "--poses", "1"],
            "--poses",
        ),
    ] {
        let run = footfall(folder.path(), arguments);
        assert_eq!(run.code, 2, "{}", run.stderr);
        assert_eq!(run.stdout, "");
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
        assert!(
            run.stderr.starts_with("error: ") && run.stderr.contains(part),
            "{}",
            run.stderr
        );
        assert!(run.stderr.contains("footfall --help"), "{}", run.stderr);
    }
}

#[test]
fn settings_out_of_range_say_what_to_give() {
    let folder = tempfile::tempdir().unwrap();
    let model = repository().join("tests/model_versions/v1.footfall");
    let model = model.to_str().unwrap();
    let synth = |extra: &[&str]| {
        let mut arguments = vec!["synth", "--model", model, "-o", "out.bvh"];
        arguments.extend(extra);
        footfall(folder.path(), &arguments)
    };
    synth(&["--speed=-1"]).fails_with(&["--speed"]);
    // At 0 somebody stands.
    synth(&["--speed=0", "--seconds=-1"]).fails_with(&["--seconds"]);
    synth(&["--fps=0"]).fails_with(&["--fps"]);
    synth(&["--turn=NaN"]).fails_with(&["turn rate"]);
    synth(&["--contacts", "out.bvh"]).fails_with(&["--contacts"]);
    let walk = own_file("walker_1_slow.bvh");
    let walk = walk.to_str().unwrap();
    footfall(
        folder.path(),
        &["retarget", walk, "-o", "out.bvh", "--fps=-3"],
    )
    .fails_with(&["-3"]);
    footfall(
        folder.path(),
        &["sheet", walk, "-o", "out.png", "--start", "900"],
    )
    .fails_with(&["--start"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
