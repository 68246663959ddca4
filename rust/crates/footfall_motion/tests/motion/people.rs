//! Knees and soles of the people of the CMU walks, person by person, as recorded and with their hip joints corrected.

use crate::common::natural::knee_degrees;
use footfall_core::{Clip, Joint, ModelPose, Side, forward_kinematics};
use footfall_motion::bvh;
use footfall_motion::corpus::{Corpus, Person, Where};
use footfall_motion::figure::sole_points;
use footfall_motion::recording::Recording;
use footfall_motion::retarget::{RetargetOptions, SkeletonFit, retarget};

/// Tenth percentile of the knees over a person's walks, degrees, as recorded.
const RECORDED: [(&str, f32); 8] = [
    ("cmu2", 15.1),
    ("cmu5", 12.1),
    ("cmu6", 16.5),
    ("cmu7", 0.0),
    ("cmu8", 14.3),
    ("cmu10", 15.8),
    ("cmu16", 15.5),
    ("cmu35", 17.6),
];

fn corpus(conditions: &[&str], fit: SkeletonFit) -> Option<Corpus> {
    let folder = crate::common::data_folder()?;
    let conditions: Vec<Where> = conditions
        .iter()
        .map(|text| text.parse().expect("a condition"))
        .collect();
    let options = RetargetOptions {
        fit,
        ..RetargetOptions::default()
    };
    Some(Corpus::read_with(folder.join("index.csv"), &conditions, &options).expect("the CMU walks"))
}

/// The same recordings twice: with skeletons put right, and as recorded.
fn corrected_and_recorded(conditions: &[&str]) -> Option<[Corpus; 2]> {
    Some([
        corpus(conditions, SkeletonFit::FromRecording)?,
        corpus(conditions, SkeletonFit::AsRecorded)?,
    ])
}

fn person_of<'a>(corpus: &'a Corpus, name: &str) -> &'a Person {
    let mut people = corpus.report.people.iter();
    people
        .find(|person| person.subject == name)
        .expect("a person of the corpus")
}

fn quantile(values: &mut [f32], share: f32) -> f32 {
    values.sort_by(f32::total_cmp);
    let at = (share * values.len() as f32) as usize;
    values.get(at).copied().unwrap_or(f32::NAN)
}

/// Frames of a clip's walks.
fn walking_frames(clip: &Recording) -> Vec<usize> {
    let steps = clip.walks.iter().flat_map(|walk| &walk.steps);
    steps.flat_map(|step| step.first..step.end).collect()
}

/// Knees over a person's walks, degrees.
fn knees<'a>(clips: impl Iterator<Item = &'a Recording>) -> Vec<f32> {
    let of_clip = |clip: &'a Recording| {
        let frames = walking_frames(clip).into_iter();
        frames.flat_map(|frame| {
            Side::BOTH.map(|side| knee_degrees(&clip.retargeted.clip, frame, side))
        })
    };
    clips.flat_map(of_clip).collect()
}

/// Their tenth percentile.
fn straightest_knee<'a>(clips: impl Iterator<Item = &'a Recording>) -> f32 {
    quantile(&mut knees(clips), 0.1)
}

/// Slope of a sole in a frame, degrees: positive with the toes up.
fn sole_slope(clip: &Clip, frame: usize, side: Side) -> f32 {
    let model = ModelPose::of(&clip.skeleton, &clip.poses[frame]);
    let [heel, ball, _] = sole_points(&clip.skeleton, &model, side);
    let along = ball - heel;
    (along.y / along.length()).asin().to_degrees()
}

/// Slopes of the soles in the middle of the stances of walking, 0.35 to 0.5 of the stance.
fn soles(clip: &Recording) -> Vec<f32> {
    let mut slopes = Vec::new();
    for step in clip.walks.iter().flat_map(|walk| &walk.steps) {
        let stances = &clip.contacts.foot(step.side).stances;
        let Some(stance) = stances.iter().find(|stance| stance.first == step.first) else {
            continue;
        };
        for share in [0.35, 0.42, 0.5] {
            let frame = stance.first + (share * stance.frames() as f32) as usize;
            slopes.push(sole_slope(&clip.retargeted.clip, frame, step.side));
        }
    }
    slopes
}

fn of_person<'a>(corpus: &'a Corpus, person: &'a Person) -> impl Iterator<Item = &'a Recording> {
    let clips = corpus.clips.iter();
    clips.filter(|clip| person.paths.contains(&clip.row.path))
}

/// Standard deviation.
fn spread(values: &[f32]) -> f32 {
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    let squares = values.iter().map(|value| (value - mean).powi(2));
    (squares.sum::<f32>() / values.len() as f32).sqrt()
}

/// Changes of the knees' velocity over the walks, degrees in a sixtieth of a second twice.
fn jerks<'a>(clips: impl Iterator<Item = &'a Recording>) -> Vec<f32> {
    let mut jerks = Vec::new();
    for clip in clips {
        let motion = &clip.retargeted.clip;
        let hop = (motion.frame_rate_hz / 60.0).round() as usize;
        let frames = walking_frames(clip).into_iter();
        for frame in frames.filter(|frame| (hop..motion.poses.len() - hop).contains(frame)) {
            for side in Side::BOTH {
                let knee = |frame: usize| knee_degrees(motion, frame, side);
                jerks.push((knee(frame - hop) - 2.0 * knee(frame) + knee(frame + hop)).abs());
            }
        }
    }
    jerks
}

#[test]
fn knees_of_the_cmu_walks_bend_as_people_do_and_soles_stay_flat() {
    let Some([corpus, recorded]) = corrected_and_recorded(&["category=*walk*", "path=cmu/*"])
    else {
        return;
    };
    let (mut peaks, mut recorded_peaks) = (Vec::new(), Vec::new());
    for (name, known) in RECORDED {
        let person = person_of(&corpus, name);
        let before = straightest_knee(of_person(&recorded, person));
        assert!((before - known).abs() < 0.5, "{name}: {before} as recorded");
        let found = &person.fit.hip_centres;
        assert!(found.verdict.correction().is_some(), "{name}: {found:?}");
        let [strike, peak, end] = found.knee.unwrap();
        // A few strides place a joint to a millimetre or two, which is a degree or two here.
        assert!(
            (2.0..=6.0).contains(&strike),
            "{name}: {strike} at heel strike"
        );
        assert!((2.0..=8.5).contains(&end), "{name}: {end} before push-off");
        peaks.push(peak);
        recorded_peaks.push(found.recorded_knee.unwrap()[1]);
        let straightest = straightest_knee(of_person(&corpus, person));
        assert!((3.0..=9.0).contains(&straightest), "{name}: {straightest}");
        let mut angles = knees(of_person(&corpus, person));
        let least = quantile(&mut angles, 0.0);
        assert!(least > 2.0, "{name}: a knee is straight: {least}");
        // A leg that comes to its limit at once stops its knee at once.
        let jerk = quantile(&mut jerks(of_person(&corpus, person)), 0.99);
        assert!(jerk < 6.0, "{name}: knees change their pace by {jerk}");
        if found.strides < 5 {
            continue;
        }
        let mut slopes: Vec<f32> = of_person(&corpus, person).flat_map(soles).collect();
        let slope = quantile(&mut slopes, 0.5);
        assert!(
            slope.abs() <= 3.0,
            "{name}: the sole slopes by {slope} degrees"
        );
    }
    // People differ as much as they did in how far they bend in loading.
    let [spread, recorded_spread] = [spread(&peaks), spread(&recorded_peaks)];
    assert!(
        spread > 0.8 * recorded_spread,
        "{peaks:?}, recorded {recorded_peaks:?}"
    );
}

#[test]
fn soles_and_pelvis_of_the_cmu_walks_turn_as_recorded() {
    let Some([corpus, recorded]) = corrected_and_recorded(&["category=neutral_walk", "path=cmu/*"])
    else {
        return;
    };
    let (mut before, mut after) = (ModelPose::default(), ModelPose::default());
    for (a, b) in recorded.clips.iter().zip(&corpus.clips) {
        let [a, b] = [a, b].map(|clip| &clip.retargeted);
        for (own, other) in a.clip.poses.iter().zip(&b.clip.poses).skip(a.first_frame) {
            forward_kinematics(&a.clip.skeleton, own, &mut before);
            forward_kinematics(&b.clip.skeleton, other, &mut after);
            for joint in [Joint::Hips, Joint::LeftFoot, Joint::RightFoot] {
                let turned = before.rotation(joint).angle_between(after.rotation(joint));
                let turned = turned.to_degrees();
                assert!(turned < 0.1, "{joint:?} turned by {turned} degrees");
            }
        }
    }
}

#[test]
fn a_clip_that_does_not_suit_its_person_stands_for_itself() {
    let Some(corpus) = corpus(&["subject=cmu16"], SkeletonFit::FromRecording) else {
        return;
    };
    let people = &corpus.report.people;
    let alone: Vec<_> = people.iter().filter(|p| p.paths.len() == 1).collect();
    assert_eq!((people.len(), alone.len()), (2, 1), "{people:?}");
    // Its left knee is straight for a tenth of the time as recorded, its right one bent by 30 degrees.
    assert!(alone[0].paths[0].ends_with("cmu_16_walkx_train_33.bvh"));
    let [left, right] = alone[0]
        .fit
        .hip_centres
        .verdict
        .correction()
        .unwrap()
        .offsets;
    assert!(left.x + 0.015 < right.x, "{left} {right}");
    let straightest = straightest_knee(of_person(&corpus, alone[0]));
    assert!((3.0..=9.0).contains(&straightest), "{straightest}");
}

#[test]
fn knees_of_the_people_in_consistent_skeletons_stay_as_recorded() {
    for conditions in [
        ["category=neutral_walk", "path=bandai/*"],
        ["style=neutral", "path=o3de/*"],
    ] {
        let Some(corpus) = corpus(&conditions, SkeletonFit::FromRecording) else {
            return;
        };
        for person in &corpus.report.people {
            let found = person.fit.hip_centres;
            assert_eq!(
                found.verdict.correction(),
                None,
                "{}: {found:?}",
                person.subject
            );
        }
    }
}

#[test]
fn a_recording_of_an_acted_walk_keeps_its_manner_on_its_own() {
    let Some(folder) = crate::common::data_folder() else {
        return;
    };
    for name in [
        "sad",
        "old",
        "giant",
        "tired",
        "chimpira",
        "not-confident",
        "proud",
    ] {
        let file =
            bvh::read(folder.join(format!("bandai/styled_walk/bn1_walk_{name}_001.bvh"))).unwrap();
        let options = RetargetOptions {
            fit: SkeletonFit::FromRecording,
            ..RetargetOptions::default()
        };
        let found = retarget(&file, &options).unwrap().report.fit.hip_centres;
        assert_eq!(found.verdict.correction(), None, "{name}: {found:?}");
    }
}

/// Mean pitch of a joint over a person's walks, degrees forwards and down.
fn pitch<'a>(clips: impl Iterator<Item = &'a Recording>, joint: Joint) -> f32 {
    let of_clip = |clip: &'a Recording| {
        let body = |frame: usize| ModelPose::of(&clip.clip().skeleton, &clip.clip().poses[frame]);
        let forward = move |frame| body(frame).rotation(joint) * glam::Vec3::Z;
        let frames = walking_frames(clip).into_iter();
        frames.map(move |frame| -forward(frame).y.asin().to_degrees())
    };
    let pitches: Vec<f32> = clips.flat_map(of_clip).collect();
    pitches.iter().sum::<f32>() / pitches.len() as f32
}

#[test]
fn faces_of_the_cmu_walks_are_nearly_level_and_necks_are_upright() {
    let Some([corpus, recorded]) = corrected_and_recorded(&["category=*walk*", "path=cmu/*"])
    else {
        return;
    };
    let mut faces = Vec::new();
    for (name, _) in RECORDED {
        let person = person_of(&corpus, name);
        faces.push(pitch(of_person(&recorded, person), Joint::Head));
        let face = pitch(of_person(&corpus, person), Joint::Head);
        assert!(
            (-2.0..=12.0).contains(&face),
            "{name}: the face is {face} down"
        );
        let neck = pitch(of_person(&corpus, person), Joint::Neck);
        assert!(
            (-5.0..=10.0).contains(&neck),
            "{name}: the neck is {neck} forwards"
        );
    }
    let least = quantile(&mut faces, 0.0);
    let most = quantile(&mut faces, 0.99);
    assert!(most - least > 30.0, "the recordings differ: {faces:?}");
}
