//! Messages that no honest peer sends.

use crate::link::{GUEST, Link, places, wander};
use footfall_model::{GaitModel, GaitStyle};
use footfall_rig::crowd::{
    Crowd, CrowdRecipe, CrowdReplicaError, CrowdSender, CrowdSettings, Routing,
};
use proptest::prelude::*;
use std::sync::Arc;

/// A crowd that has followed another for a while, and all messages that were sent to it.
fn followed() -> (Link, Vec<Vec<u8>>) {
    let mut link = Link::new(wander(), 8);
    link.loss = 0.0;
    link.delay_secs = 0.0;
    link.join();
    let mut sent = Vec::new();
    for _ in 0..60 {
        link.frame();
        sent.extend(
            link.sender
                .messages()
                .iter()
                .map(|message| message.bytes.clone()),
        );
    }
    (link, sent)
}

#[test]
fn messages_of_others_are_refused_and_change_nothing() {
    let (mut link, sent) = followed();
    let people = sent
        .iter()
        .find(|bytes| bytes[0] & 0x0f == 1)
        .expect("people");
    let steps = sent.iter().rfind(|bytes| bytes.len() > 24).expect("steps");
    let before = places(&link.there);
    let mut hear = |bytes: &[u8]| link.there.hear(bytes);

    let cut = &steps[..steps.len() - 3];
    assert_eq!(hear(cut), Err(CrowdReplicaError::Damaged(cut.len())));
    assert_eq!(hear(&[]), Err(CrowdReplicaError::Damaged(0)));
    assert_eq!(
        hear(&people[..people.len() - 2]),
        Err(CrowdReplicaError::Damaged(people.len() - 2))
    );
    let long = [steps.as_slice(), &[0; 1900]].concat();
    assert_eq!(hear(&long), Err(CrowdReplicaError::Damaged(long.len())));
    let mut newer = steps.clone();
    newer[0] = 0x20;
    assert_eq!(hear(&newer), Err(CrowdReplicaError::Format(2)));
    let mut other = people.clone();
    other[3] ^= 1;
    assert_eq!(hear(&other), Err(CrowdReplicaError::OtherModel));
    // Steps of a crowd that nobody has introduced are passed over.
    let mut strange = steps.clone();
    strange[1] ^= 1;
    assert_eq!(hear(&strange), Ok(Vec::new()));
    assert_eq!(places(&link.there), before);
    for message in [
        CrowdReplicaError::Damaged(3),
        CrowdReplicaError::Format(2),
        CrowdReplicaError::OtherModel,
        CrowdReplicaError::Nonsense,
        CrowdReplicaError::TooMany,
        CrowdReplicaError::Flood(1),
    ] {
        assert!(
            message.to_string().contains("; "),
            "{message}: and what next?"
        );
    }
}

#[test]
fn a_flood_is_cut_off_and_others_are_heard_again_later() {
    let (mut link, sent) = followed();
    let steps = sent.last().expect("steps");
    let mut heard = 0_usize;
    let refused = loop {
        match link.there.hear(steps) {
            Ok(_) => heard += steps.len(),
            Err(error) => break error,
        }
        assert!(heard < 20_000_000, "nothing is refused");
    };
    assert!(matches!(refused, CrowdReplicaError::Flood(_)));
    for _ in 0..60 {
        link.there.begin_all().expect("a walk");
        link.there.advance(1.0 / 60.0, true);
    }
    assert!(link.there.hear(steps).is_ok());
}

#[test]
fn crowds_of_other_styles_are_refused() {
    let (link, sent) = followed();
    let people = sent
        .iter()
        .find(|bytes| bytes[0] & 0x0f == 1)
        .expect("people");
    let root = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../addons/footfall/models/"
    );
    let read = |name: &str| std::fs::read(format!("{root}{name}")).expect("a file of the add-on");
    let model = Arc::new(GaitModel::from_bytes(&read("locomotion.footfall")).expect("a walk"));
    let style = GaitStyle::from_bytes(&read("sad.footstyle")).expect("a style");
    let body = model.skeleton.clone();
    let recipe = CrowdRecipe {
        model,
        styles: vec![Arc::new(style)],
        space: None,
        body,
    };
    let mut styled = Crowd::new(recipe, Routing::Scripted, CrowdSettings::default());
    assert_eq!(styled.hear(people), Ok(Vec::new()), "it follows nobody");
    styled.follow();
    assert_eq!(styled.hear(people), Err(CrowdReplicaError::OtherModel));
    assert!(!styled.is_introduced() && link.there.is_introduced());
}

#[test]
fn a_crowd_that_was_made_anew_takes_the_place_of_the_one_before() {
    let (mut link, _) = followed();
    assert_eq!(places(&link.there).len(), 8);
    link.here = crate::link::crowd(wander());
    link.here.repeats = false;
    link.here.set_count(5);
    link.sender = CrowdSender::new(2);
    link.sender.join(GUEST);
    // Each is shown from its next step on; the slowest of them take more than a second for one.
    link.walk(2.5);
    assert_eq!(places(&link.there).len(), 5);
    link.walk(1.0);
    let off = link.shares(link.secs - 1.0);
    assert!(off[3] < 0.05, "{off:?}");
}

#[test]
fn who_leaves_is_told_no_more_and_who_asks_often_gets_no_more() {
    let (mut link, _) = followed();
    let mut people = 0;
    for _ in 0..120 {
        link.join();
        link.frame();
        people += link
            .sender
            .messages()
            .iter()
            .filter(|message| message.reliable)
            .count();
    }
    assert!(people <= 3, "{people} introductions in two seconds");
    link.sender.leave(GUEST);
    link.frame();
    assert_eq!(link.sender.messages(), []);
    assert_eq!(link.sender.peers().count(), 0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_bytes_are_heard_or_refused_and_walkers_stay_somewhere(
        damage in proptest::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), any::<u8>()), 1..60),
        noise in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 0..80), 0..8),
    ) {
        let (mut link, mut sent) = followed();
        for (message, at, byte) in damage {
            let message = message.index(sent.len());
            let bytes = &mut sent[message];
            // Past what says whose it is, so that most of it is read.
            let at = 3 + at.index(bytes.len() - 3);
            bytes[at] = byte;
        }
        for noise in noise {
            sent.push([&[0x10 + (noise.len() % 3) as u8, 1, 0], noise.as_slice()].concat());
        }
        for bytes in &sent {
            let _heard_or_refused = link.there.hear(bytes);
        }
        for _ in 0..60 {
            link.there.begin_all().expect("a walk");
            link.there.advance(1.0 / 60.0, true);
        }
        for place in places(&link.there).values() {
            prop_assert!(place.is_finite(), "{}", place);
        }
    }
}
