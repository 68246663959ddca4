//! Jumps off both feet, out of standing and back into it, as people make them.
//!
//! A jump has five phases: the body goes down, pushes off until take-off, flies, takes up the fall until it is lowest, and stands up. Each phase is a
//! mean course over its own time, as a linear regression on how high and how far the jump goes.

use crate::check::{ModelError, check_finite, check_len, check_positive};
use crate::layout::FEATURE_COUNT;

/// Numbers of a posture beside standing: a rotation vector for each joint, in the joint's own frame, in the order of the
/// [features](crate::layout); then the hips' way upwards and forwards, in leg lengths.
pub const BESIDE_COUNT: usize = FEATURE_COUNT + 2;

/// Phases of a jump: dip, push, flight, absorption and recovery.
pub const JUMP_PHASES: usize = 5;

/// Numbers that answer to a jump: the mean, the slope by its rise, and the slope by its way.
pub const JUMP_RESPONSES: usize = 3;

/// Knots of a phase at most.
pub const MAX_JUMP_KNOTS: usize = 32;

/// Jumps off both feet.
#[derive(Clone, Debug, PartialEq)]
pub struct JumpModel {
    /// Dip, push, flight, absorption and recovery.
    pub phases: [JumpPhase; JUMP_PHASES],
    /// Rise of the hips above their height in standing: least, mean and most of the recorded jumps, leg lengths.
    pub rise: [f64; 3],
    /// Way forwards of the recorded jumps: least, mean and most, leg lengths.
    pub way: [f64; 3],
}

/// One phase of a jump.
#[derive(Clone, Debug, PartialEq)]
pub struct JumpPhase {
    /// Duration: mean, seconds; slopes, seconds by leg length. That of a flight follows from gravity and serves as a check only.
    pub secs: [f64; JUMP_RESPONSES],
    /// Postures at evenly spaced times, both ends included: mean and slopes of [`BESIDE_COUNT`] numbers each. The hips' way is from where they
    /// stand before the jump until take-off, and from where they stand after it from landing on.
    pub knots: Vec<[Vec<f64>; JUMP_RESPONSES]>,
}

impl JumpModel {
    /// Checks every shape and value.
    pub(crate) fn check(&self) -> Result<(), ModelError> {
        for range in [&self.rise, &self.way] {
            check_finite("range of jumps", range)?;
            if !range.is_sorted() {
                return Err(ModelError::Value {
                    part: "range of jumps".to_owned(),
                });
            }
        }
        for phase in &self.phases {
            check_positive("duration of a jump", &phase.secs[..1])?;
            check_finite("duration of a jump", &phase.secs)?;
            if !(2..=MAX_JUMP_KNOTS).contains(&phase.knots.len()) {
                return Err(ModelError::Shape {
                    part: "knots of a jump".to_owned(),
                    expected: MAX_JUMP_KNOTS,
                    found: phase.knots.len(),
                });
            }
            for row in phase.knots.iter().flatten() {
                check_len("posture of a jump", row, BESIDE_COUNT)?;
                check_finite("posture of a jump", row)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> JumpModel {
        let phase = JumpPhase {
            secs: [0.4, 0.1, 0.0],
            knots: vec![[(); JUMP_RESPONSES].map(|()| vec![0.0; BESIDE_COUNT]); 2],
        };
        JumpModel {
            phases: [(); JUMP_PHASES].map(|()| phase.clone()),
            rise: [0.1, 0.3, 0.5],
            way: [0.0, 0.5, 1.5],
        }
    }

    #[test]
    fn only_whole_and_finite_jumps_pass() {
        assert_eq!(model().check(), Ok(()));
        let mut cut = model();
        cut.phases[1].knots[0][2].pop();
        let mut lonely = model();
        lonely.phases[2].knots.pop();
        let mut broken = model();
        broken.phases[0].knots[1][0][3] = f64::NAN;
        let mut timeless = model();
        timeless.phases[0].secs[0] = 0.0;
        let mut upside_down = model();
        upside_down.rise.reverse();
        for bad in [cut, lonely, broken, timeless, upside_down] {
            assert!(bad.check().is_err());
        }
    }
}
