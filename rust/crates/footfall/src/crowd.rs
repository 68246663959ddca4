//! Walkers by the thousand, each in a hundredth of a generator's memory.
//!
//! A [`StyledBody`] is a mixture of styles on one body, measured once for all who share it. A [`Workshop`] works steps out: make one a thread. A [`CrowdWalker`] borrows
//! it about twice a second and writes a [`CrowdPose`]: every joint in the space of the character, ready for a shader or a skeleton.
//!
//! ```
//! use footfall::body::Joint;
//! use footfall::crowd::{CrowdPose, CrowdWalker, StyledBody, Workshop};
//! use footfall::gait::{Controls, GeneratorConfig, StyleSpace};
//! use footfall::model::GaitModel;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let model = GaitModel::from_bytes(&std::fs::read("addons/footfall/models/locomotion.footfall")?)?;
//! let styles = Arc::new(StyleSpace::new(&Arc::new(model), &[])?);
//! let styled = StyledBody::new(&styles, &[], &styles.model().skeleton)?;
//! let mut workshop = Workshop::new(&styled);
//! let mut crowd = (0..20)
//!     .map(|seed| {
//!         let config = GeneratorConfig { seed, phase: seed as f32 / 20.0, variation: 1.0 };
//!         CrowdWalker::new(&styled, &config, false, &mut workshop)
//!     })
//!     .collect::<Result<Vec<_>, _>>()?;
//!
//! let controls = Controls { speed_mps: styled.usual_speed_mps(), ..Controls::STAND };
//! let mut pose = CrowdPose::default();
//! for _ in 0..120 {
//!     for walker in &mut crowd {
//!         walker.step(1.0 / 60.0, controls, &mut workshop);
//!         walker.pose(&mut pose);
//!         assert!((1.2..2.0).contains(&pose.position(Joint::Head).y));
//!     }
//! }
//! assert!(crowd.iter().all(|walker| walker.start_from_character().position.z > 1.5));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use footfall_synth::{CrowdPose, CrowdWalker, StyledBody, Workshop};
