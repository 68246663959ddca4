//! Stairs as people take them: a tread a step, hips that ride, whole soles on treads.
#![expect(clippy::print_stdout, reason = "the bench prints its table")]

use footfall_tests::climb::{Climb, Outcome, Way, percentile};

/// Distances from which the stairs are come upon: a stride of them, spread evenly.
fn distances(count: usize) -> impl Iterator<Item = f32> {
    (0..count).map(move |index| 2.5 + 1.7 * index as f32 / count as f32)
}

const STAIRS: [[f32; 2]; 3] = [[0.15, 0.4], [0.17, 0.29], [0.2, 0.28]];
const SPEEDS: [f32; 4] = [0.8, 1.0, 1.2, 1.4];

fn climbs(rise: f32, run: f32, speed: f32, count: usize) -> Vec<Outcome> {
    distances(count)
        .enumerate()
        .map(|(index, distance_m)| {
            let climb = Climb {
                seed: 7 + index as u64,
                ..Climb::adult(Way::Stairs { rise, run }, distance_m, speed)
            };
            climb.walk()
        })
        .collect()
}

#[test]
fn table() {
    let count = 12;
    println!("stairs      asked  treads a step: 0 1 2 other | pace cadence | lift 99% max | overhang | bend | slip knee jump | faults");
    for [rise, run] in STAIRS {
        for rise in [rise, -rise] {
            for speed in SPEEDS {
                let outcomes = climbs(rise, run, speed, count);
                let mut kinds = [0; 4];
                for outcome in &outcomes {
                    for treads in outcome.treads(rise) {
                        let kind = usize::try_from(treads).unwrap_or(3).min(3);
                        kinds[kind] += 1;
                    }
                }
                let lift: Vec<f32> = outcomes.iter().flat_map(|o| o.lift.clone()).collect();
                let mean = |f: &dyn Fn(&Outcome) -> f32| outcomes.iter().map(f).sum::<f32>() / count as f32;
                let most = |f: &dyn Fn(&Outcome) -> f32| outcomes.iter().map(f).fold(0.0, f32::max);
                let cadence = |o: &Outcome| {
                    let on: Vec<_> = o.landings.iter().filter(|l| { let t = (l.sole.y / rise).round() as i32; (1..=6).contains(&t) }).collect();
                    (on.len() as f32 - 1.0) / (on[on.len()-1].secs - on[0].secs)
                };
                println!(
                    "{rise:5.2} x{run:4.2}  {speed:.1}   {kinds:?}  | {:.2} {:.2} | {:.1} {:.1} | {:.3} | {:.0} | {:.4} {:.0} {:.3} | {}",
                    mean(&|o| o.pace_mps), mean(&cadence),
                    percentile(&lift, 0.99), percentile(&lift, 1.0),
                    most(&|o| o.overhang), most(&|o| o.bend).to_degrees(), most(&|o| o.slip), most(&|o| o.knee), most(&|o| o.jump),
                    outcomes.iter().map(|o| o.faults.len()).sum::<usize>()
                );
            }
        }
    }
}
