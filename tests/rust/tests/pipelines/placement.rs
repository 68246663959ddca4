//! Feet on slopes, stairs, rough ground and things that move: where soles stand, how still, and how smoothly legs go.

use core::f32::consts::{FRAC_PI_2, PI};
use footfall_core::rotation::from_heading;
use footfall_core::{Pose, Side, Skeleton};
use footfall_ik::placement::{Frame, PlacementConfig, PlacementInput};
use footfall_synth::Controls;
use footfall_tests::terrain::{PlacedWalker, Relief};
use footfall_tests::walkers::{self, most_acceleration};
use glam::{Quat, Vec3};

const DT: f32 = 1.0 / 60.0;

fn walker(seed: u64) -> PlacedWalker {
    let generator = walkers::generator(&Skeleton::standard(), seed);
    PlacedWalker::new(generator, &PlacementConfig::default())
}

/// Observations of a walk.
#[derive(Debug, Default)]
struct Seen {
    /// Fastest that the stillest point of a locked sole moved, m/s.
    slip: f32,
    /// Farthest that a sole which lies flat was from the ground, metres.
    gap: f32,
    /// Most that its plane was turned against the ground, radians.
    tilt: f32,
    /// Deepest that any point of a sole was in the ground, metres.
    sunk: f32,
    /// Highest angular acceleration of a knee, rad/s².
    knee: f32,
    /// The same of the walk before it was put on the ground.
    flat_knee: f32,
    /// Highest acceleration of the hips against gravity, m/s².
    hips: f32,
    /// Frames in which a foot was locked.
    locked: usize,
    /// Frames in which it was locked and lay flat.
    lying: usize,
    /// Position of the hips at the end.
    end: Vec3,
}

struct Test {
    secs: f32,
    controls: Controls,
    announced: bool,
    carried: fn(f32) -> Frame,
}

impl Test {
    fn walk(speed_mps: f32) -> Self {
        Self {
            secs: 12.0,
            controls: Controls {
                speed_mps,
                ..Controls::STAND
            },
            announced: true,
            carried: |_| Frame::IDENTITY,
        }
    }

    fn on(&self, height: fn(f32, f32) -> f32) -> Seen {
        let mut terrain = Relief::still(height);
        let mut walker = walker(7);
        let mut seen = Seen::default();
        let mut before: Option<([[Vec3; 3]; 2], Frame)> = None;
        let mut knees: [Vec<[f32; 2]>; 2] = [vec![], vec![]];
        let mut hips = vec![];
        for frame in 0..(self.secs / DT) as usize {
            terrain.support = (self.carried)(frame as f32 * DT);
            walker.world_from_start = terrain.support;
            walker.step(DT, self.controls, &mut terrain, self.announced);
            let soles = Side::BOTH.map(|side| walker.sole(side));
            for side in Side::BOTH {
                let foot = walker.placer.feet()[side.index()];
                let sole = soles[side.index()];
                for point in sole {
                    seen.sunk = seen.sunk.max(terrain.at(point).position.y - point.y);
                }
                let local = |p: Vec3| foot.sole.local_point(p).y.abs();
                if foot.locked {
                    seen.locked += 1;
                    if sole.into_iter().all(|point| local(point) < 2e-3) && frame > 30 {
                        seen.lying += 1;
                        for point in sole {
                            let gap = (terrain.at(point).position.y - point.y).abs();
                            seen.gap = seen.gap.max(gap);
                        }
                        let ground = terrain.at(sole[1]).normal;
                        seen.tilt = seen.tilt.max(foot.sole.up().angle_between(ground));
                    }
                    if let Some((before, support)) = &before
                        && !foot.landed
                        && frame > 2
                    {
                        let slip = sole
                            .into_iter()
                            .zip(before[side.index()])
                            .map(|(now, then)| {
                                let then = terrain.support.point(support.local_point(then));
                                now.distance(then) / DT
                            })
                            .fold(f32::MAX, f32::min);
                        seen.slip = seen.slip.max(slip);
                    }
                }
                let flat_knee = walker
                    .animated
                    .rotation(side.lower_leg())
                    .angle_between(Quat::IDENTITY);
                knees[side.index()].push([walker.knee(side), flat_knee]);
            }
            hips.push(walker.hips().y);
            before = Some((soles, terrain.support));
            seen.end = walker.hips();
        }
        let bend = |a: f32, b: f32, c: f32| (a - 2.0 * b + c).abs() / (DT * DT);
        for knee in &knees {
            for w in knee[10..].windows(3) {
                seen.knee = seen.knee.max(bend(w[0][0], w[1][0], w[2][0]));
                seen.flat_knee = seen.flat_knee.max(bend(w[0][1], w[1][1], w[2][1]));
            }
        }
        for w in hips[10..].windows(3) {
            seen.hips = seen.hips.max(bend(w[0], w[1], w[2]));
        }
        seen
    }
}

const SLOPE: f32 = 0.364; // tan 20°

fn stairs(z: f32, rise: f32, run: f32) -> f32 {
    (z / run).floor().clamp(0.0, 20.0) * rise
}

/// The bounds that the README states for knees, rad/s²: people on flat ground reach 600, and a step of a stair is a bend more.
const KNEE_ON_SLOPES: f32 = 1200.0;
const KNEE_ON_STAIRS: f32 = 1500.0;

impl Seen {
    /// Standing feet stand still, on the ground and in its plane, and legs go smoothly.
    fn expect(&self, what: &str, knee: f32) {
        assert!(self.lying > 150, "{what}: few frames lie flat: {self:?}");
        assert!(self.slip < 0.005, "{what}: a standing foot moves: {self:?}");
        assert!(
            self.gap < 0.01,
            "{what}: a sole is off the ground: {self:?}"
        );
        assert!(
            self.tilt < 3.0_f32.to_radians(),
            "{what}: a sole is tilted: {self:?}"
        );
        assert!(self.knee < knee, "{what}: a knee pops: {self:?}");
        assert!(self.hips < 80.0, "{what}: the hips jerk: {self:?}");
    }
}

#[test]
fn a_turning_walker_keeps_its_feet_on_a_slope() {
    let mut test = Test::walk(1.0);
    test.controls.turn_rate_radps = 0.7;
    test.on(|_, z| SLOPE * z).expect("turning", KNEE_ON_SLOPES);
}

#[test]
fn sidesteps_and_steps_backwards_keep_their_feet_on_a_slope() {
    let mut test = Test::walk(0.6);
    for direction in [FRAC_PI_2, PI, -0.75 * PI] {
        test.controls.direction_rad = direction;
        let what = format!("{direction} rad");
        test.on(|x, z| 0.2 * z - 0.1 * x)
            .expect(&what, KNEE_ON_SLOPES);
    }
}

/// A foot that is left below raises its heel as the body goes up, and is then not set back on it: bodies fell by 8 cm in a frame.
#[test]
fn hips_do_not_fall_on_steps_taken_aside_and_backwards() {
    for (direction, speed_mps) in [(FRAC_PI_2, 0.6), (PI, 0.8)] {
        for seed in 1..13 {
            let from = 1.0 + 0.07 * seed as f32;
            let (aside, ahead) = direction.sin_cos();
            let mut terrain = Relief::still(move |x, z| {
                let way = x * aside + z * ahead - from;
                stairs(way + 0.3, 0.17, 0.3)
            });
            let mut walker = walker(seed);
            walker.generator.stand();
            let controls = Controls {
                speed_mps,
                direction_rad: direction,
                ..Controls::STAND
            };
            let hips: Vec<Vec3> = (0..600)
                .map(|_| {
                    walker.climb(DT, controls, &mut terrain, true);
                    walker.hips()
                })
                .collect();
            assert!(hips[599].y > 1.3, "{direction}, seed {seed}: it climbed");
            let most = most_acceleration(&hips);
            assert!(most < 60.0, "{direction}, seed {seed}: {most} m/s²");
        }
    }
}

#[test]
fn feet_ride_on_ground_that_moves_turns_and_rises() {
    let mut test = Test::walk(1.0);
    test.carried = |secs| Frame {
        position: Vec3::new(0.5 * secs, 0.4 - 0.4 * secs.cos(), 0.3 * secs),
        rotation: Quat::from_rotation_y(0.4 * secs.sin()),
    };
    test.on(|_, z| 0.1 * z).expect("carried", KNEE_ON_STAIRS);
}

#[test]
fn someone_who_stands_on_a_slope_stands() {
    let seen = Test::walk(0.0).on(|x, z| 0.3 * z + 0.2 * x);
    seen.expect("standing", KNEE_ON_SLOPES);
}

/// Without known contacts and footholds the placer finds them late: feet settle after they have landed.
#[test]
fn an_animation_that_tells_nothing_is_placed_on_slopes() {
    let mut test = Test::walk(1.3);
    test.announced = false;
    for (what, height) in [
        ("flat", (|_, _| 0.0) as fn(f32, f32) -> f32),
        ("up", |_, z| SLOPE * z),
        ("down", |_, z| -SLOPE * z),
    ] {
        let seen = test.on(height);
        assert!(seen.slip < 0.03, "{what}: {seen:?}");
        assert!(seen.gap < 0.01 && seen.tilt < 0.05, "{what}: {seen:?}");
        assert!(seen.lying > 300 && seen.sunk < 0.02, "{what}: {seen:?}");
        assert!(seen.knee < 2200.0, "{what}: {seen:?}");
    }
}

#[test]
fn in_the_air_and_over_a_void_feet_are_left_to_the_animation() {
    let mut walker = walker(3);
    let controls = Test::walk(1.3).controls;
    let mut void = Relief::still(|_, _| -100.0);
    for frame in 0..300 {
        walker.step_at(DT, controls, &mut void, true, 0.0);
        let placed = walker.placer.feet();
        assert!(placed.iter().all(|foot| !foot.locked));
        if frame > 60 {
            let hips = walker.pose.root_position;
            assert!(hips.distance(walker.animated.root_position) < 1e-3);
            for (placed, animated) in walker.pose.rotations.iter().zip(&walker.animated.rotations) {
                assert!(placed.angle_between(*animated) < 0.03);
            }
        }
    }
}

#[test]
fn time_that_stands_still_changes_nothing() {
    let mut terrain = Relief::still(|_, z| SLOPE * z);
    let mut walker = walker(5);
    let controls = Test::walk(1.0).controls;
    for _ in 0..200 {
        walker.step(DT, controls, &mut terrain, true);
    }
    let before = walker.pose.clone();
    walker.step(0.0, controls, &mut terrain, true);
    for (now, then) in walker.pose.rotations.iter().zip(&before.rotations) {
        assert!((*now - *then).length() < 1e-6, "{now} was {then}");
    }
}

#[test]
fn flat_ground_changes_nothing() {
    let mut terrain = Relief::still(|_, _| 0.0);
    let mut walker = walker(7);
    let controls = Test::walk(1.3).controls;
    for _ in 0..600 {
        walker.step(DT, controls, &mut terrain, true);
        assert!(
            walker
                .pose
                .root_position
                .distance(walker.animated.root_position)
                < 1e-3
        );
        for (placed, animated) in walker.pose.rotations.iter().zip(&walker.animated.rotations) {
            let turned = placed.angle_between(*animated);
            // In the frame in which a foot leaves the ground the lock has the last word.
            assert!(turned < 0.02, "turned by {turned}");
        }
    }
}

/// Walkers of a crowd report contacts to the nearest frame, up to two before the landing: feet went back to where they had last landed, and hips sank to the ground.
#[test]
fn contacts_may_be_reported_before_their_landings() {
    const EARLY_SECS: f32 = 2.1 * DT;
    let mut terrain = Relief::still(|_, _| 0.0);
    let controls = Test::walk(1.3).controls;
    for seed in 1..4 {
        let mut walker = walker(seed);
        let mut announced = [None; 2];
        let mut landed = 0;
        for _ in 0..600 {
            let mut pose = Pose::default();
            walker.generator.step(DT, &controls, &mut pose);
            let place = walker.generator.start_from_character();
            let world_from_floor = Frame {
                position: place.position,
                rotation: from_heading(place.heading),
            };
            let landings = walker.generator.landings();
            let mut contacts = walker.contacts();
            for (foot, next) in landings.iter().enumerate() {
                // A foot that still stands is not there yet.
                if let Some(next) = next.filter(|_| !contacts[foot]) {
                    announced[foot] = Some(world_from_floor.point(next.flat.position));
                    contacts[foot] = next.secs < EARLY_SECS;
                }
            }
            let input = PlacementInput {
                world_from_floor,
                contacts: Some(contacts),
                landings,
                airborne: false,
            };
            walker.placer.step(DT, &input, &mut terrain, &mut pose);
            for (placed, at) in walker.placer.feet().iter().zip(announced) {
                if let Some(at) = at.filter(|_| placed.landed) {
                    landed += 1;
                    let off = placed.sole.position.distance(at);
                    assert!(off < 0.02, "{seed}: landed {off} m from its place");
                }
            }
        }
        assert!(landed > 12, "{landed} landings");
    }
}

#[test]
fn slopes_are_walked_up_down_and_across() {
    let test = Test::walk(1.0);
    test.on(|_, z| SLOPE * z).expect("up", KNEE_ON_SLOPES);
    test.on(|_, z| -SLOPE * z).expect("down", KNEE_ON_SLOPES);
    test.on(|x, _| SLOPE * x).expect("across", KNEE_ON_SLOPES);
    let rough = |x: f32, z: f32| 0.04 * (3.0 * x).sin() + 0.05 * (2.3 * z).sin();
    test.on(rough).expect("rough", KNEE_ON_SLOPES);
}

#[test]
fn stairs_are_climbed_and_descended_with_whole_soles_on_treads() {
    let test = Test::walk(0.8);
    let up = test.on(|_, z| stairs(z - 1.0, 0.15, 0.4));
    up.expect("up", KNEE_ON_STAIRS);
    assert!(up.end.y > 3.0, "it climbed: {up:?}");
    test.on(|_, z| -stairs(z - 1.0, 0.15, 0.4))
        .expect("down", KNEE_ON_STAIRS);
    test.on(|_, z| stairs(z - 1.0, 0.17, 0.29))
        .expect("steep up", KNEE_ON_STAIRS);
    test.on(|_, z| -stairs(z - 1.0, 0.17, 0.29))
        .expect("steep down", KNEE_ON_STAIRS);
    let kerb = |_: f32, z: f32| if z > 3.0 { 0.15 } else { 0.0 };
    test.on(kerb).expect("kerb", KNEE_ON_STAIRS);
}
