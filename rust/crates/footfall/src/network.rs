//! Walkers on several machines: the same steps from updates of 24 bytes.
//!
//! One machine controls a character and sends [`UPDATE_BYTES`] fifteen to thirty times a second; the others make the same steps with the character's model, an eighth of a second after they receive them.
//!
//! ```
//! use footfall::body::Pose;
//! use footfall::gait::{Controls, GaitGenerator, GeneratorConfig, GroundTransform, StyleSpace};
//! use footfall::model::GaitModel;
//! use footfall::network::{Followed, WalkFollower, WalkIdentity, WalkSender};
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/locomotion.footfall")?;
//! let model = Arc::new(GaitModel::from_bytes(&bytes)?);
//! let body = model.skeleton.clone();
//! let styles = Arc::new(StyleSpace::new(&model, &[])?);
//!
//! // Here: a walker, and where it began in the level.
//! let config = GeneratorConfig { seed: 7, phase: 0.0, variation: 1.0 };
//! let mut walker = GaitGenerator::new(&styles, &[], &body, &config)?;
//! let start = GroundTransform::default();
//! let mut sender = WalkSender::new();
//! // Sent reliably, once.
//! let told = sender.identity(&walker)?.to_bytes();
//!
//! // There: the same walker, by another's will.
//! let identity = WalkIdentity::from_bytes(&told)?;
//! let mut replica = GaitGenerator::new(&styles, &identity.style_weights, &body, &identity.config())?;
//! identity.check(&replica)?;
//! let mut follower = WalkFollower::new(&identity);
//! let mut replica_start = GroundTransform::default();
//!
//! let controls = Controls { speed_mps: 1.3, ..Controls::STAND };
//! let mut pose = Pose::rest(&body);
//! for frame in 0..600 {
//!     walker.step(1.0 / 60.0, &controls, &mut pose);
//!     sender.step(1.0 / 60.0);
//!     if frame % 3 == 0 {
//!         // Sent as it comes; it may be late or lost.
//!         let update = sender.update(&walker, &start)?;
//!         follower.hear(&update, &replica)?;
//!     }
//!     if let Followed::Anew(place) = follower.step(1.0 / 60.0, &mut replica, &replica_start, &mut pose) {
//!         replica_start = place;
//!     }
//! }
//! let here = start.global(&walker.start_from_character());
//! let there = replica_start.global(&replica.start_from_character());
//! // As far behind as it is later.
//! assert!((here.position.z - there.position.z - 0.16).abs() < 0.06, "{here:?} {there:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Messages of peers are checked: [`ReplicaError`] gives the reason for a refusal, and then nothing changes. A peer whose walker teleports sends an
//! identity first; other moves faster than people run are refused.

pub use footfall_synth::replica::{
    Followed, ReplicaError, UPDATE_BYTES, WalkFollower, WalkIdentity, WalkSender,
};
