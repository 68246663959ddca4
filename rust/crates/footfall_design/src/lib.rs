//! Offline: styles without motion capture of them. A style sheet describes changes to a captured walk, and the walk is converted
//! to that style, with planted feet.
//!
//! Data flow: [`sheet`] parses text to numbers; `timeline` maps new frames to captured ones; `course` computes the path over the
//! ground; `body` edits pelvis, trunk, head and arms; `ground` solves hips, feet and legs. The natural variation of the capture
//! between steps is kept.

mod body;
mod chance;
mod course;
mod curve;
mod ground;
pub mod sheet;
pub mod shipped;
mod timeline;

pub use sheet::{KeySpec, SheetError, StyleSheet};

use course::Course;
use footfall_core::{Clip, Pose};
use footfall_motion::contacts::Contacts;
use footfall_motion::steps::Walk;
use ground::Ground;
use timeline::Timeline;

/// Least mean speed of a walk that has a direction, m/s.
const LEAST_SPEED_MPS: f32 = 0.2;

/// Errors of applying a sheet to a clip.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DesignError {
    /// No run of steps to build on.
    #[error("the longest walk has {steps} steps; give a clip with at least two consecutive steps")]
    TooFewSteps {
        /// Steps of the longest walk.
        steps: usize,
    },
    /// The body stays where it is, so there is no way ahead.
    #[error("the body moves at {0:.2} m/s; give a clip of walking ahead")]
    Standing(f32),
}

/// A captured walk in the style of a sheet, on the same body and at the same rate.
///
/// `contacts` and `walks` are the clip's own. The new clip holds the longest walk and up to a step before and after it. A
/// sheet that changes nothing gives the clip back as it is, from the first frame of its motion. The same `seed` draws the
/// same irregular steps.
///
/// # Errors
/// [`DesignError`] for a clip without two steps in a row or without a way ahead.
pub fn design(
    clip: &Clip,
    contacts: &Contacts,
    walks: &[Walk],
    sheet: &StyleSheet,
    seed: u64,
) -> Result<Clip, DesignError> {
    let timeline = Timeline::new(clip, contacts, walks, sheet, seed)?;
    if sheet.is_neutral() {
        return Ok(Clip {
            poses: clip.poses[contacts.first_frame..].to_vec(),
            ..clip.clone()
        });
    }
    let rate_hz = clip.frame_rate_hz;
    let poses: Vec<Pose> = timeline
        .source
        .iter()
        .filter_map(|frame| clip.pose_at(frame / rate_hz))
        .collect();
    let old = Course::captured(&poses, &timeline);
    let way = old.place[0].distance(old.place[old.place.len() - 1]);
    let captured_secs = (timeline.source[timeline.frames() - 1] - timeline.source[0]) / rate_hz;
    let speed = way / (captured_secs as f32).max(1e-3);
    if speed < LEAST_SPEED_MPS {
        return Err(DesignError::Standing(speed));
    }
    let new = old.styled(&timeline, sheet, rate_hz, seed);
    let mut styled = poses.clone();
    body::edit_body(&mut styled, &old, &timeline, sheet, rate_hz, seed);
    let captured = Clip {
        skeleton: clip.skeleton.clone(),
        frame_rate_hz: rate_hz,
        poses,
    };
    Ground {
        captured: &captured,
        timeline: &timeline,
        old: &old,
        new: &new,
        sheet,
        seed,
    }
    .place(&mut styled);
    Ok(Clip {
        poses: styled,
        ..captured
    })
}
