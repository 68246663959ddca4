//! Climbs from many distances: feet neither lose the ground nor sink in, and bodies do not jerk.
#![expect(
    clippy::print_stdout,
    clippy::expect_used,
    reason = "the whole sweep prints its table, and tests may fail"
)]

use footfall_core::{Side, Skeleton};
use footfall_synth::Controls;
use footfall_tests::climb::{BODIES, Climb, DT, Failure, Fault, Outcome, Way, percentile, walker};
use footfall_tests::terrain::{Origin, Relief};
use std::collections::BTreeMap;
use std::num::NonZero;
use std::thread;

/// Hips are accelerated by less, for 99 frames of a hundred, m/s².
const HIPS_99: f32 = 12.0;
/// No standing foot moves faster along the ground, m/s.
const SLIP_MPS: f32 = 0.001;

/// Observations of many climbs.
#[derive(Default)]
struct Survey {
    climbs: usize,
    failed: usize,
    failures: BTreeMap<Failure, usize>,
    lift: Vec<f32>,
    acceleration: Vec<f32>,
    slip: f32,
    knee: Vec<f32>,
    jump: Vec<f32>,
    /// The worst of every kind.
    worst: BTreeMap<Failure, (Climb, Fault)>,
}

impl Survey {
    fn of(climbs: &[Climb]) -> Self {
        let workers = thread::available_parallelism().map_or(1, NonZero::get);
        let share = climbs.len().div_ceil(workers).max(1);
        let mut survey = Self::default();
        thread::scope(|scope| {
            let parts: Vec<_> = climbs
                .chunks(share)
                .map(|part| {
                    scope.spawn(|| {
                        part.iter()
                            .map(|climb| (*climb, climb.walk()))
                            .collect::<Vec<_>>()
                    })
                })
                .collect();
            for part in parts {
                for (climb, outcome) in part.join().expect("a climb does not panic") {
                    survey.add(climb, &outcome);
                }
            }
        });
        survey
    }

    fn add(&mut self, climb: Climb, outcome: &Outcome) {
        self.climbs += 1;
        self.failed += usize::from(!outcome.faults.is_empty());
        for fault in &outcome.faults {
            *self.failures.entry(fault.failure).or_default() += 1;
        }
        self.lift.extend(&outcome.lift);
        self.acceleration.extend(&outcome.acceleration);
        self.slip = self.slip.max(outcome.slip);
        self.knee.push(outcome.knee);
        self.jump.push(outcome.jump);
        for fault in &outcome.faults {
            let worst = self
                .worst
                .get(&fault.failure)
                .map_or(0.0, |(_, fault)| fault.measure);
            if fault.measure > worst {
                self.worst.insert(fault.failure, (climb, *fault));
            }
        }
    }

    fn line(&self) -> String {
        let max = |values: &[f32]| values.iter().copied().fold(0.0, f32::max);
        format!(
            "{} of {} failed {:?}; hips up and down 99 %: {:.1} (most {:.1}), all ways {:.1} ({:.1}); slip {:.4}; knee {:.0}/{:.0}; jump {:.3}/{:.3}",
            self.failed,
            self.climbs,
            self.failures,
            percentile(&self.lift, 0.99),
            max(&self.lift),
            percentile(&self.acceleration, 0.99),
            max(&self.acceleration),
            self.slip,
            percentile(&self.knee, 0.5),
            max(&self.knee),
            percentile(&self.jump, 0.5),
            max(&self.jump),
        )
    }

    fn show(&self) {
        for (climb, fault) in self.worst.values() {
            println!("    {climb:?}: {fault:?}");
        }
    }

    fn expect_no_fault(&self) {
        self.show();
        assert_eq!(self.failed, 0, "{}", self.line());
        assert!(percentile(&self.lift, 0.99) <= HIPS_99, "{}", self.line());
        assert!(self.slip < SLIP_MPS, "{}", self.line());
    }
}

/// Distances from which the stairs are come upon: a stride of them, spread evenly.
fn distances(count: usize) -> impl Iterator<Item = f32> {
    (0..count).map(move |index| 2.5 + 1.7 * index as f32 / count as f32)
}

const SPEEDS: [f32; 5] = [0.8, 1.0, 1.3, 1.6, 2.0];
const RISES: [f32; 4] = [0.12, 0.15, 0.17, 0.2];
const RUNS: [f32; 4] = [0.28, 0.29, 0.32, 0.4];
const ORIGINS: [Origin; 2] = [Origin::Follows, Origin::Capsule];

/// Climbs of one body over stairs of one rise, from so many distances and at every speed; treads and what carries the body take turns.
fn stairs(body: f32, rise: f32, count: usize) -> Vec<Climb> {
    let mut climbs = vec![];
    for (index, distance_m) in distances(count).enumerate() {
        for speed_mps in SPEEDS {
            climbs.push(Climb {
                body,
                speed_mps,
                way: Way::Stairs {
                    rise,
                    run: RUNS[index % 4],
                },
                distance_m,
                origin: ORIGINS[index / 4 % 2],
                announced: true,
                runs: false,
                seed: index as u64,
            });
        }
    }
    climbs
}

/// The same over other ground; blocks lie differently every time.
fn ground(body: f32, way: Way, count: usize) -> Vec<Climb> {
    let mut climbs = stairs(body, 0.0, count);
    for climb in &mut climbs {
        climb.way = match way {
            Way::Blocks { height, .. } => Way::Blocks {
                height,
                seed: climb.seed as u32,
            },
            way => way,
        };
    }
    climbs
}

const ROUGH: Way = Way::Blocks {
    height: 0.15,
    seed: 0,
};
const RAMPS: [Way; 2] = [ramp(0.466), ramp(-0.466)];

const fn ramp(slope: f32) -> Way {
    Way::Ramp { slope, length: 3.0 }
}

/// Every speed, up and down every rise, with every body, from `FOOTFALL_CLIMBS` distances each; 200 take a quarter of an hour.
#[test]
fn the_whole_sweep() {
    let count = std::env::var("FOOTFALL_CLIMBS")
        .ok()
        .and_then(|value| value.parse().ok());
    let Some(count) = count else {
        let reason =
            "a quarter of an hour; set FOOTFALL_CLIMBS to the number of distances, for example 200";
        footfall_tests::skips::note("the_whole_sweep", reason);
        return;
    };
    let mut whole = Survey::default();
    for body in BODIES {
        for rise in RISES.into_iter().flat_map(|rise| [rise, -rise]) {
            let survey = Survey::of(&stairs(body, rise, count));
            println!("body {body}, rise {rise}: {}", survey.line());
            survey.show();
            whole.merge(survey);
        }
    }
    println!("all stairs: {}", whole.line());
    assert!(100 * whole.failed <= whole.climbs, "{}", whole.line());
    for way in [Way::Level, RAMPS[0], RAMPS[1], ROUGH] {
        for body in BODIES {
            let survey = Survey::of(&ground(body, way, count.div_ceil(4)));
            println!("body {body}, {way:?}: {}", survey.line());
            survey.show();
        }
    }
}

impl Survey {
    fn merge(&mut self, other: Self) {
        self.climbs += other.climbs;
        self.failed += other.failed;
        for (failure, count) in other.failures {
            *self.failures.entry(failure).or_default() += count;
        }
        self.lift.extend(other.lift);
        self.acceleration.extend(other.acceleration);
        self.slip = self.slip.max(other.slip);
        self.knee.extend(other.knee);
        self.jump.extend(other.jump);
        for (failure, (climb, fault)) in other.worst {
            let worst = self
                .worst
                .get(&failure)
                .map_or(0.0, |(_, fault)| fault.measure);
            if fault.measure > worst {
                self.worst.insert(failure, (climb, fault));
            }
        }
    }
}

#[test]
fn nobody_falls_through_stairs() {
    let mut climbs = vec![];
    for (index, distance_m) in distances(240).enumerate() {
        let rise = RISES[index % 4];
        climbs.push(Climb {
            body: BODIES[index / 4 % 3],
            speed_mps: SPEEDS[index % 5],
            way: Way::Stairs {
                rise: if index / 2 % 2 == 0 { rise } else { -rise },
                run: RUNS[index / 12 % 4],
            },
            distance_m,
            origin: ORIGINS[index / 7 % 2],
            announced: true,
            runs: false,
            seed: index as u64,
        });
    }
    Survey::of(&climbs).expect_no_fault();
}

/// Adults of 1.3 m/s on the level go up and down stairs at 0.5 to 0.7 m/s along the slope, one tread a step, without dawdling.
#[test]
fn stairs_are_climbed_at_the_pace_of_people() {
    const TREADS: [f32; 2] = [0.17, 0.29];
    let [rise, run] = TREADS;
    let along = rise.hypot(run) / run;
    for rise in [rise, -rise] {
        for distance_m in distances(12) {
            let outcome = Climb::adult(Way::Stairs { rise, run }, distance_m, 1.3).walk();
            let pace = along * outcome.pace_mps;
            assert!((0.55..0.8).contains(&pace), "{pace} m/s from {distance_m}");
        }
    }
}

#[test]
fn ramps_are_no_stairs() {
    let climbs: Vec<Climb> = RAMPS
        .into_iter()
        .flat_map(|way| ground(1.0, way, 6))
        .collect();
    Survey::of(&climbs).expect_no_fault();
}

/// Blocks have edges on all sides: whole soles find ground, and swinging ones keep clear of what is beside them.
#[test]
fn nobody_is_lost_on_rough_ground() {
    let climbs = BODIES.into_iter().flat_map(|body| ground(body, ROUGH, 10));
    Survey::of(&climbs.collect::<Vec<Climb>>()).expect_no_fault();
}

/// A corner under the side of a sole is left sideways, and the side of a block is no ground that falls away.
#[test]
fn edges_of_blocks_throw_no_swinging_foot() {
    for (body, speed_mps, seed) in [
        (1.0, 2.0, 0),
        (1.0, 2.0, 15),
        (1.25, 1.4, 3),
        (1.25, 1.4, 5),
        (1.0, 1.4, 11),
    ] {
        let way = Way::Blocks {
            height: 0.15,
            seed: seed + 1,
        };
        let climb = Climb {
            body,
            seed: seed.into(),
            ..Climb::adult(way, 2.0, speed_mps)
        };
        let outcome = climb.walk();
        assert!(outcome.jump < 0.07, "{climb:?}: {} m", outcome.jump);
    }
}

/// Turning on stairs swings a foot over several treads, of which these small legs go up three at a time.
#[test]
fn nobody_who_turns_on_stairs_kicks_as_high_as_the_hip() {
    let skeleton = Skeleton::standard().scaled(0.65);
    let least = 0.1 * skeleton.mean_leg_length();
    let kicks = |seed: u64| {
        let from = 1.0 + (0.37 * seed as f32).fract();
        let mut terrain =
            Relief::still(move |_, z| 0.17 * ((z - from) / 0.3 + 1.0).floor().clamp(0.0, 12.0));
        let mut walker = walker(&skeleton, seed);
        walker.generator.stand();
        (0..900).any(|frame| {
            let phase = 1.3 * frame as f32 * DT + 0.31 * seed as f32;
            let controls = Controls {
                speed_mps: 1.2,
                turn_rate_radps: 1.5 * phase.sin(),
                ..Controls::STAND
            };
            walker.climb(DT, controls, &mut terrain, true);
            let height = |joint| walker.world.position(joint).y;
            Side::BOTH
                .into_iter()
                .any(|side| height(side.upper_leg()) - height(side.foot()) < least)
        })
    };
    let kicking: Vec<u64> = (1..161).filter(|seed| kicks(*seed)).collect();
    assert!(kicking.is_empty(), "{kicking:?}");
}

/// All sizes, from a stroll to a hurry.
#[test]
fn hips_go_smoothly_over_rough_ground() {
    for body in BODIES {
        let survey = Survey::of(&ground(body, ROUGH, 12));
        let most = percentile(&survey.lift, 0.99);
        assert!(most <= HIPS_99, "body {body}: {}", survey.line());
    }
}

/// On level ground, too, where a step's end is what jolts.
#[test]
fn hips_go_smoothly_over_level_ground() {
    for body in BODIES {
        let survey = Survey::of(&ground(body, Way::Level, 6));
        let most = percentile(&survey.lift, 0.99);
        assert!(most <= HIPS_99, "body {body}: {}", survey.line());
    }
}

/// Without known landings a foot comes down late, but never to nothing.
#[test]
fn an_animation_that_tells_nothing_does_not_lose_the_ground() {
    let mut climbs: Vec<Climb> = [0.17, -0.17]
        .into_iter()
        .flat_map(|rise| stairs(1.0, rise, 8))
        .collect();
    climbs.retain(|climb| climb.speed_mps < 1.5);
    for climb in &mut climbs {
        climb.announced = false;
    }
    let survey = Survey::of(&climbs);
    survey.show();
    let lost = [
        Failure::GroundLost,
        Failure::FootAboveHip,
        Failure::BodyLeft,
        Failure::Stuck,
    ];
    assert!(
        !survey.failures.keys().any(|failure| lost.contains(failure)),
        "{}",
        survey.line()
    );
}
