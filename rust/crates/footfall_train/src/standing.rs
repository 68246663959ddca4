//! Standing, from recordings of standing people.
//!
//! The [stretches] of every recording count in which a person stands upright on planted feet with hanging arms. Their mean is the posture, whose trunk is as upright as that of
//! the walk: bones of trunks have no direction that all skeletons share, and people who are seen doing both are as upright standing as walking, to 2°.
//! Motion about it is split into glances, which jump and hold (`looks`), and the rest, a Gaussian process of octaves (`octaves`).
//! People who fidget and people who hardly move have equal weight.

mod looks;
mod octaves;
mod stretches;

use crate::trunk_pitch::{average, of_features, trunk_turns, turn};
use footfall_core::Clip;
use footfall_core::rotation::{exp_map, log_map};
use footfall_core::{Joint, Side};
use footfall_model::layout::{feature_offset, mirror};
use footfall_model::{Breath, FEATURE_COUNT, GaitModel, SWAY_COUNT, StandingModel};
use footfall_motion::retarget::Retargeted;
use glam::{Quat, Vec3};
pub use stretches::{Stretch, stretches};

/// A rate at which nothing is lost of how people stand, frames per second.
pub const RATE_HZ: f64 = 24.0;

/// Length of a recording from which on a person gains no more weight, seconds.
const ENOUGH_SECS: f64 = 60.0;

/// Breaths a minute of adults at rest: 12 to 20 (Barrett et al., *Ganong's Review of Medical Physiology*).
const BREATHS_PER_MINUTE: f64 = 15.0;

/// Motion of quiet breathing, radians from the middle of a breath to its top: shoulders and breastbone rise by a few millimetres (De Groote et
/// al. 1997, *Chest wall motion during tidal breathing*). The neck keeps the head level. Joint, axis, radians.
const BREATH: [(Joint, usize, f64); 9] = [
    (Joint::Chest, 0, -0.004),
    (Joint::UpperChest, 0, -0.010),
    (Joint::Neck, 0, 0.014),
    (Joint::LeftShoulder, 2, 0.016),
    (Joint::RightShoulder, 2, -0.016),
    (Joint::LeftUpperArm, 2, -0.012),
    (Joint::RightUpperArm, 2, 0.012),
    (Joint::LeftUpperArm, 0, 0.008),
    (Joint::RightUpperArm, 0, 0.008),
];

/// Joints whose turns add up: what they do together is spread evenly, for skeletons differ in which of them they have.
const CHAINS: [&[Joint]; 2] = [
    &[Joint::Spine, Joint::Chest, Joint::UpperChest],
    &[Joint::Neck, Joint::Head],
];

/// A recording in which a person may stand.
#[derive(Clone, Debug)]
pub struct StandingClip {
    /// The person.
    pub subject: String,
    /// The motion on the canonical body.
    pub clip: Clip,
    /// Leading frames to leave out.
    pub skip_frames: usize,
}

/// Standing as learned, and the amount of data behind it.
#[derive(Clone, Debug)]
pub struct LearnedStanding {
    /// The section of a model.
    pub model: StandingModel,
    /// People who stand, and for how many seconds.
    pub people: Vec<(String, f64)>,
}

/// Offsets of one stretch from the posture, frame by frame.
type Offsets = Vec<[f64; SWAY_COUNT]>;

/// One person's stretches, and how much they count.
struct Person {
    name: String,
    stretches: Vec<Stretch>,
    weight: f64,
}

impl StandingClip {
    /// Extracts the standing spells of a recording.
    pub fn new(subject: &str, motion: &Retargeted) -> Self {
        Self {
            subject: subject.to_owned(),
            clip: motion.clip.clone(),
            skip_frames: motion.first_frame,
        }
    }
}

/// Learns how people stand who walk like this on average; `None` without standing.
pub fn learn(clips: &[StandingClip], walk: &GaitModel) -> Option<LearnedStanding> {
    let people = people(clips);
    if people.is_empty() {
        return None;
    }
    let (mut posture, ahead) = posture(&people);
    let mut offsets: Vec<Vec<Offsets>> = people
        .iter()
        .map(|person| {
            let stretches = person.stretches.iter();
            stretches
                .map(|stretch| offsets(stretch, &posture, ahead))
                .collect()
        })
        .collect();
    stand_as_walking(&mut posture, walk);
    let looks = looks::take_out(&people, &mut offsets);
    let weights: Vec<f64> = people.iter().map(|person| person.weight).collect();
    let swayed = octaves::estimate(&offsets, &weights);
    let known = people.iter().map(|person| {
        let frames: usize = person.stretches.iter().map(Stretch::frames).sum();
        (person.name.clone(), frames as f64 / RATE_HZ)
    });
    Some(LearnedStanding {
        model: StandingModel {
            posture,
            hips_ahead: ahead,
            stance: swayed.stance,
            octaves: swayed.octaves,
            looks,
            breath: breath(),
            strength_spread: swayed.strength_spread,
        },
        people: known.collect(),
    })
}

fn people(clips: &[StandingClip]) -> Vec<Person> {
    let mut people: Vec<Person> = Vec::new();
    for clip in clips {
        let found = stretches(&clip.clip, clip.skip_frames);
        match people.iter_mut().find(|person| person.name == clip.subject) {
            Some(person) => person.stretches.extend(found),
            None => people.push(Person {
                name: clip.subject.clone(),
                stretches: found,
                weight: 0.0,
            }),
        }
    }
    people.retain(|person| !person.stretches.is_empty());
    for person in &mut people {
        let frames: usize = person.stretches.iter().map(Stretch::frames).sum();
        person.weight = (frames as f64 / RATE_HZ / ENOUGH_SECS).min(1.0);
    }
    people
}

/// Features of the mean posture, the same left and right, on flat feet below the hip joints; and how far the hips are ahead of the ankles, leg lengths.
fn posture(people: &[Person]) -> (Vec<f64>, f64) {
    let mut mean = vec![0.0; FEATURE_COUNT];
    let (mut ahead, mut turned_out, mut bent, mut total) = (0.0, 0.0, 0.0, 0.0);
    for person in people {
        let frames: usize = person.stretches.iter().map(Stretch::frames).sum();
        let share = person.weight / frames as f64;
        total += person.weight;
        for stretch in &person.stretches {
            turned_out += share * stretch.frames() as f64 * stretch.turned_out;
            for row in &stretch.features {
                for (mean, value) in mean.iter_mut().zip(row) {
                    *mean += share * value;
                }
                let knees = Side::BOTH.map(|side| angle(rotation(row, side.lower_leg())));
                bent += share * 0.5 * (knees[0] + knees[1]);
            }
            ahead += share * stretch.hips.iter().map(|[_, ahead]| ahead).sum::<f64>();
        }
    }
    for mean in &mut mean {
        *mean /= total;
    }
    let mut mirrored = mean.clone();
    mirror(&mut mirrored);
    for (mean, mirrored) in mean.iter_mut().zip(mirrored) {
        *mean = 0.5 * (*mean + mirrored);
    }
    stand_flat(&mut mean, bent / total, turned_out / total);
    level_gaze(&mut mean);
    (mean, ahead / total)
}

/// Puts the feet of a posture flat below the hip joints, pointing outwards by `turned_out`, with knees that are bent by `bent` and nothing but bent:
/// directions of small angles cancel out in a mean.
fn stand_flat(posture: &mut [f64], bent: f64, turned_out: f64) {
    let tilt = rotation(posture, Joint::Hips);
    for side in Side::BOTH {
        let thigh = Quat::from_rotation_x(-0.5 * bent as f32);
        let knee = Quat::from_rotation_x(bent as f32);
        let foot = Quat::from_rotation_y(side.sign() * turned_out as f32);
        set(posture, side.upper_leg(), tilt.inverse() * thigh);
        set(posture, side.lower_leg(), knee);
        set(posture, side.foot(), (thigh * knee).inverse() * foot);
        set(posture, side.toes(), Quat::IDENTITY);
    }
}

/// Gives the trunk of a posture the mean pitch of a walk's. Pelvis and face keep their directions.
fn stand_as_walking(posture: &mut [f64], walk: &GaitModel) {
    let turns = trunk_turns(&of_features(posture), &average(walk));
    turn(posture, &turns);
}

/// Raises the face of a posture to the horizon. Which way of a recording's head is ahead is a matter of its skeleton: people's means lie 10 to
/// 20 degrees apart.
fn level_gaze(posture: &mut [f64]) {
    let below = [Joint::Hips, Joint::Spine, Joint::Chest, Joint::UpperChest];
    let head = |posture: &[f64]| {
        let joints = below.into_iter().chain([Joint::Neck, Joint::Head]);
        joints
            .map(|joint| rotation(posture, joint))
            .product::<Quat>()
    };
    let down = -(head(posture) * Vec3::Z).y.asin();
    for joint in [Joint::Neck, Joint::Head] {
        let turned = rotation(posture, joint) * Quat::from_rotation_x(-0.5 * down);
        set(posture, joint, turned);
    }
}

fn angle(rotation: Quat) -> f64 {
    f64::from(log_map(rotation).length())
}

fn set(features: &mut [f64], joint: Joint, rotation: Quat) {
    let vector = log_map(rotation).as_dvec3().to_array();
    features[feature_offset(joint)..][..3].copy_from_slice(&vector);
}

/// The rotation of a joint in a row of features.
fn rotation(features: &[f64], joint: Joint) -> Quat {
    let vector = &features[feature_offset(joint)..];
    exp_map(Vec3::new(
        vector[0] as f32,
        vector[1] as f32,
        vector[2] as f32,
    ))
}

fn offsets(stretch: &Stretch, posture: &[f64], ahead: f64) -> Offsets {
    let rows = stretch.features.iter().zip(&stretch.hips);
    rows.map(|(features, hips)| {
        let mut row = [0.0; SWAY_COUNT];
        for joint in Joint::ALL
            .into_iter()
            .filter(|joint| *joint < Joint::LeftUpperLeg)
        {
            let turn = rotation(posture, joint).inverse() * rotation(features, joint);
            let vector = log_map(turn).as_dvec3().to_array();
            row[feature_offset(joint)..][..3].copy_from_slice(&vector);
        }
        spread_chains(&mut row);
        row[FEATURE_COUNT] = hips[0];
        row[FEATURE_COUNT + 1] = hips[1] - ahead;
        row
    })
    .collect()
}

/// Spreads what joints of a chain turn together evenly among them.
pub(crate) fn spread_chains(row: &mut [f64]) {
    for chain in CHAINS {
        for axis in 0..3 {
            let turns = chain.iter().map(|joint| row[feature_offset(*joint) + axis]);
            let mean = turns.sum::<f64>() / chain.len() as f64;
            for joint in chain {
                row[feature_offset(*joint) + axis] = mean;
            }
        }
    }
}

/// An offset of the mirrored body.
fn mirrored(row: &[f64; SWAY_COUNT]) -> [f64; SWAY_COUNT] {
    let mut mirrored = *row;
    mirror(&mut mirrored[..FEATURE_COUNT]);
    mirrored[FEATURE_COUNT] = -mirrored[FEATURE_COUNT];
    mirrored
}

/// Recordings without markers on the chest show no breathing: this is what the literature says of it.
fn breath() -> Breath {
    let mut direction = vec![0.0; SWAY_COUNT];
    for (joint, axis, value) in BREATH {
        direction[feature_offset(joint) + axis] = value;
    }
    Breath {
        rate_hz: BREATHS_PER_MINUTE / 60.0,
        direction,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapt::tests::base;
    use crate::trunk_pitch::{NECK, PELVIS};

    #[test]
    fn people_stand_as_upright_as_they_walk_and_look_ahead() {
        let walk = base();
        let mut posture = vec![0.0; FEATURE_COUNT];
        set(&mut posture, Joint::Spine, Quat::from_rotation_x(-0.3));
        level_gaze(&mut posture);
        let before = of_features(&posture);
        stand_as_walking(&mut posture, &walk);
        let [after, walking] = [of_features(&posture), average(&walk)];
        for (index, after) in after.into_iter().enumerate() {
            let is_trunk = index > PELVIS && index < NECK;
            let expected = if is_trunk { walking } else { before }[index];
            assert!((after - expected).abs() < 1e-4, "{after} {expected}");
        }
    }
}
