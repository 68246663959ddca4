//! From recordings of bodies to a model of what a sensor on them means (Mousas 2017, sections 4 and 5).
//!
//! [`bent_trunks`] finds skeletons whose bodies lean back; [`synchronise`] brings a real sensor's recording onto the time of a clip; [`observe`] turns a clip into a chain of phases with what sensors measure in each frame; [`train_imu`] combines chains to a model, whole or by representative segments; [`evaluate`] measures how
//! close the bodies come that a model makes.

mod align;
mod chain;
pub mod evaluate;
mod level_trunks;
mod statistics;
mod synchronise;
mod templates;

pub use chain::{Chain, ImuClip, observe};
pub use level_trunks::{BentTrunk, TrunkTurn, bent_trunks, level_trunks};
pub use synchronise::{Synchronised, synchronise};

use crate::error::TrainError;
use footfall_core::{PhaseKind, PhaseStart, Site, Skeleton};
use footfall_model::Provenance;
use footfall_model::imu_model::{ImuModel, MAX_FRAMES, MAX_SENSORS};
use std::collections::BTreeSet;

/// Settings of training.
#[derive(Clone, Debug, PartialEq)]
pub struct ImuTrainConfig {
    /// Frames per second of the model.
    pub frame_rate_hz: f64,
    /// Sites of the sensors; one or two.
    pub sites: Vec<Site>,
    /// True when every recording is used mirrored, too.
    pub mirror: bool,
    /// Most frames that are kept: then the cycles of movement that stand best for all others. All are kept when `None`.
    pub most_frames: Option<usize>,
    /// True when simulated sensors are those of an uncalibrated board on a loose strap, not ideal ones. Measurements showed no gain.
    pub strapped: bool,
}

impl ImuTrainConfig {
    /// 30 frames a second, mirrored recordings too.
    pub fn new(sites: &[Site]) -> Self {
        Self {
            frame_rate_hz: 30.0,
            sites: sites.to_vec(),
            mirror: true,
            most_frames: None,
            strapped: false,
        }
    }

    /// Checks rate and number of sensors, as everything that takes a configuration does.
    ///
    /// # Errors
    /// [`TrainError::FrameRate`] and [`TrainError::Sensors`].
    pub fn check(&self) -> Result<(), TrainError> {
        if !(20.0..=240.0).contains(&self.frame_rate_hz) {
            return Err(TrainError::FrameRate {
                frame_rate_hz: self.frame_rate_hz,
            });
        }
        if !(1..=MAX_SENSORS).contains(&self.sites.len()) {
            return Err(TrainError::Sensors {
                found: self.sites.len(),
            });
        }
        Ok(())
    }
}

/// Observes every clip and trains on all of them.
///
/// # Errors
/// [`TrainError`] for a configuration that cannot be, and for clips without a usable frame.
pub fn train_imu_clips(
    clips: &[ImuClip<'_>],
    config: &ImuTrainConfig,
    provenance: Provenance,
) -> Result<ImuModel, TrainError> {
    use rayon::prelude::*;
    config.check()?;
    let chains: Vec<Vec<Chain>> = clips.par_iter().map(|clip| observe(clip, config)).collect();
    let chains: Vec<&Chain> = chains.iter().flatten().collect();
    train_imu(&chains, config, provenance)
}

/// Puts chains together.
///
/// # Errors
/// As [`train_imu_clips`].
pub fn train_imu(
    chains: &[&Chain],
    config: &ImuTrainConfig,
    provenance: Provenance,
) -> Result<ImuModel, TrainError> {
    config.check()?;
    let frames: usize = chains.iter().map(|chain| chain.frames()).sum();
    if frames == 0 || frames > MAX_FRAMES {
        return Err(TrainError::ImuFrames { found: frames });
    }
    let segments = chains.iter().flat_map(|chain| &chain.segments);
    let phases: BTreeSet<PhaseKind> = segments.map(|segment| segment.kind).collect();
    let phases: Vec<PhaseKind> = phases.into_iter().collect();
    let subjects: BTreeSet<&str> = chains.iter().map(|c| c.subject.as_str()).collect();
    let subjects: Vec<&str> = subjects.into_iter().collect();
    let recordings = chains.iter().filter(|chain| !chain.mirrored);
    let landings = recordings.clone().flat_map(|chain| &chain.segments);
    let steps = landings.filter(|segment| segment.kind.start == PhaseStart::Landing);
    let provenance = Provenance {
        clips: recordings.clone().count(),
        subjects: subjects.len(),
        steps: steps.count(),
        ..provenance
    };
    let statistics = statistics::Statistics::of(chains, &phases, config.sites.len());
    let mut model = ImuModel {
        frame_rate_hz: config.frame_rate_hz,
        sites: config.sites.clone(),
        skeleton: chains
            .first()
            .map_or_else(Skeleton::standard, |c| c.skeleton.clone()),
        next: statistics.next,
        subjects: subjects.len(),
        segments: Vec::new(),
        sensor: Vec::new(),
        body: Vec::new(),
        deviations: statistics.deviations,
        regressions: statistics.regressions,
        phases,
        provenance,
    };
    let mut before: Option<templates::Cycle> = None;
    for cycle in templates::choose(chains, &model.deviations, config.most_frames) {
        let chain = chains[cycle.chain];
        let subject = subjects.binary_search(&chain.subject.as_str()).unwrap_or(0);
        let follows = before.is_some_and(|before| before.is_followed_by(&cycle));
        chain.append_to(&mut model, cycle.segments.clone(), subject as u16, follows);
        before = Some(cycle);
    }
    Ok(model)
}
