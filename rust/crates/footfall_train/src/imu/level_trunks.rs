//! Trunks of people whose skeletons have other directions than most: as upright as people walk.
//!
//! A sensor on a leg says little of the trunk, so that a body stands and walks with the trunks of the recordings. O3DE's rotations are on a skeleton whose spine is bent:
//! on the canonical body that actor walks with a chest tilted back by 22° and his neck 10 cm behind his hips, and so does whoever is reconstructed from his frames.

use crate::trunk_pitch::{NECK, Pitches, Sum, trunk_turns, turn, turn_pose};
use footfall_model::FEATURE_COUNT;
use footfall_motion::recording::Recording;
use std::collections::BTreeMap;

/// Pitch of spine, chest and upper chest in plain walking: mean of CMU's walkers, degrees. They differ by 4° (standard deviation).
const USUAL_DEG: [f32; NECK - 1] = [3.0, 2.0, 0.0];

/// Pitch of the upper chest beside the usual one from which on it is the skeleton's and not the person's, degrees.
const UNUSUAL_DEG: f32 = 12.0;

/// Least time of walking that shows how somebody walks, seconds.
const ENOUGH_SECS: f64 = 4.0;

/// Styles that show how upright a person is: acted walks stoop on purpose.
const PLAIN: [&str; 3] = ["", "neutral", "normal"];

/// A turn of the trunk, the same in all frames of a person.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrunkTurn(Pitches);

/// A person whose skeleton has a bent trunk.
#[derive(Clone, Debug, PartialEq)]
pub struct BentTrunk {
    /// The person.
    pub subject: String,
    /// Mean pitch of the upper chest in plain walks, downwards, degrees.
    pub recorded_deg: f32,
    /// Turn that sets the trunk upright. Pelvis, legs, arms and head keep their directions.
    pub turn: TrunkTurn,
}

impl TrunkTurn {
    /// Turns the features at the beginning of a row.
    pub(super) fn turn(&self, row: &mut [f32]) {
        if *self == Self::default() {
            return;
        }
        let mut features: Vec<f64> = row[..FEATURE_COUNT]
            .iter()
            .copied()
            .map(f64::from)
            .collect();
        turn(&mut features, &self.0);
        for (value, turned) in row.iter_mut().zip(features) {
            *value = turned as f32;
        }
    }
}

/// Finds the people whose plain walks show a bent trunk.
pub fn bent_trunks(recordings: &[Recording]) -> Vec<BentTrunk> {
    let mut walked: BTreeMap<&str, (Sum, f64)> = BTreeMap::new();
    for recording in recordings {
        if !PLAIN.contains(&recording.style()) {
            continue;
        }
        let clip = recording.clip();
        let steps = recording.walks.iter().flat_map(|walk| &walk.steps);
        let (sum, secs) = walked.entry(recording.subject()).or_default();
        for step in steps.filter(|step| step.take_off.is_none()) {
            sum.add(clip, step);
            *secs += (step.end - step.first) as f64 / clip.frame_rate_hz;
        }
    }
    let mut usual = Pitches::default();
    usual[1..NECK].copy_from_slice(&USUAL_DEG.map(f32::to_radians));
    let bent = walked.into_iter().map(|(subject, (sum, secs))| {
        let mean = sum.mean();
        let turns = trunk_turns(&mean, &usual);
        let is_bent = secs >= ENOUGH_SECS && turns[NECK - 1].abs() > UNUSUAL_DEG.to_radians();
        is_bent.then(|| BentTrunk {
            subject: subject.to_owned(),
            recorded_deg: mean[NECK - 1].to_degrees(),
            turn: TrunkTurn(turns),
        })
    });
    bent.flatten().collect()
}

/// Sets the trunks of those people upright, in all their recordings.
pub fn level_trunks(recordings: &mut [Recording], bent: &[BentTrunk]) {
    for recording in recordings {
        let own = bent.iter().find(|own| own.subject == recording.subject());
        let Some(own) = own else { continue };
        let clip = &mut recording.retargeted.clip;
        for pose in &mut clip.poses {
            turn_pose(pose, &own.turn.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapt::tests::clips;
    use footfall_core::{Joint, ModelPose};
    use footfall_model::layout;

    /// Recordings of a person with this name, whose trunk is turned on its skeleton.
    fn person(name: &str, turns: &Pitches) -> Vec<Recording> {
        let clips = clips("path=walker_1_*").into_iter();
        let mut clips: Vec<Recording> = clips.map(|clip| clip.of_subject(name)).collect();
        for clip in clips.iter_mut().map(|clip| &mut clip.retargeted.clip) {
            for pose in &mut clip.poses {
                turn_pose(pose, turns);
            }
        }
        clips
    }

    #[test]
    fn a_bent_skeleton_stands_upright_and_all_else_stays() {
        let bent = person("bent", &[0.0, -0.3, -0.35, -0.4, 0.0, 0.0]);
        let straight = person("straight", &Pitches::default());
        let mut all = [bent.clone(), straight.clone()].concat();
        let found = bent_trunks(&all);
        assert_eq!(found.len(), 1);
        assert!(found[0].subject == "bent" && found[0].recorded_deg < -15.0);
        level_trunks(&mut all, &found);
        let (now, others) = all.split_at(bent.len());
        for (before, after) in straight.iter().zip(others) {
            assert_eq!(before.clip().poses, after.clip().poses);
        }
        for (before, after) in straight.iter().zip(now) {
            let [before, after] = [before, after].map(Recording::clip);
            for (upright, levelled) in before.poses.iter().zip(&after.poses).step_by(20) {
                let [upright, levelled] =
                    [upright, levelled].map(|pose| ModelPose::of(&before.skeleton, pose));
                for joint in Joint::ALL {
                    let turned = upright
                        .rotation(joint)
                        .angle_between(levelled.rotation(joint));
                    // As upright as people, who differ.
                    let most = if joint < Joint::Neck { 0.15 } else { 1e-3 };
                    assert!(turned < most, "{joint:?} by {turned}");
                }
                for joint in [Joint::LeftFoot, Joint::RightLowerLeg] {
                    let moved = upright.position(joint).distance(levelled.position(joint));
                    assert!(moved < 1e-4, "{joint:?} by {moved} m");
                }
            }
        }
    }
    #[test]
    fn a_row_of_a_model_turns_as_a_pose_does() {
        let turns = TrunkTurn([0.0, 0.3, 0.35, 0.4, 0.0, 0.0]);
        for before in clips("path=walker_1_*")[0].clip().poses.iter().step_by(30) {
            let mut features = [0.0; FEATURE_COUNT];
            layout::encode(before, 0.0, None, &mut features);
            let mut row = features.map(|value| value as f32);
            turns.turn(&mut row);
            let mut from_row = before.clone();
            layout::decode(&row, &mut from_row.rotations);
            let mut turned = before.clone();
            turn_pose(&mut turned, &turns.0);
            let joints = from_row.rotations.iter().zip(&turned.rotations).skip(1);
            for (row, pose) in joints {
                assert!(row.angle_between(*pose) < 1e-3);
            }
        }
    }
}
