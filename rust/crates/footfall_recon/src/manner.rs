//! The manner of several people in place of one's: a stranger moves as people do, not as the one of them does whose sensor measured the most similar.
//!
//! Resemblance of one sensor to a person in a model says little of arms, trunk and hips. So every segment is drawn to the mean of all people in the same phase at a
//! similar speed whose sensors measured similar things, each person counting as one, however much was recorded of them.

use footfall_model::ImuModel;
use footfall_model::imu_model::{BODY_COUNT, HEIGHT, WAY};
use nalgebra::DMatrix;
use std::collections::BTreeMap;
use std::ops::Range;

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

/// Segments whose means are found at once: the bodies of a phase are read once for all of them.
const BLOCK: usize = 64;

/// Returns the rows of the bodies of a model, each person drawn to the others.
pub(crate) fn drawn_to_others(model: &ImuModel) -> Vec<f32> {
    let mut of_phase: Vec<Vec<Resampled>> = Vec::new();
    of_phase.resize_with(model.phases.len(), Vec::new);
    for (segment, resampled) in model.segments.iter().zip(resampled(model)) {
        of_phase[usize::from(segment.phase)].push(resampled);
    }
    let mut body = model.body.clone();
    for segments in &of_phase {
        let bodies = DMatrix::from_fn(TIMES * MANNER, segments.len(), |n, segment| {
            segments[segment].body[n]
        });
        for block in segments.chunks(BLOCK) {
            let mut shares = DMatrix::zeros(segments.len(), block.len());
            for (own, mut shares) in block.iter().zip(shares.column_iter_mut()) {
                own.shares_in(segments, shares.as_mut_slice());
            }
            let means = &bodies * shares;
            for (segment, mean) in block.iter().zip(means.column_iter()) {
                let rows =
                    &mut body[segment.rows.start * BODY_COUNT..segment.rows.end * BODY_COUNT];
                draw(rows, mean.as_slice());
            }
        }
    }
    body
}

/// Draws the rows of a segment to a mean at [`TIMES`] times.
fn draw(rows: &mut [f32], mean: &[f32]) {
    let frames = rows.len() / BODY_COUNT;
    for (frame, row) in rows.chunks_exact_mut(BODY_COUNT).enumerate() {
        let place = Place::of((frame as f32 + 0.5) / frames as f32, TIMES);
        for (n, value) in row[..MANNER].iter_mut().enumerate() {
            *value += SHARE * (place.between(mean, MANNER, n) - *value);
        }
    }
}

/// A segment at [`TIMES`] times.
struct Resampled {
    /// Rows of the segment in its model.
    rows: Range<usize>,
    subject: u16,
    /// Sensor numbers over their deviations.
    sensor: Vec<f32>,
    /// The first [`MANNER`] numbers of the body.
    body: Vec<f32>,
    /// Mean speed ahead, m/s.
    speed_mps: f32,
}

fn resampled(model: &ImuModel) -> impl Iterator<Item = Resampled> {
    let width = model.sensor_width();
    let mut first = 0;
    model.segments.iter().map(move |segment| {
        let rows = first..first + usize::from(segment.frames);
        first = rows.end;
        let body = &model.body[rows.start * BODY_COUNT..rows.end * BODY_COUNT];
        let sensor = &model.sensor[rows.start * width..rows.end * width];
        let ahead: f32 = body.chunks_exact(BODY_COUNT).map(|row| row[WAY + 1]).sum();
        let mut sensor = at_times(sensor, width, width);
        for row in sensor.chunks_exact_mut(width) {
            for (value, deviation) in row.iter_mut().zip(&model.deviations) {
                *value /= deviation;
            }
        }
        Resampled {
            subject: segment.subject,
            sensor,
            body: at_times(body, BODY_COUNT, MANNER),
            speed_mps: ahead / rows.len() as f32 * model.frame_rate_hz as f32,
            rows,
        }
    })
}

/// The first numbers of rows of this width, at [`TIMES`] times.
fn at_times(rows: &[f32], width: usize, first: usize) -> Vec<f32> {
    let count = rows.len() / width;
    let places = (0..TIMES).map(|time| Place::of((time as f32 + 0.5) / TIMES as f32, count));
    places
        .flat_map(|place| (0..first).map(move |n| place.between(rows, width, n)))
        .collect()
}

impl Resampled {
    /// Shares of all segments of a phase in the mean of their people, each by the segments that resemble this one: zero for those that do not count.
    fn shares_in(&self, segments: &[Self], shares: &mut [f32]) {
        /// The largest weight of a person's segments, and the sum of all.
        #[derive(Default)]
        struct Person {
            most: f32,
            sum: f32,
        }
        let mut people: BTreeMap<u16, Person> = BTreeMap::new();
        for (share, other) in shares.iter_mut().zip(segments) {
            let Some(weight) = self.likeness(other) else {
                continue;
            };
            let person = people.entry(other.subject).or_default();
            person.most = person.most.max(weight);
            person.sum += weight;
            *share = weight;
        }
        let all: f32 = people.values().map(|person| person.most).sum();
        for (share, other) in shares.iter_mut().zip(segments) {
            if let Some(person) = people.get(&other.subject) {
                *share *= person.most / (all * person.sum);
            }
        }
    }

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

    #[test]
    fn blocks_of_segments_are_drawn_as_each_by_itself() {
        // More than a block in each of two phases that take turns, of people with one to many segments.
        let specs: Vec<SegmentSpec> = (0..3 * BLOCK)
            .map(|n| {
                let wave = |step: f32| (step * n as f32).sin();
                (
                    n as u16 % 7 % 3,
                    2.0 * wave(0.7),
                    1.2 + wave(1.3),
                    wave(2.1),
                )
            })
            .collect();
        let mut model = model(&specs);
        model.phases.push(model.phases[0]);
        for (n, segment) in model.segments.iter_mut().enumerate() {
            segment.phase = n as u16 % 2;
        }
        let body = drawn_to_others(&model);
        for (n, (_, measured, speed, own)) in specs.iter().enumerate() {
            // Sums of people: weights, and weighted bodies. Sensors and bodies are constant over a segment.
            let mut people = [(0.0_f32, 0.0_f32, 0.0_f32); 3];
            for (other, (subject, felt, pace, body)) in specs.iter().enumerate() {
                let squares = SENSOR_COUNT as f32 * (measured - felt).powi(2) / ALIKE;
                let apart = squares + ((speed - pace) / ALIKE_SPEED_MPS).powi(2);
                if other % 2 == n % 2 && apart < FARTHEST {
                    let weight = (-0.5 * apart).exp();
                    let (most, sum, bodies) = &mut people[usize::from(*subject)];
                    *most = most.max(weight);
                    *sum += weight;
                    *bodies += weight * body;
                }
            }
            let found = people.iter().filter(|(_, sum, _)| *sum > 0.0);
            let all: f32 = found.clone().map(|(most, ..)| most).sum();
            let mean: f32 = found
                .map(|(most, sum, bodies)| most / all * bodies / sum)
                .sum();
            let expected = own + SHARE * (mean - own);
            let row = &body[3 * n * BODY_COUNT..];
            assert!(
                (row[0] - expected).abs() < 1e-4,
                "{} is not {expected}",
                row[0]
            );
            assert!((row[HEIGHT] - expected).abs() < 1e-4);
            // What is no manner stays.
            assert!((row[WAY] - own).abs() < 1e-6);
        }
    }
}
