//! The published method where this crate does otherwise, one switch each, to compare (`footfall evaluate imu --as-published`).

mod phase_deviations;

pub(crate) use phase_deviations::PhaseDeviations;

use crate::blend::Blending;
use crate::prepared::Prepared;
use crate::reconstructor::ReconConfig;

/// Part of the method as published (Mousas 2017).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Published {
    /// Three transitions with equal probabilities on both levels (section 5.2): a frame is kept, followed or skipped, and in every frame the phase may be
    /// left for any other. The next phase is entered in any of its segments.
    Transitions,
    /// A Gaussian for each phase, refined by all of its segments (equations 8 and 9), every frame of the sensor in full, and none ignored because it fits nothing.
    Gaussians,
    /// Interpolation of five segments of the most probable phase (section 5.3).
    Interpolation,
    /// Regression of the body on the sensor (equation 6).
    Regression,
    /// Velocity-based blending (section 6).
    Blending,
    /// Bodies of single people, not drawn to those of others.
    Manner,
    /// Sensors alone, without the time since a foot landed.
    Strides,
}

impl Published {
    /// All parts.
    pub const ALL: [Self; 7] = [
        Self::Transitions,
        Self::Gaussians,
        Self::Interpolation,
        Self::Regression,
        Self::Blending,
        Self::Manner,
        Self::Strides,
    ];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Transitions => "transitions",
            Self::Gaussians => "gaussians",
            Self::Interpolation => "interpolation",
            Self::Regression => "regression",
            Self::Blending => "blending",
            Self::Manner => "manner",
            Self::Strides => "strides",
        }
    }

    /// One line about it, for the command line's help.
    pub const fn summary(self) -> &'static str {
        match self {
            Self::Transitions => {
                "Equal transitions: a frame is kept, followed or skipped, and phases end at any time"
            }
            Self::Gaussians => {
                "A Gaussian for each phase, refined by its segments, with every frame in full"
            }
            Self::Interpolation => "Five segments of the most probable phase",
            Self::Regression => "Regression of the body on the sensor",
            Self::Blending => "Velocity-based blending",
            Self::Manner => "Bodies of single people, not drawn to those of others",
            Self::Strides => "Sensors alone, without the time since a foot landed",
        }
    }

    /// Sets this part.
    pub const fn set(self, recon: &mut ReconConfig) {
        let config = &mut recon.tracker;
        match self {
            Self::Transitions => {
                config.stay_next_skip = [1.0 / 3.0; 3];
                config.keep_recording = 0.0;
                config.keep_subject = 0.0;
                config.exit = 1.0 / 3.0;
                config.round_frames = 1;
            }
            Self::Gaussians => {
                config.evidence = 1.0;
                config.farthest = f32::MAX;
                recon.stands_unexplained = false;
            }
            Self::Interpolation => {
                config.interpolated = 5;
                config.one_phase = true;
            }
            Self::Regression => config.regression = 1.0,
            Self::Blending => recon.blending = Blending::Velocity { gain: 0.6 },
            Self::Manner => {}
            Self::Strides => config.stride = 0.0,
        }
    }

    /// Lays a model out for these parts.
    #[must_use]
    pub fn prepare(parts: &[Self], prepared: Prepared) -> Prepared {
        let prepared = if parts.contains(&Self::Manner) {
            prepared.with_bodies_as_recorded()
        } else {
            prepared
        };
        if parts.contains(&Self::Gaussians) {
            prepared.with_phase_deviations()
        } else {
            prepared
        }
    }
}
