//! Walkers on several machines: the same steps from updates of 24 bytes.
//!
//! One machine controls a character and sends [`UPDATE_BYTES`] fifteen to thirty times a second; the others make the same steps with the character's model, a sixth of a second after they receive them.
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
//! let message = sender.identity(&walker)?.to_bytes();
//!
//! // There: a walker that follows it.
//! let identity = WalkIdentity::from_bytes(&message)?;
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
//!         // Sent unreliably: it may be late or lost.
//!         let update = sender.update(&walker, &start)?;
//!         follower.hear(&update, &replica)?;
//!     }
//!     if let Followed::Anew(place) = follower.step(1.0 / 60.0, &mut replica, &replica_start, &mut pose) {
//!         replica_start = place;
//!     }
//! }
//! let here = start.global(&walker.start_from_character());
//! let there = replica_start.global(&replica.start_from_character());
//! // The replica is as far behind as its delay.
//! assert!((here.position.z - there.position.z - 0.2).abs() < 0.06, "{here:?} {there:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Crowds
//!
//! A [`CrowdSender`] sends a whole [`Crowd`](crate::crowd::Crowd) to other peers as [`CrowdMessage`]s: its walkers, reliably, and [`STEP_BYTES`] for each walker and step, as many as a budget
//! allows. There, the crowd [follows](crate::crowd::Crowd::follow): its walkers have the same names, and take the same steps a third of a second after the messages arrive.
//!
//! ```
//! use footfall::crowd::{Crowd, CrowdRecipe, CrowdSettings, Routing};
//! use footfall::glam::Vec2;
//! use footfall::model::GaitModel;
//! use footfall::network::CrowdSender;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let model = Arc::new(GaitModel::from_bytes(&std::fs::read("addons/footfall/models/locomotion.footfall")?)?);
//! let recipe = CrowdRecipe { body: model.skeleton.clone(), model, styles: Vec::new(), space: None };
//! let wander = Routing::Wander { half: Vec2::splat(20.0) };
//!
//! // Here: a crowd that wanders, and a peer that shows it.
//! let mut here = Crowd::new(recipe.clone(), wander, CrowdSettings::default());
//! here.set_count(20);
//! here.repeats = false;
//! let mut sender = CrowdSender::new(1);
//! sender.join(2);
//!
//! // There: the crowd that follows.
//! let mut there = Crowd::new(recipe, Routing::Scripted, CrowdSettings::default());
//! there.follow();
//! for _ in 0..180 {
//!     here.begin_all()?;
//!     here.advance(1.0 / 60.0, true);
//!     sender.step(1.0 / 60.0, &here, 64_000);
//!     for message in sender.messages() {
//!         // Sent to `message.to`, reliably where `message.reliable` says so.
//!         there.hear(&message.bytes)?;
//!     }
//!     there.begin_all()?;
//!     there.advance(1.0 / 60.0, true);
//! }
//! assert_eq!(here.names().count(), there.names().count());
//! for (one, other) in here.agents().iter().zip(there.agents()) {
//!     // Steps are shown later, so that walkers are behind by their way in that time.
//!     assert!(one.place.distance(other.place) < 0.9, "{} {}", one.place, other.place);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Messages of peers are checked: [`ReplicaError`] and [`CrowdReplicaError`] give the reason for a refusal, and then nothing changes. A peer whose walker teleports sends an
//! identity first; other moves faster than people run are refused.

pub use footfall_rig::crowd::{CrowdMessage, CrowdReplicaError, CrowdSender, STEP_BYTES};
pub use footfall_synth::replica::{
    Followed, ReplicaError, UPDATE_BYTES, WalkFollower, WalkIdentity, WalkSender,
};
