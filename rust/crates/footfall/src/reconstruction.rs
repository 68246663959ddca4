//! A whole body from the measurements of one or two sensors.
//!
//! [`Prepared`] prepares a model once for all bodies. A [`Reconstructor`] takes samples as they arrive and writes poses. A [`ReconConfig`], with a [`TrackerConfig`], holds
//! its settings; a [`SensorState`] reports whether samples arrive, a [`Behaviour`] what the body does. [`reconstruct_recording`] makes a [`Reconstructed`] of a whole
//! recording, in which later samples improve earlier frames. Poses are relative to the body's start; [`Reconstructor::split`] divides one into the character's place and the pose above it.
//!
//! ```
//! use footfall::body::Pose;
//! use footfall::model::ImuModel;
//! use footfall::reconstruction::{
//!     Behaviour, Prepared, ReconConfig, Reconstructed, Reconstructor, SensorState, reconstruct_recording,
//! };
//! use footfall::sensor::csv;
//! use std::path::Path;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/right_foot.footimu")?;
//! let model = Arc::new(ImuModel::from_bytes(&bytes)?);
//! let body = model.skeleton.clone();
//! let prepared = Arc::new(Prepared::new(model)?);
//! let config = ReconConfig::default();
//! let recording = csv::read(Path::new("tests/data/walker_1_slow.right_foot.csv"))?;
//!
//! let mut live = Reconstructor::new(&prepared, &body, &config)?;
//! assert_eq!(live.sensor_state(), SensorState::Waiting);
//! let mut pose = Pose::rest(&body);
//! for sample in &recording.samples {
//!     live.push(0, *sample);
//!     live.step(0.01, &mut pose); // A game does this once a frame.
//! }
//! assert_eq!(live.sensor_state(), SensorState::Tracking);
//! assert_eq!(live.behaviour(), Behaviour::Walk);
//!
//! // For an engine: the place and heading of the character, and the pose above it.
//! let (place, heading) = live.split(&mut pose);
//! assert!(place.z > 3.0 && heading.abs() < 0.5, "{place} {heading}");
//! assert!(pose.root_position.with_y(0.0).length() < 0.3, "{}", pose.root_position);
//!
//! let whole: Reconstructed = reconstruct_recording(&prepared, &[recording], &body, &config, false)?;
//! let walks = whole.behaviours.iter().filter(|behaviour| **behaviour == Behaviour::Walk);
//! assert!(walks.count() > whole.clip.poses.len() / 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Blending`], in [`ReconConfig`], is the transition of the shown body between segments of the recordings.
//!
//! [`find_mounting`] finds the [`Mounting`] of a sensor in any orientation from a recording of a few steps; a [`MountingError`] reports too
//! little motion. Pass [`Mounting::site_from_sensor`] to [`Reconstructor::set_mounting`].
//!
//! ```
//! use footfall::glam::Quat;
//! use footfall::model::ImuModel;
//! use footfall::reconstruction::{Mounting, MountingError, Prepared, TrackerConfig, find_mounting};
//! use footfall::sensor::csv;
//! use std::path::Path;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/right_foot.footimu")?;
//! let prepared = Arc::new(Prepared::new(Arc::new(ImuModel::from_bytes(&bytes)?))?);
//! let aligned = csv::read(Path::new("tests/data/walker_1_slow.right_foot.csv"))?;
//! let worn = Quat::from_rotation_x(1.0) * Quat::from_rotation_z(2.0);
//! let recording = aligned.turned(worn);
//! let mounting: Result<Mounting, MountingError> =
//!     find_mounting(&prepared, 0, &recording, &TrackerConfig::default());
//! // Turned back by what was found, the recording is nearly the aligned one.
//! let error = (mounting?.site_from_sensor * worn).angle_between(Quat::IDENTITY);
//! assert!(error < 0.35, "{error}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`examine()`] finds the mounting and its problems: an [`Examination`] with a [`SensorProblem`] if the sensor is on the other side of the body, or turned from the assumed
//! mounting. [`find_exchange`] does so for two sensors that may be swapped. The message of each problem says what to do; [`Reconstructor::problem`] returns the current one.
//!
//! ```
//! use footfall::glam::Quat;
//! use footfall::model::ImuModel;
//! use footfall::reconstruction::{
//!     Examination, Prepared, SensorProblem, TrackerConfig, examine, find_exchange,
//! };
//! use footfall::sensor::csv;
//! use std::path::Path;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/right_foot.footimu")?;
//! let prepared = Arc::new(Prepared::new(Arc::new(ImuModel::from_bytes(&bytes)?))?);
//! let recording = csv::read(Path::new("tests/data/walker_1_slow.right_foot.csv"))?;
//! let config = TrackerConfig::default();
//! let believed = Quat::from_rotation_z(3.0); // Upside down.
//! let examined: Examination = examine(&prepared, 0, &recording, Some(believed), &config)?;
//! let problem: Option<SensorProblem> = examined.finding;
//! assert!(problem.is_some_and(|problem| problem.name() == "turned"));
//! // A model of one sensor has none to exchange.
//! assert_eq!(find_exchange(&prepared, [&recording, &recording], &config)?, None);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`SensorCalibration`] stores what a session has learned about wearer and sensors, with a [`CalibratedSensor`] per [`Site`], as the bytes of a `.footcal` file; a [`CalibrationError`] gives the reason for a refusal. A
//! [`CalibrationGuide`] guides the wearer through the [`GuideStep`]s. [`Prepared::wear`] makes a [`WornRecording`] of samples in the sensor's axes, ready for
//! [`reconstruct_recording`], with a [`ProblemSpan`] for each problem.
//!
//! ```
//! use footfall::glam::Quat;
//! use footfall::model::ImuModel;
//! use footfall::reconstruction::{
//!     CalibratedSensor, CalibrationError, CalibrationGuide, GuideStep, Prepared, ProblemSpan, ReconConfig, Reconstructor,
//!     SensorCalibration, Site, WornRecording,
//! };
//! use footfall::sensor::csv;
//! use std::path::Path;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/right_foot.footimu")?;
//! let prepared = Arc::new(Prepared::new(Arc::new(ImuModel::from_bytes(&bytes)?))?);
//! let body = prepared.model().skeleton.clone();
//! let recording = csv::read(Path::new("tests/data/walker_1_slow.right_foot.csv"))?;
//!
//! let mut guide = CalibrationGuide::default();
//! guide.push(&recording.samples[0]);
//! guide.push(&recording.samples[1]);
//! assert_eq!(guide.step(), GuideStep::Stand); // Show `guide.step().message()` to the wearer.
//!
//! let mut live = Reconstructor::new(&prepared, &body, &ReconConfig::default())?;
//! live.set_mounting(0, Quat::IDENTITY);
//! let kept: SensorCalibration = live.calibration().expect("the mounting is known");
//! let bytes = kept.to_bytes()?;
//! live.calibrate(&SensorCalibration::from_bytes(&bytes)?)?; // In the next session.
//! let refused = SensorCalibration::from_bytes(b"anything else");
//! assert!(refused.is_err_and(|error: CalibrationError| error == CalibrationError::NotACalibration));
//!
//! let aligned = CalibratedSensor::mounted(Site::RightFoot, Quat::IDENTITY);
//! let worn: WornRecording = prepared.wear(0, &recording, &aligned, None);
//! let problems: Vec<ProblemSpan> = worn.problems;
//! assert!(problems.is_empty(), "{problems:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use footfall_core::{Behaviour, Site};
pub use footfall_model::{CalibratedSensor, CalibrationError, SensorCalibration};
pub use footfall_recon::{
    Blending, CalibrationGuide, Examination, GuideStep, Mounting, MountingError, Prepared,
    ProblemSpan, ReconConfig, Reconstructed, Reconstructor, SensorProblem, SensorState,
    TrackerConfig, WornRecording, examine, find_exchange, find_mounting, reconstruct_recording,
};
