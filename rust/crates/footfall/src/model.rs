//! Models in files: walks, styles, sensors.
//!
//! Models are read from and written to bytes; the caller handles files. A [`ModelFileError`] reports invalid bytes, a [`ModelError`] the invalid part
//! of a model. No input panics.
//!
//! A [`GaitModel`] (`.footfall`) walks, stands and supports styles. A [`GaitStyle`] (`.footstyle`) is a way of walking for one model; a [`StyleError`] reports another
//! model's style. [`Provenance`] records a model's training data and their terms.
//!
//! ```
//! use footfall::model::{GaitModel, GaitStyle, ModelFileError};
//!
//! # std::env::set_current_dir("../../..")?;
//! let walk = GaitModel::from_bytes(&std::fs::read("addons/footfall/models/locomotion.footfall")?)?;
//! let proud = GaitStyle::from_bytes(&std::fs::read("addons/footfall/models/proud.footstyle")?)?;
//! walk.check_styles(&[&proud])?;
//! let [slowest, fastest] = walk.speed_range();
//! assert!(slowest < 1.2 && fastest > 1.5);
//! assert!(walk.provenance.steps > 100);
//! // Half as proud, as a model of its own.
//! assert!(walk.styled(&[(&proud, 0.5)])?.to_bytes().is_ok());
//! assert!(matches!(GaitModel::from_bytes(b"a picture"), Err(ModelFileError::NotAModel)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`DynamicsModel`] (`.footdyn`) is gait as two linear systems that switch. A [`WalkModel`] is either kind, by the file's header.
//!
//! ```
//! use footfall::model::WalkModel;
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/walk.footdyn")?;
//! match WalkModel::from_bytes(&bytes)? {
//!     WalkModel::Gait(model) => println!("a gait of {} steps a second", model.cadence_hz()),
//!     WalkModel::Dynamics(model) => assert!(model.frame_rate_hz > 0.0),
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! An [`ImuModel`] (`.footimu`) maps the measurements of one or two sensors to a moving body; a [`Site`] is the place of a sensor.
//!
//! ```
//! use footfall::model::{ImuModel, Site};
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/right_thigh.footimu")?;
//! assert_eq!(ImuModel::from_bytes(&bytes)?.sites, [Site::RightThigh]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use footfall_core::Site;
pub use footfall_model::{
    DynamicsModel, GaitModel, GaitStyle, ImuModel, ModelError, ModelFileError, Provenance,
    StyleError, WalkModel,
};
