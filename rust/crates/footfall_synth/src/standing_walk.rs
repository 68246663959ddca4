//! A whole walk out of standing and back into it, as the streaming generator walks it.

use crate::error::SynthError;
use crate::generator::{Controls, GaitGenerator, GeneratorConfig};
use crate::space::StyleSpace;
use crate::walk::{SynthesizedWalk, WalkConfig};
use footfall_core::rotation::from_heading;
use footfall_core::{Clip, FrameSpan, Joint, Pose, Skeleton};
use footfall_model::GaitModel;
use std::sync::Arc;

/// Standing before and after the walk, seconds.
const STANDING_SECS: f64 = 0.6;

/// No walk takes longer than this a step, seconds.
const LONGEST_STEP_SECS: f64 = 4.0;

const STAND: Controls = Controls {
    speed_mps: 0.0,
    turn_rate_radps: 0.0,
};

pub(crate) fn synthesize(
    model: &Arc<GaitModel>,
    skeleton: &Skeleton,
    config: &WalkConfig,
) -> Result<SynthesizedWalk, SynthError> {
    let space = Arc::new(StyleSpace::new(model, &[])?);
    let walker = GeneratorConfig {
        seed: config.seed,
        phase: 0.0,
        variation: config.variation,
    };
    let mut generator = GaitGenerator::new(&space, &[], skeleton, &walker)?;
    generator.stand();
    let mut recording = Recording {
        generator,
        frame_rate_hz: config.frame_rate_hz.unwrap_or(model.frame_rate_hz),
        poses: Vec::new(),
        contact: [Vec::new(), Vec::new()],
    };
    let frames = |secs: f64| (secs * recording.frame_rate_hz).round() as usize;
    let (rest, longest) = (frames(STANDING_SECS), frames(LONGEST_STEP_SECS));
    let walking = Controls {
        speed_mps: config.speed_mps.unwrap_or(model.speed.reference_mps as f32),
        turn_rate_radps: config.turn_rate_radps,
    };
    for _ in 0..=rest {
        recording.step(STAND);
    }
    // The last step is the one that stops: it is asked for while the one before is walked.
    let mut taken = 0;
    let steps = config.steps.max(2);
    for _ in 0..steps * longest {
        if taken + 1 == steps {
            break;
        }
        taken += recording.step(walking);
    }
    for _ in 0..2 * longest {
        if taken >= steps && recording.generator.is_standing() {
            break;
        }
        taken += recording.step(STAND);
    }
    for _ in 0..rest {
        recording.step(STAND);
    }
    Ok(recording.into_walk(skeleton))
}

struct Recording {
    generator: GaitGenerator,
    frame_rate_hz: f64,
    poses: Vec<Pose>,
    contact: [Vec<bool>; 2],
}

impl Recording {
    /// Records a frame and tells how many steps began.
    fn step(&mut self, controls: Controls) -> usize {
        // The first frame is where the walker stands.
        let dt = if self.poses.is_empty() {
            0.0
        } else {
            (1.0 / self.frame_rate_hz) as f32
        };
        let mut pose = Pose::default();
        self.generator.step(dt, &controls, &mut pose);
        let place = self.generator.start_from_character();
        let turn = from_heading(place.heading);
        pose.root_position = turn * pose.root_position + place.position;
        let hips = Joint::Hips.index();
        pose.rotations[hips] = (turn * pose.rotations[hips]).normalize();
        self.poses.push(pose);
        let feet = self.generator.feet_in_contact();
        for (contact, bears) in self.contact.iter_mut().zip(feet) {
            contact.push(bears);
        }
        self.generator.footsteps().len()
    }

    fn into_walk(self, skeleton: &Skeleton) -> SynthesizedWalk {
        SynthesizedWalk {
            contacts: self.contact.map(|contact| spans(&contact)),
            clip: Clip {
                skeleton: skeleton.clone(),
                frame_rate_hz: self.frame_rate_hz,
                poses: self.poses,
            },
        }
    }
}

/// The runs of frames that hold.
fn spans(holds: &[bool]) -> Vec<FrameSpan> {
    let mut spans: Vec<FrameSpan> = Vec::new();
    for (frame, _) in holds.iter().enumerate().filter(|(_, holds)| **holds) {
        match spans.last_mut() {
            Some(span) if span.last + 1 == frame => span.last = frame,
            _ => spans.push(FrameSpan {
                first: frame,
                last: frame,
            }),
        }
    }
    spans
}
