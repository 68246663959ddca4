//! The evaluator sees what is wrong with a walk: a judge that passes everything is none.

use footfall_motion::bvh::{self, BvhFile};
use footfall_tests::data::own_file;
use footfall_tests::evaluator::evaluate;

fn walk() -> BvhFile {
    bvh::read(own_file("walker_1_slow.bvh")).expect("our own recording")
}

/// Adds to one channel of the root in every frame.
fn shifted(mut file: BvhFile, channel: usize, shift: impl Fn(usize) -> f32) -> BvhFile {
    let width = file.channel_count();
    for (frame, row) in file.values.chunks_exact_mut(width).enumerate() {
        row[channel] += shift(frame);
    }
    file
}

#[test]
fn a_good_walk_passes() {
    let quality = evaluate(&walk());
    assert!(quality.median_slip_mps < 0.005, "{quality:?}");
    assert!(quality.penetration_m < 0.01, "{quality:?}");
    assert!((1.0..1.06).contains(&quality.speed_mps), "{quality:?}");
    assert!((1.6..1.66).contains(&quality.cadence_hz), "{quality:?}");
    assert!(
        quality.contacts.iter().all(|contacts| contacts.len() >= 4),
        "{quality:?}"
    );
}

#[test]
fn sliding_feet_are_seen() {
    let file = walk();
    let secs = file.frame_time_secs as f32;
    let quality = evaluate(&shifted(file, 0, |frame| 0.1 * secs * frame as f32));
    assert!(
        (0.097..0.103).contains(&quality.median_slip_mps),
        "{quality:?}"
    );
}

#[test]
fn sunken_feet_are_seen() {
    let good = evaluate(&walk()).penetration_m;
    let quality = evaluate(&shifted(walk(), 1, |_| -0.03));
    assert!(
        (quality.penetration_m - good - 0.03).abs() < 1e-3,
        "{quality:?}"
    );
}

#[test]
fn floating_feet_do_not_stand() {
    let quality = evaluate(&shifted(walk(), 1, |_| 0.1));
    assert!(quality.contacts.iter().all(Vec::is_empty), "{quality:?}");
}

#[test]
fn ripple_of_frame_parity_is_seen() {
    let file = walk();
    // A degree up and down on the left knee's first angle, frame by frame.
    let channel = 6 + 3 * 15;
    let rippled = shifted(
        walk(),
        channel,
        |frame| if frame % 2 == 0 { 0.5 } else { -0.5 },
    );
    assert!(evaluate(&rippled).ripple > evaluate(&file).ripple);
}
