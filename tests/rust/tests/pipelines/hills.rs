//! Runs over hills and blocks: where it is not steep they go on as runs, and hips, feet and knees go as smoothly as on level ground.

use core::f32::consts::FRAC_PI_2;
use footfall_core::{Side, Skeleton};
use footfall_synth::Controls;
use footfall_tests::climb::{BODIES, Climb, DT, Outcome, Way, percentile, walker};
use footfall_tests::terrain::Relief;
use footfall_tests::walkers::most_acceleration;
use glam::Vec3;

/// Distance to the ground that is not level, metres: the run has its speed by then.
const DISTANCE_M: f32 = 6.0;

/// A run, and the share of frames without a standing foot from 2 m to 10 m behind the first edge.
fn run(climb: &Climb) -> (Outcome, f32) {
    let (mut flying, mut frames) = (0, 0);
    let outcome = climb.watch(|_, walker| {
        if (2.0..10.0).contains(&(walker.hips().z - climb.distance_m)) {
            frames += 1;
            flying += usize::from(walker.placer.feet().iter().all(|foot| !foot.locked));
        }
    });
    (outcome, flying as f32 / frames as f32)
}

const fn ramp(slope: f32) -> Way {
    Way::Ramp {
        slope,
        length: 12.0,
    }
}

fn runner(way: Way, speed_mps: f32) -> Climb {
    Climb {
        runs: true,
        ..Climb::adult(way, DISTANCE_M, speed_mps)
    }
}

/// Expects that nothing goes wrong: level runs of 5 m/s accelerate hips by 18 m/s² in 99 frames of a hundred, and ankles change their way by 6 cm in a frame.
fn expect_smooth(climb: &Climb, outcome: &Outcome, jump_m: f32) {
    assert!(outcome.faults.is_empty(), "{climb:?}: {:?}", outcome.faults);
    assert!(outcome.slip < 0.001, "{climb:?}: {} m/s", outcome.slip);
    let hips = percentile(&outcome.acceleration, 0.99);
    assert!(hips < 25.0, "{climb:?}: {hips} m/s²");
    assert!(outcome.jump < jump_m, "{climb:?}: {} m", outcome.jump);
    let bend = outcome.bend.to_degrees();
    assert!(bend < 155.0, "{climb:?}: {bend}°");
}

#[test]
fn runners_go_on_running_up_and_down_slopes() {
    for body in BODIES {
        for speed_mps in [3.5, 5.0] {
            for slope in [-0.21, -0.14, -0.07, 0.07, 0.14] {
                let way = ramp(slope);
                let climb = Climb {
                    body,
                    ..runner(way, speed_mps)
                };
                let (outcome, flight) = run(&climb);
                expect_smooth(&climb, &outcome, 0.075);
                assert!(flight > 0.2, "{climb:?}: {flight} of the frames");
                assert!(outcome.knee < 2500.0, "{climb:?}: {} rad/s²", outcome.knee);
            }
        }
    }
}

#[test]
fn nobody_runs_up_what_is_steep() {
    for slope in [-0.4, 0.4] {
        let way = ramp(slope);
        let climb = runner(way, 3.5);
        let (outcome, flight) = run(&climb);
        expect_smooth(&climb, &outcome, 0.075);
        assert!(flight < 0.02, "{climb:?}: {flight} of the frames");
    }
}

#[test]
fn hills_and_blocks_are_run_over_smoothly() {
    for seed in 0..4 {
        let hills = [0.5, 1.0, 2.0].map(|height| Way::Hills { height, seed });
        let blocks = [0.06, 0.15].map(|height| Way::Blocks { height, seed });
        for way in hills.into_iter().chain(blocks) {
            for speed_mps in [2.4, 3.5, 5.0] {
                let climb = Climb {
                    seed: 7 + u64::from(seed),
                    ..runner(way, speed_mps)
                };
                let (outcome, _) = run(&climb);
                expect_smooth(&climb, &outcome, 0.11);
            }
        }
    }
}

#[test]
fn knees_bend_on_slopes_little_more_than_on_level_ground() {
    // On level ground it is 68 to 75°.
    for (slope, most) in [(0.14, 85.0), (0.364, 100.0), (-0.14, 92.0), (-0.364, 103.0)] {
        let way = ramp(slope);
        for speed_mps in [0.8, 1.3, 2.0] {
            let climb = Climb::adult(way, DISTANCE_M, speed_mps);
            let bend = climb.walk().bend.to_degrees();
            assert!(bend < most, "{climb:?}: {bend}°");
        }
    }
}

/// From a stroll to a brisk walk.
fn walks(slope: f32) -> impl Iterator<Item = Climb> {
    [0.8, 1.3, 1.6]
        .map(|speed_mps| Climb::adult(ramp(slope), DISTANCE_M, speed_mps))
        .into_iter()
}

/// Flexion of the knees on a slope in the frames in which feet land, least of it while one foot stands, and that in the middle of this time: medians,
/// degrees.
fn knees_on_slope(climb: &Climb) -> [f32; 3] {
    let mut landing = Vec::new();
    let mut straightest = Vec::new();
    let mut middle = Vec::new();
    let mut alone: [Vec<f32>; 2] = Default::default();
    climb.watch(|_, walker| {
        let feet = walker.placer.feet();
        let is_on_slope = (2.0..10.0).contains(&(walker.hips().z - climb.distance_m));
        for side in Side::BOTH {
            let (index, knee) = (side.index(), walker.knee(side).to_degrees());
            if feet[index].landed {
                alone[index].clear();
                if is_on_slope {
                    landing.push(knee);
                }
            }
            if feet[index].locked && !feet[1 - index].locked {
                alone[index].push(knee);
            }
            if feet[1 - index].landed && is_on_slope && !alone[index].is_empty() {
                straightest.push(alone[index].iter().copied().fold(f32::MAX, f32::min));
                middle.push(alone[index][alone[index].len() / 2]);
            }
        }
    });
    [landing, straightest, middle].map(|knees| percentile(&knees, 0.5))
}

#[test]
fn knees_straighten_uphill_as_on_level_ground() {
    for (slope, most) in [(0.0, 18.0), (0.05, 30.0), (0.14, 42.0), (0.25, 54.0)] {
        for climb in walks(slope) {
            let [landing, straightest, _] = knees_on_slope(&climb);
            assert!(landing < most, "{climb:?}: lands on a knee of {landing}°");
            assert!(
                straightest < 12.0,
                "{climb:?}: stands on a knee of {straightest}°"
            );
        }
    }
}

#[test]
fn who_goes_downhill_stands_on_a_leg_that_is_little_bent() {
    for (slope, most) in [(-0.05, 30.0), (-0.14, 42.0), (-0.25, 47.0), (-0.364, 51.0)] {
        for climb in walks(slope) {
            let [_, _, middle] = knees_on_slope(&climb);
            assert!(middle < most, "{climb:?}: stands on a knee of {middle}°");
        }
    }
}

/// Farthest that an ankle jumps beyond how it moved the frame before, metres, of somebody who is asked for something else again and again, also in mid-swing. The hips
/// of its animation stay at a height between that over a deeply bent knee and that of a leap.
fn jump_of_the_restless(way: Way, seed: u16) -> f32 {
    const SPEEDS: [f32; 6] = [0.0, 1.2, 4.5, 2.6, 0.4, 3.4];
    const TURNS: [f32; 5] = [0.0, -1.4, 0.0, 1.8, 0.6];
    const DIRECTIONS: [f32; 3] = [0.0, 3.5, 1.6];
    let mut terrain = Relief::still(move |x, z| way.height(x, z.rem_euclid(way.length())));
    let mut walker = walker(&Skeleton::standard(), u64::from(seed) + 1);
    let mut controls = Controls::STAND;
    let mut ankles: Vec<[Vec3; 2]> = Vec::new();
    for frame in 0..900_usize {
        let (change, since) = (frame / 41, frame % 41);
        if since == 0 {
            let turn = change + usize::from(seed);
            controls.speed_mps = SPEEDS[turn % SPEEDS.len()];
            controls.turn_rate_radps = TURNS[turn % TURNS.len()];
            let slow = controls.speed_mps < 1.5;
            controls.direction_rad = if slow {
                DIRECTIONS[turn % DIRECTIONS.len()]
            } else {
                0.0
            };
        }
        walker.climb(DT, controls, &mut terrain, true);
        let hips = walker.animated.root_position.y;
        assert!(
            frame < 60 || (0.66..1.2).contains(&hips),
            "{way:?}, seed {seed}, frame {frame}: hips at {hips} m"
        );
        ankles.push(Side::BOTH.map(|side| walker.world.position(side.foot())));
    }
    let jumps = ankles[60..]
        .windows(3)
        .flat_map(|at| [0, 1].map(|foot| (at[0][foot] - 2.0 * at[1][foot] + at[2][foot]).length()));
    jumps.fold(0.0, f32::max)
}

#[test]
fn no_foot_jumps_when_a_step_is_planned_anew() {
    for seed in 0..64_u16 {
        let hills = Way::Hills {
            height: 1.0,
            seed: seed.into(),
        };
        let blocks = Way::Blocks {
            height: 0.1,
            seed: seed.into(),
        };
        // Edges in the way of a foot lift it within some frames.
        for (way, most_m) in [(Way::Level, 0.08), (hills, 0.08), (blocks, 0.2)] {
            let jump = jump_of_the_restless(way, seed);
            assert!(jump < most_m, "{way:?}, seed {seed}: {jump} m");
        }
    }
}

/// A runner's foot is high in the middle of its way, toes that point straight down point neither ahead nor back, and a foot with little time to come down
/// gets up its hurry.
#[test]
fn kerbs_are_crossed_without_a_kick() {
    for (body, height_m, speed_mps, direction_rad) in [
        (0.65, 0.15, 3.2, 0.0),
        (0.65, 0.1, 3.2, 0.0),
        (1.0, 0.23, 4.0, 0.0),
        (0.65, 0.15, 0.8, FRAC_PI_2),
    ] {
        let skeleton = Skeleton::standard().scaled(body);
        let (aside, ahead) = f32::sin_cos(direction_rad);
        for seed in 1..13 {
            let from = 1.0 + (0.37 * seed as f32).fract();
            let mut terrain = Relief::still(move |x, z| {
                let way = x * aside + z * ahead - from;
                if way > 0.0 && way.rem_euclid(4.0) < 2.0 {
                    height_m
                } else {
                    0.0
                }
            });
            let mut walker = walker(&skeleton, seed);
            walker.generator.stand();
            let controls = Controls {
                speed_mps,
                direction_rad,
                ..Controls::STAND
            };
            let mut toes = Side::BOTH.map(|_| vec![]);
            for _ in 0..600 {
                walker.climb(DT, controls, &mut terrain, true);
                for side in Side::BOTH {
                    toes[side.index()].push(walker.world.position(side.toes()));
                }
            }
            for places in toes {
                let most = most_acceleration(&places) / body;
                assert!(
                    most < 450.0,
                    "body {body}, {height_m} m, {direction_rad}, seed {seed}: {most} m/s²"
                );
            }
        }
    }
}
