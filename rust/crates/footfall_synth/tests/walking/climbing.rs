//! Climbs: walkers lean into the grade that is set.

use crate::world::{DT, Kind, assert_continuous, config, generator, run, space, walking};
use footfall_core::{Joint, Pose, Skeleton};
use footfall_synth::GaitGenerator;
use glam::Vec3;

#[test]
fn whoever_climbs_leans_ahead_without_a_jerk_and_comes_back() {
    let skeleton = Skeleton::standard();
    let mut climber = generator(Kind::Styled, 3);
    let mut walker = generator(Kind::Styled, 3);
    let mut leans = vec![];
    let mut frames = vec![];
    for grade in [0.6, 0.0, f32::NAN] {
        climber.set_grade(grade);
        let (climbed, _) = run(&mut climber, &skeleton, &walking(0.8), 180);
        let (walked, _) = run(&mut walker, &skeleton, &walking(0.8), 180);
        let up = |at: usize| {
            let lean = |frames: &[crate::world::Frame]| {
                (frames[at].model.rotation(Joint::UpperChest) * Vec3::Y)
                    .z
                    .asin()
            };
            lean(&climbed) - lean(&walked)
        };
        leans.push(up(179));
        frames.extend(climbed);
    }
    assert!((0.08..0.13).contains(&leans[0]), "{leans:?}");
    assert!(leans[1].abs() < 1e-3 && leans[2].abs() < 1e-3, "{leans:?}");
    assert_continuous(Kind::Styled, &frames[1..]);
}

#[test]
fn a_climb_goes_on_from_a_saved_state_bit_for_bit() {
    let skeleton = Skeleton::standard();
    let mut first = generator(Kind::Styled, 11);
    run(&mut first, &skeleton, &walking(0.7), 100);
    first.set_grade(0.5);
    run(&mut first, &skeleton, &walking(0.7), 10);
    let mut second = GaitGenerator::new(&space(), &[], &skeleton, &config(2)).unwrap();
    second.restore(&first.state()).unwrap();
    let (mut a, mut b) = (Pose::default(), Pose::default());
    for frame in 0..120 {
        first.step(DT, &walking(0.7), &mut a);
        second.step(DT, &walking(0.7), &mut b);
        assert_eq!(a, b, "frame {frame}");
    }
}
