//! Interface to evaluations: the command line hands its own commands over, so that both show the same figures.

use std::path::PathBuf;
use std::sync::Arc;

/// Kinds of evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EvaluateKind {
    /// Are styles told apart?
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
    pub const ALL: [Self; 5] = [
        Self::Style,
        Self::Imu,
        Self::Dynamics,
        Self::Contacts,
        Self::Training,
    ];

    /// The name of the command: `footfall evaluate NAME`.
    pub const fn command(self) -> &'static str {
        match self {
            Self::Style => "style",
            Self::Imu => "imu",
            Self::Dynamics => "dynamics",
            Self::Contacts => "contacts",
            Self::Training => "training",
        }
    }

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

/// Request for an evaluation: its kind and its recordings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EvaluateRequest {
    /// Kind of evaluation.
    pub kind: EvaluateKind,
    /// Table of the recordings.
    pub index: PathBuf,
    /// Conditions on its columns, `column=value`.
    pub conditions: Vec<String>,
    /// Table of the walks that were made, for styles.
    pub synthesised: Option<PathBuf>,
}

/// Judges, and returns what `footfall evaluate … --json` prints, or one line that says why not.
pub type Evaluator =
    Arc<dyn Fn(&EvaluateRequest) -> Result<serde_json::Value, String> + Send + Sync>;
