//! Runners with too few steps to train a model on: the run of those with many is adapted to them.
//!
//! Trained on all together, the few are lost among the many, and where skeletons were fitted otherwise, feet stand neither as the ones' nor as the others' do.
//! A transform that all states share is determined by eight steps (Tilmanne et al. 2012, section 5.1.3).

use crate::adapt::{AdaptConfig, AdaptMethod, adapt_style, mean_speed};
use crate::encoded::EncodedCorpus;
use crate::error::TrainError;
use crate::progress::Progress;
use crate::train::TrainConfig;
use footfall_core::Side;
use footfall_model::{
    FEATURE_COUNT, FINE_SCALES, GaitModel, GaitStyle, OBSERVATION_COUNT, StepOffset,
};
use footfall_motion::recording::Recording;

/// Recordings of the people with `enough` steps, and of those with fewer. If nobody has enough, all recordings count as having them.
pub(super) fn split(clips: Vec<Recording>, enough: usize) -> [Vec<Recording>; 2] {
    let steps_of = |subject: &str| -> usize {
        let own = clips.iter().filter(|clip| clip.subject() == subject);
        own.map(Recording::step_count).sum()
    };
    let has_enough: Vec<bool> = clips
        .iter()
        .map(|clip| steps_of(clip.subject()) >= enough)
        .collect();
    if !has_enough.contains(&true) {
        return [clips, Vec::new()];
    }
    let mut split = [Vec::new(), Vec::new()];
    for (clip, has_enough) in clips.into_iter().zip(has_enough) {
        split[usize::from(!has_enough)].push(clip);
    }
    split
}

/// Brings a run to the mean of its own people and the `few`, each counting once, and lets runners differ along the way from the ones to the others.
/// Returns the share of the few among the people; 0 if they show no two steps in a row, and the run stays as it is.
///
/// # Errors
/// [`TrainError`] if the run cannot explain the steps of the few.
pub(super) fn include(
    run: &mut GaitModel,
    few: &[Recording],
    config: &TrainConfig,
    progress: &mut dyn Progress,
) -> Result<f64, TrainError> {
    let (corpus, _) = EncodedCorpus::of(few, config)?.steady();
    if corpus.is_empty() {
        return Ok(0.0);
    }
    let mirrored = AdaptConfig {
        method: AdaptMethod::Cmllr,
        steps: None,
        mirror: true,
    };
    let at_their_speed = at_speed(run, mean_speed(&corpus));
    let adapted = adapt_style(
        &at_their_speed,
        few,
        "few steps",
        &mirrored,
        run.provenance.clone(),
        progress,
    );
    let style = match adapted {
        Ok(adapted) => adapted.style,
        Err(TrainError::NoSteps | TrainError::TooFewSteps { .. }) => return Ok(0.0),
        Err(error) => return Err(error),
    };
    let difference = Side::BOTH.map(|side| difference(&at_their_speed, &style, side));
    let more = &style.provenance;
    let share = more.subjects as f64 / (run.provenance.subjects + more.subjects) as f64;
    for (side, offset) in Side::BOTH.into_iter().zip(&difference) {
        add(run, side, offset, share);
    }
    reweigh(run, &style, share);
    let deviation = deviation(share);
    run.variation.walker.push(difference.map(|offset| {
        let mut component = StepOffset::zero();
        component.add_scaled(&evenly_timed(offset), deviation);
        component
    }));
    run.provenance.clips += more.clips;
    run.provenance.subjects += more.subjects;
    run.provenance.steps += more.steps;
    Ok(share)
}

/// Deviation of what is 1 for this share of people and 0 for the others.
pub(super) fn deviation(share: f64) -> f64 {
    (share * (1.0 - share)).sqrt()
}

/// The run at another speed.
fn at_speed(run: &GaitModel, speed_mps: f64) -> GaitModel {
    let mut moved = run.clone();
    let by = speed_mps - run.speed.reference_mps;
    for (side, slope) in Side::BOTH.into_iter().zip(&run.speed.slopes) {
        add(&mut moved, side, slope, by);
    }
    moved.speed.reference_mps = speed_mps;
    moved
}

/// Adds a weighted offset to one step of a run.
fn add(run: &mut GaitModel, side: Side, offset: &StepOffset, weight: f64) {
    let step = &mut run.steps[side.index()];
    let rows = offset.means.chunks_exact(OBSERVATION_COUNT);
    let offsets = rows.zip(&offset.log_durations);
    for (state, (row, log_duration)) in step.states.iter_mut().zip(offsets) {
        for (mean, value) in state.mean.iter_mut().zip(row) {
            *mean += weight * value;
        }
        state.duration_mean *= (weight * log_duration).exp();
    }
    step.other_terminal += weight * offset.other_terminal;
}

/// Difference of a style's step from the run's.
fn difference(run: &GaitModel, style: &GaitStyle, side: Side) -> StepOffset {
    let (from, to) = (run.step(side), &style.steps[side.index()]);
    let pairs = || from.states.iter().zip(&to.states);
    StepOffset {
        means: pairs()
            .flat_map(|(from, to)| to.mean.iter().zip(&from.mean).map(|(to, from)| to - from))
            .collect(),
        log_durations: pairs()
            .map(|(from, to)| (to.duration_mean / from.duration_mean).ln())
            .collect(),
        other_terminal: to.other_terminal - from.other_terminal,
    }
}

/// The same offset with the tempo of the whole step in every state, as differences between walkers have it.
fn evenly_timed(mut offset: StepOffset) -> StepOffset {
    let mean = offset.log_durations.iter().sum::<f64>() / offset.log_durations.len() as f64;
    offset.log_durations.fill(mean);
    offset
}

/// Moves variances, and the strength of the fine motion with how far features swing, a share of the way to a style's.
fn reweigh(run: &mut GaitModel, style: &GaitStyle, share: f64) {
    let towards = |own: &mut f64, other: f64| *own *= (other / *own).powf(share);
    for (step, styled) in run.steps.iter_mut().zip(&style.steps) {
        for (state, styled) in step.states.iter_mut().zip(&styled.states) {
            let pairs = state.variance.iter_mut().zip(&styled.variance);
            pairs.for_each(|(own, other)| towards(own, *other));
        }
    }
    let before = run.global_variance.mean.clone();
    let swings = &mut run.global_variance;
    for dim in 0..FEATURE_COUNT {
        towards(&mut swings.mean[dim], style.global_variance.mean[dim]);
        towards(
            &mut swings.variance[dim],
            style.global_variance.variance[dim],
        );
    }
    if let Some(fine) = &mut run.fine {
        for (dim, scale) in fine.scale.iter_mut().enumerate() {
            let swing = (run.global_variance.mean[dim] / before[dim]).sqrt();
            *scale *= swing.clamp(FINE_SCALES[0], FINE_SCALES[1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::EmConfig;
    use crate::adapt::tests::{base, clips};
    use footfall_prob::windows::Windows;

    const CONFIG: TrainConfig = TrainConfig {
        frame_rate_hz: 60.0,
        windows: Windows::Compact,
        mirror: true,
        em: EmConfig {
            max_iterations: 5,
            min_gain_per_frame: 1e-3,
        },
    };

    /// Recordings of a person other than that of the run, whose steps take a quarter longer.
    fn few() -> Vec<Recording> {
        let mut few = clips("path=walker_2_slow*");
        for clip in &mut few {
            clip.retargeted.clip.frame_rate_hz *= 0.8;
        }
        few
    }

    /// A model whose walkers share their fine motion, as those of a run do.
    fn run() -> GaitModel {
        let mut run = base();
        run.fine = None;
        run
    }

    fn cadence_hz(model: &GaitModel, speed_mps: f64) -> f64 {
        at_speed(model, speed_mps).cadence_hz()
    }

    #[test]
    fn two_people_meet_half_way() {
        let few = few();
        let before = run();
        let mut run = before.clone();
        include(&mut run, &few, &CONFIG, &mut ()).unwrap();

        let (corpus, counts) = EncodedCorpus::of(&few, &CONFIG).unwrap().steady();
        let speed_mps = mean_speed(&corpus);
        let frames: usize = corpus.iter().map(crate::sequence::Sequence::frames).sum();
        let steps: usize = corpus.iter().map(|sequence| sequence.steps.len()).sum();
        let theirs = steps as f64 * CONFIG.frame_rate_hz / frames as f64;
        let own = cadence_hz(&before, speed_mps);
        let way = (cadence_hz(&run, speed_mps) / own).ln() / (theirs / own).ln();
        assert!(
            (way - 0.5).abs() < 0.1,
            "{way} of the way from {own} to {theirs} steps a second"
        );
        // The second person is a deviation from the mean, and the first is one the other way.
        let added = run.variation.walker.last().unwrap();
        let tempo: f64 = added.iter().map(|offset| offset.log_durations[0]).sum();
        let expected = (own / theirs).ln();
        assert!(
            (tempo - expected).abs() < 0.2 * expected.abs(),
            "{tempo} {expected}"
        );
        assert_eq!(
            run.variation.walker.len(),
            before.variation.walker.len() + 1
        );
        assert_eq!(run.provenance.steps, before.provenance.steps + counts.steps);
        run.check().unwrap();
    }

    #[test]
    fn sides_stay_alike() {
        let few = few();
        let mut run = run();
        let apart =
            |run: &GaitModel| (run.steps[0].mean_frames() - run.steps[1].mean_frames()).abs();
        let before = apart(&run);
        include(&mut run, &few, &CONFIG, &mut ()).unwrap();
        assert!(apart(&run) < before + 0.02, "{} {before}", apart(&run));
    }

    #[test]
    fn people_are_many_or_few_by_their_steps() {
        let one = clips("path=walker_1_*");
        let other = clips("path=walker_2_slow*");
        let count = |clips: &[Recording]| clips.iter().map(Recording::step_count).sum::<usize>();
        assert!(count(&one) >= 10 && count(&other) < 10);
        let [many, few] = split([other.clone(), one.clone()].concat(), 10);
        assert_eq!((many.len(), few.len()), (one.len(), other.len()));
        // Alone, the few are all that there is.
        let [many, few] = split(other.clone(), 10);
        assert_eq!((many.len(), few.len()), (other.len(), 0));
    }
}
