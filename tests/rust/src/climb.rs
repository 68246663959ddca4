//! Walks over stairs and rough ground from a distance on, and what goes wrong on the way.

mod outcome;
mod way;

pub use outcome::{Failure, Fault, Landed, Outcome, percentile};
pub use way::Way;

use crate::terrain::{Origin, PlacedWalker, Relief};
use crate::walkers;
use footfall_core::{Side, Skeleton};
use footfall_ik::placement::{Frame, PlacementConfig};
use footfall_synth::{Controls, GaitChoice};
use glam::Vec3;
use std::ops::Range;

/// Time between two frames, seconds.
pub const DT: f32 = 1.0 / 60.0;
/// The walker comes out of its first pose before anything counts, frames.
const SETTLED: usize = 60;
/// Distance that the body goes on behind the last step, metres.
const BEYOND_M: f32 = 1.5;
/// A contact of the animation that is not one on the ground for longer is a lost one, seconds.
const LOST_SECS: f32 = 0.1;
/// A point of a sole is inside a step when it is farther from its surface, up and sideways, metres.
const INSIDE_M: f32 = 0.02;
/// A sole that stands has a point at the ground within this distance, metres.
const OFF_M: f32 = 0.02;
/// A point of a sole bears when it is no higher above the ground than this, metres.
const BEARS_M: f32 = 0.005;
/// Hips over the ground below them, in lengths of the leg.
const HIPS: [f32; 2] = [0.5, 1.6];

/// One walk over a profile.
#[derive(Clone, Copy, Debug)]
pub struct Climb {
    /// Size of the body, of an adult of 1.77 m.
    pub body: f32,
    /// The speed that is asked for, m/s.
    pub speed_mps: f32,
    /// Ground that is walked over.
    pub way: Way,
    /// From the start to the first edge, metres.
    pub distance_m: f32,
    /// Carrier of the character's origin over the ground.
    pub origin: Origin,
    /// True when the placer knows contacts and landings.
    pub announced: bool,
    /// True when it may run where it is not steep, as beside `FootPlacement3D`. Otherwise even legs that are short enough to run at this speed walk.
    pub runs: bool,
    /// Of the walker.
    pub seed: u64,
}

/// A walker of the shipped model with this body.
pub fn walker(skeleton: &Skeleton, seed: u64) -> PlacedWalker {
    PlacedWalker::of(
        walkers::generator(skeleton, seed),
        skeleton,
        &PlacementConfig::default(),
    )
}

impl Climb {
    /// An adult with default settings.
    pub fn adult(way: Way, distance_m: f32, speed_mps: f32) -> Self {
        Self {
            body: 1.0,
            speed_mps,
            way,
            distance_m,
            origin: Origin::Follows,
            announced: true,
            runs: false,
            seed: 7,
        }
    }

    /// Walks it.
    pub fn walk(&self) -> Outcome {
        self.watch(|_, _| {})
    }

    /// Walks it, and shows every frame.
    pub fn watch(&self, mut show: impl FnMut(usize, &PlacedWalker)) -> Outcome {
        let (way, from) = (self.way, self.distance_m);
        let mut terrain = Relief::still(move |x, z| way.height(x, z - from));
        let skeleton = Skeleton::standard().scaled(self.body);
        let mut walker = walker(&skeleton, self.seed);
        walker.carrier = self.origin;
        let controls = Controls {
            speed_mps: self.speed_mps,
            gait: if self.runs {
                GaitChoice::Auto
            } else {
                GaitChoice::Walk
            },
            ..Controls::STAND
        };
        let mut watcher = Watcher {
            leg: skeleton.mean_leg_length(),
            between: from..from + way.length(),
            ..Watcher::default()
        };
        let goal = from + way.length() + BEYOND_M;
        let mut between = 0;
        let longest = ((10.0 + 4.0 * goal) / DT) as usize;
        for frame in 0..longest {
            walker.climb(DT, controls, &mut terrain, self.announced);
            show(frame, &walker);
            watcher.see(frame, &walker, &terrain);
            between += usize::from(watcher.between.contains(&walker.hips().z));
            if walker.hips().z > goal {
                break;
            }
            if frame + 1 == longest {
                watcher.fault(Failure::Stuck, frame, &walker, walker.hips().z);
            }
        }
        watcher.outcome.pace_mps = way.length() / (between as f32 * DT);
        watcher.outcome
    }
}

#[derive(Default)]
struct Watcher {
    leg: f32,
    /// Along the way, from the first edge to the last, metres.
    between: Range<f32>,
    outcome: Outcome,
    hips: Vec<Vec3>,
    knees: [Vec<f32>; 2],
    ankles: [Vec<Vec3>; 2],
    soles: [[Vec3; 3]; 2],
    lost: [f32; 2],
}

impl Watcher {
    fn fault(&mut self, failure: Failure, frame: usize, walker: &PlacedWalker, measure: f32) {
        let worst = self
            .outcome
            .faults
            .iter_mut()
            .find(|fault| fault.failure == failure);
        if let Some(worst) = worst {
            worst.measure = worst.measure.max(measure);
        } else {
            self.outcome.faults.push(Fault {
                failure,
                secs: frame as f32 * DT,
                hips: walker.hips(),
                measure,
            });
        }
    }

    fn see(&mut self, frame: usize, walker: &PlacedWalker, terrain: &Relief) {
        let hips = walker.hips();
        self.hips.push(hips);
        self.outcome.secs = frame as f32 * DT;
        let contacts = walker.contacts();
        let soles = Side::BOTH.map(|side| walker.sole(side));
        for side in Side::BOTH {
            let index = side.index();
            let ankle = walker.world.position(side.foot());
            self.ankles[index].push(ankle);
            self.knees[index].push(walker.knee(side));
            if frame < SETTLED {
                continue;
            }
            let placed = &walker.placer.feet()[index];
            if placed.landed {
                self.outcome.steps += 1;
                self.outcome.landings.push(Landed {
                    secs: frame as f32 * DT,
                    sole: placed.sole.position,
                });
            }
            self.outcome.bend = self.outcome.bend.max(walker.knee(side));
            self.lost[index] = if contacts[index] && !placed.locked {
                self.lost[index] + DT
            } else {
                0.0
            };
            if self.lost[index] > LOST_SECS {
                self.fault(Failure::GroundLost, frame, walker, self.lost[index]);
            }
            let above = ankle.y - walker.world.position(side.upper_leg()).y;
            if above > 0.0 {
                self.fault(Failure::FootAboveHip, frame, walker, above);
            }
            let rim = walker.rim(side);
            let whole = || soles[index].iter().chain(rim.as_flattened());
            let inside = whole()
                .map(|point| depth(terrain, *point))
                .fold(0.0, f32::max);
            if inside > INSIDE_M {
                self.fault(Failure::Inside, frame, walker, inside);
            }
            if placed.locked {
                let hangs = overhang(terrain, &placed.sole, soles[index]);
                self.outcome.overhang = self.outcome.overhang.max(hangs);
                let off = whole().map(|point| point.y - terrain.at(*point).position.y);
                let off = off.fold(f32::MAX, f32::min);
                if off > OFF_M {
                    self.fault(Failure::OffGround, frame, walker, off);
                }
                if !placed.landed {
                    let slip = slide(&placed.sole, soles[index], self.soles[index]) / DT;
                    self.outcome.slip = self.outcome.slip.max(slip);
                }
            }
        }
        self.soles = soles;
        if frame < SETTLED {
            return;
        }
        let height = (hips.y - terrain.at(hips).position.y) / self.leg;
        if !(HIPS[0]..HIPS[1]).contains(&height) {
            self.fault(Failure::BodyLeft, frame, walker, height);
        }
        if let [.., a, b, c] = self.hips[..] {
            let bend = (a - 2.0 * b + c) / (DT * DT);
            self.outcome.lift.push(bend.y.abs());
            if self.between.contains(&b.z) {
                self.outcome.lift_between.push(bend.y.abs());
            }
            self.outcome.acceleration.push(bend.length());
        }
        for knee in &self.knees {
            if let [.., a, b, c] = knee[..] {
                self.outcome.knee = self.outcome.knee.max((a - 2.0 * b + c).abs() / (DT * DT));
            }
        }
        for ankle in &self.ankles {
            if let [.., a, b, c] = ankle[..] {
                self.outcome.jump = self.outcome.jump.max((a - 2.0 * b + c).length());
            }
        }
    }
}

/// Slide of a sole that rolls: the least way along the ground of any point on which it stood and stands. That one end comes down while
/// the other rises is no slide.
fn slide(sole: &Frame, now: [Vec3; 3], then: [Vec3; 3]) -> f32 {
    let height = |point: Vec3| sole.local_point(point).y;
    let along = |now: Vec3, then: Vec3| (now - then).reject_from_normalized(sole.up()).length();
    let pairs = || now.into_iter().zip(then);
    let bearing = pairs().filter(|(now, then)| height(*now).max(height(*then)) < BEARS_M);
    let slid = bearing.map(|(now, then)| along(now, then));
    let slid = slid.reduce(f32::min);
    slid.unwrap_or_else(|| {
        let any = pairs().map(|(now, then)| along(now, then));
        any.fold(f32::MAX, f32::min)
    })
}

/// Length of the part of a sole that lies flat with nothing under it, metres; 0 for one that rolls.
fn overhang(terrain: &Relief, sole: &Frame, points: [Vec3; 3]) -> f32 {
    const PARTS: usize = 50;
    let [heel, _, tip] = points;
    let flat = points.map(|point| sole.local_point(point).y.abs() < BEARS_M);
    if flat != [true; 3] {
        return 0.0;
    }
    let places = (0..=PARTS).map(|part| heel.lerp(tip, part as f32 / PARTS as f32));
    let hanging = places.filter(|place| place.y - terrain.at(*place).position.y > OFF_M);
    heel.distance(tip) * hanging.count() as f32 / (PARTS + 1) as f32
}

/// Distance of a point to the nearest way out of the ground: up, to the side, or to the side and then up what is left there; 0 outside.
fn depth(terrain: &Relief, point: Vec3) -> f32 {
    let down = |place: Vec3| (terrain.at(place).position.y - point.y).max(0.0);
    let below = down(point);
    if below <= INSIDE_M {
        return below;
    }
    let ways = [Vec3::Z, -Vec3::Z, Vec3::X, -Vec3::X];
    let aside = (1..=10).map(|step| 0.01 * step as f32);
    let out = aside.flat_map(|aside| ways.map(|way| aside.hypot(down(point + way * aside))));
    out.fold(below, f32::min)
}

/// Sizes of the body: adults, a child and a tall person.
pub const BODIES: [f32; 3] = [0.68, 1.0, 1.13];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_as_deep_as_its_shortest_way_out() {
        let way = Way::Stairs {
            rise: 0.17,
            run: 0.29,
        };
        let ground = Relief::still(move |x, z| way.height(x, z));
        for ([y, z], deep) in [
            ([0.171, 0.1], 0.0),
            ([0.16, 0.1], 0.01),
            // In the riser ahead, and in both that and the tread.
            ([0.18, 0.305], 0.02),
            ([0.169, 0.2903], 0.001),
            ([0.14, 0.32], 0.05),
            ([0.1, 0.43], 0.24),
        ] {
            let found = depth(&ground, Vec3::new(0.0, y, z));
            assert!((found - deep).abs() < 0.011, "{found} m at {y}, {z}");
            assert_eq!(found > INSIDE_M, deep > INSIDE_M, "{found} m at {y}, {z}");
        }
    }
}
