//! Representative templates: the cycles of movement that stand best for all others, so that a model stays small.
//!
//! A *cycle* is a run of segments until the phase that began it comes again; recordings are kept or left out by whole cycles, so that what is kept
//! still goes from phase to phase as it was recorded. What is lost by leaving cycles out is the sum, over all frames of all recordings, of how far
//! their segment is from the nearest of the same phase that is kept of another recording. Cycle after cycle is left out, always the one whose frames
//! are missed least. What one person does for minutes counts by the square root of its frames: otherwise one actor's runs displace those of all others.

use super::chain::{Chain, ChainSegment};
use footfall_core::{Behaviour, PhaseKind};
use footfall_model::FEATURE_COUNT;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;

/// Frames at which segments of a phase are compared, however long they are: their ends are the same events.
const SAMPLES: usize = 4;

/// Weight of a sensor's squared deviation against a joint's squared radian: enough to keep cycles that feel different to the sensor.
const SENSOR_SHARE: f32 = 0.05;

/// Distance of a frame from a phase of which no segment is kept: farther than any two segments are.
const MISSED: f32 = 1e2;

/// Weight, beside the distance to what is kept of other recordings, of the distance to all that is kept. With the
/// latter alone, every unique motion would be kept, although it never recurs in the same way.
const OWN_WEIGHT: f64 = 0.05;

/// A run of segments of one chain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Cycle {
    pub(super) chain: usize,
    pub(super) segments: Range<usize>,
}

impl Cycle {
    /// Returns true when another goes on where this one ends.
    pub(super) fn is_followed_by(&self, other: &Self) -> bool {
        other.chain == self.chain && other.segments.start == self.segments.end
    }
}

/// The cycles of these chains, in order: all of them, or the most representative ones within a number of frames.
pub(super) fn choose(
    chains: &[&Chain],
    deviations: &[f32],
    most_frames: Option<usize>,
) -> Vec<Cycle> {
    let cycles: Vec<Cycle> = chains
        .iter()
        .enumerate()
        .flat_map(|(chain, of)| cycles(chain, &of.segments))
        .collect();
    let frames: usize = chains.iter().map(|chain| chain.frames()).sum();
    match most_frames {
        Some(most) if most < frames => Choice::new(chains, deviations, cycles).reduce(most),
        _ => cycles,
    }
}

fn cycles(chain: usize, segments: &[ChainSegment]) -> Vec<Cycle> {
    let mut cycles: Vec<Cycle> = Vec::new();
    for (n, segment) in segments.iter().enumerate() {
        let begins = cycles.last().is_none_or(|cycle| {
            let first = segments[cycle.segments.start].kind;
            first == segment.kind || first.behaviour != segment.kind.behaviour
        });
        match cycles.last_mut() {
            Some(cycle) if !begins => cycle.segments.end = n + 1,
            _ => cycles.push(Cycle {
                chain,
                segments: n..n + 1,
            }),
        }
    }
    cycles
}

/// A segment as it is compared with others.
struct Template {
    cycle: usize,
    /// Weight of all of its frames together.
    weight: f64,
    kind: PhaseKind,
    /// Body and sensor, scaled, at [`SAMPLES`] frames.
    values: Vec<f32>,
    recording: usize,
    /// The two nearest cycles that are kept, and how far they are: among all, and among those of other recordings.
    nearest: [[(usize, f32); 2]; 2],
}

/// Cycles that are kept so far.
struct Choice {
    cycles: Vec<Cycle>,
    kept: Vec<bool>,
    /// Frames of each cycle.
    frames: Vec<usize>,
    templates: Vec<Template>,
    of_phase: BTreeMap<PhaseKind, Vec<usize>>,
}

const NONE: (usize, f32) = (usize::MAX, MISSED);

impl Choice {
    fn new(chains: &[&Chain], deviations: &[f32], cycles: Vec<Cycle>) -> Self {
        let mut templates = Vec::new();
        let mut of_phase: BTreeMap<PhaseKind, Vec<usize>> = BTreeMap::new();
        let mut frames = Vec::with_capacity(cycles.len());
        let mut recordings = Vec::with_capacity(chains.len());
        for chain in chains {
            let last = recordings.last().copied().unwrap_or(0);
            recordings.push(last + usize::from(!chain.mirrored));
        }
        let shares = Shares::of(chains);
        for (n, cycle) in cycles.iter().enumerate() {
            let chain = chains[cycle.chain];
            let segments = &chain.segments[cycle.segments.clone()];
            for segment in segments {
                of_phase
                    .entry(segment.kind)
                    .or_default()
                    .push(templates.len());
                templates.push(Template {
                    cycle: n,
                    weight: shares.weight(chain, segment),
                    kind: segment.kind,
                    values: samples(chain, segment, deviations),
                    recording: recordings[cycle.chain],
                    nearest: [[NONE; 2]; 2],
                });
            }
            frames.push(
                segments
                    .iter()
                    .map(|segment| segment.end - segment.first)
                    .sum(),
            );
        }
        let mut choice = Self {
            kept: vec![true; cycles.len()],
            cycles,
            frames,
            templates,
            of_phase,
        };
        choice.find_nearest(&(0..choice.templates.len()).collect::<Vec<_>>());
        choice
    }

    /// Leaves cycles out until this many frames are left, or one cycle.
    fn reduce(mut self, most_frames: usize) -> Vec<Cycle> {
        let mut left: usize = self.frames.iter().sum();
        let mut losses = vec![0.0; self.cycles.len()];
        for template in &self.templates {
            template.count(1.0, &mut losses);
        }
        for _ in 1..self.cycles.len() {
            if left <= most_frames {
                break;
            }
            let each = |n: &usize| losses[*n] / self.frames[*n] as f64;
            let least = (0..self.cycles.len())
                .filter(|n| self.kept[*n])
                .min_by(|a, b| each(a).total_cmp(&each(b)));
            let Some(out) = least else { break };
            self.kept[out] = false;
            left -= self.frames[out];
            let missing: Vec<usize> = (0..self.templates.len())
                .filter(|n| {
                    self.templates[*n]
                        .nearest
                        .iter()
                        .flatten()
                        .any(|near| near.0 == out)
                })
                .collect();
            for n in &missing {
                self.templates[*n].count(-1.0, &mut losses);
            }
            self.find_nearest(&missing);
            for n in &missing {
                self.templates[*n].count(1.0, &mut losses);
            }
        }
        let cycles = self.cycles.into_iter().zip(self.kept);
        cycles
            .filter_map(|(cycle, kept)| kept.then_some(cycle))
            .collect()
    }

    /// Looks for the nearest cycles of these templates among those that are kept.
    fn find_nearest(&mut self, of: &[usize]) {
        let found: Vec<[[(usize, f32); 2]; 2]> = of.par_iter().map(|n| self.nearest(*n)).collect();
        for (n, nearest) in of.iter().zip(found) {
            self.templates[*n].nearest = nearest;
        }
    }

    fn nearest(&self, of: usize) -> [[(usize, f32); 2]; 2] {
        let own = &self.templates[of];
        let mut both = [[NONE; 2]; 2];
        for other in self.of_phase[&own.kind].iter().map(|n| &self.templates[*n]) {
            if !self.kept[other.cycle] {
                continue;
            }
            let pairs = own.values.iter().zip(&other.values);
            let apart: f32 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
            let apart = apart.sqrt().min(MISSED);
            for (n, nearest) in both.iter_mut().enumerate() {
                if n == 1 && other.recording == own.recording {
                    continue;
                }
                // Of one cycle only its nearest segment counts.
                if other.cycle == nearest[0].0 {
                    nearest[0].1 = nearest[0].1.min(apart);
                } else if apart < nearest[0].1 {
                    *nearest = [(other.cycle, apart), nearest[0]];
                } else if apart < nearest[1].1 {
                    nearest[1] = (other.cycle, apart);
                }
            }
        }
        both
    }
}

/// Frames of each person in each behaviour.
struct Shares<'a>(BTreeMap<(&'a str, Behaviour), usize>);

impl<'a> Shares<'a> {
    fn of(chains: &[&'a Chain]) -> Self {
        let mut frames = BTreeMap::new();
        for chain in chains {
            for segment in &chain.segments {
                let own = (chain.subject.as_str(), segment.kind.behaviour);
                *frames.entry(own).or_default() += segment.end - segment.first;
            }
        }
        Self(frames)
    }

    /// Weight of a segment: all segments of one person and behaviour together, the square root of their frames.
    fn weight(&self, chain: &'a Chain, segment: &ChainSegment) -> f64 {
        let all = self.0[&(chain.subject.as_str(), segment.kind.behaviour)];
        (segment.end - segment.first) as f64 / (all as f64).sqrt()
    }
}

impl Template {
    /// Adds what is lost with the nearest cycle to what leaving that cycle out would cost.
    fn count(&self, sign: f64, losses: &mut [f64]) {
        for (weight, nearest) in [OWN_WEIGHT, 1.0].into_iter().zip(&self.nearest) {
            let [(cycle, apart), (_, next)] = *nearest;
            if let Some(loss) = losses.get_mut(cycle) {
                *loss += sign * weight * self.weight * f64::from(next - apart);
            }
        }
    }
}

/// Joint rotations and what the sensors measured at times spread over a segment.
fn samples(chain: &Chain, segment: &ChainSegment, deviations: &[f32]) -> Vec<f32> {
    let last = (segment.end - segment.first - 1) as f32;
    let mut values = Vec::with_capacity(SAMPLES * (FEATURE_COUNT + deviations.len()));
    let weight = (SAMPLES as f32).sqrt().recip();
    for sample in 0..SAMPLES {
        let place = last * sample as f32 / (SAMPLES - 1) as f32;
        let frame = segment.first + place.round() as usize;
        values.extend(
            chain.body_row(frame)[..FEATURE_COUNT]
                .iter()
                .map(|value| weight * value),
        );
        let sensor = chain.sensor_row(frame).iter().zip(deviations);
        let sensor_weight = weight * SENSOR_SHARE.sqrt();
        values.extend(sensor.map(|(value, deviation)| sensor_weight * value / deviation));
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::imu::level_trunks::TrunkTurn;
    use footfall_core::{Behaviour, PhaseStart, Side, Skeleton};
    use footfall_model::imu_model::{BODY_COUNT, SENSOR_COUNT};

    const FRAMES: usize = 5;

    fn kind(behaviour: Behaviour, start: PhaseStart) -> PhaseKind {
        PhaseKind {
            behaviour,
            start,
            side: Side::Left,
        }
    }

    /// A recording of steps, each of two phases, with a joint turned by an angle.
    fn chain(behaviour: Behaviour, steps: &[f32]) -> Chain {
        let mut chain = Chain {
            subject: "somebody".to_owned(),
            mirrored: false,
            skeleton: Skeleton::standard(),
            segments: Vec::new(),
            sensor: Vec::new(),
            body: Vec::new(),
            trunk: TrunkTurn::default(),
        };
        for turned in steps {
            for start in [PhaseStart::Landing, PhaseStart::TakeOff] {
                let first = chain.frames();
                for _ in 0..FRAMES {
                    let mut row = [0.0; BODY_COUNT];
                    row[7] = *turned;
                    chain.body.extend(row);
                    chain.sensor.extend([0.0; SENSOR_COUNT]);
                }
                chain.segments.push(ChainSegment {
                    kind: kind(behaviour, start),
                    first,
                    end: first + FRAMES,
                });
            }
        }
        chain
    }

    fn choose_of(chains: &[Chain], most_frames: usize) -> Vec<(usize, usize)> {
        let chains: Vec<&Chain> = chains.iter().collect();
        let chosen = choose(&chains, &[1.0; SENSOR_COUNT], Some(most_frames));
        let place = |cycle: &Cycle| (cycle.chain, cycle.segments.start / 2);
        chosen.iter().map(place).collect()
    }

    #[test]
    fn a_cycle_ends_where_it_begins_again_or_something_else_begins() {
        let mut walk = chain(Behaviour::Walk, &[0.0, 0.1]).segments;
        walk.extend(chain(Behaviour::Jump, &[0.0]).segments);
        let found: Vec<Range<usize>> = cycles(3, &walk).into_iter().map(|c| c.segments).collect();
        assert_eq!(found, [0..2, 2..4, 4..6]);
    }

    #[test]
    fn what_stands_for_others_is_kept() {
        // Two ways of walking that both recordings show, a stumble, and a jump that nothing else stands for.
        let chains = [
            chain(Behaviour::Walk, &[0.0, 0.02, 1.0, 3.0]),
            chain(Behaviour::Walk, &[0.01, 1.01, 0.015]),
            chain(Behaviour::Jump, &[0.0]),
        ];
        let cycle = 2 * FRAMES;
        assert_eq!(choose_of(&chains, 8 * cycle).len(), 8);
        assert_eq!(choose_of(&chains, 7 * cycle + 9).len(), 7);
        let few = choose_of(&chains, 5 * cycle);
        let way = |turned: &[(usize, usize)]| few.iter().any(|place| turned.contains(place));
        assert!(
            way(&[(0, 0), (0, 1), (1, 0), (1, 2)]) && way(&[(0, 2), (1, 1)]),
            "{few:?}"
        );
        assert!(few.contains(&(2, 0)) && !few.contains(&(0, 3)), "{few:?}");
        assert_eq!(choose_of(&chains, 0).len(), 1);
    }

    #[test]
    fn who_does_one_thing_for_long_pushes_nobody_out() {
        // One person walks in forty ways of her own, another three times in a third way: his walks stay.
        let many: Vec<f32> = (0..40).map(|n| 0.1 * n as f32).collect();
        let own: Vec<Chain> = many.chunks(4).map(|c| chain(Behaviour::Walk, c)).collect();
        let mut chains = own;
        for _ in 0..3 {
            let mut other = chain(Behaviour::Walk, &[-2.5]);
            other.subject = "somebody else".to_owned();
            chains.push(other);
        }
        let few = choose_of(&chains, 3 * 2 * FRAMES);
        assert!(few.iter().any(|(chain, _)| *chain >= 10), "{few:?}");
    }
}
