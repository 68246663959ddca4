//! The report as tables for a terminal.

use footfall_core::Behaviour;
use footfall_train::evaluate::imu::{ImuFigures, ImuReport, TransitionFigures};

/// Every sensor's tables, one below the other.
pub(super) fn table(report: &ImuReport) -> String {
    let mut lines = Vec::new();
    for sensor in &report.sensors {
        let sites = sensor.sites.join(" and ");
        lines.extend(transition_lines(&sites, &sensor.transitions));
        for (seen, figures) in [
            ("given model", &sensor.given_model),
            ("trained on other recordings", &sensor.other_recordings),
            ("trained on other subjects", &sensor.other_subjects),
        ] {
            if figures.is_empty() {
                continue;
            }
            lines.push(format!("{sites}, {seen}; cm over moving frames"));
            lines.push(title());
            lines.extend(
                figures
                    .iter()
                    .map(|(category, figures)| line(category, figures)),
            );
            if let Some(total) = figures.get("total") {
                lines.extend(confusion_lines(total));
            }
            lines.push(String::new());
        }
    }
    lines.join("\n").trim_end().to_owned()
}

/// Titles of the columns of a [`line`].
fn title() -> String {
    format!(
        "{:28} {:>10} {:>7} {:>6} {:>7} {:>6} {:>5} {:>9} {:>8} {:>8} {:>11} {:>6} {:>16} {:>12}",
        "",
        "recordings",
        "frames",
        "live",
        "spread",
        "whole",
        "r",
        "constant",
        "average",
        "nearest",
        "recognised",
        "delay",
        "standing knee",
        "sudden, m/s²"
    )
}

/// Behaviours that each behaviour is taken for, in shares of its frames.
fn confusion_lines(figures: &ImuFigures) -> Vec<String> {
    let mut lines = vec![format!(
        "{:28} {}",
        "taken live for",
        Behaviour::ALL.map(|b| format!("{:>9}", b.name())).join(" ")
    )];
    lines.extend(figures.confusion.iter().map(|(truth, shares)| {
        let share = |b: Behaviour| 100.0 * shares.get(b.name()).copied().unwrap_or(0.0);
        let cells = Behaviour::ALL.map(|b| format!("{:7.0} %", share(b)));
        format!("{truth:28} {}", cells.join(" "))
    }));
    lines
}

/// One line of the table.
fn line(category: &str, figures: &ImuFigures) -> String {
    let delay = figures
        .median_delay_s
        .map_or("-".to_owned(), |d| format!("{d:.2} s"));
    let knee = figures
        .standing_knee_deg
        .map_or("-".to_owned(), |[truth, live]| {
            format!("{live:.0}° of {truth:.0}°")
        });
    format!(
        "{category:28} {:10} {:7} {:6.2} {:7.2} {:6.2} {:5.2} {:9.2} {:8.2} {:8.2} {:9.0} % {delay:>6} {knee:>16} {:>12}",
        figures.recordings,
        figures.moving_frames,
        figures.live_cm,
        figures.live_spread_cm,
        figures.whole_cm,
        figures.correlation,
        figures.constant_cm,
        figures.average_cm,
        figures.nearest_cm,
        100.0 * figures.recognised,
        format!(
            "{:.0} of {:.0}",
            figures.sudden_m_s2[1], figures.sudden_m_s2[0]
        ),
    )
}

/// Lines of the table; none without figures.
fn transition_lines(sites: &str, figures: &[TransitionFigures]) -> Vec<String> {
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
