//! Level heads of an average walk that was learned from heads as recorded.
//!
//! The error of a head is a constant of a person, which says nothing about gait, but takes part in what distinguishes walkers. Were it taken from the
//! recordings, the walkers that a model's seeds make would become other ones with every finding about heads. So walks are learned as recorded, and the
//! average walker's mean gets what was found.

use footfall_core::Joint;
use footfall_core::rotation::{exp_map, log_map_near};
use footfall_model::GaitModel;
use footfall_model::layout::feature_offset;
use footfall_motion::recording::Recording;
use glam::{Quat, Vec3};

/// Share of it that is taken. It was chosen on a test: with all of it two samples of the model's own walkers are told apart by smoothness with 0.685, beyond 0.68.
const SHARE: f32 = 0.9;

/// Turns neck and head of every state by the mean of what was found about the people in recordings, each as often as strides were found.
pub(crate) fn level(model: &mut GaitModel, recordings: &[Recording]) {
    let mut seen: Vec<&str> = Vec::new();
    let (mut strides, mut turns) = (0.0, [0.0_f32; 2]);
    for recording in recordings {
        let name = recording.subject();
        if seen.contains(&name) {
            continue;
        }
        seen.push(name);
        if let Some(found) = recording.retargeted.report.fit.head {
            let (recorded, corrected) = (found.recorded, found.corrected);
            let own = found.strides as f32;
            strides += own;
            turns[0] += own * (corrected.neck.x - recorded.neck.x);
            turns[1] += own * (corrected.head.x - recorded.head.x);
        }
    }
    if strides <= 0.0 {
        return;
    }
    let [neck, head] =
        turns.map(|degrees| Quat::from_rotation_x((SHARE * degrees / strides).to_radians()));
    for state in model.steps.iter_mut().flat_map(|step| &mut step.states) {
        turn_feature(&mut state.mean, Joint::Neck, Quat::IDENTITY, neck);
        turn_feature(&mut state.mean, Joint::Head, neck.inverse(), head);
    }
}

/// Turns a joint of features in the axes of its parent and in its own.
pub(crate) fn turn_feature(features: &mut [f64], joint: Joint, parent: Quat, own: Quat) {
    let at = feature_offset(joint);
    let vector = &mut features[at..at + 3];
    let before = Vec3::new(vector[0] as f32, vector[1] as f32, vector[2] as f32);
    let turned = log_map_near(parent * exp_map(before) * own, before);
    for (value, turned) in vector.iter_mut().zip(turned.to_array()) {
        *value = f64::from(turned);
    }
}
