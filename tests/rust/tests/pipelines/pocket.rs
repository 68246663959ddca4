//! A phone in the pocket: sixty rounded samples a second, in an unknown pocket, taken out, laid down and put back.

#![expect(clippy::unwrap_used, reason = "helpers of tests, which may panic")]

use core::f32::consts::{FRAC_PI_2, TAU};
use footfall_core::{Behaviour, Pose, Site};
use footfall_imu::{GRAVITY_MPS2, ImuRecording, ImuSample, find_rest};
use footfall_model::{ImuModel, SensorCalibration};
use footfall_motion::virtual_imu::{SensorNoise, VirtualImuConfig, simulate};
use footfall_recon::{
    CalibrationGuide, GuideStep, Prepared, ReconConfig, Reconstructor, SensorProblem,
    TrackerConfig, examine,
};
use footfall_tests::data::repository;
use footfall_tests::walkers;
use glam::{Quat, Vec3};
use std::sync::Arc;

const RATE_HZ: f64 = 60.0;

fn prepared() -> Arc<Prepared> {
    let path = repository().join("addons/footfall/models/right_thigh.footimu");
    let model = ImuModel::from_bytes(&std::fs::read(path).unwrap()).unwrap();
    Arc::new(Prepared::new(Arc::new(model)).unwrap())
}

/// Samples as a browser gives them: in steps of 0.1 m/s² and 0.1 °/s.
fn rounded(recording: ImuRecording) -> ImuRecording {
    let steps = |vector: Vec3, step: f32| (vector / step).round() * step;
    let samples = recording.samples.into_iter().map(|sample| ImuSample {
        time_secs: sample.time_secs,
        force: steps(sample.force, 0.1),
        rate: steps(sample.rate, 0.1_f32.to_radians()),
    });
    ImuRecording {
        samples: samples.collect(),
    }
}

/// A walk of a quarter of a minute out of standing, in the pocket of a thigh, turned so.
fn walk(site: Site, turned: Quat) -> ImuRecording {
    let gait = walkers::model("addons/footfall/models/locomotion.footfall");
    let clip = walkers::recorded(&gait, &gait.skeleton, 4, 1.25);
    let config = VirtualImuConfig {
        mounting: turned,
        noise: Some(SensorNoise::consumer(1.0)),
        seed: 4,
        ..VirtualImuConfig::ideal(RATE_HZ)
    };
    rounded(simulate(&clip, 0, site, &config))
}

/// Seconds of a phone that measures this, force and rate.
fn phone(secs: f64, measured: impl Fn(f32) -> (Vec3, Vec3)) -> ImuRecording {
    let samples = (0..(secs * RATE_HZ) as u32).map(|n| {
        let time_secs = f64::from(n) / RATE_HZ;
        let (force, rate) = measured(time_secs as f32);
        let noise = 0.02 * Vec3::splat((f64::from(n) * 78.233).sin() as f32);
        ImuSample {
            time_secs,
            force: force + 3.0 * noise,
            rate: rate + 0.3 * noise,
        }
    });
    rounded(ImuRecording {
        samples: samples.collect(),
    })
}

/// A phone in a hand that carries and turns it.
fn handled(secs: f64) -> ImuRecording {
    phone(secs, |time| {
        let wave = |hertz: f32, n: f32| (TAU * hertz * time + n).sin();
        let force = Vec3::new(wave(2.3, 0.0), wave(3.1, 1.0), wave(2.7, 2.0)) * 7.0;
        let rate = Vec3::new(wave(2.9, 3.0), wave(1.9, 4.0), wave(3.3, 5.0)) * 5.0;
        (force + Vec3::Y * GRAVITY_MPS2, rate)
    })
}

/// A phone that lies on a table.
fn on_the_table(secs: f64, up: Vec3) -> ImuRecording {
    phone(secs, |_| (up * GRAVITY_MPS2, Vec3::ZERO))
}

/// A game that hears a phone.
struct Game {
    body: Reconstructor,
    pose: Pose,
    now_secs: f64,
}

impl Game {
    fn new(prepared: &Arc<Prepared>) -> Self {
        let skeleton = prepared.model().skeleton.clone();
        Self {
            body: Reconstructor::new(prepared, &skeleton, &ReconConfig::default()).unwrap(),
            pose: Pose::default(),
            now_secs: 0.0,
        }
    }

    /// Feeds a recording; returns the names of the reported problems, in order.
    fn hear(&mut self, recording: &ImuRecording) -> Vec<&'static str> {
        let mut problems: Vec<&'static str> = Vec::new();
        for sample in &recording.samples {
            self.now_secs += 1.0 / RATE_HZ;
            let time_secs = self.now_secs;
            self.body.push(
                0,
                ImuSample {
                    time_secs,
                    ..*sample
                },
            );
            self.body.step((1.0 / RATE_HZ) as f32, &mut self.pose);
            let name = self.body.problem(0).map_or("", |problem| problem.name());
            if problems.last() != Some(&name) {
                problems.push(name);
            }
        }
        problems
    }
}

#[test]
fn a_phone_that_is_taken_out_laid_down_and_put_back_is_problems_at_every_step() {
    let prepared = prepared();
    let config = TrackerConfig::default();
    let (first, second) = (Quat::from_rotation_y(0.4), Quat::from_rotation_z(2.8));
    let pocket = walk(Site::RightThigh, first);
    let found = examine(&prepared, 0, &pocket, None, &config).unwrap();
    assert_eq!(found.finding, None);
    let mounting = found.mounting.site_from_sensor;
    let mut game = Game::new(&prepared);
    game.body.set_mounting(0, mounting);
    assert_eq!(game.hear(&pocket), [""], "in the pocket");
    assert_eq!(game.body.behaviour(), Behaviour::Walk);
    let problems = game.hear(&handled(4.0));
    assert_eq!(problems.last(), Some(&"unexplained"), "{problems:?}");
    assert_eq!(game.body.behaviour(), Behaviour::Stand);
    // On its back, which is no way to stand in a pocket.
    let up = mounting.inverse() * Quat::from_rotation_x(FRAC_PI_2) * Vec3::Y;
    let problems = game.hear(&on_the_table(4.0, up));
    assert_eq!(problems.last(), Some(&"lies"), "{problems:?}");
    assert_eq!(game.body.behaviour(), Behaviour::Stand);
    // Back in the pocket upside down: the turn is reported, and the mounting found.
    let again = walk(Site::RightThigh, second);
    let problems = game.hear(&again);
    assert!(problems.contains(&"unexplained"), "{problems:?}");
    let seen = examine(&prepared, 0, &again, Some(mounting), &config).unwrap();
    assert!(
        matches!(seen.finding, Some(SensorProblem::Turned { .. })),
        "{:?}",
        seen.finding
    );
    game.body.set_mounting(0, seen.mounting.site_from_sensor);
    assert_eq!(game.hear(&again).last(), Some(&""), "it is understood");
    assert_eq!(game.body.behaviour(), Behaviour::Walk);
}

#[test]
fn standing_and_four_steps_calibrate_a_phone() {
    let prepared = prepared();
    let turned = Quat::from_rotation_x(1.1) * Quat::from_rotation_z(-0.7);
    let steps = walk(Site::RightThigh, turned);
    let up = steps.samples[..20].iter().map(|s| s.force).sum::<Vec3>() / 20.0;
    let mut heard = on_the_table(2.3, up.normalize());
    let bias = Vec3::new(0.02, -0.01, 0.015);
    let begin = 2.3;
    heard
        .samples
        .extend(steps.samples.iter().map(|sample| ImuSample {
            time_secs: sample.time_secs - steps.start_secs() + begin,
            ..*sample
        }));
    heard.samples.iter_mut().for_each(|s| s.rate += bias);
    let mut guide = CalibrationGuide::default();
    let mut asked = vec![guide.step()];
    let mut until = 0;
    for (n, sample) in heard.samples.iter().enumerate() {
        guide.push(sample);
        if asked.last() != Some(&guide.step()) {
            asked.push(guide.step());
        }
        if guide.wants_mounting() {
            until = n;
            break;
        }
    }
    assert_eq!(
        asked,
        [GuideStep::Connect, GuideStep::Stand, GuideStep::Walk]
    );
    let secs = heard.samples[until].time_secs;
    assert!((4.0..6.5).contains(&secs), "{secs} s");
    let heard = ImuRecording {
        samples: heard.samples[..=until].to_vec(),
    };
    let found = examine(&prepared, 0, &heard, None, &TrackerConfig::default()).unwrap();
    guide.found(found.mounting.certainty);
    assert_eq!(guide.step(), GuideStep::Done, "{:?}", found.mounting);
    let off = (found.mounting.site_from_sensor * turned.inverse()).angle_between(Quat::IDENTITY);
    assert!(off < 0.5, "{off}");
    let rest = find_rest(&heard).unwrap();
    assert!(rest.rate_bias.distance(bias) < 0.005, "{rest:?}");

    // The next session begins where this one ended.
    let mut game = Game::new(&prepared);
    game.body.set_mounting(0, found.mounting.site_from_sensor);
    game.body.set_rest(0, rest.rate_bias, rest.force.length());
    game.body.set_stride(1.1);
    let bytes = game.body.calibration().unwrap().to_bytes().unwrap();
    let kept = SensorCalibration::from_bytes(&bytes).unwrap();
    assert_eq!(kept.sensors[0].rate_bias, rest.rate_bias);
    let mut next = Game::new(&prepared);
    next.body.forget_mounting(0);
    assert_eq!(next.body.calibration(), None, "nothing is known yet");
    next.body.calibrate(&kept).unwrap();
    assert!((next.body.stride() - 1.1).abs() < 1e-6);
    assert_eq!(next.hear(&steps), [""]);
    assert_eq!(next.body.behaviour(), Behaviour::Walk);
    let mut other = kept.clone();
    other.sensors[0].site = Site::RightFoot;
    assert!(next.body.calibrate(&other).is_err());
}
