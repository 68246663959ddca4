//! The report as tables for a terminal.

use footfall_motion::switches::Landing;
use footfall_train::evaluate::contacts::{
    Ablated, Agreement, ContactsReport, Person, mean_and_worst_f1,
};
use std::collections::BTreeMap;

type People = BTreeMap<String, Person>;

/// All tables, one below the other.
pub(super) fn table(report: &ContactsReport) -> String {
    let mut lines = people_table(&report.people, report.tolerance_ms);
    lines.extend(ablation_table(&report.ablation));
    lines.extend([
        format!(
            "Contacts within {} ms; bias and spread of found minus known, ms",
            report.tolerance_ms
        ),
        format!(
            "{:36} {:>10} {:>6} {:>6} {:>5} {:>7} {:>7}",
            "known by", "recordings", "known", "found", "F1", "bias", "spread"
        ),
    ]);
    for (known, agreements) in [
        ("kinematics", &report.categories),
        ("sensors' reference", &report.sensors),
    ] {
        lines.extend(agreements.iter().map(|(category, agreement)| {
            let name = format!("{known}: {category}");
            format!(
                "{name:36} {:10} {:6} {:6} {:5.2} {:+7.1} {:7.1}",
                agreement.recordings,
                agreement.known,
                agreement.found,
                agreement.f1,
                agreement.bias_ms,
                agreement.spread_ms
            )
        }));
    }
    lines.join("\n")
}

/// A line for each person, then the mean and the worst.
fn people_table(people: &People, tolerance_ms: f64) -> Vec<String> {
    if people.is_empty() {
        return Vec::new();
    }
    let cells = |agreement: &Agreement| {
        if agreement.known + agreement.found == 0 {
            return format!("{:>5} {:>5} {:>7}", 0, "-", "-");
        }
        let Agreement {
            known,
            f1,
            median_ms,
            ..
        } = agreement;
        format!("{known:5} {f1:5.2} {median_ms:+7.1}")
    };
    let mut lines = vec![
        format!(
            "People: contacts against Zeni et al. 2008 within 50 ms; switches against contacts within {tolerance_ms} ms; median of found minus known, ms"
        ),
        format!(
            "{:28} {:>19}  {:>19}  {:>19}",
            "", "initial contacts", "terminal contacts", "switches"
        ),
        format!(
            "{:28} {heads}  {heads}  {heads}",
            "person",
            heads = format_args!("{:>5} {:>5} {:>7}", "known", "F1", "median")
        ),
    ];
    for (name, person) in people {
        let limits = person.limits.map_or_else(String::new, |limits| {
            format!(
                "  heel on {:.2}, toes off {:.2}",
                limits.heel_speed_on, limits.toe_speed_off
            )
        });
        let switch_limits = person.switch_limits.map_or_else(String::new, |limits| {
            format!(
                ", switches {:+.0} ms and {:.0} a radian",
                1000.0 * limits.landing_secs,
                1000.0 * limits.bend_secs_per_rad
            )
        });
        lines.push(format!(
            "{name:28} {}  {}  {}{limits}{switch_limits}",
            cells(&person.initial_contact),
            cells(&person.terminal_contact),
            cells(&person.switches)
        ));
    }
    let columns: [fn(&Person) -> &Agreement; 3] = [
        |person| &person.initial_contact,
        |person| &person.terminal_contact,
        |person| &person.switches,
    ];
    let scores = columns.map(|of| mean_and_worst_f1(people.values().map(of)));
    for (place, name) in ["mean, with 4 events or more", "worst of them"]
        .into_iter()
        .enumerate()
    {
        let [initial, terminal, switches] = scores
            .map(|score| score.map_or_else(|| "-".to_owned(), |f1| format!("{:.2}", f1[place])));
        lines.push(format!(
            "{name:28} {initial:>11} {terminal:>20} {switches:>20}"
        ));
    }
    lines
}

/// Ways to place switches, from the least to the most.
fn ablation_table(ablation: &BTreeMap<&'static str, Ablated>) -> Vec<String> {
    if ablation.is_empty() {
        return Vec::new();
    }
    let mut lines = vec![format!(
        "{:36} {:>5} {:>7} {:>7} {:>10} {:>6}  worst person",
        "switches by", "F1", "bias", "spread", "F1, people", "worst"
    )];
    let known = Landing::ALL
        .into_iter()
        .filter_map(|landing| ablation.get_key_value(landing.name()));
    lines.extend(known.map(|(name, ablated)| {
        format!(
            "{name:36} {:5.2} {:+7.1} {:7.1} {:10.2} {:6.2}  {}",
            ablated.all.f1,
            ablated.all.bias_ms,
            ablated.all.spread_ms,
            ablated.mean_f1,
            ablated.worst_f1,
            ablated.worst
        )
    }));
    lines
}
