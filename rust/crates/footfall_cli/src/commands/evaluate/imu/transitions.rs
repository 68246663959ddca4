//! Table of how suddenly bodies move where one motion gives way to another.

use footfall_train::imu::evaluate::{TRANSITIONS, TransitionTrial};
use serde::Serialize;

/// Medians over the changes of a kind: greatest acceleration of the joints relative to the hips, m/s².
#[derive(Serialize)]
pub(super) struct Figures {
    from: &'static str,
    to: &'static str,
    changes: usize,
    /// As a game shows it.
    shown_m_s2: f64,
    /// The same without blending.
    unblended_m_s2: f64,
    /// The recorded bodies before and after the change.
    recorded_m_s2: f64,
    /// The recorded bodies, one cut to the other.
    cut_m_s2: f64,
}

/// Figures of every kind that was drawn.
pub(super) fn figures(trials: &[TransitionTrial]) -> Vec<Figures> {
    let kinds = TRANSITIONS.into_iter().filter_map(|kind| {
        let own: Vec<&TransitionTrial> = trials.iter().filter(|t| t.kind == kind).collect();
        let median = |value: fn(&TransitionTrial) -> f64| {
            let mut values: Vec<f64> = own.iter().map(|trial| value(trial)).collect();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied()
        };
        Some(Figures {
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

/// Lines of the table; none without figures.
pub(super) fn lines(sites: &str, figures: &[Figures]) -> Vec<String> {
    if figures.is_empty() {
        return Vec::new();
    }
    let mut lines = vec![
        format!(
            "{sites}, changes between other people's motions; greatest acceleration of the joints, median, m/s²"
        ),
        format!(
            "{:28} {:>7} {:>6} {:>9} {:>8} {:>6}",
            "", "changes", "shown", "unblended", "recorded", "cut"
        ),
    ];
    lines.extend(figures.iter().map(|f| {
        format!(
            "{:28} {:7} {:6.1} {:9.1} {:8.1} {:6.1}",
            format!("{} to {}", f.from, f.to),
            f.changes,
            f.shown_m_s2,
            f.unblended_m_s2,
            f.recorded_m_s2,
            f.cut_m_s2,
        )
    }));
    lines.push(String::new());
    lines
}
