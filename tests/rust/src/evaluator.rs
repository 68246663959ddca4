//! Quality of a walk from its BVH file alone: contacts, slip, penetration, speed, cadence.
//!
//! Shares no code with the trainer or the generator: own kinematics, own contact rule. A foot is in contact while its
//! sole's clearance is under 2 cm (until 3.5 cm) and its slip under 0.35 m/s (until 0.6 m/s). Slip is the least horizontal
//! speed among the points that could be the pivot: foot-fixed points at floor level, the toe joint, the toe tip. 50 ms at
//! both ends of a contact are left out of the slip.

use footfall_motion::bvh::{BvhFile, Channel};
use glam::{DQuat, DVec3};

const CLEARANCE_ON_M: f64 = 0.02;
const CLEARANCE_OFF_M: f64 = 0.035;
const SLIP_ON_MPS: f64 = 0.35;
const SLIP_OFF_MPS: f64 = 0.6;
const END_MARGIN_SECS: f64 = 0.05;
/// Contacts shorter than this are noise.
const LEAST_CONTACT_SECS: f64 = 0.1;
/// A foot-fixed point is at floor level when it is within this of the foot's lowest point.
const FLOOR_LEVEL_M: f64 = 0.01;
/// Length of the heel behind the ankle of a canonical foot, metres.
const HEEL_BEHIND_M: f64 = 0.05;
const SOLE_SAMPLES: usize = 8;

/// Measurements of a walk.
#[derive(Clone, Debug, PartialEq)]
pub struct WalkQuality {
    /// Contacts of the left and of the right foot, first and last frame.
    pub contacts: [Vec<(usize, usize)>; 2],
    /// Median slip of the feet in contact, m/s.
    pub median_slip_mps: f64,
    /// 99th percentile of the same.
    pub worst_slip_mps: f64,
    /// Depth of the lowest sole point of any frame below the floor, metres; 0 when none is below.
    pub penetration_m: f64,
    /// Mean speed of the hips along the ground from the first initial contact to the last, m/s.
    pub speed_mps: f64,
    /// Steps per second from the first initial contact to the last.
    pub cadence_hz: f64,
    /// Initial contacts of both feet.
    pub initial_contacts: usize,
    /// Energy of `x[t−1] − 2x[t] + x[t+1]` over that of x's own motion, worst joint's rotation: parity ripple shows here.
    pub ripple: f64,
}

struct FootPoints {
    /// Points that could be the pivot in this frame; foot-fixed ones first.
    points: Vec<DVec3>,
    /// Number of them that are fixed to the foot.
    foot_fixed: usize,
}

/// Judges a file on the canonical body, floor at y = 0.
///
/// # Panics
/// When a joint of the canonical leg is missing: not a file that this can judge.
pub fn evaluate(file: &BvhFile) -> WalkQuality {
    let rate = file.frame_rate_hz();
    let frames: Vec<Vec<(DVec3, DQuat)>> = (0..file.frame_count)
        .map(|frame| world_transforms(file, frame))
        .collect();
    let mut slips = Vec::new();
    let mut penetration_m = 0.0_f64;
    let contacts = ["Left", "Right"].map(|side| {
        let feet: Vec<FootPoints> = frames
            .iter()
            .map(|frame| foot_points(file, frame, side))
            .collect();
        for foot in &feet {
            penetration_m = penetration_m.max(-lowest(foot));
        }
        let slip: Vec<f64> = (0..feet.len())
            .map(|frame| slip_at(&feet, frame, rate))
            .collect();
        let contacts = find_contacts(&feet, &slip, rate);
        let margin = (END_MARGIN_SECS * rate).ceil() as usize;
        for &(first, last) in &contacts {
            slips.extend(
                (first + margin..(last + 1).saturating_sub(margin)).map(|frame| slip[frame]),
            );
        }
        contacts
    });
    slips.sort_by(f64::total_cmp);
    let percentile = |share: f64| {
        let index = (share * slips.len().saturating_sub(1) as f64).round() as usize;
        slips.get(index).copied().unwrap_or(f64::NAN)
    };
    // A contact that holds in frame 0 began before the file did.
    let mut initial: Vec<usize> = contacts
        .iter()
        .flatten()
        .map(|contact| contact.0)
        .filter(|frame| *frame > 0)
        .collect();
    initial.sort_unstable();
    let (speed_mps, cadence_hz) = match (initial.first(), initial.last()) {
        (Some(&first), Some(&last)) if last > first => {
            let secs = (last - first) as f64 / rate;
            let hips = joint(file, "Hips");
            let way = (frames[last][hips].0 - frames[first][hips].0).with_y(0.0);
            (way.length() / secs, (initial.len() - 1) as f64 / secs)
        }
        _ => (f64::NAN, f64::NAN),
    };
    WalkQuality {
        contacts,
        median_slip_mps: percentile(0.5),
        worst_slip_mps: percentile(0.99),
        penetration_m,
        speed_mps,
        cadence_hz,
        initial_contacts: initial.len(),
        ripple: ripple(file),
    }
}

fn joint(file: &BvhFile, name: &str) -> usize {
    file.joint_named(name)
        .unwrap_or_else(|| panic!("the file has no joint {name}"))
}

/// Position and `world_from_joint` rotation of every joint.
fn world_transforms(file: &BvhFile, frame: usize) -> Vec<(DVec3, DQuat)> {
    let mut values = file.frame(frame).iter();
    let mut world: Vec<(DVec3, DQuat)> = Vec::with_capacity(file.joints.len());
    for joint in &file.joints {
        let mut offset = joint.offset.as_dvec3();
        let mut rotation = DQuat::IDENTITY;
        for channel in &joint.channels {
            let value = f64::from(*values.next().expect("a value for each channel"));
            let turn = value.to_radians();
            match channel {
                Channel::XPosition => offset.x = value,
                Channel::YPosition => offset.y = value,
                Channel::ZPosition => offset.z = value,
                Channel::XRotation => rotation *= DQuat::from_rotation_x(turn),
                Channel::YRotation => rotation *= DQuat::from_rotation_y(turn),
                Channel::ZRotation => rotation *= DQuat::from_rotation_z(turn),
            }
        }
        world.push(match joint.parent {
            None => (offset, rotation),
            Some(parent) => {
                let (origin, turn) = world[parent];
                (origin + turn * offset, turn * rotation)
            }
        });
    }
    world
}

/// The sole lies in the plane through the toe tip: in the T-pose of our files that is the floor.
fn foot_points(file: &BvhFile, frame: &[(DVec3, DQuat)], side: &str) -> FootPoints {
    let (foot, toes) = (
        joint(file, &format!("{side}Foot")),
        joint(file, &format!("{side}Toes")),
    );
    let ball = file.joints[toes].offset.as_dvec3();
    let tip = file.joints[toes]
        .end_sites
        .first()
        .expect("an End Site at the toe tip")
        .as_dvec3();
    let sole = ball.y + tip.y;
    let at = |index: usize, point: DVec3| frame[index].0 + frame[index].1 * point;
    let mut points: Vec<DVec3> = (0..=SOLE_SAMPLES)
        .map(|sample| {
            let share = sample as f64 / SOLE_SAMPLES as f64;
            let z = -HEEL_BEHIND_M + share * (ball.z + HEEL_BEHIND_M);
            at(foot, DVec3::new(ball.x * share, sole, z))
        })
        .collect();
    let foot_fixed = points.len();
    // Under the toe joint, where it touches; and the tip.
    points.push(at(toes, DVec3::new(0.0, tip.y, 0.0)));
    points.push(at(toes, tip));
    FootPoints { points, foot_fixed }
}

fn lowest(foot: &FootPoints) -> f64 {
    foot.points
        .iter()
        .map(|point| point.y)
        .fold(f64::MAX, f64::min)
}

fn slip_at(feet: &[FootPoints], frame: usize, rate: f64) -> f64 {
    let (before, after) = (frame.saturating_sub(1), (frame + 1).min(feet.len() - 1));
    if before == after {
        return 0.0;
    }
    let floor = lowest(&feet[frame]);
    let secs = (after - before) as f64 / rate;
    let now = &feet[frame];
    (0..now.points.len())
        .filter(|&index| index >= now.foot_fixed || now.points[index].y < floor + FLOOR_LEVEL_M)
        .map(|index| {
            let way = feet[after].points[index] - feet[before].points[index];
            way.with_y(0.0).length() / secs
        })
        .fold(f64::MAX, f64::min)
}

fn find_contacts(feet: &[FootPoints], slip: &[f64], rate: f64) -> Vec<(usize, usize)> {
    let mut contacts = Vec::new();
    let mut begun = None;
    for frame in 0..=feet.len() {
        let stands = feet.get(frame).is_some_and(|foot| {
            let (clearance, slip) = (lowest(foot), slip[frame]);
            if begun.is_some() {
                clearance < CLEARANCE_OFF_M && slip < SLIP_OFF_MPS
            } else {
                clearance < CLEARANCE_ON_M && slip < SLIP_ON_MPS
            }
        });
        match (begun, stands) {
            (None, true) => begun = Some(frame),
            (Some(first), false) => {
                if (frame - first) as f64 >= LEAST_CONTACT_SECS * rate {
                    contacts.push((first, frame - 1));
                }
                begun = None;
            }
            _ => {}
        }
    }
    contacts
}

fn ripple(file: &BvhFile) -> f64 {
    let width = file.channel_count();
    let mut worst = 0.0_f64;
    // The root's six channels travel and wrap; the joints' angles are the question.
    for channel in 6..width {
        let series: Vec<f64> = (0..file.frame_count)
            .map(|frame| f64::from(file.frame(frame)[channel]))
            .collect();
        let mean = series.iter().sum::<f64>() / series.len() as f64;
        let motion: f64 = series.iter().map(|value| (value - mean).powi(2)).sum();
        let second: f64 = series
            .windows(3)
            .map(|at| (at[0] - 2.0 * at[1] + at[2]).powi(2))
            .sum();
        // Joints that hardly move (under half a degree) would divide noise by nothing.
        if motion / series.len() as f64 > 0.25 {
            worst = worst.max(second / motion);
        }
    }
    worst
}
