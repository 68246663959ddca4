//! Phase of the stride: the share of its way from one landing to the next that a foot with a sensor has behind it.
//!
//! A standing foot measures nothing but gravity: only the time since it landed indicates when the other leg leaves the ground, passes, or lands. People who walk or run
//! repeat their strides, so this time, as a share of the strides before, shows where in the stride they are.

use crate::measure::SensorFrames;
use crate::prepared::{Prepared, WornFoot};
use core::f32::consts::TAU;
use core::ops::Range;
use footfall_core::{Behaviour, PhaseStart};
use footfall_imu::SensorContact;
use footfall_model::ImuModel;

/// Numbers of a phase: its cosine and its sine, so that the end of a stride is near the beginning of the next. Both are 0 where there are no strides.
pub(crate) const PHASE_COUNT: usize = 2;

/// Standard deviation of both numbers.
pub(crate) const PHASE_DEVIATION: f32 = 0.3;

/// Squared distance, in deviations, of a frame that belongs to no stride from every phase: that of a tenth of a stride. Were it farther, strides would go on
/// where people stop or jump.
pub(crate) const NO_STRIDE: f32 = 4.0;

/// Durations of strides of walking and running, seconds.
const STRIDE_SECS: Range<f32> = 0.5..2.0;

/// Strides are alike if the logarithms of their durations differ by less.
const ALIKE: f32 = 0.2;

/// Weight while only one stride is known.
const ONE_STRIDE: f32 = 0.5;

/// Share of a stride after which the next landing is overdue: the wearer has stopped.
const OVERDUE: f32 = 1.15;

/// Least number of phases in a stride of a model.
const LEAST_SEGMENTS: usize = 4;

/// Phase of the stride, as measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StridePhase {
    /// Cosine and sine.
    pub values: [f32; PHASE_COUNT],
    /// Weight, 0 to 1; 0 while unknown.
    pub weight: f32,
}

impl StridePhase {
    fn of(share: f32, weight: f32) -> Self {
        let (sin, cos) = (TAU * share).sin_cos();
        Self {
            values: [cos, sin],
            weight,
        }
    }
}

/// Strides of the first foot with a sensor, frame by frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrideClock {
    /// The sensor on the foot.
    sensor: Option<usize>,
    frame_secs: f32,
    stood: bool,
    /// Time since the last landing, and durations of the last two strides, the latest first, seconds.
    since_secs: Option<f32>,
    strides_secs: [Option<f32>; 2],
}

impl StrideClock {
    /// Starts without a stride.
    pub(crate) fn new(prepared: &Prepared) -> Self {
        Self {
            sensor: prepared.worn_feet.first().map(|foot| foot.sensor),
            frame_secs: 1.0 / prepared.model.frame_rate_hz as f32,
            stood: false,
            since_secs: None,
            strides_secs: [None; 2],
        }
    }

    /// Forgets all strides.
    pub(crate) const fn forget(&mut self) {
        (self.since_secs, self.strides_secs) = (None, [None; 2]);
    }

    /// Advances by a frame and returns the phase at its end.
    pub(crate) fn step(&mut self, frames: &SensorFrames) -> StridePhase {
        let contact = self.sensor.and_then(|sensor| frames[sensor]?.contact);
        if let Some(contact) = contact {
            self.hear(contact);
        } else {
            self.forget();
        }
        self.phase().unwrap_or_default()
    }

    fn hear(&mut self, contact: SensorContact) {
        self.since_secs = self.since_secs.map(|secs| secs + self.frame_secs);
        if contact.stands && !self.stood && contact.for_secs.is_finite() {
            let stride = self.since_secs.map(|secs| secs - contact.for_secs);
            let stride = stride.filter(|secs| STRIDE_SECS.contains(secs));
            self.strides_secs = [stride, self.strides_secs[0]];
            self.since_secs = Some(contact.for_secs);
        }
        self.stood = contact.stands;
    }

    fn phase(&self) -> Option<StridePhase> {
        let (since, [last, before]) = (self.since_secs?, self.strides_secs);
        let last = last?;
        let alike = before.filter(|before| (last / before).ln().abs() < ALIKE);
        let (stride, weight) =
            alike.map_or((last, ONE_STRIDE), |before| (0.5 * (last + before), 1.0));
        let share = since / stride;
        (share < OVERDUE).then(|| StridePhase::of(share.min(1.0), weight))
    }
}

/// Returns the phase of every frame of a model in the strides of a foot.
pub(crate) fn phases_of(model: &ImuModel, foot: WornFoot) -> Vec<[f32; PHASE_COUNT]> {
    let spans = spans(model, foot);
    let mut phases = Vec::with_capacity(model.frame_count());
    for segment in &model.segments {
        let span = spans[usize::from(segment.phase)];
        let frames = usize::from(segment.frames);
        phases.extend((0..frames).map(|frame| {
            span.map_or([0.0; PHASE_COUNT], |[start, end]| {
                // A frame belongs to the phase in which it ends.
                let share = (frame as f32 + 0.5) / frames as f32;
                StridePhase::of(start + share * (end - start), 1.0).values
            })
        }));
    }
    phases
}

/// Returns the runs of frames that belong to no strides, given the phases of all.
pub(crate) fn without_stride(phases: &[[f32; PHASE_COUNT]]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    let frames = phases.iter().enumerate();
    for (frame, _) in frames.filter(|(_, phase)| phase[0].hypot(phase[1]) < 0.5) {
        match runs.last_mut().filter(|run| run.end == frame) {
            Some(run) => run.end += 1,
            None => runs.push(frame..frame + 1),
        }
    }
    runs
}

/// Returns the mean shares of a stride at which each kind of phase begins and ends; `None` for those that belong to no strides.
fn spans(model: &ImuModel, foot: WornFoot) -> Vec<Option<[f32; 2]>> {
    let mut sums = vec![([0.0_f32; 2], 0.0_f32); model.phases.len()];
    for cycle in cycles(model) {
        let lands = |n: &usize| {
            let kind = model.phases[usize::from(model.segments[*n].phase)];
            kind.start == PhaseStart::Landing && kind.side == foot.side
        };
        let mut landings = cycle.clone().filter(lands);
        // A phase that not every stride has may come again only after several.
        let (Some(landing), None) = (landings.next(), landings.next()) else {
            continue;
        };
        let frames = |n: usize| f32::from(model.segments[n].frames);
        let all: f32 = cycle.clone().map(frames).sum();
        let mut at = 0.0;
        // From the landing on, and round to it again.
        for n in (landing..cycle.end).chain(cycle.start..landing) {
            let (span, count) = &mut sums[usize::from(model.segments[n].phase)];
            span[0] += at;
            at += frames(n) / all;
            span[1] += at;
            *count += 1.0;
        }
    }
    let means = sums.into_iter();
    let means = means.map(|(span, count)| (count > 0.0).then(|| span.map(|sum| sum / count)));
    means.collect()
}

/// Returns the strides of a model: runs of segments of walking or running, each until the phase that began it comes again.
fn cycles(model: &ImuModel) -> Vec<Range<usize>> {
    let kind = |n: usize| model.phases[usize::from(model.segments[n].phase)];
    let mut cycles = Vec::new();
    let mut first = 0;
    for end in 1..=model.segments.len() {
        let goes_on = end < model.segments.len()
            && model.segments[end].follows
            && kind(end) != kind(first)
            && kind(end).behaviour == kind(first).behaviour;
        if goes_on {
            continue;
        }
        let strides = matches!(kind(first).behaviour, Behaviour::Walk | Behaviour::Run);
        if strides && end - first >= LEAST_SEGMENTS {
            cycles.push(first..end);
        }
        first = end;
    }
    cycles
}

#[cfg(test)]
mod tests {
    #![expect(
        clippy::float_cmp,
        reason = "a phase that counts in full or not at all is exact"
    )]

    use super::*;
    use crate::tracker::{Measurement, Tracker, TrackerConfig};
    use footfall_core::{PhaseKind, Side, Site, Skeleton};
    use footfall_model::Provenance;
    use footfall_model::imu_model::{BODY_COUNT, MAX_WIDTH, SENSOR_COUNT, Segment};
    use std::sync::Arc;

    const FRAME_SECS: f32 = 1.0 / 30.0;

    fn clock() -> StrideClock {
        StrideClock {
            sensor: Some(0),
            frame_secs: FRAME_SECS,
            stood: false,
            since_secs: None,
            strides_secs: [None; 2],
        }
    }

    /// Phases of frames after landings at these times, each for 60 % of the time to the next.
    fn phases(landings: &[f32], secs: f32) -> Vec<StridePhase> {
        let mut clock = clock();
        let frames = (1..(secs / FRAME_SECS) as usize).map(|n| n as f32 * FRAME_SECS);
        let phases = frames.map(|time| {
            let last = landings.iter().rposition(|landing| *landing <= time);
            let stands = last.is_some_and(|n| {
                let next = landings.get(n + 1).copied().unwrap_or(f32::INFINITY);
                time < 0.4 * landings[n] + 0.6 * next
            });
            let for_secs = last.map_or(f32::INFINITY, |n| time - landings[n]);
            clock.hear(SensorContact { stands, for_secs });
            clock.phase().unwrap_or_default()
        });
        phases.collect()
    }

    #[test]
    fn phases_follow_the_strides_of_the_wearer() {
        // Strides of 1.1 s; the landings are not on frames.
        let landings: Vec<f32> = (0..5).map(|n| 0.31 + 1.1 * n as f32).collect();
        let phases = phases(&landings, 4.7);
        let at = |secs: f32| phases[(secs / FRAME_SECS).round() as usize - 1];
        assert_eq!(at(1.3).weight, 0.0, "no stride has ended");
        assert!((at(2.0).weight - ONE_STRIDE).abs() < 1e-6);
        for secs in [2.8_f32, 3.2, 4.0, 4.5] {
            let share = ((secs - 0.31) / 1.1).fract();
            let right = StridePhase::of(share, 1.0);
            let apart = |n: usize| (at(secs).values[n] - right.values[n]).abs();
            assert!(
                at(secs).weight == 1.0 && apart(0).max(apart(1)) < 0.02,
                "{secs} s"
            );
        }
    }

    /// Walks of these phases and their numbers of frames, one after the other.
    fn walks(kinds: &[(PhaseStart, Side)], walks: &[&[(u16, u16)]]) -> ImuModel {
        let frames = walks.iter().copied().flatten();
        let frames: usize = frames.map(|(_, n)| usize::from(*n)).sum();
        let phases = kinds.iter().map(|(start, side)| PhaseKind {
            behaviour: Behaviour::Walk,
            start: *start,
            side: *side,
        });
        let of = |(n, (phase, frames)): (usize, &(u16, u16))| Segment {
            phase: *phase,
            subject: 0,
            frames: *frames,
            follows: n > 0,
        };
        ImuModel {
            frame_rate_hz: 30.0,
            sites: vec![Site::RightFoot],
            skeleton: Skeleton::standard(),
            phases: phases.collect(),
            next: vec![0.0; kinds.len() * kinds.len()],
            subjects: 1,
            segments: walks
                .iter()
                .flat_map(|walk| walk.iter().enumerate().map(of))
                .collect(),
            sensor: vec![0.0; frames * SENSOR_COUNT],
            body: vec![0.0; frames * BODY_COUNT],
            deviations: vec![1.0; SENSOR_COUNT],
            regressions: vec![Vec::new(); kinds.len()],
            provenance: Provenance::default(),
        }
    }

    #[test]
    fn the_strides_of_a_model_begin_at_the_landing_of_the_foot() {
        use PhaseStart::{HeelOff, Landing, TakeOff};
        let kinds = [
            (Landing, Side::Left),
            (TakeOff, Side::Right),
            (Landing, Side::Right),
            (TakeOff, Side::Left),
            (HeelOff, Side::Left),
        ];
        // Two strides of 30 frames from the left foot's landing on; then two that begin with a phase that comes but once.
        let stride = [(0, 4), (1, 11), (2, 5), (3, 10)];
        let longer = [(0, 3), (1, 11), (2, 5), (3, 11)];
        let twice = [&[(4, 1)], &longer[..], &longer].concat();
        let model = walks(&kinds, &[&[stride, stride].concat(), &twice]);
        let foot = WornFoot {
            sensor: 0,
            side: Side::Right,
        };
        let spans = spans(&model, foot);
        let right = [
            [0.5, 19.0 / 30.0],
            [19.0 / 30.0, 1.0],
            [0.0, 1.0 / 6.0],
            [1.0 / 6.0, 0.5],
        ];
        for (span, right) in spans.iter().zip(right) {
            let span = span.expect("a part of strides");
            assert!(
                (0..2).all(|n| (span[n] - right[n]).abs() < 1e-5),
                "{span:?}"
            );
        }
        assert_eq!(spans[4], None);
        let phases = phases_of(&model, foot);
        assert_eq!(phases[60], [0.0; 2], "no stride, no phase");
        let landed = StridePhase::of(0.5 / 30.0, 1.0).values;
        assert!(
            (phases[15][0] - landed[0]).abs() < 1e-5 && (phases[15][1] - landed[1]).abs() < 1e-5
        );
    }

    #[test]
    fn frames_without_a_stride_are_a_tenth_of_one_off() {
        use PhaseStart::{HeelOff, Landing, TakeOff};
        let kinds = [
            (Landing, Side::Right),
            (TakeOff, Side::Left),
            (Landing, Side::Left),
            (TakeOff, Side::Right),
            (HeelOff, Side::Right),
        ];
        let stride = [(0, 5), (1, 10), (2, 5), (3, 10)];
        let model = walks(&kinds, &[&[stride, stride].concat(), &[(4, 6)]]);
        let prepared = Prepared::new(Arc::new(model)).expect("a model that fits together");
        let config = TrackerConfig {
            stay_next_skip: [1.0, 0.0, 0.0],
            exit: 0.0,
            evidence: 1.0,
            repeated: 1.0,
            ..TrackerConfig::default()
        };
        let mut tracker = Tracker::new(&Arc::new(prepared), config);
        let landed = 0.5 / 30.0;
        tracker.step(Some(&Measurement {
            values: [0.0; MAX_WIDTH],
            weights: [1.0; MAX_WIDTH],
            stride: StridePhase::of(landed, 1.0),
        }));
        let probability = tracker.probabilities();
        let beside = |frame: usize| (probability[frame] / probability[0]).ln();
        let without = beside(62);
        assert!((without + 0.5 * NO_STRIDE).abs() < 1e-3, "{without}");
        // Frames two and four thirtieths of a stride later are nearer and farther.
        assert!(beside(2) > without && without > beside(4));
        assert!(beside(15) < -15.0, "half a stride off");
    }

    #[test]
    fn whoever_stops_or_hurries_has_no_phase_to_rely_on() {
        let stopped = phases(&[0.3, 1.4, 2.5], 6.0);
        let last = |phases: &[StridePhase]| phases[phases.len() - 1].weight;
        assert_eq!(last(&stopped), 0.0);
        let hurried = phases(&[0.3, 1.7, 3.1, 3.9], 4.0);
        assert!((last(&hurried) - ONE_STRIDE).abs() < 1e-6);
    }
}
