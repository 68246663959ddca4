//! Level heads of an average walk that was learned from heads as recorded.
//!
//! The error of a head is a constant of a person, which says nothing about gait, but takes part in what distinguishes walkers. Were it taken from the
//! recordings, the walkers that a model's seeds make would become other ones with every finding about heads. So walks are learned as recorded, and the
//! average walker's mean gets what was found.

use footfall_core::Joint;
use footfall_core::rotation::{exp_map, log_map_near};
use footfall_model::layout::feature_offset;
use footfall_model::{GaitModel, StateModel};
use footfall_motion::recording::Recording;
use glam::{Quat, Vec3};

/// Turns neck and head of every state by the mean of what was found about the people in recordings. Each person counts once.
pub(crate) fn level(model: &mut GaitModel, recordings: &[Recording]) {
    let mut people: Vec<(&str, [f32; 2])> = Vec::new();
    for recording in recordings {
        let name = recording.subject();
        if people.iter().all(|(known, _)| *known != name) {
            let found = recording.retargeted.report.fit.head;
            let turns = found.map_or([0.0; 2], |found| {
                let (recorded, corrected) = (found.recorded, found.corrected);
                [
                    corrected.neck.x - recorded.neck.x,
                    corrected.head.x - recorded.head.x,
                ]
            });
            people.push((name, turns));
        }
    }
    let [neck, head] = [0, 1].map(|joint| {
        let degrees: f32 = people.iter().map(|(_, turns)| turns[joint]).sum();
        Quat::from_rotation_x((degrees / people.len().max(1) as f32).to_radians())
    });
    for state in model.steps.iter_mut().flat_map(|step| &mut step.states) {
        turn(state, Joint::Neck, Quat::IDENTITY, neck);
        turn(state, Joint::Head, neck.inverse(), head);
    }
}

/// Turns a joint's mean in the axes of its parent and in its own.
fn turn(state: &mut StateModel, joint: Joint, parent: Quat, own: Quat) {
    let at = feature_offset(joint);
    let mean = &mut state.mean[at..at + 3];
    let before = Vec3::new(mean[0] as f32, mean[1] as f32, mean[2] as f32);
    let turned = log_map_near(parent * exp_map(before) * own, before);
    for (value, turned) in mean.iter_mut().zip(turned.to_array()) {
        *value = f64::from(turned);
    }
}
