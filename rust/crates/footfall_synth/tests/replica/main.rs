//! Walkers over a network: one that is walked here makes the same steps there, whatever the network does.
//!
//! The link delays every update by 200 ms and up to 10 more, and loses one in twenty.

#![expect(clippy::unwrap_used, reason = "tests may fail")]
#![expect(clippy::disallowed_methods, reason = "the shipped walk is a file")]

mod link;
mod strangers;

use core::f32::consts::PI;
use footfall_core::{GroundTransform, Joint, Pose};
use footfall_synth::Controls;
use footfall_synth::replica::WalkSender;
use glam::Vec3;
use link::{Body, DT, Link, differences, farthest, slid_at_join, slip, walking};

/// Footsteps agree within this, metres.
const SAME_PLACE_M: f32 = 0.05;

/// A foot that stands keeps within this, m/s.
const MOST_SLIP_MPS: f32 = 0.005;

/// The rest of a stance in whose middle the walk begins slides no farther than this, beside the whole ones that follow. Frames of this machine lie between the model's, so
/// that a rolling foot seems to slide by up to 4 mm in each.
const SLID_AT_JOIN: f32 = 1.4;

/// So long after a join steps agree, seconds: the delay of the link and a step.
const JOINED_SECS: f32 = 1.2;

fn assert_same_steps(link: &Link, from_secs: f32, least: usize) {
    let differences = differences(link, from_secs);
    assert!(
        differences.len() >= least,
        "only {} steps",
        differences.len()
    );
    let most = differences.iter().copied().fold(0.0, f32::max);
    assert!(most < SAME_PLACE_M, "a step is {most} m from the sender's");
}

fn anew(link: &Link) -> usize {
    link.there.frames.iter().filter(|frame| frame.anew).count()
}

/// Controls of a player who changes everything a little in every frame, and much every second.
fn played(secs: f32) -> Controls {
    let speed = 1.2 + 1.4 * (0.9 * secs).sin() + 0.3 * (5.0 * secs).sin();
    Controls {
        turn_rate_radps: 1.2 * (0.7 * secs).sin(),
        direction_rad: 0.4 * (1.3 * secs).sin(),
        ..walking(speed.max(0.0))
    }
}

fn play(link: &mut Link, secs: f32) {
    for frame in 0..(secs / DT) as usize {
        link.frame(&played(frame as f32 * DT));
    }
}

/// Slip of a walker that is played without a network, in frames half way between the model's, as the frames of a machine that hears of a walk may be.
fn slip_alone(seed: u64, secs: f32) -> f32 {
    let config = Link::new(seed).identity.config();
    let mut alone = Body::new(&config, GroundTransform::default());
    let mut now = 0.0;
    let mut dt_secs = 0.5 * DT;
    while now < secs {
        now += dt_secs;
        let controls = played(now);
        alone.generator.step(dt_secs, &controls, &mut alone.pose);
        alone.show(now, false);
        dt_secs = DT;
    }
    slip(&alone.frames, DT)
}

#[test]
fn steps_agree_whatever_is_walked() {
    for seed in 1..5 {
        let mut link = Link::new(seed);
        link.walk(&walking(1.3), 6.0);
        let turning = Controls {
            turn_rate_radps: 0.6,
            ..walking(1.3)
        };
        link.walk(&turning, 4.0);
        link.walk(&Controls::STAND, 3.0);
        link.walk(&walking(3.2), 6.0);
        link.walk(&walking(1.0), 4.0);
        let sideways = Controls {
            direction_rad: PI / 2.0,
            ..walking(0.7)
        };
        link.walk(&sideways, 4.0);
        link.walk(&Controls::STAND, 3.0);
        assert_same_steps(&link, JOINED_SECS, 45);
        assert_eq!(anew(&link), 1, "seed {seed}");
        let [here, there] = [link.here.place(), link.there.place()];
        let off = here.position.distance(there.position);
        assert!(
            off < 0.02 && (here.heading - there.heading).abs() < 0.01,
            "{off} m"
        );
    }
}

#[test]
fn steps_agree_with_a_player_who_never_keeps_still() {
    // The slip of one player depends on where its frames lie between the model's, so that all who are compared count together.
    let (mut there, mut alone) = (Vec::new(), Vec::new());
    for seed in (1..41).chain([79, 97, 127, 139, 236, 345]) {
        let mut link = Link::new(seed);
        play(&mut link, 40.0);
        assert_same_steps(&link, JOINED_SECS, 45);
        assert_eq!(anew(&link), 1, "seed {seed}");
        if seed <= 8 {
            there.push(slip(&link.there.frames, DT));
            alone.push(slip_alone(seed, 40.0));
        }
    }
    let most = |slips: &[f32]| slips.iter().copied().fold(0.0, f32::max);
    assert!(
        most(&there) < 1.05 * most(&alone) && there.iter().sum::<f32>() < alone.iter().sum(),
        "feet slip at {there:?} m/s with a network, at {alone:?} without"
    );
}

#[test]
fn whoever_joins_late_makes_the_same_steps_within_a_second() {
    for (seed, speed) in (1..25).zip([1.3, 3.3, 0.8].into_iter().cycle()) {
        let mut link = Link::new(seed);
        link.joined = false;
        link.walk(&walking(speed), 60.0 + 0.1 * seed as f32);
        link.joined = true;
        let joined_secs = link.secs;
        link.walk(&walking(speed), 6.0);
        assert_same_steps(&link, joined_secs + JOINED_SECS, 6);
        assert_eq!(anew(&link), 1, "seed {seed}");
        let [slid, whole] = slid_at_join(&link.there.frames);
        assert!(
            slid < SLID_AT_JOIN * whole,
            "seed {seed}: a foot slides by {slid} m, and by {whole} m in whole stances"
        );
    }
}

#[test]
fn machines_of_any_frame_rate_agree() {
    for fps in [15.0, 30.0, 144.0] {
        for seed in [2, 7, 24] {
            let mut link = Link::new(seed);
            link.their_dt = 1.0 / fps;
            play(&mut link, 20.0);
            assert_same_steps(&link, JOINED_SECS, 30);
        }
    }
}

/// A wall, a push of the physics or a correction of the game: the body is where the walk alone would not have brought it.
#[test]
fn what_parts_them_is_walked_off_on_feet_that_stand() {
    for seed in 1..5 {
        let mut link = Link::new(seed);
        link.walk(&walking(1.3), 6.0);
        let undisturbed = farthest(&link.there.frames, Joint::Hips);
        link.here.shared_from_start.position.x += 0.45;
        let (moved_secs, moved_at) = (link.secs, link.there.frames.len());
        link.walk(&walking(1.3), 6.0);
        assert_eq!(anew(&link), 1, "seed {seed}: walked off");
        // Three steps of at most 0.2 m, and the delay.
        assert_same_steps(&link, moved_secs + 3.0, 5);
        let hips = farthest(&link.there.frames, Joint::Hips);
        assert!(
            hips < 2.0 * undisturbed,
            "hips go {hips} m in a frame, {undisturbed} before"
        );
        let slip = slip(&link.there.frames[moved_at..], DT);
        assert!(
            slip < MOST_SLIP_MPS,
            "seed {seed}: a foot slips at {slip} m/s"
        );
    }
}

#[test]
fn whoever_rests_beside_the_place_steps_over() {
    for seed in 1..5 {
        let mut link = Link::new(seed);
        link.walk(&walking(1.3), 4.0);
        link.walk(&Controls::STAND, 3.0);
        link.here.shared_from_start.position.z += 0.3;
        let (steps, moved_at) = (link.there.prints.len(), link.there.frames.len());
        link.walk(&Controls::STAND, 6.0);
        assert!(link.there.prints.len() > steps, "seed {seed}");
        let off = link
            .here
            .place()
            .position
            .distance(link.there.place().position);
        assert!(off < 0.04, "seed {seed}: {off} m");
        let slip = slip(&link.there.frames[moved_at..], DT);
        assert!(
            slip < MOST_SLIP_MPS,
            "seed {seed}: a foot slips at {slip} m/s"
        );
        // And the walk goes on in step.
        let rested_secs = link.secs;
        link.walk(&walking(1.3), 5.0);
        assert_same_steps(&link, rested_secs, 6);
        assert_eq!(anew(&link), 1, "seed {seed}");
    }
}

/// Nothing comes while the sender stops, so that the follower walks on; then it comes back.
#[test]
fn a_stop_that_was_lost_is_made_good() {
    for seed in 1..5 {
        let mut link = Link::new(seed);
        link.walk(&walking(1.3), 4.0 + 0.09 * seed as f32);
        link.loss = 1.0;
        link.walk(&Controls::STAND, 0.45);
        link.loss = 0.05;
        link.walk(&Controls::STAND, 6.0);
        let off = link
            .here
            .place()
            .position
            .distance(link.there.place().position);
        assert!(
            off < 0.04 && link.there.generator.is_standing(),
            "seed {seed}: {off} m"
        );
        let gone_secs = link.secs;
        link.walk(&walking(1.3), 5.0);
        assert_same_steps(&link, gone_secs + JOINED_SECS, 5);
    }
}

#[test]
fn a_jump_through_the_level_is_one_cut() {
    let mut link = Link::new(2);
    link.walk(&walking(1.3), 5.0);
    link.here.shared_from_start.position.z += 300.0;
    let moved_secs = link.secs;
    // The game sends the identity reliably, and later than the first update.
    link.walk(&walking(1.3), 0.5);
    assert!(link.refused > 3, "they belong to a walker who is elsewhere");
    let identity = link.sender.identity(&link.here.generator).unwrap();
    assert!(identity != link.identity && identity.is_same_walker(&link.identity));
    link.follower.become_walker(&identity).unwrap();
    link.walk(&walking(1.3), 5.0);
    assert_eq!(anew(&link), 2);
    assert_same_steps(&link, moved_secs + 0.5 + JOINED_SECS, 5);
}

/// Off both feet, up and to a place, and as a leap of a run: as high there as here, and no cut.
#[test]
fn jumps_are_made_there_too() {
    for seed in 1..4 {
        let mut link = Link::new(seed);
        link.walk(&Controls::STAND, 3.0);
        let highest = |frames: &[link::Frame]| {
            let heights = frames
                .iter()
                .map(|frame| frame.model.position(Joint::Hips).y);
            heights.fold(0.0, f32::max)
        };
        let mut from = link.here.frames.len();
        for way in [Vec3::ZERO, Vec3::new(0.0, 0.0, 1.3)] {
            if way == Vec3::ZERO {
                link.here.generator.jump(0.35);
            } else {
                link.here.generator.jump_to(way);
            }
            link.walk(&Controls::STAND, 3.0);
            let [here, there] = [&link.here, &link.there].map(|body| highest(&body.frames[from..]));
            assert!(
                here > 1.2 && (here - there).abs() < 0.03,
                "{way}: {here} m here, {there} there"
            );
            let off = link
                .here
                .place()
                .position
                .distance(link.there.place().position);
            assert!(off < 0.05, "{way}: {off} m after it");
            from = link.here.frames.len();
        }
        link.walk(&walking(3.0), 4.0);
        link.here.generator.jump(0.3);
        link.walk(&walking(3.0), 3.0);
        let [here, there] = [&link.here, &link.there].map(|body| highest(&body.frames[from..]));
        assert!(
            (here - there).abs() < 0.03,
            "a leap: {here} m here, {there} there"
        );
        assert_same_steps(&link, JOINED_SECS, 15);
        assert_eq!(anew(&link), 1, "seed {seed}");
    }
}

/// Carried away as it stands, as by a lift of the physics: too far to step there.
#[test]
fn whoever_is_carried_far_as_it_rests_is_set_there() {
    let mut link = Link::new(1);
    link.walk(&Controls::STAND, 2.0);
    link.here.shared_from_start.position.x += 2.0;
    link.walk(&Controls::STAND, 2.0);
    assert_eq!(anew(&link), 2);
    let off = link
        .here
        .place()
        .position
        .distance(link.there.place().position);
    assert!(off < 0.02, "{off} m");
}

#[test]
fn whoever_hears_nothing_more_comes_to_a_stand() {
    let mut link = Link::new(3);
    link.walk(&walking(1.3), 4.0);
    link.loss = 1.0;
    link.walk(&walking(1.3), 6.0);
    assert!(link.there.generator.is_standing());
    assert!(
        link.there
            .frames
            .iter()
            .all(|frame| frame.model.position(Joint::Hips).is_finite())
    );
}

/// A machine that loads something stands still, and its walkers with it. Others are ahead of it by a step, which they make good by slower ones, or by more, and begin anew.
#[test]
fn who_stood_still_finds_the_steps_again() {
    let speeds = [(0, 1.3), (1, 0.8), (2, 3.0)];
    let machines = [[true, false], [false, true]];
    for (pauses, secs) in machines
        .map(|pauses| [0.7, 2.0].map(|secs| (pauses, secs)))
        .concat()
    {
        for (seed, speed_mps) in speeds {
            let mut link = Link::new(seed);
            let controls = Controls {
                turn_rate_radps: 0.4,
                ..walking(speed_mps)
            };
            link.walk(&controls, 5.0);
            link.pauses = pauses;
            link.walk(&controls, secs);
            link.pauses = [false; 2];
            let back = link.secs;
            link.walk(&controls, 14.0);
            assert_same_steps(&link, back + 6.0, 10);
            assert!(anew(&link) <= 2, "at {speed_mps} m/s, {secs} s");
        }
    }
}

/// A replica that is ahead of its sender ends its steps before it hears of them, until it has slowed down enough.
#[test]
fn who_is_ahead_of_a_machine_that_stood_still_waits_for_it() {
    const IN_TIME_SECS: f32 = 2.3;
    for (paused_secs, at_secs) in [(0.4, 1.0), (0.4, 5.0), (0.5, 1.0), (0.5, 5.0)] {
        for seed in 0..6 {
            let mut link = Link::new(seed);
            play(&mut link, at_secs);
            link.pauses = [true, false];
            play(&mut link, paused_secs);
            link.pauses = [false; 2];
            let back = link.secs;
            play(&mut link, 10.0);
            assert_same_steps(&link, back + IN_TIME_SECS, 8);
        }
    }
}

/// A saved follower goes on bit for bit, in the middle of a step that leads it back to its place, and its sender too.
#[test]
fn a_state_holds_what_a_follower_is_made_of() {
    for moment in 0..6 {
        let mut link = Link::new(4);
        link.walk(&walking(1.3), 6.0);
        link.here.shared_from_start.position.x += 0.3;
        link.walk(&walking(1.3), 0.5 + 0.15 * moment as f32);
        for body in [&mut link.here, &mut link.there] {
            let mut restored = link::generator(&link.identity.config());
            restored.restore(&body.generator.state()).unwrap();
            let mut pose = Pose::default();
            for frame in 0..200 {
                let controls = walking(if frame < 100 { 1.3 } else { 0.0 });
                body.generator.step(DT, &controls, &mut body.pose);
                restored.step(DT, &controls, &mut pose);
                assert!(body.pose == pose, "frame {frame}");
            }
            // Its own updates continue, too.
            let start = GroundTransform::default();
            let told = [&body.generator, &restored]
                .map(|walker| WalkSender::new().update(walker, &start).unwrap());
            assert_eq!(told[0], told[1]);
        }
    }
}
