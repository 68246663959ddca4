//! Models that training hands to the runtime: the feature layout, the gait model, and its versioned file.
//!
//! Probability is in f64 and poses are in f32; the two meet in [`layout`]. The crate works on bytes: it reads and
//! writes no file.
//!
//! Modules in suggested reading order: [`layout`], [`gait_model`], [`style`], [`dynamics`], [`imu_model`], [`standing`], [`jumping`], [`crouching`], [`sensor_calibration`], [`provenance`], [`mod@file`].

mod check;
pub mod crouching;
pub mod dynamics;
pub mod file;
pub mod fine_motion;
pub mod gait_model;
pub mod imu_model;
pub mod jumping;
pub mod layout;
pub mod provenance;
pub mod sensor_calibration;
pub mod standing;
pub mod style;

pub use check::ModelError;
pub use crouching::CrouchModel;
pub use dynamics::{DynamicsModel, Regime, SEGMENT_SLACK};
pub use file::{FORMAT_VERSION, ModelFileError, WalkModel};
pub use fine_motion::{
    FINE_POINTS, FINE_REACH, FINE_TAPS, FineChance, FineMotion, FineTable, MAX_FINE_DIRECTIONS,
};
pub use gait_model::{
    GaitModel, GlobalVarianceModel, STATES_PER_STEP, SpeedResponse, StateModel, StepContext,
    StepModel, StepOffset, Variation,
};
pub use imu_model::ImuModel;
pub use jumping::{
    BESIDE_COUNT, JUMP_PHASES, JUMP_RESPONSES, JumpModel, JumpPhase, MAX_JUMP_KNOTS,
};
pub use layout::{FEATURE_COUNT, OBSERVATION_COUNT};
pub use provenance::Provenance;
pub use sensor_calibration::{CalibratedSensor, CalibrationError, SensorCalibration};
pub use standing::{
    Breath, LOOK_DIRECTIONS, Looks, MAX_SWAY_DIRECTIONS, MAX_SWAY_OCTAVES, SWAY_COUNT,
    StandingModel, SwayOctave,
};
pub use style::{FINE_SCALES, GaitStyle, StepSpread, StyleError, carried_posture_share};
