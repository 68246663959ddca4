//! A finding in one line, for the person who opened the recording.

use super::{HipCorrection, HipFinding, HipVerdict};
use footfall_core::Skeleton;
use glam::Vec2;
use std::fmt::{Display, Formatter, Result};

/// Below this, centimetres, left and right are said to move alike.
const ALIKE_CM: f32 = 0.05;

/// The line begins with "moved", "left" or "not looked at"; lengths are centimetres on the canonical body.
impl Display for HipFinding {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        let recorded = knee(self.recorded_knee);
        let strides = self.strides;
        match &self.verdict {
            HipVerdict::Corrected(correction) => write!(
                out,
                "moved {} cm up and {} cm forwards, legs {:.3} of their length: knees {recorded} to {} at heel strike, in \
                 loading and before push-off over {strides} strides",
                along(correction, |offset| offset.x),
                along(correction, |offset| offset.y),
                correction.leg_factor,
                knee(self.knee),
            ),
            HipVerdict::AsRecorded => out.write_str("not looked at: left as recorded"),
            HipVerdict::OwnBody => out.write_str("left: the body is the canonical one"),
            HipVerdict::Natural => write!(
                out,
                "left: knees bend {recorded} over {strides} strides, which no misplaced joint has to explain"
            ),
            HipVerdict::OwnManner => write!(
                out,
                "left: knees bend {recorded} over {strides} strides, which a manner of walking explains better than a \
                 misplaced joint"
            ),
            HipVerdict::TooLittleWalking => {
                write!(out, "left: {strides} strides of plain walking are too few")
            }
        }
    }
}

impl HipCorrection {
    /// Ways of the left and of the right joint up (*x*) and forwards (*y*), centimetres on the canonical body.
    pub fn moved_cm(&self) -> [Vec2; 2] {
        let leg_cm = 100.0 * Skeleton::standard().mean_leg_length();
        self.offsets.map(|offset| offset * leg_cm)
    }
}

/// Way along one axis, one number where both joints move alike.
fn along(correction: &HipCorrection, axis: fn(Vec2) -> f32) -> String {
    let [left, right] = correction.moved_cm().map(axis);
    if (left - right).abs() < ALIKE_CM {
        format!("{left:+.1}")
    } else {
        format!("{left:+.1} (left) {right:+.1} (right)")
    }
}

fn knee(angles: Option<[f32; 3]>) -> String {
    angles.map_or_else(String::new, |[strike, peak, end]| {
        format!("{strike:.0}/{peak:.0}/{end:.0}°")
    })
}
