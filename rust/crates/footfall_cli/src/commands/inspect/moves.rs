//! Jumps and crouching of a model's people.

use footfall_model::{FEATURE_COUNT, GaitModel};
use serde::Serialize;

/// Jumps of a model's people off both feet, in metres on its own body.
#[derive(Serialize)]
pub(in crate::commands) struct JumpFacts {
    /// Rise of the hips above standing: least, mean and most.
    rise_m: [f64; 3],
    /// Way forwards: least, mean and most.
    way_m: [f64; 3],
    /// Mean time from standing to take-off, and from landing to standing, seconds.
    load_secs: f64,
    landing_secs: f64,
}

/// Crouching of a model's people.
#[derive(Serialize)]
pub(in crate::commands) struct CrouchFacts {
    /// Lowering of the hips, metres on the model's own body.
    depth_m: f64,
    /// Fastest that they go, m/s.
    fastest_mps: f64,
}

impl JumpFacts {
    pub(in crate::commands) fn of(model: &GaitModel) -> Option<Self> {
        let leg = f64::from(model.skeleton.mean_leg_length());
        model.jump.as_ref().map(|jump| Self {
            rise_m: jump.rise.map(|rise| rise * leg),
            way_m: jump.way.map(|way| way * leg),
            load_secs: jump.phases[..2].iter().map(|phase| phase.secs[0]).sum(),
            landing_secs: jump.phases[3..].iter().map(|phase| phase.secs[0]).sum(),
        })
    }

    pub(in crate::commands) fn line(&self) -> String {
        format!(
            "hips rise {:.2} to {:.2} m (mean {:.2}) and go {:.2} to {:.2} m forwards, {:.2} s before take-off, {:.2} s after landing",
            self.rise_m[0],
            self.rise_m[2],
            self.rise_m[1],
            self.way_m[0],
            self.way_m[2],
            self.load_secs,
            self.landing_secs
        )
    }
}

impl CrouchFacts {
    pub(in crate::commands) fn of(model: &GaitModel) -> Option<Self> {
        let leg = f64::from(model.skeleton.mean_leg_length());
        model.crouch.as_ref().map(|crouch| Self {
            depth_m: -leg * crouch.beside[FEATURE_COUNT],
            fastest_mps: leg * crouch.fastest,
        })
    }

    pub(in crate::commands) fn line(&self) -> String {
        format!(
            "hips {:.2} m lower, up to {:.2} m/s",
            self.depth_m, self.fastest_mps
        )
    }
}
