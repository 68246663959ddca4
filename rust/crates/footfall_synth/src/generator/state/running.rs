//! Saving a run: its gaits, and the foot that is in the air as a step begins.

use super::is_reasonable;
use crate::gait::Gait;
use crate::generator::GaitGenerator;
use crate::ground::Airborne;
use crate::source::Steps;
use footfall_ik::FootTarget;
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

/// Gaits and airborne foot, behind a [`State`](super::State).
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Running {
    /// True for the previous step and this one if they are of a run.
    runs: [bool; 2],
    /// The foot in the air as the step begins: ankle, rotation of foot and toes, then and a frame earlier; and the time between.
    airborne: Option<([f32; 11], [f32; 11], f32)>,
}

impl Running {
    pub(super) fn of(generator: &GaitGenerator) -> Self {
        let Steps::Styled(steps) = &generator.steps else {
            return Self::default();
        };
        let feet = steps.window.origin().planter;
        let airborne = feet.and_then(|feet| feet.airborne);
        Self {
            runs: steps.window.blends().map(|blend| blend.gait == Gait::Run),
            airborne: airborne.map(|foot| {
                (
                    numbers_of(&foot.now),
                    numbers_of(&foot.before),
                    foot.frame_secs,
                )
            }),
        }
    }

    pub(super) fn gaits(&self) -> [Gait; 2] {
        self.runs
            .map(|runs| if runs { Gait::Run } else { Gait::Walk })
    }

    pub(super) fn airborne(&self) -> Option<Airborne> {
        self.airborne.map(|(now, before, frame_secs)| Airborne {
            now: foot_of(now),
            before: foot_of(before),
            frame_secs,
        })
    }

    pub(super) fn is_sensible(&self) -> bool {
        self.airborne.is_none_or(|(now, before, secs)| {
            let numbers = now.into_iter().chain(before).chain([secs]);
            secs > 0.0 && numbers.map(f64::from).all(is_reasonable)
        })
    }
}

/// A foot's numbers: ankle, rotation of the foot, rotation of the toes.
fn numbers_of(foot: &FootTarget) -> [f32; 11] {
    let [x, y, z] = foot.ankle.to_array();
    let [a, b, c, d] = foot.foot.to_array();
    let [e, f, g, h] = foot.toes.to_array();
    [x, y, z, a, b, c, d, e, f, g, h]
}

fn foot_of([x, y, z, a, b, c, d, e, f, g, h]: [f32; 11]) -> FootTarget {
    FootTarget {
        ankle: Vec3::new(x, y, z),
        foot: Quat::from_xyzw(a, b, c, d),
        toes: Quat::from_xyzw(e, f, g, h),
    }
}
