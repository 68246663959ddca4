//! Bodies from sensors against the recorded ones, by category (Mousas 2017, tables 2 and 3, figure 10).

mod figures;
mod transitions;

pub use figures::ImuFigures;
pub use transitions::TransitionFigures;

use crate::error::TrainError;
use crate::imu::evaluate::{
    Conditions, Device, HeldOut, evaluate_imu, evaluate_imu_model, evaluate_transitions,
};
use crate::imu::{ImuClip, ImuTrainConfig};
use crate::progress::{Progress, advance};
use figures::by_category;
use footfall_core::Site;
use footfall_model::ImuModel;
use footfall_motion::corpus::Where;
use footfall_motion::recording::Recording;
use footfall_recon::Published;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Sites of figure 10 of the paper, each alone, and the pair of table 3.
pub const PAPER_SENSORS: [&[Site]; 6] = [
    &[Site::RightFoot],
    &[Site::RightFoot, Site::RightHand],
    &[Site::RightKnee],
    &[Site::RightHand],
    &[Site::RightForearm],
    &[Site::Root],
];

/// Models that reconstruct the bodies.
#[derive(Clone, Debug)]
pub enum ImuModels {
    /// One that is there already: which recordings it has seen is the caller's to know.
    Given(Arc<ImuModel>),
    /// Models of these settings, one after the other, trained on other recordings and on those of other subjects.
    Trained(Vec<ImuTrainConfig>),
    /// The same, trained on other subjects alone.
    TrainedOnStrangers(Vec<ImuTrainConfig>),
    /// The same, and not how close bodies come is judged but how suddenly they move where one motion gives way to another.
    Transitions(Vec<ImuTrainConfig>),
}

impl Default for ImuModels {
    /// Trained, for the [`PAPER_SENSORS`].
    fn default() -> Self {
        Self::Trained(PAPER_SENSORS.map(ImuTrainConfig::new).to_vec())
    }
}

/// Request for an evaluation of bodies from sensors.
#[derive(Clone, Debug, Default)]
pub struct ImuRequest {
    /// Models that reconstruct the bodies.
    pub models: ImuModels,
    /// Conditions on the recordings that are judged; models are trained on the others, too.
    pub judged: Vec<Where>,
    /// Simulated sensor that bodies are reconstructed from.
    pub device: Device,
    /// Parts of the method that are as published.
    pub published: Vec<Published>,
}

/// Bodies from sensors.
#[derive(Clone, Debug, Serialize)]
pub struct ImuReport {
    /// Parts of the method that are as published.
    pub as_published: Vec<&'static str>,
    /// A report for each sensor or pair.
    pub sensors: Vec<SensorReport>,
}

/// Bodies from one sensor, or two; figures by category, and of all under `total` where there are several.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SensorReport {
    /// Names of the sites.
    pub sites: Vec<&'static str>,
    /// Changes from one motion to another; the only figures of [`ImuModels::Transitions`], else empty.
    pub transitions: Vec<TransitionFigures>,
    /// A model that was given; otherwise empty.
    pub given_model: BTreeMap<String, ImuFigures>,
    /// Models that have seen all other recordings; empty for strangers.
    pub other_recordings: BTreeMap<String, ImuFigures>,
    /// Models that have seen other subjects only; empty when there is but one.
    pub other_subjects: BTreeMap<String, ImuFigures>,
}

impl ImuRequest {
    /// Checks the settings of models that are to be trained.
    ///
    /// # Errors
    /// As [`ImuTrainConfig::check`].
    pub fn check(&self) -> Result<(), TrainError> {
        self.models
            .configs()
            .iter()
            .try_for_each(ImuTrainConfig::check)
    }

    /// Returns true for a recording that meets the conditions.
    fn judges(&self, recording: &Recording) -> bool {
        self.judged.iter().all(|condition| {
            let value = recording.row.column(&condition.column);
            value.is_some_and(|value| condition.matches(value))
        })
    }
}

impl ImuModels {
    /// Settings of models that are to be trained.
    fn configs(&self) -> &[ImuTrainConfig] {
        match self {
            Self::Given(_) => &[],
            Self::Trained(configs)
            | Self::TrainedOnStrangers(configs)
            | Self::Transitions(configs) => configs,
        }
    }
}

/// Reconstructs recordings from simulated sensors and compares the bodies with the recorded ones.
///
/// # Errors
/// [`TrainError`] for a model that cannot be used or trained, and when `progress` asks to stop, which it may between sensors.
pub fn evaluate_sensors(
    recordings: &[Recording],
    request: &ImuRequest,
    progress: &mut dyn Progress,
) -> Result<ImuReport, TrainError> {
    request.check()?;
    let judge = Judge {
        clips: recordings.iter().map(ImuClip::simulated).collect(),
        categories: recordings.iter().map(|one| one.row.category()).collect(),
        is_judged: recordings.iter().map(|one| request.judges(one)).collect(),
        request,
    };
    let mut sensors = Vec::new();
    if let ImuModels::Given(model) = &request.models {
        let sites = begin(&model.sites, progress)?;
        sensors.push(SensorReport {
            sites,
            given_model: judge.given(model)?,
            ..SensorReport::default()
        });
    }
    for config in request.models.configs() {
        let sites = begin(&config.sites, progress)?;
        sensors.push(SensorReport {
            sites,
            ..judge.trained(config)?
        });
    }
    Ok(ImuReport {
        as_published: request.published.iter().map(|part| part.name()).collect(),
        sensors,
    })
}

/// Says which sensors are judged next, and returns the names of their sites.
fn begin(sites: &[Site], progress: &mut dyn Progress) -> Result<Vec<&'static str>, TrainError> {
    let names: Vec<&'static str> = sites.iter().map(|site| site.name()).collect();
    let task = format!("reconstructing from {}", names.join(" and "));
    advance(progress, &task, 0, 0)?;
    Ok(names)
}

/// Recordings as they are judged.
struct Judge<'a> {
    clips: Vec<ImuClip<'a>>,
    categories: Vec<&'a str>,
    is_judged: Vec<bool>,
    request: &'a ImuRequest,
}

type Figures = BTreeMap<String, ImuFigures>;

impl Judge<'_> {
    fn given(&self, model: &Arc<ImuModel>) -> Result<Figures, TrainError> {
        let judged = |clip: usize| self.is_judged[clip];
        let conditions = self.conditions(HeldOut::Subject);
        let trials = evaluate_imu_model(&self.clips, model, &conditions, &judged)?;
        Ok(by_category(&trials, &self.categories))
    }

    fn trained(&self, config: &ImuTrainConfig) -> Result<SensorReport, TrainError> {
        let judged = |clip: usize| self.is_judged[clip];
        if let ImuModels::Transitions(_) = self.request.models {
            let conditions = self.conditions(HeldOut::Subject);
            let trials = evaluate_transitions(&self.clips, config, &conditions, &judged)?;
            return Ok(SensorReport {
                transitions: transitions::figures(&trials),
                ..SensorReport::default()
            });
        }
        let figures = |held_out: HeldOut| -> Result<Figures, TrainError> {
            let conditions = self.conditions(held_out);
            let trials = evaluate_imu(&self.clips, config, &conditions, &judged)?;
            Ok(by_category(&trials, &self.categories))
        };
        let mut pairs = self.clips.windows(2);
        let has_several = pairs.any(|pair| pair[0].subject != pair[1].subject);
        Ok(SensorReport {
            other_recordings: match self.request.models {
                ImuModels::TrainedOnStrangers(_) => Figures::new(),
                _ => figures(HeldOut::Recording)?,
            },
            other_subjects: if has_several {
                figures(HeldOut::Subject)?
            } else {
                Figures::new()
            },
            ..SensorReport::default()
        })
    }

    fn conditions(&self, held_out: HeldOut) -> Conditions {
        Conditions {
            held_out,
            device: self.request.device,
            published: self.request.published.clone(),
        }
    }
}
