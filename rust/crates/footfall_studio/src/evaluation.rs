//! Evaluations that the studio offers: what is asked for, and the tables that come of it.

use crate::table::{Table, tables};
use footfall_motion::corpus::{Corpus, Where};
use footfall_train::dynamics::DynamicsConfig;
use footfall_train::evaluate::contacts::{ContactsRequest, evaluate_contacts};
use footfall_train::evaluate::dynamics::evaluate_dynamics;
use footfall_train::evaluate::evaluate_styles;
use footfall_train::evaluate::imu::{ImuRequest, evaluate_sensors};
use footfall_train::evaluate::style_report::StyleReport;
use footfall_train::evaluate::training::{DEFAULT_RATE_HZ, evaluate_training};
use footfall_train::imu::{bent_trunks, level_trunks};
use footfall_train::{Progress, TrainError};
use std::path::{Path, PathBuf};

/// Kinds of evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum EvaluateKind {
    /// Classification of styles.
    #[default]
    Style,
    /// Bodies from one sensor.
    Imu,
    /// Gait as two switching systems.
    Dynamics,
    /// Contacts from joint angles.
    Contacts,
    /// Walker-adaptive training.
    Training,
}

impl EvaluateKind {
    /// Every kind.
    pub(crate) const ALL: [Self; 5] = [
        Self::Style,
        Self::Imu,
        Self::Dynamics,
        Self::Contacts,
        Self::Training,
    ];

    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Style => "Styles: recognition, naturalness",
            Self::Imu => "Bodies from a sensor",
            Self::Dynamics => "Switching systems against one",
            Self::Contacts => "Contacts, person by person",
            Self::Training => "Walker-adaptive training",
        }
    }

    pub(crate) const fn explanation(self) -> &'static str {
        match self {
            Self::Style => {
                "A classifier learns styles of real strides and names those it has not seen; with walks that were made, theirs too (Tilmanne et al. 2012, tables 2 and 3)."
            }
            Self::Imu => {
                "Every recording is reconstructed by models that have not seen it (Mousas 2017, tables 2 and 3). This takes minutes."
            }
            Self::Dynamics => {
                "Prediction errors of two switching linear systems and of a single one."
            }
            Self::Contacts => {
                "Contacts by the feet's heights and speeds against a published detector (Zeni et al. 2008), and initial contacts by hip and knee angles alone against those."
            }
            Self::Training => {
                "How much the average model's variance falls, and how well it explains a walker it has not seen."
            }
        }
    }
}

/// Request for an evaluation: its kind and its recordings. All else is as the command line has it by default.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct EvaluateRequest {
    /// Kind of evaluation.
    pub(crate) kind: EvaluateKind,
    /// Table of the recordings.
    pub(crate) index: PathBuf,
    /// Conditions on its columns, `column=value`.
    pub(crate) conditions: Vec<String>,
    /// Table of the walks that were made, for styles.
    pub(crate) synthesised: Option<PathBuf>,
}

/// Judges recordings. Returns the tables of the report, or one line that says why there is none.
pub(crate) fn evaluate(
    request: &EvaluateRequest,
    progress: &mut dyn Progress,
) -> Result<Vec<Table>, String> {
    let conditions = request.conditions.iter();
    let conditions: Vec<Where> = conditions
        .map(|condition| condition.parse())
        .collect::<Result<_, _>>()
        .map_err(said)?;
    begin(progress, "reading the recordings")?;
    let mut corpus = Corpus::read(&request.index, &conditions).map_err(said)?;
    if request.kind == EvaluateKind::Imu {
        let bent = bent_trunks(&corpus.clips);
        level_trunks(&mut corpus.clips, &bent);
    }
    begin(progress, "judging")?;
    let recordings = &corpus.clips;
    Ok(match request.kind {
        EvaluateKind::Style => tables::style(&judge_styles(request, &corpus)?),
        EvaluateKind::Imu => tables::imu(
            &evaluate_sensors(recordings, &ImuRequest::default(), progress)
                .map_err(|error| about(&request.index, error))?,
        ),
        EvaluateKind::Dynamics => {
            let evaluation = evaluate_dynamics(recordings, &DynamicsConfig::default());
            tables::dynamics(&evaluation.map_err(said)?.report)
        }
        EvaluateKind::Contacts => {
            let request = ContactsRequest {
                recordings,
                ..ContactsRequest::default()
            };
            tables::contacts(&evaluate_contacts(&request).map_err(said)?)
        }
        EvaluateKind::Training => tables::training(
            &evaluate_training(&corpus, DEFAULT_RATE_HZ, progress)
                .map_err(|error| about(&request.index, error))?,
        ),
    })
}

fn judge_styles(request: &EvaluateRequest, real: &Corpus) -> Result<StyleReport, String> {
    let synthesised = request.synthesised.as_ref();
    let synthesised = synthesised.map(|index| Corpus::read(index, &[]));
    let synthesised = synthesised.transpose().map_err(said)?;
    let made = synthesised.as_ref().map(|corpus| corpus.clips.as_slice());
    let evaluation =
        evaluate_styles(&real.clips, made, None).map_err(|error| about(&request.index, error))?;
    let corpora = [Some(real), synthesised.as_ref()].into_iter().flatten();
    let skipped = corpora.flat_map(|corpus| corpus.report.reasons()).collect();
    Ok(StyleReport::new(&evaluation, skipped))
}

/// Says what is done next; an error when the work is to stop.
fn begin(progress: &mut dyn Progress, task: &str) -> Result<(), String> {
    if progress.advance(task, 0, 0).is_break() {
        return Err(said(TrainError::Cancelled));
    }
    Ok(())
}

fn said(error: impl core::error::Error) -> String {
    error.to_string()
}

fn about(index: &Path, error: impl core::error::Error) -> String {
    format!("{}: {error}", index.display())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Cell;

    fn request(kind: EvaluateKind, condition: &str) -> EvaluateRequest {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../tests/data");
        EvaluateRequest {
            kind,
            index: data.join("index.csv"),
            conditions: vec![condition.to_owned()],
            synthesised: None,
        }
    }

    fn value(table: &Table, row: &str, column: &str) -> Cell {
        let (_, cells) = table.rows.iter().find(|(name, _)| name == row).unwrap();
        let place = table.columns.iter().position(|name| name == column);
        cells[place.unwrap()].clone()
    }

    #[test]
    fn chosen_recordings_are_judged() {
        let request = request(EvaluateKind::Contacts, "subject=walker_1");
        let tables = evaluate(&request, &mut ()).unwrap();
        let categories = tables.iter().find(|table| table.title == "Categories");
        let categories = categories.unwrap();
        assert_eq!(value(categories, "walk", "recordings"), Cell::Number(2.0));
        let f1 = value(categories, "walk", "F1").number().unwrap();
        assert!(f1 > 0.9, "{f1}");
        let people = tables.iter().find(|table| table.title == "People");
        assert_eq!(people.unwrap().rows.len(), 1);
    }

    #[test]
    fn every_kind_makes_a_table_of_what_it_judges() {
        for kind in EvaluateKind::ALL {
            let mut request = request(kind, "category=walk");
            if kind == EvaluateKind::Style {
                // Its styles are one; that needs two.
                request.conditions = vec!["subject=walker_1".to_owned()];
                let error = evaluate(&request, &mut ()).unwrap_err();
                assert!(
                    error.contains("index.csv: ") && error.contains("needs two"),
                    "{error}"
                );
                continue;
            }
            let tables = evaluate(&request, &mut ()).unwrap();
            let is_full = |table: &Table| {
                let rows = table.rows.iter();
                let mut rows = rows.map(|(_, cells)| cells.len());
                !table.rows.is_empty() && rows.all(|cells| cells == table.columns.len())
            };
            assert!(
                !tables.is_empty() && tables.iter().all(is_full),
                "{tables:?}"
            );
        }
    }

    #[test]
    fn conditions_that_choose_nothing_or_are_none_are_one_line() {
        let none = request(EvaluateKind::Dynamics, "subject=nobody");
        let error = evaluate(&none, &mut ()).unwrap_err();
        assert!(
            error.contains("nobody") && error.contains("walker_1"),
            "{error}"
        );
        let unreadable = request(EvaluateKind::Dynamics, "nobody");
        let error = evaluate(&unreadable, &mut ()).unwrap_err();
        assert!(error.contains("column=value"), "{error}");
    }
}
