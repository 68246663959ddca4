//! Stairs as people take them: a tread a step, hips that ride, whole soles on treads, knees no higher than need be.

use core::f32::consts::FRAC_PI_2;
use footfall_core::{Joint, Side};
use footfall_tests::climb::{Climb, Outcome, Way, percentile};
use glam::Vec3;

/// Rise and run of the stairs, metres: a flight of steps outdoors, one in a house, and the steepest that is built.
const STAIRS: [[f32; 2]; 3] = [[0.15, 0.4], [0.17, 0.29], [0.2, 0.28]];
const SPEEDS: [f32; 4] = [0.8, 1.0, 1.2, 1.4];
/// Distances from which each is come upon: a stride of them.
const DISTANCES: usize = 12;
/// Up and down, unfiltered second differences at 60 frames a second between the first edge and the last, for 99 frames of a hundred, m/s².
const HIPS_99: f32 = 12.0;
/// Most of a sole that lies over an edge, metres.
const OVERHANG_M: f32 = 0.02;
/// Steps a second.
const CADENCES: [f32; 2] = [1.2, 2.0];
/// Greatest bend of a knee up and down, degrees; people have about 100.
const BEND_DEG: [f32; 2] = [117.0, 124.0];
/// Angular acceleration of a knee, rad/s², and how far an ankle is from where it would be had it gone on, metres: of the smoothest of stairs and of a
/// foot thrown over a riser.
const KNEE: f32 = 1500.0;
const JUMP_M: f32 = 0.058;
/// Distances of the sweep for thrown feet at each speed, and how far no foot jumps in it, metres: the farthest of 4,800 climbs is 0.055.
const MANY_DISTANCES: usize = 20;
const THROWN_M: f32 = 0.058;
/// Climbs in which feet were thrown by 7 to 30 cm within a frame: rise and run, distance, speed and seed.
const THROWN: [([f32; 2], f32, f32, u64); 7] = [
    // Toes stood a hair inside a riser and below their tread.
    ([0.17, 0.29], 3.83, 1.2, 26),
    // A swinging foot pointed straight down.
    ([-0.15, 0.4], 3.746_666_7, 1.4, 1524),
    ([-0.15, 0.4], 3.86, 1.4, 1468),
    ([-0.17, 0.29], 3.746_666_7, 1.4, 1524),
    ([-0.15, 0.4], 3.718_333_2, 1.4, 1583),
    // An edge no longer held a foot up.
    ([-0.17, 0.29], 2.613_333_3, 1.0, 1484),
    ([-0.2, 0.28], 3.916_666_7, 1.4, 1410),
];

/// Stairs on which Protopapadaki et al. (2007, Clinical Biomechanics 22: 203–210) measured 33 people: rise and run, metres.
const MEASURED: [f32; 2] = [0.18, 0.285];
/// Their greatest flexion of knee and ankle and extension of the ankle, up and down, degrees, and how far the means of climbs may be from theirs: ankles
/// bent by 57° and were extended by 5° before feet hung, pushed off and came down with their toes first.
const JOINTS_DEG: [[f32; 3]; 2] = [[93.9, 11.2, 31.3], [90.5, 21.1, 40.1]];
const JOINTS_OFF_DEG: f32 = 19.0;

/// One of the climbs of a staircase from all [`DISTANCES`].
fn climb([rise, run]: [f32; 2], speed_mps: f32, index: usize) -> Climb {
    let distance = 2.5 + 1.7 * index as f32 / DISTANCES as f32;
    Climb {
        seed: 7 + index as u64,
        ..Climb::adult(Way::Stairs { rise, run }, distance, speed_mps)
    }
}

/// Outcomes of climbs of one staircase at one speed.
struct Row {
    rise: f32,
    outcomes: Vec<Outcome>,
}

impl Row {
    fn of(stairs: [f32; 2], speed_mps: f32) -> Self {
        let climbs = (0..DISTANCES).map(|index| climb(stairs, speed_mps, index));
        Self {
            rise: stairs[0],
            outcomes: climbs.map(|climb| climb.walk()).collect(),
        }
    }

    fn treads(&self) -> Vec<i32> {
        let outcomes = self.outcomes.iter();
        outcomes.flat_map(|o| o.treads(self.rise)).collect()
    }

    /// Percentile of the hips' acceleration up and down.
    fn lift(&self, share: f32) -> f32 {
        let outcomes = self.outcomes.iter();
        let all: Vec<f32> = outcomes.flat_map(|o| o.lift_between.clone()).collect();
        percentile(&all, share)
    }

    fn most(&self, of: impl Fn(&Outcome) -> f32) -> f32 {
        self.outcomes.iter().map(of).fold(0.0, f32::max)
    }

    fn mean(&self, of: impl Fn(&Outcome) -> f32) -> f32 {
        self.outcomes.iter().map(of).sum::<f32>() / self.outcomes.len() as f32
    }

    fn cadence(&self) -> f32 {
        self.mean(|outcome| {
            let on_treads = |sole: f32| (0.5..6.5).contains(&(sole / self.rise));
            let landings = outcome.landings.iter();
            let secs: Vec<f32> = landings
                .filter(|landed| on_treads(landed.sole.y))
                .map(|landed| landed.secs)
                .collect();
            let spans = secs.windows(2).map(|pair| pair[1] - pair[0]);
            (secs.len() - 1) as f32 / spans.sum::<f32>()
        })
    }

    fn line(&self) -> String {
        format!(
            "{:.2} m/s, {:.2} steps/s, hips {:.1} m/s² (most {:.1}), overhang {:.3} m, knees {:.0}° {:.0} rad/s², ankles {:.3} m, slip {:.4} m/s",
            self.mean(|o| o.pace_mps),
            self.cadence(),
            self.lift(0.99),
            self.lift(1.0),
            self.most(|o| o.overhang),
            self.most(|o| o.bend).to_degrees(),
            self.most(|o| o.knee),
            self.most(|o| o.jump),
            self.most(|o| o.slip),
        )
    }
}

/// Mean lean of the trunk between the first edge and the last, and before the first, degrees forwards.
fn leans(rise: f32) -> [f32; 2] {
    let (distance, length) = (3.0, 6.0 * 0.29);
    let mut leans = [vec![], vec![]];
    let climb = Climb::adult(Way::Stairs { rise, run: 0.29 }, distance, 1.2);
    climb.watch(|_, walker| {
        let up = walker.world.rotation(Joint::UpperChest) * Vec3::Y;
        let lean = up.z.atan2(up.y).to_degrees();
        let along = walker.hips().z - distance;
        // The way there counts a second after the start, until two steps before the stairs.
        if (0.0..length).contains(&along) {
            leans[0].push(lean);
        } else if (-1.8..-1.0).contains(&along) {
            leans[1].push(lean);
        }
    });
    leans.map(|leans| leans.iter().sum::<f32>() / leans.len() as f32)
}

#[test]
fn trunks_lean_into_stairs_up_and_back_from_those_down() {
    let [up, level] = leans(0.17);
    assert!((3.0..9.0).contains(&(up - level)), "{up} after {level}");
    let [down, level] = leans(-0.17);
    assert!(
        (-6.0..-1.0).contains(&(down - level)),
        "{down} after {level}"
    );
}

/// Greatest flexion of knee and ankle and extension of the ankle from one landing of a foot on the stairs to the next, means over climbs, degrees.
fn joints(stairs: [f32; 2]) -> [f32; 3] {
    let mut cycles: Vec<[f32; 3]> = vec![];
    for index in 0..DISTANCES {
        let climb = climb(stairs, SPEEDS[index % SPEEDS.len()], index);
        let steps = 0.0..climb.way.length();
        let mut most: [Option<[f32; 3]>; 2] = [None; 2];
        climb.watch(|_, walker| {
            for side in Side::BOTH {
                let (foot, most) = (&walker.placer.feet()[side.index()], &mut most[side.index()]);
                if foot.landed {
                    let on_stairs = steps.contains(&(foot.sole.position.z - climb.distance_m));
                    cycles.extend(most.take().filter(|_| on_stairs));
                    *most = on_stairs.then_some([0.0; 3]);
                }
                if let Some(most) = most {
                    let shank = walker.world.position(side.lower_leg())
                        - walker.world.position(side.foot());
                    let toes = walker.world.rotation(side.foot()) * Vec3::Z;
                    let ankle = FRAC_PI_2 - toes.angle_between(shank);
                    for (most, now) in most.iter_mut().zip([walker.knee(side), ankle, -ankle]) {
                        *most = most.max(now.to_degrees());
                    }
                }
            }
        });
    }
    core::array::from_fn(|joint| {
        cycles.iter().map(|cycle| cycle[joint]).sum::<f32>() / cycles.len() as f32
    })
}

#[test]
fn joints_turn_on_stairs_as_those_of_people() {
    let [rise, run] = MEASURED;
    for (rise, people) in [rise, -rise].into_iter().zip(JOINTS_DEG) {
        let joints = joints([rise, run]);
        for (joint, people) in joints.into_iter().zip(people) {
            let off = (joint - people).abs();
            assert!(off < JOINTS_OFF_DEG, "{rise}: {joints:?}, people {people}");
        }
    }
}

#[test]
fn every_tread_is_taken_with_one_step_smoothly() {
    for [rise, run] in STAIRS {
        for rise in [rise, -rise] {
            for speed in SPEEDS {
                let row = Row::of([rise, run], speed);
                let what = format!("{rise} by {run} at {speed} m/s: {}", row.line());
                let treads = row.treads();
                assert!(treads.len() >= 6 * DISTANCES, "{what}: {}", treads.len());
                assert!(treads.iter().all(|t| *t == 1), "{what}: {treads:?}");
                assert!(row.lift(0.99) <= HIPS_99, "{what}");
                assert!(row.most(|o| o.overhang) <= OVERHANG_M, "{what}");
                let [slow, quick] = CADENCES;
                assert!((slow..quick).contains(&row.cadence()), "{what}");
                let bend = BEND_DEG[usize::from(rise < 0.0)];
                assert!(row.most(|o| o.bend).to_degrees() < bend, "{what}");
                assert!(row.most(|o| o.knee) < KNEE, "{what}");
                assert!(row.most(|o| o.jump) < JUMP_M, "{what}");
                assert!(row.most(|o| o.slip) < 0.001, "{what}");
                let faults = row.outcomes.iter().map(|o| o.faults.len());
                assert_eq!(faults.sum::<usize>(), 0, "{what}");
            }
        }
    }
}

#[test]
fn no_foot_is_thrown_however_stairs_are_come_upon() {
    let stairs = STAIRS
        .into_iter()
        .flat_map(|[rise, run]| [[rise, run], [-rise, run]]);
    let many = stairs.flat_map(|stairs| {
        (0..MANY_DISTANCES * SPEEDS.len()).map(move |index| {
            let distance = 2.5 + 1.7 * index as f32 / (MANY_DISTANCES * SPEEDS.len()) as f32;
            (stairs, distance, SPEEDS[index % SPEEDS.len()], index as u64)
        })
    });
    for ([rise, run], distance, speed, seed) in THROWN.into_iter().chain(many) {
        let climb = Climb {
            seed,
            ..Climb::adult(Way::Stairs { rise, run }, distance, speed)
        };
        let outcome = climb.walk();
        assert!(outcome.jump < THROWN_M, "{climb:?}: {outcome}");
        assert!(outcome.faults.is_empty(), "{climb:?}: {outcome}");
    }
}
