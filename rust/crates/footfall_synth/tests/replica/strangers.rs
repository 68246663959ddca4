//! Peers who send what they should not.

use crate::link::{DT, Link, walking};
use footfall_core::{GroundTransform, Pose};
use footfall_synth::GaitGenerator;
use footfall_synth::replica::{ReplicaError, UPDATE_BYTES, WalkFollower, WalkIdentity, WalkSender};
use glam::Vec3;

/// A change to an update, and the expected error.
type Spoil = Box<dyn Fn(&[u8; UPDATE_BYTES]) -> Vec<u8>>;
type Expected = fn(&ReplicaError) -> bool;

/// A follower in the middle of a walk, and the next update for it.
fn heard() -> (Link, [u8; UPDATE_BYTES]) {
    let mut link = Link::new(5);
    link.walk(&walking(1.3), 3.0);
    link.sender.step(0.5);
    let start = link.here.shared_from_start;
    let next = link.sender.update(&link.here.generator, &start).unwrap();
    (link, next)
}

/// Everything that shows of a follower after a second.
fn course(link: &mut Link) -> Vec<(Pose, GroundTransform)> {
    (0..60)
        .map(|_| {
            let start = link.there.shared_from_start;
            let (follower, there) = (&mut link.follower, &mut link.there);
            let mut pose = Pose::default();
            follower.step(DT, &mut there.generator, &start, &mut pose);
            (pose, there.place())
        })
        .collect()
}

#[test]
fn what_is_refused_changes_nothing() {
    let wrong = |at: usize, value: u8| {
        move |update: &[u8; UPDATE_BYTES]| {
            let mut bytes = update.to_vec();
            bytes[at] = value;
            bytes
        }
    };
    let spoiled: [(Spoil, Expected); 7] = [
        (Box::new(|_| vec![]), |error| {
            *error == ReplicaError::Length(0)
        }),
        (Box::new(|update| update[..23].to_vec()), |error| {
            *error == ReplicaError::Length(23)
        }),
        (Box::new(|update| [&update[..], &[0]].concat()), |error| {
            *error == ReplicaError::Length(25)
        }),
        (Box::new(wrong(0, 0xf0)), |error| {
            *error == ReplicaError::Format(15)
        }),
        (
            Box::new(|update| {
                let mut bytes = update.to_vec();
                bytes[1] ^= 1;
                bytes
            }),
            |error| *error == ReplicaError::OtherWalker,
        ),
        // A time of before.
        (
            Box::new(|update| {
                let mut bytes = update.to_vec();
                let time = u16::from_le_bytes([bytes[3], bytes[4]]).wrapping_sub(400);
                bytes[3..5].copy_from_slice(&time.to_le_bytes());
                bytes
            }),
            |error| *error == ReplicaError::Old,
        ),
        // Eight kilometres away.
        (Box::new(wrong(16, 0x7f)), |error| {
            matches!(error, ReplicaError::TooFar(_))
        }),
    ];
    let (mut undisturbed, _) = heard();
    let expected = course(&mut undisturbed);
    for (index, (spoil, is_expected)) in spoiled.iter().enumerate() {
        let (mut link, next) = heard();
        let refused = link.follower.hear(&spoil(&next), &link.there.generator);
        assert!(
            refused.as_ref().is_err_and(is_expected),
            "{index}: {refused:?}"
        );
        assert!(course(&mut link) == expected, "{index}");
    }
    let (mut link, next) = heard();
    assert_eq!(link.follower.hear(&next, &link.there.generator), Ok(()));
    assert_eq!(
        link.follower.hear(&next, &link.there.generator),
        Err(ReplicaError::Old),
        "the same once more"
    );
}

#[test]
fn a_flood_is_passed_over_and_the_walk_goes_on() {
    let (mut link, _) = heard();
    let start = link.here.shared_from_start;
    let mut refused = 0;
    for _ in 0..5000 {
        link.sender.step(0.005);
        let update = link.sender.update(&link.here.generator, &start).unwrap();
        let heard = link.follower.hear(&update, &link.there.generator);
        refused += usize::from(matches!(heard, Err(ReplicaError::Flood(_))));
    }
    assert!(refused > 4950, "{refused} refused");
    let places = course(&mut link);
    assert!(
        places
            .iter()
            .all(|(_, place)| place.position.distance(start.position) < 8.0)
    );
    for _ in 0..20 {
        let identity = link.identity.clone();
        link.follower.become_walker(&identity).ok();
    }
    assert_eq!(
        link.follower.become_walker(&link.identity),
        Err(ReplicaError::Flood(1))
    );
}

/// A peer who says in every update that it is three metres on.
#[test]
fn who_goes_faster_than_people_is_not_believed() {
    let (mut link, _) = heard();
    let before = link.there.place();
    let mut lying = link.sender;
    let mut start = link.here.shared_from_start;
    let mut refused = 0;
    for _ in 0..40 {
        for _ in 0..3 {
            lying.step(DT);
            link.follower.step(
                DT,
                &mut link.there.generator,
                &link.there.shared_from_start,
                &mut link.there.pose,
            );
        }
        start.position.x += 3.0;
        // Its identity stays, as a liar's would.
        let honest = WalkSender::new()
            .update(&link.here.generator, &start)
            .unwrap();
        let mut update = lying.update(&link.here.generator, &start).unwrap();
        update[1..3].copy_from_slice(&honest[1..3]);
        let heard = link.follower.hear(&update, &link.there.generator);
        refused += usize::from(matches!(heard, Err(ReplicaError::TooFar(_))));
    }
    // In two seconds nobody runs farther than 16 m, and a few are believed at once.
    let gone = link.there.place().position.distance(before.position);
    assert!(refused > 25 && gone < 25.0, "{refused} refused, {gone} m");
}

#[test]
fn bytes_of_others_are_no_identity() {
    let link = Link::new(1);
    let bytes = link.identity.to_bytes();
    assert!(bytes.len() < 40, "{} bytes", bytes.len());
    assert_eq!(
        WalkIdentity::from_bytes(&bytes).as_ref(),
        Ok(&link.identity)
    );
    assert_eq!(WalkIdentity::from_bytes(&[]), Err(ReplicaError::Identity));
    assert_eq!(
        WalkIdentity::from_bytes(&[9; 30]),
        Err(ReplicaError::Format(9))
    );
    assert_eq!(
        WalkIdentity::from_bytes(&bytes[..12]),
        Err(ReplicaError::Identity)
    );
    let nan = |at: usize| {
        let mut bytes = bytes.clone();
        bytes[at..at + 4].copy_from_slice(&f32::NAN.to_le_bytes());
        WalkIdentity::from_bytes(&bytes)
    };
    // Phase and variation stand before the epoch and the styles at the end.
    assert_eq!(nan(bytes.len() - 10), Err(ReplicaError::Identity));
    assert_eq!(nan(bytes.len() - 6), Err(ReplicaError::Identity));
}

#[test]
fn a_walker_that_cannot_be_told_says_so() {
    let link = Link::new(1);
    for far in [Vec3::X * 1e4, Vec3::NAN, Vec3::Y * f32::INFINITY] {
        let start = GroundTransform {
            position: far,
            heading: 0.0,
        };
        let update = WalkSender::new().update(&link.here.generator, &start);
        assert!(
            matches!(update, Err(ReplicaError::OutOfRange(_))),
            "{update:?}"
        );
    }
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../addons/footfall/models/walk.footdyn"
    );
    let bytes = std::fs::read(path).unwrap();
    let model = footfall_model::DynamicsModel::from_bytes(&bytes).unwrap();
    let body = footfall_core::Skeleton::standard();
    let config = link.identity.config();
    let switching = GaitGenerator::switching(&std::sync::Arc::new(model), &body, &config).unwrap();
    assert_eq!(
        WalkSender::new().identity(&switching),
        Err(ReplicaError::Switching)
    );
    assert_eq!(
        link.identity.check(&switching),
        Err(ReplicaError::Switching)
    );
    assert_eq!(link.identity.check(&link.here.generator), Ok(()));
    // A follower without updates stands.
    let mut follower = WalkFollower::new(&link.identity);
    let mut walker = crate::link::generator(&config);
    let mut pose = Pose::default();
    for _ in 0..200 {
        follower.step(DT, &mut walker, &GroundTransform::default(), &mut pose);
    }
    assert!(walker.is_standing());
}
