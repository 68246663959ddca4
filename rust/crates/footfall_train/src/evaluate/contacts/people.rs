//! Contacts and switches person by person.

use super::left_out::best_without;
use super::switch_limits::{self, SwitchLimits};
use super::{Agreement, ContactsError};
use crate::averages::mean;
use footfall_core::{EventKind, GaitEvent, Side};
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::published_events::PublishedEvents;
use footfall_motion::recording::Recording;
use serde::Serialize;
use std::collections::BTreeMap;

/// Largest difference at which two contacts count as one, milliseconds; a little more than 50, for times are those of frames.
const CONTACT_TOLERANCE_MS: f64 = 50.1;

/// Events nearer to an end than this are left out, seconds.
const EDGE_SECS: f64 = 0.2;

/// People with fewer known events than this say nothing about which limits are good.
pub(super) const LEAST_EVENTS: usize = 4;

/// Limits that are tried when a person is left out, the shipped ones first: shares of the swing's speed below which the heel lands
/// and above which the toes lift.
const HEEL_SPEEDS_ON: [f32; 3] = [0.2, 0.15, 0.25];
const TOE_SPEEDS_OFF: [f32; 3] = [0.3, 0.25, 0.35];

/// Two limits of the detector, shares of the swing's speed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Limits {
    /// The heel lands below this.
    pub heel_speed_on: f32,
    /// The toes lift above this.
    pub toe_speed_off: f32,
}

/// One person.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Person {
    /// Initial contacts against Zeni et al. 2008.
    pub initial_contact: Agreement,
    /// Terminal contacts against the same.
    pub terminal_contact: Agreement,
    /// Switches against initial contacts.
    pub switches: Agreement,
    /// Limits that were chosen on the other people.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limits: Option<Limits>,
    /// Times of switches that were chosen on the other people.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub switch_limits: Option<SwitchLimits>,
}

type People = BTreeMap<String, Person>;

/// Judges all people in the recordings.
pub(super) fn judge(
    clips: &[Recording],
    tolerance_ms: f64,
    leave_one_out: bool,
) -> Result<People, ContactsError> {
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
            let best = best_without(&trials, name, |person| {
                vec![&person.initial_contact, &person.terminal_contact]
            });
            if let Some((limits, judged)) = best {
                *person = judged[name].clone();
                person.limits = Some(*limits);
            }
        }
    }
    for (name, (limits, switches)) in switch_limits::judge(clips, tolerance_ms, leave_one_out)? {
        let person = people.entry(name).or_default();
        person.switches = switches;
        person.switch_limits = limits;
    }
    Ok(people)
}

/// Contacts of all people under some limits.
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

/// Mean and least F1 over those agreements with enough events; `None` without any.
pub fn mean_and_worst_f1<'a>(agreements: impl Iterator<Item = &'a Agreement>) -> Option<[f64; 2]> {
    let telling = agreements.filter(|agreement| agreement.known >= LEAST_EVENTS);
    let f1: Vec<f64> = telling.map(|agreement| agreement.f1).collect();
    let worst = f1.iter().copied().reduce(f64::min)?;
    Some([mean(&f1), worst])
}
