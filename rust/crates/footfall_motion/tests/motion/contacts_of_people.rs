//! Contacts and switches of recorded people, person by person, against a published detector.
//!
//! Skipped, and said so, where there are no recordings.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::allow_attributes,
    reason = "tests; the figures are worth seeing"
)]

use footfall_core::{EventKind, GaitEvent, Side};
use footfall_motion::bvh;
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::corpus::{Corpus, Where};
use footfall_motion::published_events::PublishedEvents;
use footfall_motion::recording::Recording;
use footfall_motion::retarget::{RetargetOptions, retarget};
use footfall_motion::switches::{Landing, SwitchConfig, detect_switches_by};
use std::collections::BTreeMap;

/// A little more than 50 ms, for times are those of frames.
const CONTACT_SECS: f64 = 0.0501;
const SWITCH_SECS: f64 = 0.0335;

/// Fewer events than this do not make a person.
const LEAST_EVENTS: usize = 4;

/// Known, found and matched events, and the delays of those that matched, seconds.
#[derive(Default)]
struct Agreement {
    known: usize,
    found: usize,
    delays: Vec<f64>,
}

impl Agreement {
    fn add(&mut self, known: &[f64], found: &[f64], tolerance: f64) {
        self.known += known.len();
        self.found += found.len();
        let mut free = found.to_vec();
        for time in known {
            let nearest = (0..free.len())
                .min_by(|&a, &b| (free[a] - time).abs().total_cmp(&(free[b] - time).abs()));
            if let Some(n) = nearest
                && (free[n] - time).abs() <= tolerance
            {
                self.delays.push(free.swap_remove(n) - time);
            }
        }
    }

    fn f1(&self) -> f64 {
        2.0 * self.delays.len() as f64 / (self.known + self.found).max(1) as f64
    }

    fn mean_delay(&self) -> f64 {
        self.delays.iter().sum::<f64>() / self.delays.len().max(1) as f64
    }
}

fn corpus(conditions: &[&str]) -> Option<Corpus> {
    let folder = crate::common::data_folder()?;
    let conditions: Vec<Where> = conditions.iter().map(|c| c.parse().unwrap()).collect();
    Some(Corpus::read(folder.join("index.csv"), &conditions).unwrap())
}

/// Detected contacts; those of a corpus may be corrected.
fn detected(clip: &Recording) -> Vec<GaitEvent> {
    let first = clip.retargeted.first_frame;
    detect_contacts(&clip.retargeted.clip, &ContactConfig::from_frame(first)).events()
}

/// Times of a foot's events of one kind in the frames that count.
fn times(
    events: &[GaitEvent],
    (side, kind): (Side, EventKind),
    rate: f64,
    counts: impl Fn(usize) -> bool,
) -> Vec<f64> {
    let wanted = |e: &&GaitEvent| e.side == side && e.kind == kind && counts(e.frame);
    let events = events.iter().filter(wanted);
    events.map(|event| event.frame as f64 / rate).collect()
}

/// Frames that are not near an end of the motion.
fn inside(clip: &Recording, margin_secs: f64) -> impl Fn(usize) -> bool + use<> {
    let motion = &clip.retargeted;
    let margin = (margin_secs * motion.clip.frame_rate_hz) as usize;
    let frames = motion.first_frame + margin..motion.clip.poses.len().saturating_sub(margin);
    move |frame| frames.contains(&frame)
}

#[test]
fn events_of_recorded_walks_agree_with_a_published_detector() {
    for set in [
        "cmu/neutral_walk",
        "bandai/neutral_walk",
        "bandai/styled_walk",
    ] {
        let Some(corpus) = corpus(&[&format!("path={set}/*")]) else {
            return;
        };
        for (kind, bias) in [
            (EventKind::InitialContact, 0.03),
            (EventKind::TerminalContact, 0.015),
        ] {
            let mut agreement = Agreement::default();
            for clip in &corpus.clips {
                let motion = &clip.retargeted;
                let published = PublishedEvents::of(&motion.clip, motion.first_frame).events;
                let counts = inside(clip, 0.2);
                for side in Side::BOTH {
                    let of = |events: &[GaitEvent]| {
                        times(events, (side, kind), motion.clip.frame_rate_hz, &counts)
                    };
                    agreement.add(&of(&published), &of(&detected(clip)), CONTACT_SECS);
                }
            }
            let (f1, delay) = (agreement.f1(), agreement.mean_delay());
            println!(
                "{set} {}: F1 {f1:.3}, {:+.1} ms",
                kind.name(),
                1000.0 * delay
            );
            assert!(f1 > 0.95, "{set} {}: F1 {f1}", kind.name());
            assert!(delay.abs() < bias, "{set} {}: {delay} s", kind.name());
        }
    }
}

/// Contacts of everybody against the published detector where they walk straight ahead.
fn by_person(clips: &[Recording]) -> BTreeMap<(String, &'static str), Agreement> {
    let mut people: BTreeMap<(String, &'static str), Agreement> = BTreeMap::new();
    for clip in clips {
        let motion = &clip.retargeted;
        let published = PublishedEvents::of(&motion.clip, motion.first_frame);
        let found = detected(clip);
        let inside = inside(clip, 0.2);
        let counts = |frame: usize| inside(frame) && published.is_steady[frame];
        for kind in [EventKind::InitialContact, EventKind::TerminalContact] {
            let person = (clip.row.subject().to_owned(), kind.name());
            let agreement = people.entry(person).or_default();
            for side in Side::BOTH {
                let of = |events: &[GaitEvent]| {
                    times(events, (side, kind), motion.clip.frame_rate_hz, counts)
                };
                agreement.add(&of(&published.events), &of(&found), CONTACT_SECS);
            }
        }
    }
    people.retain(|_, agreement| agreement.known >= LEAST_EVENTS);
    people
}

fn all_hold(people: &BTreeMap<(String, &'static str), Agreement>) {
    for ((person, kind), agreement) in people {
        let Agreement { known, found, .. } = agreement;
        let f1 = agreement.f1();
        println!("{person} {kind}: known {known}, found {found}, F1 {f1:.3}");
        assert!(f1 >= 0.95, "{person} {kind}: F1 {f1}");
    }
}

#[test]
fn contacts_of_every_person_hold() {
    let mut people = BTreeMap::new();
    // Acted styles, turns and starts included, as long as somebody walks. Of the takes those in which walking is the matter.
    for set in [
        "path=*/neutral_walk/*",
        "path=*/styled_walk/*",
        "path=*/transition_stand_to_walk/*",
        "path=*/turning/*",
        "path=o3de/Walk*",
    ] {
        let Some(corpus) = corpus(&[set]) else {
            return;
        };
        for (person, agreement) in by_person(&corpus.clips) {
            let sum: &mut Agreement = people.entry(person).or_default();
            sum.known += agreement.known;
            sum.found += agreement.found;
            sum.delays.extend(agreement.delays);
        }
    }
    assert!(people.len() >= 20, "{} people and kinds", people.len());
    all_hold(&people);
}

/// The same recordings whose first frame of motion lasts for 20 s, read anew.
fn with_long_standing(clips: &mut [Recording]) {
    for clip in clips {
        let mut file = bvh::read(&clip.row.path).unwrap();
        let channels = file.channel_count();
        let at = clip.retargeted.first_frame * channels;
        let stands = file.values[at..at + channels].to_vec();
        let frames = (20.0 * clip.retargeted.clip.frame_rate_hz) as usize;
        let rows = std::iter::repeat_n(stands, frames).flatten();
        file.values.splice(at..at, rows);
        file.frame_count += frames;
        clip.retargeted = retarget(&file, &RetargetOptions::default()).unwrap();
    }
}

#[test]
fn contacts_of_every_person_hold_in_clips_of_long_standing() {
    // People who stand before they walk.
    let Some(mut corpus) = corpus(&["path=cmu/transition_stand_to_walk/*"]) else {
        return;
    };
    with_long_standing(&mut corpus.clips);
    let people = by_person(&corpus.clips);
    assert!(people.len() >= 6);
    all_hold(&people);
}

#[test]
fn contacts_of_every_person_hold_where_the_body_is_known_and_the_clip_stands() {
    let Some(mut corpus) = corpus(&["path=cmu/neutral_walk/*"]) else {
        return;
    };
    // Nobody stands in these: what is held is a step, so on the body as it was put together from the walk.
    for clip in &mut corpus.clips {
        let motion = &mut clip.retargeted;
        let at = motion.first_frame;
        let stands = motion.clip.poses[at].clone();
        let frames = (20.0 * motion.clip.frame_rate_hz) as usize;
        let poses = &mut motion.clip.poses;
        poses.splice(at..at, std::iter::repeat_n(stands, frames));
    }
    let people = by_person(&corpus.clips);
    assert!(people.len() >= 12);
    all_hold(&people);
}

#[test]
fn switches_of_every_person_are_the_contacts() {
    let Some(mut corpus) = corpus(&["path=*/neutral_walk/*"]) else {
        return;
    };
    if let Some(styled) = self::corpus(&["path=*/styled_walk/*"]) {
        corpus.clips.extend(styled.clips);
    }
    let of = |landing: Landing| {
        let mut people: BTreeMap<String, Agreement> = BTreeMap::new();
        for clip in &corpus.clips {
            let motion = &clip.retargeted;
            let rate = motion.clip.frame_rate_hz;
            let switches =
                detect_switches_by(&motion.clip, motion.first_frame, &SwitchConfig::by(landing))
                    .unwrap();
            let switches: Vec<GaitEvent> = switches.iter().map(|switch| switch.event()).collect();
            let (known, inside) = (detected(clip), inside(clip, 0.1));
            let person = people.entry(clip.row.subject().to_owned()).or_default();
            for side in Side::BOTH {
                let of = |events: &[GaitEvent]| {
                    times(events, (side, EventKind::InitialContact), rate, &inside)
                };
                person.add(&of(&known), &of(&switches), SWITCH_SECS);
            }
        }
        people
    };
    let by_legs = of(Landing::Legs);
    assert!(by_legs.len() >= 9);
    for (person, agreement) in &by_legs {
        let f1 = agreement.f1();
        println!("{person}: {} switches, F1 {f1:.3}", agreement.known);
        assert!(f1 >= 0.9, "{person}: F1 {f1}");
        // No shift of a person's own.
        let delay = agreement.mean_delay();
        assert!(delay.abs() < 0.02, "{person}: {delay} s");
    }
    // The legs are what places them: without, the half cycles are early or late.
    let worst = |people: &BTreeMap<String, Agreement>| {
        people.values().map(Agreement::f1).fold(1.0, f64::min)
    };
    assert!(worst(&of(Landing::HalfCycle)) < 0.5);
}
