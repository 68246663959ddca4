//! The forward and the backward algorithm against slow ones with the whole transition matrix.

use footfall_core::{Behaviour, PhaseKind, PhaseStart, Side, Site, Skeleton};
use footfall_model::imu_model::{BODY_COUNT, SENSOR_COUNT, Segment};
use footfall_model::{ImuModel, Provenance};
use footfall_recon::{
    Measurement, Prepared, Published, ReconConfig, StridePhase, Tracker, TrackerConfig,
};
use std::sync::Arc;

const WIDTH: usize = SENSOR_COUNT * 2;

/// Three recordings of two subjects, in three phases that follow each other in turn.
fn model() -> ImuModel {
    let kind = |start: PhaseStart, side: Side| PhaseKind {
        behaviour: Behaviour::Walk,
        start,
        side,
    };
    let phases = vec![
        kind(PhaseStart::Landing, Side::Left),
        kind(PhaseStart::TakeOff, Side::Left),
        kind(PhaseStart::Landing, Side::Right),
    ];
    let mut segments = Vec::new();
    for (recording, subject) in [(0_u16, 0), (1, 1), (2, 0)] {
        for n in 0..5_u16 {
            segments.push(Segment {
                phase: (recording + n) % 3,
                subject,
                frames: 1 + (n * 3 + recording) % 4,
                follows: n > 0,
            });
        }
    }
    let frames: usize = segments.iter().map(|s| usize::from(s.frames)).sum();
    let wave = |n: usize| ((n * 37 % 101) as f32 * 0.3).sin();
    ImuModel {
        frame_rate_hz: 30.0,
        sites: vec![Site::RightFoot],
        skeleton: Skeleton::standard(),
        next: vec![0.0, 0.8, 0.2, 0.3, 0.0, 0.7, 1.0, 0.0, 0.0],
        phases,
        subjects: 2,
        sensor: (0..frames * SENSOR_COUNT).map(wave).collect(),
        body: (0..frames * BODY_COUNT)
            .map(|n| 0.3 * wave(n + 7))
            .collect(),
        deviations: vec![0.7; SENSOR_COUNT],
        regressions: vec![Vec::new(); 3],
        segments,
        provenance: Provenance::default(),
    }
}

fn measured(n: usize) -> Measurement {
    let mut measurement = Measurement {
        values: [0.0; WIDTH],
        weights: [1.0; WIDTH],
        stride: StridePhase::default(),
    };
    for (number, value) in measurement.values.iter_mut().enumerate() {
        *value = ((n * 5 + number) as f32 * 0.7).cos();
    }
    measurement.weights[8] = 0.3;
    measurement
}

/// Probability to go from each frame to each.
fn transitions(model: &ImuModel, config: &TrackerConfig) -> Vec<Vec<f64>> {
    let places: Vec<(usize, usize)> = model
        .segments
        .iter()
        .enumerate()
        .flat_map(|(n, segment)| (0..usize::from(segment.frames)).map(move |frame| (n, frame)))
        .collect();
    let first = |segment: usize| {
        places
            .iter()
            .position(|p| *p == (segment, 0))
            .expect("a segment")
    };
    let [stay, next, skip] = config.stay_next_skip.map(f64::from);
    let (keep, keep_subject) = (
        f64::from(config.keep_recording),
        f64::from(config.keep_subject),
    );
    let mut matrix = vec![vec![0.0; places.len()]; places.len()];
    for (from, (n, frame)) in places.iter().enumerate() {
        let segment = &model.segments[*n];
        let length = usize::from(segment.frames);
        let followed = model.segments.get(n + 1).is_some_and(|next| next.follows);
        matrix[from][from] += stay;
        for (steps, share) in [(1, next), (2, skip)] {
            if frame + steps < length {
                matrix[from][from + steps] += share;
                continue;
            }
            if followed {
                // A skip from the last frame lands on the second of the next segment, if there is one.
                let beyond = frame + steps - length;
                if beyond < usize::from(model.segments[n + 1].frames) {
                    matrix[from][first(n + 1) + beyond] += keep * share;
                }
            }
            let leaving = if followed {
                (1.0 - keep) * share
            } else {
                share
            };
            for (other, target) in model.segments.iter().enumerate() {
                let kinds = model.phases.len();
                let shares =
                    model.next[usize::from(segment.phase) * kinds + usize::from(target.phase)];
                let of_phase = model.segments.iter().filter(|s| s.phase == target.phase);
                let own = of_phase
                    .clone()
                    .filter(|s| s.subject == segment.subject)
                    .count();
                let mut share = (1.0 - keep_subject) / of_phase.count() as f64;
                if target.subject == segment.subject {
                    share += keep_subject / own as f64;
                }
                matrix[from][first(other)] += leaving * f64::from(shares) * share;
            }
        }
    }
    let anywhere = f64::from(config.exit) / places.len() as f64;
    for row in &mut matrix {
        for share in row {
            *share = (1.0 - f64::from(config.exit)) * *share + anywhere;
        }
    }
    matrix
}

/// Squared distance of a frame from a measurement, in deviations.
fn squares(model: &ImuModel, frame: usize, sensor: &Measurement) -> f64 {
    let row = &model.sensor[frame * SENSOR_COUNT..(frame + 1) * SENSOR_COUNT];
    let numbers = row.iter().zip(&sensor.values).zip(&sensor.weights);
    let squares = numbers
        .map(|((own, value), weight)| f64::from(*weight) * (f64::from(own - value) / 0.7).powi(2));
    squares.sum()
}

/// Likelihood of a measurement in a frame, up to a factor. Beyond a squared distance of 12 all frames are equal.
fn likelihood(config: &TrackerConfig, squares: f64) -> f64 {
    (-0.5 * f64::from(config.evidence) * squares.min(12.0)).exp()
}

/// The project's transitions and the published ones: settings, whole matrix and tracker.
fn cases(model: &ImuModel) -> [(TrackerConfig, Vec<Vec<f64>>, Tracker); 2] {
    let mut published = ReconConfig::default();
    Published::Transitions.set(&mut published);
    let own = TrackerConfig {
        exit: 0.0,
        ..TrackerConfig::default()
    };
    let prepared =
        Arc::new(Prepared::new(Arc::new(model.clone())).expect("a model that fits together"));
    [own, published.tracker].map(|config| {
        // Some of the measured frames are farther, and some are not.
        let config = TrackerConfig {
            farthest: 12.0,
            ..config
        };
        let matrix = transitions(model, &config);
        (config, matrix, Tracker::new(&prepared, config))
    })
}

/// The measurement of each frame; every seventh is missing.
fn sensor(n: usize) -> Option<Measurement> {
    (n % 7 != 6).then(|| measured(n))
}

#[test]
fn the_forward_algorithm_is_that_of_the_whole_matrix() {
    let model = model();
    for (config, matrix, mut tracker) in cases(&model) {
        let frames = matrix.len();
        let mut slow = vec![1.0 / frames as f64; frames];
        let (mut near, mut far) = (0, 0);
        for n in 0..60 {
            let sensor = sensor(n);
            tracker.step(sensor.as_ref());
            let mut after = vec![0.0; frames];
            for (to, after) in after.iter_mut().enumerate() {
                *after = (0..frames).map(|from| slow[from] * matrix[from][to]).sum();
                if let Some(sensor) = &sensor {
                    let squares = squares(&model, to, sensor);
                    near += usize::from(squares < 12.0);
                    far += usize::from(squares > 12.0);
                    *after *= likelihood(&config, squares);
                }
            }
            let sum: f64 = after.iter().sum();
            slow = after.iter().map(|p| p / sum).collect();
            for (fast, slow) in tracker.probabilities().iter().zip(&slow) {
                assert!(
                    (f64::from(*fast) - slow).abs() < 2e-4,
                    "{fast} is not {slow} at {n}"
                );
            }
        }
        assert!(near > 100 && far > 100, "{near} frames near, {far} far");
    }
}

#[test]
fn the_backward_algorithm_is_that_of_the_whole_matrix() {
    let model = model();
    for (config, matrix, mut tracker) in cases(&model) {
        let frames = matrix.len();
        let mut fast = vec![1.0_f32; frames];
        let mut slow = vec![1.0_f64; frames];
        for n in (0..60).rev() {
            let sensor = sensor(n);
            tracker.step_back(sensor.as_ref(), &mut fast);
            let explained = slow.iter().enumerate().map(|(frame, later)| {
                let likelihood = sensor.as_ref().map_or(1.0, |sensor| {
                    likelihood(&config, squares(&model, frame, sensor))
                });
                likelihood * later
            });
            let explained: Vec<f64> = explained.collect();
            let before = matrix.iter().map(|row| {
                let pairs = row.iter().zip(&explained);
                pairs.map(|(share, later)| share * later).sum::<f64>()
            });
            slow = before.collect();
            let mean = slow.iter().sum::<f64>() / frames as f64;
            for value in &mut slow {
                *value /= mean;
            }
            for (fast, slow) in fast.iter().zip(&slow) {
                assert!(
                    (f64::from(*fast) - slow).abs() < 2e-3 * slow.max(1.0),
                    "{fast} is not {slow} at {n}"
                );
            }
        }
    }
}

#[test]
fn a_measurement_that_fits_nothing_is_no_evidence() {
    let prepared = Arc::new(Prepared::new(Arc::new(model())).unwrap());
    let mut heard = Tracker::new(&prepared, TrackerConfig::default());
    for n in 0..20 {
        heard.step(Some(&measured(n)));
    }
    let mut silent = heard.clone();
    let mut odd = measured(20);
    odd.values[3] = 1e3;
    heard.step(Some(&odd));
    silent.step(None);
    for (heard, silent) in heard.probabilities().iter().zip(silent.probabilities()) {
        assert!((heard - silent).abs() < 0.01, "{heard} is not {silent}");
    }
}

#[test]
fn what_fits_nothing_leaves_a_whole_distribution() {
    let prepared = Arc::new(Prepared::new(Arc::new(model())).unwrap());
    let mut tracker = Tracker::new(&prepared, TrackerConfig::default());
    for n in 0..50 {
        let mut sensor = measured(n);
        sensor.values[n % 9] = 1e6;
        tracker.step(Some(&sensor));
        let sum: f32 = tracker.probabilities().iter().sum();
        assert!((sum - 1.0).abs() < 1e-3, "{sum}");
        let sum: f32 = tracker.behaviours().iter().sum();
        assert!((sum - 1.0).abs() < 1e-3, "{sum}");
    }
}
