//! The manner of several people in place of one's: a stranger moves as people do, not as the one of them does whose sensor measured the most similar.
//!
//! Resemblance of one sensor to a person in a model says little of arms, trunk and hips. So every segment is drawn to the mean of all people in the same phase at a
//! similar speed whose sensors measured similar things, each person counting as one, however much was recorded of them.

use footfall_model::ImuModel;
use footfall_model::imu_model::{BODY_COUNT, HEIGHT, WAY};
use std::collections::BTreeMap;

/// Share of the way to the mean of others.
const SHARE: f32 = 0.7;

/// Times of a segment at which it is compared and averaged, however long it is: its ends are the same events.
const TIMES: usize = 8;

/// Mean squared distance of the sensors, in deviations of the model, at which a segment has the weight e^-½.
const ALIKE: f32 = 6.0;

/// The same of the mean speed ahead, m/s: runs are not averaged with jogs.
const ALIKE_SPEED_MPS: f32 = 0.5;

/// Segments with less weight than e^-½ to the power of this do not count: most of a large model.
const FARTHEST: f32 = 14.0;

/// Numbers of the body that have a manner: joints and height. The way, the turn, contacts and headings are the segment's own.
const MANNER: usize = HEIGHT + 1;

/// Returns the rows of the bodies of a model, each person drawn to the others.
pub(crate) fn drawn_to_others(model: &ImuModel) -> Vec<f32> {
    let segments = resampled(model);
    let mut of_phase: Vec<Vec<usize>> = vec![Vec::new(); model.phases.len()];
    for (n, segment) in model.segments.iter().enumerate() {
        of_phase[usize::from(segment.phase)].push(n);
    }
    let mut body = model.body.clone();
    let mut rows = body.chunks_exact_mut(BODY_COUNT);
    for (own, segment) in segments.iter().zip(&model.segments) {
        let alike = &of_phase[usize::from(segment.phase)];
        let alike = alike
            .iter()
            .map(|n| (model.segments[*n].subject, &segments[*n]));
        let mean = mean_of_people(own, alike);
        let frames = usize::from(segment.frames);
        for (frame, row) in rows.by_ref().take(frames).enumerate() {
            let place = Place::of((frame as f32 + 0.5) / frames as f32, TIMES);
            for (n, value) in row[..MANNER].iter_mut().enumerate() {
                *value += SHARE * (place.between(&mean, BODY_COUNT, n) - *value);
            }
        }
    }
    body
}

/// A segment at [`TIMES`] times.
struct Resampled {
    /// Sensor numbers over their deviations.
    sensor: Vec<f32>,
    body: Vec<f32>,
    /// Mean speed ahead, m/s.
    speed_mps: f32,
}

fn resampled(model: &ImuModel) -> Vec<Resampled> {
    let width = model.sensor_width();
    let mut first = 0;
    let segments = model.segments.iter().map(|segment| {
        let frames = usize::from(segment.frames);
        let body = &model.body[first * BODY_COUNT..(first + frames) * BODY_COUNT];
        let sensor = &model.sensor[first * width..(first + frames) * width];
        first += frames;
        let ahead: f32 = body.chunks_exact(BODY_COUNT).map(|row| row[WAY + 1]).sum();
        let mut sensor = at_times(sensor, width, frames);
        for row in sensor.chunks_exact_mut(width) {
            for (value, deviation) in row.iter_mut().zip(&model.deviations) {
                *value /= deviation;
            }
        }
        Resampled {
            sensor,
            body: at_times(body, BODY_COUNT, frames),
            speed_mps: ahead / frames as f32 * model.frame_rate_hz as f32,
        }
    });
    segments.collect()
}

/// Rows of this width at [`TIMES`] times.
fn at_times(rows: &[f32], width: usize, frames: usize) -> Vec<f32> {
    let places = (0..TIMES).map(|time| Place::of((time as f32 + 0.5) / TIMES as f32, frames));
    places
        .flat_map(|place| (0..width).map(move |n| place.between(rows, width, n)))
        .collect()
}

/// Mean body at [`TIMES`] times of the people of these segments, each by the segments that resemble one.
fn mean_of_people<'a>(
    own: &Resampled,
    segments: impl Iterator<Item = (u16, &'a Resampled)>,
) -> Vec<f32> {
    /// The largest weight of a person's segments, the sum of all, and that of the weighted bodies.
    struct Person {
        most: f32,
        sum: f32,
        bodies: Vec<f32>,
    }
    let mut people: BTreeMap<u16, Person> = BTreeMap::new();
    for (subject, other) in segments {
        let Some(weight) = own.likeness(other) else {
            continue;
        };
        let person = people.entry(subject).or_insert_with(|| Person {
            most: 0.0,
            sum: 0.0,
            bodies: vec![0.0; own.body.len()],
        });
        person.most = person.most.max(weight);
        person.sum += weight;
        for (sum, value) in person.bodies.iter_mut().zip(&other.body) {
            *sum += weight * value;
        }
    }
    let all: f32 = people.values().map(|person| person.most).sum();
    let mut mean = vec![0.0; own.body.len()];
    for person in people.values() {
        let weight = person.most / (all * person.sum);
        for (mean, value) in mean.iter_mut().zip(&person.bodies) {
            *mean += weight * value;
        }
    }
    mean
}

impl Resampled {
    /// Weight of another segment beside this one; `None` where it does not count.
    fn likeness(&self, other: &Self) -> Option<f32> {
        let faster = (self.speed_mps - other.speed_mps) / ALIKE_SPEED_MPS;
        let mut apart = faster * faster;
        let width = self.sensor.len() / TIMES;
        let times = self.sensor.chunks_exact(width);
        for (own, other) in times.zip(other.sensor.chunks_exact(width)) {
            if apart > FARTHEST {
                return None;
            }
            let squares = own.iter().zip(other).map(|(a, b)| (a - b).powi(2));
            apart += squares.sum::<f32>() / (TIMES as f32 * ALIKE);
        }
        (apart < FARTHEST).then(|| (-0.5 * apart).exp())
    }
}

/// A place between two rows.
#[derive(Clone, Copy)]
struct Place {
    rows: [usize; 2],
    share: f32,
}

impl Place {
    /// Interpolation at a share of this many rows, each of which is at the middle of its time.
    fn of(share: f32, count: usize) -> Self {
        let at = (share * count as f32 - 0.5).clamp(0.0, count as f32 - 1.0);
        let first = at as usize;
        Self {
            rows: [first, (first + 1).min(count - 1)],
            share: at - first as f32,
        }
    }

    /// A number there.
    fn between(self, rows: &[f32], width: usize, n: usize) -> f32 {
        let [a, b] = self.rows.map(|row| rows[row * width + n]);
        a + self.share * (b - a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Behaviour, PhaseKind, PhaseStart, Side, Site, Skeleton};
    use footfall_model::Provenance;
    use footfall_model::imu_model::{SENSOR_COUNT, Segment};

    /// A segment: its subject, a number that its sensor measures, its speed, and a number of its body.
    type SegmentSpec = (u16, f32, f32, f32);

    /// A model of one phase.
    fn model(segments: &[SegmentSpec]) -> ImuModel {
        const FRAMES: usize = 3;
        let rows = |row: &dyn Fn(&SegmentSpec) -> Vec<f32>| {
            let rows = segments.iter().flat_map(|s| vec![row(s); FRAMES].concat());
            rows.collect()
        };
        ImuModel {
            frame_rate_hz: 30.0,
            sites: vec![Site::RightFoot],
            skeleton: Skeleton::standard(),
            phases: vec![PhaseKind {
                behaviour: Behaviour::Walk,
                start: PhaseStart::Landing,
                side: Side::Right,
            }],
            next: vec![1.0],
            subjects: 3,
            segments: segments
                .iter()
                .map(|(subject, ..)| Segment {
                    phase: 0,
                    subject: *subject,
                    frames: FRAMES as u16,
                    follows: false,
                })
                .collect(),
            sensor: rows(&|(_, measured, ..)| vec![*measured; SENSOR_COUNT]),
            body: rows(&|(_, _, speed, body)| {
                let mut row = vec![*body; BODY_COUNT];
                row[WAY + 1] = speed / 30.0;
                row
            }),
            deviations: vec![1.0; SENSOR_COUNT],
            regressions: vec![Vec::new()],
            provenance: Provenance::default(),
        }
    }

    /// The body of the first segment.
    fn first(segments: &[SegmentSpec]) -> f32 {
        let body = drawn_to_others(&model(segments));
        // What is no manner stays.
        assert!((body[WAY] - segments[0].3).abs() < 1e-6);
        body[0]
    }

    #[test]
    fn people_count_alike_however_much_was_recorded_of_them() {
        // The mean of three people is 2; one of them was recorded four times.
        let mut segments = vec![(0, 0.0, 1.2, 0.0), (1, 0.0, 1.2, 1.0)];
        segments.extend([(2, 0.0, 1.2, 5.0); 4]);
        assert!((first(&segments) - SHARE * 2.0).abs() < 1e-4);
        // The only person of a model is not changed.
        let alone = [(0, 0.0, 1.2, 3.0), (0, 0.0, 1.2, 3.0)];
        assert!((first(&alone) - 3.0).abs() < 1e-4);
    }

    #[test]
    fn those_who_feel_different_or_go_faster_do_not_count() {
        let near = (1, 0.0, 1.2, 1.0);
        let with = |other: SegmentSpec| first(&[(0, 0.0, 1.2, 0.0), near, other]);
        let drawn = SHARE * 0.5;
        for other in [(2, 5.0, 1.2, 9.0), (2, 0.0, 4.0, 9.0)] {
            assert!((with(other) - drawn).abs() < 1e-3, "{}", with(other));
        }
        assert!(with((2, 0.5, 1.3, 9.0)) > drawn + 1.0);
    }
}
