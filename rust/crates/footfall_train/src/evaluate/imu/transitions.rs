//! Figures of how suddenly bodies move where one motion gives way to another.

use crate::averages::upper_median;
use crate::imu::evaluate::{TRANSITIONS, TransitionTrial};
use serde::Serialize;

/// Medians over the changes of a kind: greatest acceleration of the joints relative to the hips, m/s².
#[derive(Clone, Debug, Serialize)]
pub struct TransitionFigures {
    /// Behaviour before the change.
    pub from: &'static str,
    /// Behaviour after it.
    pub to: &'static str,
    /// Number of changes.
    pub changes: usize,
    /// As a game shows it.
    pub shown_m_s2: f64,
    /// The same without blending.
    pub unblended_m_s2: f64,
    /// The recorded bodies before and after the change.
    pub recorded_m_s2: f64,
    /// The recorded bodies, one cut to the other.
    pub cut_m_s2: f64,
}

/// Figures of every kind that was drawn.
pub(super) fn figures(trials: &[TransitionTrial]) -> Vec<TransitionFigures> {
    let kinds = TRANSITIONS.into_iter().filter_map(|kind| {
        let own: Vec<&TransitionTrial> = trials.iter().filter(|t| t.kind == kind).collect();
        let median =
            |value: fn(&TransitionTrial) -> f64| upper_median(own.iter().map(|trial| value(trial)));
        Some(TransitionFigures {
            from: kind[0].name(),
            to: kind[1].name(),
            changes: own.len(),
            shown_m_s2: median(|t| t.shown)?,
            unblended_m_s2: median(|t| t.unblended)?,
            recorded_m_s2: median(|t| t.recorded)?,
            cut_m_s2: median(|t| t.cut)?,
        })
    });
    kinds.collect()
}
