//! Runtime: samples, orientation, features and gait events of inertial sensors.
//!
//! Modules in the order of data flow: [`sample`]s, read from [`csv`] recordings or computed from tracked poses by a [`pose_meter`]; recordings and their [`checks`], a [`stream_monitor`] that checks live samples, the measurements at [`rest`], the [`orientation`] of the sensor, the
//! [`features`] that a reconstructor compares with its model, and, for a foot sensor, gait [`events`] and [`strides`], which a [`contact_meter`] and a
//! [`stride_meter`] report live. With the feature `live`, [`live`] receives samples over serial ports and networks; without it, the crate opens no port.
//!
//! Specific force is in m/s² and includes gravity (a sensor at rest reads +9.81 along up), angular rate is in rad/s, and axes are
//! right-handed.

pub mod checks;
mod columns;
pub mod contact_meter;
pub mod csv;
pub mod events;
pub mod features;
pub mod filter;
#[cfg(feature = "live")]
pub mod live;
pub mod orientation;
pub mod pose_meter;
pub mod rest;
pub mod sample;
pub mod stream_monitor;
pub mod stride_meter;
pub mod strides;
mod units;
mod zero_velocity;

pub use checks::{RecordingFault, check_recording};
pub use contact_meter::{ContactMeter, SensorContact};
pub use csv::ImuCsvError;
pub use features::{FeatureFrame, FeatureStream, SENSOR_FEATURES};
pub use orientation::OrientationFilter;
pub use pose_meter::PoseMeter;
pub use rest::{Rest, find_rest};
pub use sample::{GRAVITY_MPS2, ImuRecording, ImuSample};
pub use stream_monitor::{FaultSpan, StreamFault, StreamMonitor};
pub use stride_meter::StrideMeter;
pub use units::{ForceUnit, RateUnit, TimeUnit};
