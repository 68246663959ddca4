//! Manoeuvres that walkers are asked for, and the times they take.

use anyhow::Result;
use core::f32::consts::{FRAC_PI_2, PI};
use footfall_core::rotation::{from_heading, wrap_angle};
use footfall_core::{Joint, Pose};
use footfall_model::GaitModel;
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
use footfall_train::evaluate::response::{Manoeuvre, ManoeuvreKind, Travel};
use glam::{Vec2, Vec3};
use std::sync::Arc;

const RATE_HZ: f64 = 60.0;
/// Time until a walker has reached its first request, and time of observation after that, seconds.
const BEFORE_SECS: f64 = 3.0;
const AFTER_SECS: f64 = 5.0;
/// Walkers are asked at moments of their stride that differ by this, seconds.
const APART_SECS: f64 = 0.083;

/// Steering of a character that is to face elsewhere, as `GaitCharacter3D` does: it turns what is left in so many seconds, less what its steps go on turning
/// meanwhile, no faster than this, rad/s, and slows down for what lies between these angles, radians, to this share of its speed.
const TURN_SECS: f32 = 0.3;
const TURN_LAG_SECS: f32 = 0.2;
const MOST_TURN_RADPS: f32 = 3.5;
const SLOWS_RAD: [f32; 2] = [1.75, 2.6];
const SLOWEST: f32 = 0.3;

/// A request: a speed, where the travel goes from where the body faces, and how far the body is to turn, m/s and radians.
#[derive(Clone, Copy, Debug)]
struct Asked {
    speed: f32,
    direction: f32,
    turn: f32,
}

/// A change of what is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) name: &'static str,
    before: Asked,
    after: Asked,
}

const fn straight(speed: f32) -> Asked {
    turned(speed, 0.0)
}

const fn turned(speed: f32, turn: f32) -> Asked {
    Asked {
        speed,
        direction: 0.0,
        turn,
    }
}

const fn towards(speed: f32, direction: f32) -> Asked {
    Asked {
        speed,
        direction,
        turn: 0.0,
    }
}

const fn course(name: &'static str, before: Asked, after: Asked) -> Course {
    Course {
        name,
        before,
        after,
    }
}

pub(super) const COURSE: [Course; 12] = [
    course("start to 1.3 m/s", straight(0.0), straight(1.3)),
    course("start to 3.0 m/s", straight(0.0), straight(3.0)),
    course(
        "90° from standing to 1.3",
        straight(0.0),
        turned(1.3, FRAC_PI_2),
    ),
    course(
        "90° from standing to 3.0",
        straight(0.0),
        turned(3.0, FRAC_PI_2),
    ),
    course("stop from 1.3 m/s", straight(1.3), straight(0.0)),
    course("stop from 3.4 m/s", straight(3.4), straight(0.0)),
    course("90° at 1.3 m/s", straight(1.3), turned(1.3, FRAC_PI_2)),
    course("90° at 3.0 m/s", straight(3.0), turned(3.0, FRAC_PI_2)),
    course("180° at 1.3 m/s", straight(1.3), turned(1.3, PI)),
    course("180° at 3.0 m/s", straight(3.0), turned(3.0, PI)),
    course(
        "sideways at 1.5 m/s",
        straight(0.0),
        towards(1.5, FRAC_PI_2),
    ),
    course("backwards at 1.5 m/s", straight(0.0), towards(1.5, PI)),
];

/// One walker on a course.
pub(super) struct Trial {
    /// From being asked until it is so, seconds.
    pub(super) asked_secs: Option<f64>,
    /// The same by the motion alone.
    pub(super) moved_secs: Option<f64>,
    /// The speed in the last two seconds, m/s.
    pub(super) speed_mps: f64,
    /// Angle by which the body turned farther than asked, radians; `None` where it was not to turn.
    pub(super) beyond_rad: Option<f32>,
    /// The hips' accelerations, m/s².
    pub(super) accelerations: Vec<f32>,
}

/// Runs walkers through a course.
pub(super) fn run_course(
    model: &Arc<GaitModel>,
    course: &Course,
    seeds: u32,
) -> Result<Vec<Trial>> {
    let space = Arc::new(StyleSpace::new(model, &[])?);
    (1..=u64::from(seeds))
        .map(|seed| run_trial(&space, model, course, seed))
        .collect()
}

fn run_trial(
    space: &Arc<StyleSpace>,
    model: &GaitModel,
    course: &Course,
    seed: u64,
) -> Result<Trial> {
    let config = GeneratorConfig {
        seed,
        phase: 0.0,
        variation: 1.0,
    };
    let mut walker = GaitGenerator::new(space, &[], &model.skeleton, &config)?;
    walker.stand();
    let frames = |secs: f64| (secs * RATE_HZ).round() as usize;
    let asks = frames(BEFORE_SECS + APART_SECS * seed as f64);
    let mut poses = Vec::new();
    let mut pose = Pose::default();
    let mut heading_before = 0.0;
    let mut beyond: f32 = 0.0;
    for frame in 0..asks + frames(AFTER_SECS) {
        let asked = if frame < asks {
            course.before
        } else {
            course.after
        };
        let heading = walker.start_from_character().heading;
        let turning = wrap_angle(heading - heading_before) * RATE_HZ as f32;
        heading_before = heading;
        let angle = wrap_angle(asked.turn - heading);
        if frame >= asks && angle.abs() < FRAC_PI_2 {
            beyond = beyond.max(-angle);
        }
        let left = wrap_angle(angle - TURN_LAG_SECS * turning);
        let controls = Controls {
            speed_mps: asked.speed * pace(angle),
            turn_rate_radps: (left / TURN_SECS).clamp(-MOST_TURN_RADPS, MOST_TURN_RADPS),
            direction_rad: asked.direction,
            ..Controls::STAND
        };
        walker.step(1.0 / RATE_HZ as f32, &controls, &mut pose);
        let place = walker.start_from_character();
        let hips = place.position + from_heading(place.heading) * pose.root_position;
        let mut shown = pose.clone();
        shown.root_position = hips;
        shown.rotations[Joint::Hips.index()] =
            from_heading(place.heading) * shown.rotations[Joint::Hips.index()];
        poses.push(shown);
    }
    let travel = Travel::of_poses(&poses, RATE_HZ);
    let asked_at = asks as f64 / RATE_HZ;
    let way = course.after.direction + course.after.turn;
    let wanted = course.after.speed * Vec2::new(way.sin(), way.cos());
    let last = [asks + frames(AFTER_SECS - 2.0), poses.len() - 1];
    let [from, to] = last.map(|frame| poses[frame].root_position * Vec3::new(1.0, 0.0, 1.0));
    Ok(Trial {
        asked_secs: travel.secs_to(asked_at, wanted),
        moved_secs: moved(&travel, asked_at, course),
        speed_mps: f64::from(from.distance(to)) / ((last[1] - last[0]) as f64 / RATE_HZ),
        beyond_rad: (course.after.turn > 0.0).then_some(beyond),
        accelerations: accelerations(&poses[asks..], RATE_HZ),
    })
}

/// Share of the speed that a walker keeps with this much still to turn: a walker that turns back slows down.
fn pace(left: f32) -> f32 {
    let [full, slow] = SLOWS_RAD;
    let share = (left.abs() - full) / (slow - full);
    1.0 + share.clamp(0.0, 1.0) * (SLOWEST - 1.0)
}

/// Duration of the manoeuvre that begins when it is asked for.
fn moved(travel: &Travel, asked_at: f64, course: &Course) -> Option<f64> {
    let kind = match (course.before.speed > 0.0, course.after.speed > 0.0) {
        (false, _) => ManoeuvreKind::Start,
        (_, false) => ManoeuvreKind::Stop,
        _ if course.after.turn > 3.0 => ManoeuvreKind::Reversal,
        _ => return None,
    };
    let found = travel.manoeuvres();
    let own = |found: &&Manoeuvre| found.kind == kind && found.begin_secs > asked_at - 0.3;
    found.iter().find(own).map(|found| found.secs)
}

/// Magnitudes of the hips' accelerations, m/s².
pub(super) fn accelerations(poses: &[Pose], rate_hz: f64) -> Vec<f32> {
    let rate = rate_hz as f32;
    let windows = poses.windows(3);
    windows
        .map(|at| {
            let [a, b, c] = [0, 1, 2].map(|index: usize| at[index].root_position);
            (a - 2.0 * b + c).length() * rate * rate
        })
        .collect()
}
