//! Files that cannot be retargeted, or hardly.

use super::{expect_near, options, renamed, source};
use crate::common::walker::walker;
use footfall_core::Joint;
use footfall_motion::bvh::{Channel, clip_to_bvh};
use footfall_motion::retarget::{RetargetError, RetargetOptions, parse_joint_map, retarget};
use glam::Vec3;
use proptest::prelude::*;

#[test]
fn an_unknown_skeleton_is_told_what_to_do() {
    let (clip, file) = source();
    let names: Vec<String> = (0..22).map(|n| format!("thing{n}")).collect();
    let strange = renamed(file, &std::array::from_fn(|n| names[n].as_str()));
    let error = retarget(&strange, &options()).unwrap_err();
    let text = error.to_string();
    for part in ["Hips", "LeftUpperLeg", "RightFoot", "thing21", "--map"] {
        assert!(text.contains(part), "{text}");
    }
    let lines = Joint::ALL.iter().zip(&names);
    let toml = lines
        .map(|(joint, name)| format!("{} = [\"nobody\", \"{name}\"]", joint.name()))
        .collect::<Vec<_>>()
        .join(
            "
",
        );
    let with_map = RetargetOptions {
        map: Some(parse_joint_map(&toml).unwrap()),
        ..options()
    };
    expect_near(&clip, &retarget(&strange, &with_map).unwrap(), 1.0);
    let partial = RetargetOptions {
        map: Some(parse_joint_map("Hips = 'thing0'").unwrap()),
        ..options()
    };
    let RetargetError::UnknownSkeleton { missing, .. } = retarget(&strange, &partial).unwrap_err()
    else {
        panic!("a map of one joint is not enough");
    };
    assert!(!missing.contains(&Joint::Hips) && missing.contains(&Joint::LeftFoot));
    for (text, word) in [
        ("Hips = ", "joint map"),
        ("Pelvis = 'a'", "UpperChest"),
        ("Hips = 3", "in quotes"),
    ] {
        let error = parse_joint_map(text).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn legs_without_length_are_an_error() {
    let (_, mut file) = source();
    for joint in &mut file.joints {
        joint.offset = Vec3::ZERO;
    }
    let error = retarget(&file, &options()).unwrap_err().to_string();
    assert!(error.contains("LeftLowerLeg"), "{error}");
}

#[test]
fn one_frame_and_odd_channels_are_no_trouble() {
    let (clip, mut file) = source();
    let width = file.channel_count();
    file.frame_count = 1;
    file.values.truncate(width);
    let one = retarget(&file, &options()).unwrap();
    assert_eq!(one.clip.poses.len(), 1);
    // Position channels on every joint replace the offsets.
    let (_, file) = source();
    let mut wide = file.clone();
    for joint in &mut wide.joints[1..] {
        joint.channels.splice(
            0..0,
            [Channel::ZPosition, Channel::XPosition, Channel::YPosition],
        );
    }
    wide.values.clear();
    for frame in 0..file.frame_count {
        let row = file.frame(frame);
        wide.values.extend(&row[..6]);
        for (joint, angles) in file.joints[1..].iter().zip(row[6..].chunks_exact(3)) {
            wide.values
                .extend([joint.offset.z, joint.offset.x, joint.offset.y]);
            wide.values.extend(angles);
        }
    }
    expect_near(&clip, &retarget(&wide, &options()).unwrap(), 1.0);
}

proptest! {
    #[test]
    fn nonsense_is_refused_or_finite(
        changes in proptest::collection::vec((any::<proptest::sample::Index>(), -1.0_f32..1.0, 0_i32..39), 0..40),
        frames in 1_usize..40,
    ) {
        let mut file = clip_to_bvh(&walker(60.0, frames));
        for (at, value, power) in changes {
            let value = value * 10_f32.powi(power);
            let count = file.values.len();
            match at.index(count + 22).checked_sub(count) {
                Some(joint) => file.joints[joint].offset.y = value,
                None => file.values[at.index(count)] = value,
            }
        }
        if let Ok(retargeted) = retarget(&file, &options()) {
            let config = footfall_motion::contacts::ContactConfig::from_frame(retargeted.first_frame);
            let contacts = footfall_motion::contacts::detect_contacts(&retargeted.clip, &config);
            footfall_motion::steps::segment_walks(&retargeted.clip, &contacts);
            for pose in &retargeted.clip.poses {
                prop_assert!(pose.root_position.is_finite());
            }
        }
    }
}
