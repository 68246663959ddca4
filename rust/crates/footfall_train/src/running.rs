//! Running, as a part of a gait model.

mod carriage;
mod few;
mod level_off;

use crate::error::TrainError;
use crate::progress::Progress;
use crate::train::{TrainConfig, train_gait};
use carriage::Carriages;
use footfall_core::Joint;
use footfall_model::layout::feature_offset;
use footfall_model::{
    FEATURE_COUNT, GaitModel, OBSERVATION_COUNT, Provenance, STATES_PER_STEP, StepOffset,
    carried_posture_share,
};
use footfall_motion::recording::Recording;

/// Share of a walker's own tempo that is theirs in a run, too.
const TEMPO_SHARE: f64 = 0.5;

/// Fewest steps of one person that a run is trained on.
const ENOUGH_STEPS: usize = 40;

/// Learns the run of a walk's model from the runs in recordings. People with many steps train it; it is adapted to those with few, and each person counts once.
/// Trunks lean as far from the average walk as each person's from their own. Those who run differ as those who walk do: each of the walk's components between walkers becomes one of the run, of how the body is held and of tempo.
///
/// # Errors
/// [`TrainError`] if the recordings have no runs, or training on them fails.
pub fn learn_running(
    walk: &GaitModel,
    clips: &[Recording],
    config: &TrainConfig,
    provenance: Provenance,
    progress: &mut dyn Progress,
) -> Result<GaitModel, TrainError> {
    let clips: Vec<Recording> = clips.iter().map(Recording::with_head_as_recorded).collect();
    let carriages = Carriages::of(&clips, walk);
    let clips: Vec<Recording> = clips
        .into_iter()
        .map(Recording::running)
        .filter(|clip| !clip.walks.is_empty())
        .collect();
    let [many, few] = few::split(clips, ENOUGH_STEPS);
    let mut run = train_gait(&many, config, provenance, progress)?.model;
    let components = walk.variation.walker.iter();
    run.variation.walker = components
        .map(|component| {
            let carried = carried(walk, component);
            [carried.clone(), carried]
        })
        .collect();
    if let Some(fine) = &mut run.fine {
        // Its tables belong to the components that were.
        fine.walker.clear();
        fine.chance.walker_strength.clear();
    }
    let share = few::include(&mut run, &few, config, progress)?;
    carriages.level(&mut run, [&many, &few], share);
    level_off::level_off(&mut run);
    Ok(run)
}

/// Offset of every state of a run by a walker's difference from the average.
fn carried(walk: &GaitModel, component: &[StepOffset; 2]) -> StepOffset {
    let mut posture = [0.0; FEATURE_COUNT];
    let mut tempo = 0.0;
    let frames: f64 = walk
        .steps
        .iter()
        .map(footfall_model::StepModel::mean_frames)
        .sum();
    for (step, offset) in walk.steps.iter().zip(component) {
        let rows = offset.means.chunks_exact(OBSERVATION_COUNT);
        for (index, (state, row)) in step.states.iter().zip(rows).enumerate() {
            let share = state.duration_mean / frames;
            for (sum, value) in posture.iter_mut().zip(row) {
                *sum += share * value;
            }
            tempo += share * offset.log_durations[index];
        }
    }
    for joint in Joint::ALL {
        for value in &mut posture[feature_offset(joint)..][..3] {
            *value *= carried_posture_share(joint);
        }
    }
    let mut carried = StepOffset::zero();
    for row in carried.means.chunks_exact_mut(OBSERVATION_COUNT) {
        row[..FEATURE_COUNT].copy_from_slice(&posture);
    }
    carried.log_durations = vec![TEMPO_SHARE * tempo; STATES_PER_STEP];
    carried
}
