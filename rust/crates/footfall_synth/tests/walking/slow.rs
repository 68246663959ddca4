//! Slow walks, and steps on the spot: hips that neither jolt nor sink, and feet that are lifted no higher than people lift them.

use crate::quick::hardest;
use crate::world::{Frame, Kind, generator, knee, landing_knees, run, walking};
use footfall_core::{Joint, Side, Skeleton};
use footfall_synth::Controls;

/// Frames of a walker who has settled into these controls.
fn settled(seed: u64, controls: &Controls) -> Vec<Frame> {
    let skeleton = Skeleton::standard();
    let mut walker = generator(Kind::Styled, seed);
    run(&mut walker, &skeleton, controls, 200);
    run(&mut walker, &skeleton, controls, 600).0
}

/// A leg that trails behind raises its heel; with a flat foot it would pull the hips down onto a bent knee.
#[test]
fn hips_do_not_sink_before_a_foot_lands() {
    for speed in [0.4, 0.6, 0.8, 1.0] {
        for seed in 1..25 {
            let frames = settled(seed, &walking(speed));
            let hardest = hardest(&frames, Joint::Hips);
            assert!(hardest < 14.0, "{speed} m/s, seed {seed}: {hardest} m/s²");
            let knees = landing_knees(&frames);
            assert!(knees.len() > 8, "{speed} m/s, seed {seed}: {knees:?}");
            for knee in knees {
                assert!(
                    knee < 26.0,
                    "{speed} m/s, seed {seed}: lands on a knee of {knee}°"
                );
            }
        }
    }
}

/// People who turn on the spot bend their knees by 30 to 45° and keep their feet flat (`TurnOnSpot1` of the O3DE takes).
#[test]
fn feet_are_lifted_less_on_the_spot() {
    let peak = |controls: &Controls| {
        let peaks = (1..9).map(|seed| {
            let frames = settled(seed, controls);
            let knees = frames.iter().map(|frame| knee(frame, Side::Left));
            knees.fold(0.0, f32::max)
        });
        peaks.sum::<f32>() / 8.0
    };
    let turning = Controls {
        turn_rate_radps: 1.5,
        ..Controls::STAND
    };
    let spot = peak(&turning);
    assert!((30.0..50.0).contains(&spot), "knees of {spot}° on the spot");
    let [slow, usual] = [0.3, 1.2].map(|speed| peak(&walking(speed)));
    assert!(
        spot < slow && slow < usual,
        "{spot}°, {slow}°, {usual}°: slower steps are lower"
    );
}
