//! Facts of a gait model.

use super::moves::{CrouchFacts, JumpFacts};
use super::{FileFacts, fact};
use anyhow::Result;
use footfall_core::{Joint, Side};
use footfall_model::layout::feature_offset;
use footfall_model::{GaitModel, OBSERVATION_COUNT, StandingModel};
use footfall_train::read_model_file;
use serde::Serialize;
use std::path::Path;

/// Facts of a model.
#[derive(Serialize)]
pub(super) struct ModelFacts {
    #[serde(flatten)]
    file: FileFacts,
    fps: f64,
    windows: String,
    leg_length_m: f32,
    observation_numbers: usize,
    /// Slowest, mean and fastest walk of the corpus.
    speed_range_mps: [f64; 2],
    mean_speed_mps: f64,
    /// Slowest and fastest of the corpus.
    cadence_range_per_minute: [f64; 2],
    left_step: StepFacts,
    right_step: StepFacts,
    walker_components: usize,
    step_components: usize,
    /// Places in a walk whose steps have models of their own.
    ends: Vec<String>,
    /// Standing of its people; absent where it stands still.
    standing: Option<StandingFacts>,
    /// Running of its people; nothing where it only walks.
    running: Option<RunningFacts>,
    /// Jumps of its people off both feet and crouching; nothing where they do not.
    jumping: Option<JumpFacts>,
    crouching: Option<CrouchFacts>,
}

#[derive(Serialize)]
struct StandingFacts {
    knees_deg: f64,
    octaves: usize,
    directions: usize,
    looks_per_minute: f64,
    breaths_per_minute: f64,
    /// Standard deviation of how far people move, as a factor.
    strength_factor: f64,
}

/// Running of a model's people.
#[derive(Serialize)]
pub(in crate::commands) struct RunningFacts {
    subjects: usize,
    steps: usize,
    speed_range_mps: [f64; 2],
    mean_speed_mps: f64,
    cadence_range_per_minute: [f64; 2],
    /// Share of a step that is spent in the air.
    flight: f64,
}

impl RunningFacts {
    pub(in crate::commands) fn of(model: &GaitModel) -> Self {
        let counts = &model.provenance;
        Self {
            subjects: counts.subjects,
            steps: counts.steps,
            speed_range_mps: model.speed_range(),
            mean_speed_mps: model.speed.reference_mps,
            cadence_range_per_minute: model.speed.cadence_range_hz.map(|hz| 60.0 * hz),
            flight: -model.step(Side::Left).other_terminal,
        }
    }

    pub(in crate::commands) fn line(&self) -> String {
        let [slowest, fastest] = self.speed_range_mps;
        let [fewest, most] = self.cadence_range_per_minute;
        format!(
            "{} steps of {} subjects, {slowest:.2} to {fastest:.2} m/s, mean {:.2}, {fewest:.0} to {most:.0} steps a minute, in the air {:.0} %",
            self.steps,
            self.subjects,
            self.mean_speed_mps,
            100.0 * self.flight
        )
    }
}

#[derive(Serialize)]
struct StepFacts {
    /// Mean of each state.
    state_seconds: Vec<f64>,
    /// Standard deviation of each state.
    state_deviation_seconds: Vec<f64>,
    seconds: f64,
    /// When the other foot leaves the ground, as a share of the step.
    other_terminal: f64,
}

/// Reads a model.
pub(super) fn inspect(path: &Path) -> Result<ModelFacts> {
    let model = read_model_file(path, GaitModel::from_bytes)?;
    let step = |side: Side| {
        let step = model.step(side);
        let secs = |frames: f64| frames / model.frame_rate_hz;
        StepFacts {
            state_seconds: step
                .states
                .iter()
                .map(|state| secs(state.duration_mean))
                .collect(),
            state_deviation_seconds: step
                .states
                .iter()
                .map(|state| secs(state.duration_variance.sqrt()))
                .collect(),
            seconds: step
                .states
                .iter()
                .map(|state| secs(state.duration_mean))
                .sum(),
            other_terminal: step.other_terminal,
        }
    };
    let GaitModel {
        speed, variation, ..
    } = &model;
    Ok(ModelFacts {
        file: FileFacts::of(path)?,
        fps: model.frame_rate_hz,
        windows: format!("{:?}", model.windows).to_lowercase(),
        leg_length_m: model.skeleton.mean_leg_length(),
        observation_numbers: OBSERVATION_COUNT,
        speed_range_mps: model.speed_range(),
        mean_speed_mps: speed.reference_mps,
        cadence_range_per_minute: speed.cadence_range_hz.map(|hz| 60.0 * hz),
        left_step: step(Side::Left),
        right_step: step(Side::Right),
        walker_components: variation.walker.len(),
        step_components: variation.step.len(),
        ends: model
            .contexts
            .iter()
            .map(|context| format!("{} {}", context.position.name(), context.side.name()))
            .collect(),
        standing: model.standing.as_ref().map(standing_facts),
        running: model.running.as_deref().map(RunningFacts::of),
        jumping: JumpFacts::of(&model),
        crouching: CrouchFacts::of(&model),
    })
}

fn standing_facts(standing: &StandingModel) -> StandingFacts {
    let knee = &standing.posture[feature_offset(Joint::LeftLowerLeg)..][..3];
    let directions = standing
        .octaves
        .iter()
        .map(|octave| octave.directions.len());
    StandingFacts {
        knees_deg: knee.iter().map(|v| v * v).sum::<f64>().sqrt().to_degrees(),
        octaves: standing.octaves.len(),
        directions: directions.sum(),
        looks_per_minute: 60.0 * standing.looks.rate_hz,
        breaths_per_minute: 60.0 * standing.breath.rate_hz,
        strength_factor: standing.strength_spread.exp(),
    }
}

impl ModelFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = self.file.lines("gait model", Vec::new());
        let [slowest, fastest] = self.speed_range_mps;
        let [fewest, most] = self.cadence_range_per_minute;
        lines.extend([
            fact(
                "rate",
                format!("{} fps, {} windows", self.fps, self.windows),
            ),
            fact("body", format!("legs of {:.3} m", self.leg_length_m)),
            fact(
                "speed",
                format!(
                    "{slowest:.2} to {fastest:.2} m/s, mean {:.2}",
                    self.mean_speed_mps
                ),
            ),
            fact(
                "cadence",
                format!("{fewest:.0} to {most:.0} steps a minute"),
            ),
        ]);
        for (name, step) in [
            ("left step", &self.left_step),
            ("right step", &self.right_step),
        ] {
            let states: Vec<String> = step
                .state_seconds
                .iter()
                .zip(&step.state_deviation_seconds)
                .map(|(mean, deviation)| {
                    format!("{:.0} ± {:.0}", 1000.0 * mean, 1000.0 * deviation)
                })
                .collect();
            lines.push(fact(
                name,
                format!(
                    "{:.3} s, states of {} ms, the other foot leaves at {:.0} %",
                    step.seconds,
                    states.join(", "),
                    100.0 * step.other_terminal
                ),
            ));
        }
        lines.push(fact(
            "variation",
            format!(
                "{} components between walkers, {} between steps",
                self.walker_components, self.step_components
            ),
        ));
        let ends = if self.ends.is_empty() {
            "as inside".to_owned()
        } else {
            self.ends.join(", ")
        };
        lines.push(fact("ends of walks", ends));
        let standing = self.standing.as_ref().map_or_else(
            || "still".to_owned(),
            |standing| {
                format!(
                    "knees of {:.0}°, sway in {} directions of {} octaves, {:.1} looks and {:.0} breaths a minute; people differ by a factor of {:.1}",
                    standing.knees_deg,
                    standing.directions,
                    standing.octaves,
                    standing.looks_per_minute,
                    standing.breaths_per_minute,
                    standing.strength_factor
                )
            },
        );
        lines.push(fact("standing", standing));
        let running = self.running.as_ref().map(RunningFacts::line);
        lines.push(fact("running", running.unwrap_or_else(|| "no".to_owned())));
        let jumping = self.jumping.as_ref().map(JumpFacts::line);
        lines.push(fact("jumping", jumping.unwrap_or_else(|| "no".to_owned())));
        let crouching = self.crouching.as_ref().map(CrouchFacts::line);
        lines.push(fact(
            "crouching",
            crouching.unwrap_or_else(|| "no".to_owned()),
        ));
        lines
    }
}
