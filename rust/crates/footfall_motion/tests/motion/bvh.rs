//! The BVH reader and writer: round trips, spellings, and every kind of damage.

use footfall_core::{Clip, Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_motion::bvh::{
    BvhError, BvhFile, BvhJoint, Channel, JointTransforms, clip_to_bvh, parse, read, write,
    write_file,
};
use glam::{Quat, Vec3};
use proptest::prelude::*;

const SMALL: &str = "HIERARCHY
ROOT Hips
{
\tOFFSET 0 0 0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tJOINT Knee
\t{
\t\tOFFSET 0 -10 0
\t\tCHANNELS 1 Xrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 0 -5 1
\t\t}
\t}
}
MOTION
Frames: 2
Frame Time: 0.0083333
0 10 0 0 0 0 0
1 10 2 0 0 90 45
";

fn any_channels() -> impl Strategy<Value = Vec<Channel>> {
    (Just(Channel::ALL.to_vec()).prop_shuffle(), 0_usize..=6).prop_map(|(mut all, count)| {
        all.truncate(count);
        all
    })
}

fn any_file() -> impl Strategy<Value = BvhFile> {
    let number = -1.0e4_f32..1.0e4;
    let vector = proptest::array::uniform3(number.clone()).prop_map(Vec3::from_array);
    let joint = (
        "[A-Za-z_:.][A-Za-z0-9_:. ]{0,8}[a-z]",
        any::<proptest::sample::Index>(),
        vector.clone(),
        any_channels(),
        proptest::collection::vec(vector, 0..3),
    );
    (
        proptest::collection::vec(joint, 1..12),
        1_usize..5,
        1e-3_f64..1.0,
    )
        .prop_flat_map(move |(joints, frame_count, frame_time_secs)| {
            let mut built: Vec<BvhJoint> = Vec::new();
            for (name, parent, offset, channels, end_sites) in joints {
                // Depth first: the parent is the joint before or one of its ancestors.
                let mut line = Vec::new();
                let mut at = built.len().checked_sub(1);
                while let Some(index) = at {
                    line.push(index);
                    at = built[index].parent;
                }
                let parent = (!line.is_empty()).then(|| line[parent.index(line.len())]);
                built.push(BvhJoint {
                    name,
                    parent,
                    offset,
                    channels,
                    end_sites,
                });
            }
            if built.iter().all(|joint| joint.channels.is_empty()) {
                built[0].channels.push(Channel::XRotation);
            }
            let width: usize = built.iter().map(|joint| joint.channels.len()).sum();
            proptest::collection::vec(number.clone(), width * frame_count).prop_map(move |values| {
                BvhFile {
                    joints: built.clone(),
                    frame_time_secs,
                    frame_count,
                    values,
                }
            })
        })
}

proptest! {
    #[test]
    fn writing_and_parsing_gives_the_same_file(file in any_file()) {
        prop_assert_eq!(parse(&write(&file)).unwrap(), file);
    }

    #[test]
    fn damaged_text_never_panics(
        file in any_file(),
        edits in proptest::collection::vec((any::<proptest::sample::Index>(), any::<u8>(), 0_u8..4), 1..8),
    ) {
        let mut bytes = write(&file).into_bytes();
        for (at, byte, kind) in edits {
            if bytes.is_empty() {
                break;
            }
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.truncate(at),
                2 => bytes.insert(at, byte),
                _ => drop(bytes.remove(at)),
            }
        }
        if let Err(error) = parse(&String::from_utf8_lossy(&bytes)) {
            prop_assert!(error.to_string().starts_with("line "), "{}", error);
        }
    }

    #[test]
    fn any_text_never_panics(text in "\\PC*") {
        prop_assert!(parse(&text).is_err());
    }
}

#[test]
fn spellings_do_not_matter() {
    let expected = parse(SMALL).unwrap();
    let variants = [
        SMALL.replace('\n', "\r\n"),
        SMALL.replace('\n', "\n\n"),
        SMALL.replace('\t', "  "),
        SMALL
            .to_ascii_lowercase()
            .replace("hips", "Hips")
            .replace("knee", "Knee"),
        SMALL
            .to_ascii_uppercase()
            .replace("HIPS", "Hips")
            .replace("KNEE", "Knee"),
        SMALL.trim_end().to_owned(),
        format!("\u{feff}{SMALL}"),
        SMALL.replace("\n{", " {"),
        SMALL
            .replace("Frames: 2", "Frames:\t2 ")
            .replace("Frame Time:", "Frame  Time :"),
        SMALL.replace("0 10 0 0 0 0 0", "0e0\t1.0E+1 -0.0 +0 0. .0 0"),
        SMALL.replace("MOTION", "# made by hand\nMOTION"),
        SMALL.replace("End Site", "End Site toe"),
    ];
    for text in variants {
        assert_eq!(parse(&text).unwrap(), expected, "{text}");
    }
    assert!((expected.frame_rate_hz() - 120.0).abs() < 1e-12);
}

/// Line, column, and a word of what was expected.
#[test]
fn damage_is_named_with_its_place() {
    let cases: [(String, usize, usize, &str); 19] = [
        (String::new(), 1, 1, "HIERARCHY"),
        ("{\"json\": true}".to_owned(), 1, 1, "HIERARCHY"),
        ("HIERARCHY\nMOTION\n".to_owned(), 2, 1, "ROOT"),
        (SMALL.replace("ROOT Hips", "ROOT"), 2, 5, "name"),
        (
            SMALL.replace("\tOFFSET 0 0 0", "\tOFFSET 0 nan 0"),
            4,
            11,
            "finite",
        ),
        (
            SMALL.replace("\tOFFSET 0 0 0\n", ""),
            5,
            2,
            "OFFSET of joint Hips",
        ),
        (
            SMALL.replace("CHANNELS 1", "CHANNELS 7"),
            9,
            12,
            "number of channels",
        ),
        (
            SMALL.replace("CHANNELS 1 Xrotation", "CHANNELS 1 Wrotation"),
            9,
            14,
            "Xrotation",
        ),
        (
            SMALL.replace("Zrotation Xrotation", "Xrotation Xrotation"),
            5,
            53,
            "each once",
        ),
        (SMALL.replace("Frames: 2", "Frames: 0"), 17, 9, "at least 1"),
        (
            SMALL.replace("Frames: 2", "Frames: two"),
            17,
            9,
            "number of frames",
        ),
        (SMALL.replace("0.0083333", "0"), 18, 13, "above zero"),
        (SMALL.replace("0.0083333", "inf"), 18, 13, "seconds"),
        (SMALL.replace("0 0 90 45", "0 0 90"), 20, 14, "7 values"),
        (
            SMALL.replace("0 0 90 45", "0 0 90 45 1"),
            20,
            18,
            "after 7 values",
        ),
        (
            SMALL.replace("0 0 90 45", "0 0 90 NaN"),
            20,
            15,
            "finite number in frame 1",
        ),
        (
            SMALL.replace("0 0 90 45", "0 0 90 1e99"),
            20,
            15,
            "finite number",
        ),
        (
            SMALL.replace("Frames: 2", "Frames: 3"),
            21,
            1,
            "promises 3 frames",
        ),
        (
            SMALL.replace("Frames: 2", "Frames: 1"),
            20,
            1,
            "1 frames of the header",
        ),
    ];
    for (text, line, column, word) in cases {
        let error = parse(&text).unwrap_err();
        let BvhError::Syntax {
            line: found_line,
            column: found_column,
            ref expected,
            ..
        } = error
        else {
            panic!("{error}");
        };
        assert_eq!((found_line, found_column), (line, column), "{error}");
        assert!(expected.contains(word), "{error}");
    }
    for cut in 0..SMALL.trim_end().len() - 1 {
        // Cut within the last number, the file is a shorter but valid one.
        if cut < SMALL.find(" 45").unwrap() {
            assert!(parse(&SMALL[..cut]).is_err(), "cut at {cut}");
        }
    }
}

#[test]
fn depth_does_not_matter() {
    let depth = 20_000;
    let mut text = "HIERARCHY\nROOT a { OFFSET 0 0 0 CHANNELS 1 Xrotation\n".to_owned();
    text.push_str(&"JOINT b { OFFSET 0 1 0\n".repeat(depth));
    text.push_str(&"}".repeat(depth + 1));
    text.push_str("\nMOTION\nFrames: 1\nFrame Time: 0.1\n5\n");
    let file = parse(&text).unwrap();
    assert_eq!(file.joints.len(), depth + 1);
    assert_eq!(parse(&write(&file)).unwrap(), file);
}

#[test]
fn files_are_read_and_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.bvh");
    let file = parse(SMALL).unwrap();
    write_file(&file, &path).unwrap();
    assert_eq!(read(&path).unwrap(), file);
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        1,
        "nothing is left beside it"
    );
    std::fs::write(&path, &SMALL[..SMALL.len() / 2]).unwrap();
    let error = read(&path).unwrap_err().to_string();
    assert!(
        error.contains("a.bvh") && error.contains("line 8"),
        "{error}"
    );
    let missing = folder.path().join("missing/b.bvh");
    assert!(read(&missing).unwrap_err().to_string().contains("b.bvh"));
    assert!(
        write_file(&file, &missing)
            .unwrap_err()
            .to_string()
            .contains("b.bvh")
    );
}

#[test]
fn joints_are_placed_as_the_channels_say() {
    let file = parse(SMALL).unwrap();
    let mut out = JointTransforms::default();
    file.place_joints(1, &mut out);
    assert_eq!(out.positions[0], Vec3::new(1.0, 10.0, 2.0));
    assert_eq!(out.positions[1], Vec3::new(1.0, 0.0, 2.0));
    let expected =
        Quat::from_rotation_y(90_f32.to_radians()) * Quat::from_rotation_x(45_f32.to_radians());
    assert!(out.rotations[1].angle_between(expected) < 1e-5);
}

#[test]
fn the_canonical_file_says_what_the_clip_says() {
    let mut poses = vec![Pose::rest(&Skeleton::standard()); 2];
    for (n, joint) in Joint::ALL.into_iter().enumerate() {
        let turn = Vec3::new(0.3, -0.2, 0.1) * (n as f32 / 11.0 - 1.0);
        poses[1].rotations[joint.index()] = Quat::from_scaled_axis(turn);
    }
    let clip = Clip {
        skeleton: Skeleton::standard(),
        frame_rate_hz: 60.0,
        poses,
    };
    let file = parse(&write(&clip_to_bvh(&clip))).unwrap();
    let names: Vec<&str> = file
        .joints
        .iter()
        .map(|joint| joint.name.as_str())
        .collect();
    assert_eq!(names, Joint::ALL.map(Joint::name));
    assert!((file.frame_rate_hz() - 60.0).abs() < 1e-9);
    let mut placed = JointTransforms::default();
    let mut model = ModelPose::default();
    for (frame, pose) in clip.poses.iter().enumerate() {
        file.place_joints(frame, &mut placed);
        forward_kinematics(&clip.skeleton, pose, &mut model);
        for joint in Joint::ALL {
            let gap = placed.positions[joint.index()].distance(model.position(joint));
            assert!(gap < 1e-5, "{joint:?} is off by {gap} m");
        }
    }
    assert!(
        file.frame(0)[3..].iter().all(|angle| *angle == 0.0),
        "zero rotations are the T-pose"
    );
    for name in ["Head", "LeftToes", "RightToes", "LeftHand", "RightHand"] {
        let joint = &file.joints[file.joint_named(name).unwrap()];
        assert_eq!(joint.end_sites.len(), 1, "{name}");
    }
}
