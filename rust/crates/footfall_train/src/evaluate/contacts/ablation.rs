//! Switches without the parts that place them.

use super::people::LEAST_EVENTS;
use super::{Agreement, ContactsError};
use crate::averages::mean;
use footfall_motion::recording::Recording;
use footfall_motion::switches::{Landing, SwitchConfig};
use serde::Serialize;
use std::collections::BTreeMap;

/// One way to place switches.
#[derive(Clone, Debug, Serialize)]
pub struct Ablated {
    /// Over all recordings.
    pub all: Agreement,
    /// Mean F1 of people with enough events, each counting once.
    pub mean_f1: f64,
    /// The least of them.
    pub worst_f1: f64,
    /// Name of who has it.
    pub worst: String,
}

/// Switches placed in every way.
pub(super) fn ablate(
    clips: &[Recording],
    tolerance_ms: f64,
) -> Result<BTreeMap<&'static str, Ablated>, ContactsError> {
    let mut ablation = BTreeMap::new();
    for landing in Landing::ALL {
        let config = SwitchConfig::by(landing);
        let mut all = Agreement::default();
        let mut people: BTreeMap<&str, Agreement> = BTreeMap::new();
        for clip in clips {
            all.add_switches(clip, &config, tolerance_ms)?;
            let person = people.entry(clip.row.subject()).or_default();
            person.add_switches(clip, &config, tolerance_ms)?;
        }
        all.summarise();
        let f1: Vec<(f64, &str)> = people
            .into_iter()
            .filter(|(_, agreement)| agreement.known >= LEAST_EVENTS)
            .map(|(name, mut agreement)| {
                agreement.summarise();
                (agreement.f1, name)
            })
            .collect();
        let worst = f1.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let (worst_f1, worst) = worst.copied().unwrap_or_default();
        ablation.insert(
            landing.name(),
            Ablated {
                all,
                mean_f1: mean(&f1.iter().map(|(f1, _)| *f1).collect::<Vec<_>>()),
                worst_f1,
                worst: worst.to_owned(),
            },
        );
    }
    Ok(ablation)
}
