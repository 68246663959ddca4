//! Sensors that fail, are worn wrongly or ride a lift: each problem is reported, and the body stands or walks without jumps.

#![expect(clippy::unwrap_used, reason = "helpers of tests, which may panic")]

use footfall_core::{Behaviour, Joint, Pose, Site};
use footfall_imu::{GRAVITY_MPS2, ImuRecording, ImuSample};
use footfall_model::ImuModel;
use footfall_motion::virtual_imu::{SensorNoise, VirtualImuConfig, simulate};
use footfall_recon::{
    Prepared, ReconConfig, Reconstructor, SensorProblem, TrackerConfig, find_mounting,
};
use footfall_tests::data::{recordings, repository};
use footfall_tests::{real_feet, walkers};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// The game's frames.
const DT_SECS: f64 = 1.0 / 60.0;

/// Faults begin so long after the recording, seconds.
const FAULTY_SECS: f64 = 6.0;

/// Time within which a wearer who is not seen any more stands, seconds.
const STANDS_SECS: f64 = 0.5;

/// No joint may turn faster, rad/s, and no body move faster over the ground, m/s.
const MOST_RADPS: f32 = 20.5;
const MOST_MPS: f32 = 7.0;

fn shipped(site: &str) -> Arc<Prepared> {
    let path = repository().join(format!("addons/footfall/models/{site}.footimu"));
    let model = ImuModel::from_bytes(&std::fs::read(path).unwrap()).unwrap();
    Arc::new(Prepared::new(Arc::new(model)).unwrap())
}

/// Motion of a body from the time of a fault on.
struct Driven {
    /// Fastest joint of each frame, rad/s, in order of size.
    turns: Vec<f32>,
    /// Fastest way of the hips over the ground, m/s.
    fastest_mps: f32,
    /// Names of the problems, and the time of the first report of each, seconds after the fault.
    reported: Vec<(&'static str, f64)>,
    /// When the body moved first, seconds after the fault.
    moves_secs: f64,
    /// When it moved last.
    moved_secs: f64,
    /// Frames, and those in which it stands.
    frames: usize,
    stood: usize,
    /// Fastest joint in the last second.
    last_turn: f32,
    behaviour: Behaviour,
}

impl Driven {
    /// Time of a problem's first report, seconds after the fault.
    fn reported_secs(&self, name: &str) -> Option<f64> {
        let reported = self.reported.iter().find(|(own, _)| *own == name);
        reported.map(|(_, secs)| *secs)
    }

    /// The turn of the fastest joint that one frame in a hundred exceeds.
    fn high_turn(&self) -> f32 {
        self.turns[self.turns.len() * 99 / 100]
    }

    fn assert_calm(&self, what: &str) {
        let fastest = self.turns[self.turns.len() - 1];
        assert!(fastest < MOST_RADPS, "{what}: {fastest} rad/s");
        assert!(
            self.fastest_mps < MOST_MPS,
            "{what}: {} m/s",
            self.fastest_mps
        );
    }
}

fn drive(prepared: &Arc<Prepared>, recording: &ImuRecording, mounting: Quat) -> Driven {
    let skeleton = prepared.model().skeleton.clone();
    let mut body = Reconstructor::new(prepared, &skeleton, &ReconConfig::default()).unwrap();
    body.set_mounting(0, mounting);
    let (mut pose, mut before) = (Pose::default(), None::<(Pose, Vec3)>);
    let start_secs = recording.start_secs();
    let mut driven = Driven {
        turns: Vec::new(),
        fastest_mps: 0.0,
        reported: Vec::new(),
        moves_secs: f64::INFINITY,
        moved_secs: 0.0,
        frames: 0,
        stood: 0,
        last_turn: 0.0,
        behaviour: Behaviour::Stand,
    };
    let mut samples = recording.samples.iter().peekable();
    for frame in 0..(recording.duration_secs() / DT_SECS) as u32 {
        let secs = f64::from(frame) * DT_SECS;
        while let Some(sample) = samples.next_if(|s| s.time_secs <= start_secs + secs) {
            body.push(0, *sample);
        }
        body.step(DT_SECS as f32, &mut pose);
        let (place, _) = body.split(&mut pose);
        assert!(pose.rotations.iter().all(|turn| turn.is_finite()));
        let last = before.replace((pose.clone(), place));
        if secs < FAULTY_SECS {
            continue;
        }
        let (last, last_place) = last.unwrap();
        let turn = |joint| last.rotation(joint).angle_between(pose.rotation(joint));
        let turn = Joint::ALL.into_iter().map(turn).fold(0.0, f32::max) / DT_SECS as f32;
        driven.turns.push(turn);
        driven.fastest_mps = driven
            .fastest_mps
            .max(place.distance(last_place) / DT_SECS as f32);
        driven.frames += 1;
        if body.behaviour() != Behaviour::Stand {
            driven.moves_secs = driven.moves_secs.min(secs - FAULTY_SECS);
            driven.moved_secs = secs - FAULTY_SECS;
        }
        driven.stood += usize::from(body.behaviour() == Behaviour::Stand);
        if secs > recording.duration_secs() - 1.0 {
            driven.last_turn = driven.last_turn.max(turn);
        }
        if let Some(problem) = body.problem(0)
            && driven.reported_secs(problem.name()).is_none()
        {
            driven.reported.push((problem.name(), secs - FAULTY_SECS));
        }
    }
    driven.turns.sort_by(f32::total_cmp);
    driven.behaviour = body.behaviour();
    driven
}

/// A walk of a quarter of a minute of a walker of the project's own, measured by a consumer's sensor.
fn walk(site: Site, mounting: Quat) -> ImuRecording {
    let gait = walkers::model("tests/model_versions/v1.footfall");
    let clip = walkers::recorded(&gait, &gait.skeleton, 5, 1.2);
    let config = VirtualImuConfig {
        noise: Some(SensorNoise::consumer(1.0)),
        mounting,
        ..VirtualImuConfig::ideal(100.0)
    };
    simulate(&clip, 0, site, &config)
}

/// A recording whose samples are changed, or lost, from [`FAULTY_SECS`] on.
fn faulty(
    recording: &ImuRecording,
    mut change: impl FnMut(usize, &mut ImuSample) -> bool,
) -> ImuRecording {
    let from = recording.start_secs() + FAULTY_SECS;
    let samples = recording.samples.iter().enumerate().filter_map(|(n, own)| {
        let mut sample = *own;
        let kept = sample.time_secs < from || change(n, &mut sample);
        kept.then_some(sample)
    });
    ImuRecording {
        samples: samples.collect(),
    }
}

/// Change of a sample by its number, in a recording of so many samples a second.
type Change = fn(usize, f64, &mut ImuSample) -> bool;

/// Faults of a stream: the name of each, whether the body stands then, and the seconds of motion within which it is reported.
const FAULTS: [(&str, bool, f64, Change); 8] = [
    ("stuck_axis", true, 3.0, |_, _, s| {
        s.rate.x = 0.2;
        true
    }),
    ("stuck_axis", true, 3.0, |_, _, s| {
        s.rate.y = 0.2;
        true
    }),
    ("stuck_axis", true, 3.0, |_, _, s| {
        s.force.y = 4.0;
        true
    }),
    ("stuck_axis", true, 3.0, |_, _, s| {
        s.force.z = 0.0;
        true
    }),
    ("rate_in_degrees", true, 2.0, |_, _, s| {
        s.rate *= 1_f32.to_degrees();
        true
    }),
    ("pace", false, 4.1, |n, _, _| n % 2 == 0),
    ("slow", true, 5.0, |n, rate_hz, _| {
        n % (rate_hz / 14.0) as usize == 0
    }),
    ("saturated", false, 6.0, |_, _, s| {
        let end = Vec3::splat(2.0 * GRAVITY_MPS2);
        s.force = s.force.clamp(-end, end);
        true
    }),
];

fn assert_faults_are_borne(prepared: &Arc<Prepared>, recording: &ImuRecording, mounting: Quat) {
    let sound = drive(prepared, recording, mounting);
    sound.assert_calm("sound");
    assert!(sound.stood < sound.frames / 2, "a walk");
    assert!(sound.reported.is_empty(), "{:?}", sound.reported);
    for (n, (name, stands, within_secs, change)) in FAULTS.into_iter().enumerate() {
        let what = format!("{n}, {name}");
        let rate_hz = recording.rate_hz();
        let changed = faulty(recording, |n, sample| change(n, rate_hz, sample));
        let driven = drive(prepared, &changed, mounting);
        driven.assert_calm(&what);
        assert!(
            driven.high_turn() < 1.1 * sound.high_turn(),
            "{what}: {} rad/s, {} of a sound sensor",
            driven.high_turn(),
            sound.high_turn()
        );
        let reported = driven.reported_secs(name);
        assert!(
            reported.is_some_and(|secs| secs < sound.moves_secs + within_secs),
            "{what}: {:?}",
            driven.reported
        );
        if stands {
            assert_eq!(driven.behaviour, Behaviour::Stand, "{what}");
            let after_secs = driven.moved_secs - reported.unwrap_or_default();
            assert!(after_secs < STANDS_SECS, "{what}: moves {after_secs} s on");
            // Knees of who walks turn by 7 rad/s.
            assert!(driven.last_turn < 2.0, "{what}: {} rad/s", driven.last_turn);
        } else {
            assert!(driven.stood < driven.frames / 2, "{what}: it walks on");
        }
    }
}

#[test]
fn a_simulated_sensor_that_fails_is_reported_and_throws_nobody() {
    let worn = Quat::from_rotation_x(0.3);
    let recording = walk(Site::RightFoot, worn);
    assert_faults_are_borne(&shipped("right_foot"), &recording, worn);
}

#[test]
fn a_real_sensor_that_fails_is_reported_and_throws_nobody() {
    let Some(data) = recordings("bad_input") else {
        return;
    };
    let prepared = shipped("right_foot");
    for recording in [
        real_feet::ipol(&data, 3, 1, "rf"),
        real_feet::xio(&data, "long_walk"),
    ] {
        let found = find_mounting(&prepared, 0, &recording, &TrackerConfig::default()).unwrap();
        assert_faults_are_borne(&prepared, &recording, found.site_from_sensor);
    }
}

/// Change of a sample that a single sample does not reveal.
type Wrong<'a> = dyn Fn(&mut ImuSample) + 'a;

/// Samples alone do not reveal wrong signs and axes, or exchanged streams of two people; the body survives them.
#[test]
fn wrong_signs_and_exchanged_people_throw_nobody() {
    let Some(data) = recordings("bad_input") else {
        return;
    };
    let prepared = shipped("right_foot");
    let recording = real_feet::ipol(&data, 5, 1, "rf");
    let other = real_feet::ipol(&data, 7, 2, "rf");
    let found = find_mounting(&prepared, 0, &recording, &TrackerConfig::default()).unwrap();
    let sound = drive(&prepared, &recording, found.site_from_sensor);
    let changes: [(&str, &Wrong<'_>); 5] = [
        ("force y", &|s| s.force.y = -s.force.y),
        ("force", &|s| s.force = -s.force),
        ("rate x", &|s| s.rate.x = -s.rate.x),
        ("upside down", &|s| {
            *s = s.turned(Quat::from_rotation_x(core::f32::consts::PI));
        }),
        ("exchanged", &|s| {
            *s = ImuSample {
                time_secs: s.time_secs,
                ..other.at(s.time_secs)
            }
        }),
    ];
    for (what, change) in changes {
        let changed = faulty(&recording, |_, sample| {
            change(sample);
            true
        });
        let driven = drive(&prepared, &changed, found.site_from_sensor);
        driven.assert_calm(what);
        assert!(
            driven.high_turn() < 1.1 * sound.high_turn(),
            "{what}: {} rad/s",
            driven.high_turn()
        );
        if ["force", "upside down"].contains(&what) {
            assert!(
                driven.reported_secs("unexplained").is_some(),
                "{what}: {:?}",
                driven.reported
            );
        }
    }
}

/// A sensor with these measurements after some time of standing.
fn after_standing(measured: impl Fn(f32) -> (Vec3, Vec3)) -> ImuRecording {
    let samples = (0..1600_u16).map(|n| {
        let secs = f32::from(n) * 0.01;
        let (force, rate) = if f64::from(secs) < FAULTY_SECS {
            (Vec3::Y * GRAVITY_MPS2, Vec3::ZERO)
        } else {
            measured(secs - FAULTY_SECS as f32)
        };
        let noise = 0.01
            * Vec3::new(
                (secs * 91.0).sin(),
                (secs * 83.0).sin(),
                (secs * 79.0).sin(),
            );
        ImuSample {
            time_secs: f64::from(secs),
            force: force + noise,
            rate: rate + noise,
        }
    });
    ImuRecording {
        samples: samples.collect(),
    }
}

#[test]
fn whoever_lies_down_or_rides_a_lift_is_reported_and_stands() {
    for site in ["right_foot", "right_thigh"] {
        let prepared = shipped(site);
        // Over a second it is turned over, and lies.
        let lies = after_standing(|secs| {
            let angle = core::f32::consts::FRAC_PI_2 * secs.min(1.0);
            let rate = if secs < 1.0 {
                core::f32::consts::FRAC_PI_2
            } else {
                0.0
            };
            let turn = Quat::from_rotation_x(-angle);
            (turn * Vec3::Y * GRAVITY_MPS2, Vec3::X * rate)
        });
        let lift = after_standing(|secs| {
            let push = match secs {
                1.0..3.0 => 0.9,
                6.0..8.0 => -0.9,
                _ => 0.0,
            };
            (Vec3::Y * (GRAVITY_MPS2 + push), Vec3::ZERO)
        });
        for (name, recording, within_secs) in [("lies", lies, 3.0), ("rides", lift, 2.5)] {
            let driven = drive(&prepared, &recording, Quat::IDENTITY);
            let reported = driven.reported_secs(name);
            assert!(
                reported.is_some_and(|secs| secs < within_secs),
                "{site}: {:?}",
                driven.reported
            );
            driven.assert_calm(name);
            // Who turns a sensor over takes a leg along, once.
            let (most, stands) = if name == "lies" {
                (MOST_RADPS, 0.7)
            } else {
                (2.0, 0.9)
            };
            assert!(
                driven.high_turn() < most,
                "{site} {name}: {}",
                driven.high_turn()
            );
            let stood = driven.stood as f64 / driven.frames as f64;
            assert!(
                stood > stands,
                "{site} {name} stands for {stood:.2} of the time"
            );
            assert_eq!(driven.behaviour, Behaviour::Stand, "{site} {name}");
            assert!(
                driven.last_turn < 1.0,
                "{site} {name}: {}",
                driven.last_turn
            );
        }
    }
}

#[test]
fn silence_is_reported_until_samples_come() {
    let prepared = shipped("right_foot");
    let skeleton = prepared.model().skeleton.clone();
    let mut body = Reconstructor::new(&prepared, &skeleton, &ReconConfig::default()).unwrap();
    let mut pose = Pose::default();
    assert_eq!(body.problem(0), None);
    for _ in 0..90 {
        body.step(DT_SECS as f32, &mut pose);
    }
    assert_eq!(body.problem(0), Some(SensorProblem::Silent));
    assert_eq!(body.problem(1), None, "the model has one sensor");
    for sample in &walk(Site::RightFoot, Quat::IDENTITY).samples[..100] {
        body.push(0, *sample);
    }
    assert_eq!(body.problem(0), None);
}
