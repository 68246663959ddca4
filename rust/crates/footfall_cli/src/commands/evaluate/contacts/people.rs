//! Contacts and switches person by person, and what each part of the switching method adds.

use super::Agreement;
use anyhow::Result;
use footfall_core::{EventKind, GaitEvent, Side};
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::published_events::PublishedEvents;
use footfall_motion::recording::Recording;
use footfall_motion::switches::Landing;
use serde::Serialize;
use std::collections::BTreeMap;

/// Largest difference at which two contacts count as one, milliseconds; a little more than 50, for times are those of frames.
const CONTACT_TOLERANCE_MS: f64 = 50.1;

/// Events nearer to an end than this are left out, seconds.
const EDGE_SECS: f64 = 0.2;

/// People with fewer known events than this say nothing about which limits are good.
const LEAST_EVENTS: usize = 4;

/// Limits that are tried when a person is left out, the shipped ones first: shares of the swing's speed below which the heel lands
/// and above which the toes lift.
const HEEL_SPEEDS_ON: [f32; 3] = [0.2, 0.15, 0.25];
const TOE_SPEEDS_OFF: [f32; 3] = [0.3, 0.25, 0.35];

/// Two limits of the detector.
#[derive(Clone, Copy, Serialize)]
pub(super) struct Limits {
    heel_speed_on: f32,
    toe_speed_off: f32,
}

/// One person.
#[derive(Clone, Default, Serialize)]
pub(super) struct Person {
    /// Against Zeni et al. 2008.
    initial_contact: Agreement,
    terminal_contact: Agreement,
    /// Switches against initial contacts.
    switches: Agreement,
    /// Chosen on the other people.
    #[serde(skip_serializing_if = "Option::is_none")]
    limits: Option<Limits>,
}

/// One way to place switches.
#[derive(Serialize)]
pub(super) struct Ablated {
    /// Over all recordings.
    all: Agreement,
    /// Of people, each counting once; the least of them.
    mean_f1: f64,
    worst_f1: f64,
    worst: String,
}

type People = BTreeMap<String, Person>;

/// Judges everybody in the recordings.
pub(super) fn judge(clips: &[Recording], tolerance_ms: f64, leave_one_out: bool) -> Result<People> {
    let published: Vec<PublishedEvents> = clips
        .iter()
        .map(|clip| PublishedEvents::of(&clip.retargeted.clip, clip.retargeted.first_frame))
        .collect();
    let mut trials: Vec<(Limits, People)> = Vec::new();
    for heel_speed_on in HEEL_SPEEDS_ON {
        for toe_speed_off in TOE_SPEEDS_OFF {
            if !leave_one_out && !trials.is_empty() {
                break;
            }
            let limits = Limits {
                heel_speed_on,
                toe_speed_off,
            };
            trials.push((limits, with_limits(clips, &published, limits)));
        }
    }
    let mut people = trials[0].1.clone();
    if leave_one_out {
        for (name, person) in &mut people {
            let best = trials.iter().rev().max_by(|a, b| {
                let [a, b] = [a, b].map(|(_, people)| score_without(people, name));
                a.total_cmp(&b)
            });
            if let Some((limits, judged)) = best {
                *person = judged[name].clone();
                person.limits = Some(*limits);
            }
        }
    }
    for clip in clips {
        let person = people.entry(clip.row.subject().to_owned()).or_default();
        person
            .switches
            .add_switches(clip, Landing::default(), tolerance_ms)?;
    }
    for person in people.values_mut() {
        person.switches.summarise();
    }
    Ok(people)
}

/// Contacts of everybody under some limits.
fn with_limits(clips: &[Recording], published: &[PublishedEvents], limits: Limits) -> People {
    let mut people = People::new();
    for (clip, published) in clips.iter().zip(published) {
        let motion = &clip.retargeted;
        let config = ContactConfig {
            heel_speed_on: limits.heel_speed_on,
            toe_speed_off: limits.toe_speed_off,
            ..ContactConfig::from_frame(motion.first_frame)
        };
        // Not those of the corpus, which a person may have corrected.
        let found = detect_contacts(&motion.clip, &config).events();
        let rate = motion.clip.frame_rate_hz;
        let edge = (EDGE_SECS * rate) as usize;
        let inside = motion.first_frame + edge..motion.clip.poses.len().saturating_sub(edge);
        let judged =
            |event: &&GaitEvent| inside.contains(&event.frame) && published.is_steady[event.frame];
        let person = people.entry(clip.row.subject().to_owned()).or_default();
        for (kind, agreement) in [
            (EventKind::InitialContact, &mut person.initial_contact),
            (EventKind::TerminalContact, &mut person.terminal_contact),
        ] {
            agreement.recordings += 1;
            for side in Side::BOTH {
                let times = |events: &[GaitEvent]| -> Vec<f64> {
                    let of_kind = |event: &&GaitEvent| event.side == side && event.kind == kind;
                    let events = events.iter().filter(of_kind).filter(judged);
                    events.map(|event| event.frame as f64 / rate).collect()
                };
                agreement.add(
                    times(&published.events),
                    times(&found),
                    CONTACT_TOLERANCE_MS,
                );
            }
        }
    }
    for person in people.values_mut() {
        person.initial_contact.summarise();
        person.terminal_contact.summarise();
    }
    people
}

/// The F1 of all people but one, each counting once.
fn score_without(people: &People, left_out: &str) -> f64 {
    let others = people.iter().filter(|(name, _)| *name != left_out);
    let f1: Vec<f64> = others
        .flat_map(|(_, person)| [&person.initial_contact, &person.terminal_contact])
        .filter(|agreement| agreement.known >= LEAST_EVENTS)
        .map(|agreement| agreement.f1)
        .collect();
    mean(&f1)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Switches placed in every way.
pub(super) fn ablate(
    clips: &[Recording],
    tolerance_ms: f64,
) -> Result<BTreeMap<&'static str, Ablated>> {
    let mut ablation = BTreeMap::new();
    for landing in Landing::ALL {
        let mut all = Agreement::default();
        let mut people: BTreeMap<&str, Agreement> = BTreeMap::new();
        for clip in clips {
            all.add_switches(clip, landing, tolerance_ms)?;
            let person = people.entry(clip.row.subject()).or_default();
            person.add_switches(clip, landing, tolerance_ms)?;
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

/// Everybody in a line, then the mean and the worst.
pub(super) fn table(people: &People, tolerance_ms: f64) -> Vec<String> {
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
            "People: contacts against Zeni et al. 2008 within 50 ms; switches against contacts within {tolerance_ms} ms; median of found less known, ms"
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
        lines.push(format!(
            "{name:28} {}  {}  {}{limits}",
            cells(&person.initial_contact),
            cells(&person.terminal_contact),
            cells(&person.switches)
        ));
    }
    let f1 = |of: fn(&Person) -> &Agreement| -> Vec<f64> {
        let known = people.values().map(of).filter(|a| a.known >= LEAST_EVENTS);
        known.map(|agreement| agreement.f1).collect()
    };
    let columns = [
        f1(|person| &person.initial_contact),
        f1(|person| &person.terminal_contact),
        f1(|person| &person.switches),
    ];
    let summary = |name: &str, of: fn(&[f64]) -> f64| {
        let [initial, terminal, switches] = columns.each_ref().map(|f1| {
            if f1.is_empty() {
                "-".to_owned()
            } else {
                format!("{:.2}", of(f1))
            }
        });
        format!("{name:28} {initial:>11} {terminal:>20} {switches:>20}")
    };
    lines.push(summary("mean, with 4 events or more", mean));
    lines.push(summary("worst of them", |f1| {
        f1.iter().copied().fold(1.0, f64::min)
    }));
    lines
}

/// Ways to place switches, from the least to the most.
pub(super) fn ablation_table(ablation: &BTreeMap<&'static str, Ablated>) -> Vec<String> {
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
