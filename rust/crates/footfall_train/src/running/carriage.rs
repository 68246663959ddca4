//! Carriage of the trunk: each runner leans from their own walk as recorded, so that runners start from the average walk.
//!
//! The bones of pelvis and trunk have no direction that all skeletons share. Walking upright, the upper chest of O3DE's actor is tilted back by 23° on the canonical
//! body and his pelvis by 12°, the chests of CMU's walkers by -4 to 5°. Taken as recorded, the mean of such people runs with a trunk that nobody has, and runners differ by
//! what sets skeletons apart.

use super::few::deviation;
use crate::trunk_pitch::{NECK, Pitches, Sum, average, difference, mean, sum, turn};
use footfall_model::{GaitModel, OBSERVATION_COUNT};
use footfall_motion::recording::Recording;
use std::collections::{BTreeMap, BTreeSet};

/// Fewest walked steps that show how somebody walks.
const ENOUGH_STEPS: usize = 10;

/// Turns of the trunks of people, by which their skeletons differ from the average walk's.
#[derive(Debug)]
pub(super) struct Carriages(BTreeMap<String, Pitches>);

impl Carriages {
    /// Compares how people walk with the average walk. The trunk of somebody who is not seen walking is turned as that of the one whose trunk has the most similar
    /// directions in runs, for their skeletons are likely to be made alike. Their head, which may look anywhere, has the mean pitch of the others'.
    pub(super) fn of(clips: &[Recording], walk: &GaitModel) -> Self {
        let [mut walked, mut ran] = [BTreeMap::new(), BTreeMap::new()];
        for clip in clips {
            for step in clip.walks.iter().flat_map(|walk| &walk.steps) {
                let sums: &mut BTreeMap<String, Sum> = if step.take_off.is_some() {
                    &mut ran
                } else {
                    &mut walked
                };
                let name = clip.subject().to_owned();
                sums.entry(name).or_default().add(clip.clip(), step);
            }
        }
        let walking = average(walk);
        let mut turns: BTreeMap<String, Pitches> = walked
            .into_iter()
            .filter(|(name, walked)| walked.steps >= ENOUGH_STEPS && ran.contains_key(name))
            .map(|(name, walked)| (name, difference(&walking, &walked.mean())))
            .collect();
        if turns.is_empty() {
            return Self(turns);
        }
        let runs = turns
            .iter()
            .map(|(name, turn)| sum(&ran[name].mean(), turn));
        let running = mean(runs);
        let unseen: Vec<(String, Pitches)> = ran
            .iter()
            .filter(|(name, _)| !turns.contains_key(*name))
            .map(|(name, own)| {
                let own = own.mean();
                let unlike = |other: &str| trunks_apart(&own, &ran[other].mean());
                let alike = turns
                    .iter()
                    .min_by(|(a, _), (b, _)| unlike(a).total_cmp(&unlike(b)));
                let mut turn = difference(&running, &own);
                if let Some((_, alike)) = alike {
                    turn[..NECK].copy_from_slice(&alike[..NECK]);
                }
                (name.clone(), turn)
            })
            .collect();
        turns.extend(unseen);
        Self(turns)
    }

    /// Mean turn of the people in recordings, each counting once.
    fn mean(&self, clips: &[Recording]) -> Pitches {
        let names: BTreeSet<&str> = clips.iter().map(Recording::subject).collect();
        mean(names.iter().filter_map(|name| self.0.get(*name).copied()))
    }

    /// Turns a run that was learned from `many`, and [brought to](super::few::include) the mean with `few`, whose share among the people this is, by the mean of
    /// all, and how runners differ along the way from the ones to the others by the difference.
    pub(super) fn level(&self, run: &mut GaitModel, [many, few]: [&[Recording]; 2], share: f64) {
        let (own, other) = (self.mean(many), self.mean(few));
        let apart = difference(&other, &own);
        let [way, deviation] = [share, deviation(share)].map(|share| share as f32);
        let average = sum(&own, &apart.map(|turn| way * turn));
        let deviating = apart.map(|turn| deviation * turn);
        let GaitModel {
            steps, variation, ..
        } = run;
        for (side, step) in steps.iter_mut().enumerate() {
            for state in &mut step.states {
                turn(&mut state.mean, &average);
            }
            let Some(component) = variation.walker.last_mut().filter(|_| share > 0.0) else {
                continue;
            };
            let rows = component[side].means.chunks_exact_mut(OBSERVATION_COUNT);
            for (row, state) in rows.zip(&step.states) {
                let mut turned = state.mean.clone();
                turn(&mut turned, &deviating);
                for (value, (after, before)) in row.iter_mut().zip(turned.iter().zip(&state.mean)) {
                    *value += after - before;
                }
            }
        }
    }
}

/// Sum of the squared differences of two trunks' pitches.
fn trunks_apart(a: &Pitches, b: &Pitches) -> f32 {
    let apart = difference(a, b);
    apart[..NECK].iter().map(|angle| angle * angle).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapt::tests::{base, clips};
    use crate::trunk_pitch::CHAIN;
    use crate::trunk_pitch::tests::turned;
    use footfall_motion::steps::Step;

    /// Walks of one person, of which the last steps count as a run's.
    fn recordings(subject: &str) -> Vec<Recording> {
        let clips = clips("path=walker_1_*").into_iter();
        let mut clips: Vec<Recording> = clips.map(|clip| clip.of_subject(subject)).collect();
        let walks = clips.iter_mut().flat_map(|clip| &mut clip.walks);
        let mut steps: Vec<&mut Step> = walks.flat_map(|walk| &mut walk.steps).collect();
        assert!(steps.len() > ENOUGH_STEPS);
        for step in steps.iter_mut().skip(ENOUGH_STEPS) {
            step.take_off = Some(step.end - 1);
        }
        clips
    }

    /// The same of somebody whose skeleton has other directions of the trunk.
    fn tilted(mut clips: Vec<Recording>, tilt: &Pitches) -> Vec<Recording> {
        for clip in &mut clips {
            for pose in &mut clip.retargeted.clip.poses {
                *pose = turned(pose, tilt);
            }
        }
        clips
    }

    const TILT: Pitches = [-0.1, -0.2, -0.3, -0.4, 0.1, 0.2];

    #[test]
    fn what_skeletons_call_upright_is_found_and_taken_back() {
        let walk = base();
        let upright = recordings("one");
        let other = tilted(recordings("other"), &TILT);
        let people = [upright.clone(), other.clone()].concat();
        let carriages = Carriages::of(&people, &walk);
        let [own, others] = [&upright, &other].map(|clips| carriages.mean(clips));
        for ((own, others), tilt) in own.iter().zip(others).zip(TILT) {
            assert!((others - own + tilt).abs() < 0.01, "{own} {others} {tilt}");
        }
        // A run that was learned from both half and half, along the way from the one to the other, and in which nobody leans beyond their walk.
        let mut run = walk.clone();
        for state in run.steps.iter_mut().flat_map(|step| &mut step.states) {
            turn(&mut state.mean, &TILT.map(|tilt| 0.5 * tilt));
            turn(&mut state.mean, &own.map(|turn| -turn));
        }
        let learned = run.clone();
        run.variation
            .walker
            .push([0, 1].map(|_| footfall_model::StepOffset::zero()));
        let component = run.variation.walker.last_mut().unwrap();
        for (offset, step) in component.iter_mut().zip(&learned.steps) {
            let rows = offset.means.chunks_exact_mut(OBSERVATION_COUNT);
            for (row, state) in rows.zip(&step.states) {
                let mut tilted = state.mean.clone();
                turn(&mut tilted, &TILT.map(|tilt| 0.5 * tilt));
                let differences = tilted.iter().zip(&state.mean);
                for (value, (tilted, own)) in row.iter_mut().zip(differences) {
                    *value = tilted - own;
                }
            }
        }
        carriages.level(&mut run, [&upright, &other], 0.5);
        let apart = |a: &[f64], b: &[f64]| {
            let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            differences.fold(0.0, f64::max)
        };
        for (run, walk) in run.steps.iter().zip(&walk.steps) {
            for (run, walk) in run.states.iter().zip(&walk.states) {
                let apart = apart(&run.mean, &walk.mean);
                assert!(apart < 0.02, "{apart} rad from the walk");
            }
        }
        let component = run.variation.walker.last().unwrap();
        let most = component.iter().flat_map(|offset| &offset.means);
        let most = most.fold(0.0, |most: f64, value| most.max(value.abs()));
        assert!(most < 0.02, "{most} rad between runners");
    }

    #[test]
    fn who_is_not_seen_walking_is_taken_for_one_whose_trunk_is_alike() {
        let walk = base();
        let lean = [0.02, 0.04, 0.06, 0.08, 0.3, -0.5];
        let mut stranger = tilted(recordings("stranger"), &sum(&TILT, &lean));
        for clip in &mut stranger {
            for walk in &mut clip.walks {
                walk.steps.retain(|step| step.take_off.is_some());
            }
        }
        let known = recordings("known");
        let alike = tilted(recordings("alike"), &TILT);
        let people = [known.clone(), alike.clone(), stranger.clone()].concat();
        let carriages = Carriages::of(&people, &walk);
        let [known, alike, strange] =
            [&known, &alike, &stranger].map(|clips| carriages.mean(clips));
        // Their own lean stays theirs; their head is held as those of the others are.
        assert_eq!(strange[..NECK], alike[..NECK]);
        for index in NECK..CHAIN.len() {
            let apart = strange[index] - known[index] + TILT[index] + lean[index];
            assert!(apart.abs() < 0.01, "{:?} {apart}", CHAIN[index]);
        }
        assert!(Carriages::of(&stranger, &walk).0.is_empty());
    }
}
