//! Characters that walk: generated gait, feet on real ground, and bodies from inertial sensors, for any game engine.
//!
//! # A walk
//!
//! The project ships the models of this page. Paths are relative to its repository.
//!
//! ```
//! use footfall::body::Pose;
//! use footfall::gait::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
//! use footfall::model::GaitModel;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/locomotion.footfall")?;
//! let model = Arc::new(GaitModel::from_bytes(&bytes)?);
//! let body = model.skeleton.clone();
//! let styles = Arc::new(StyleSpace::new(&model, &[])?);
//! let config = GeneratorConfig { seed: 1, phase: 0.0, variation: 1.0 };
//! let mut walker = GaitGenerator::new(&styles, &[], &body, &config)?;
//!
//! let controls = Controls { speed_mps: 1.3, ..Controls::STAND };
//! let mut pose = Pose::rest(&body);
//! for _ in 0..600 {
//!     walker.step(1.0 / 60.0, &controls, &mut pose);
//! }
//! let place = walker.start_from_character();
//! assert!((11.0..15.0).contains(&place.position.z), "ten seconds: {place:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Pose`](body::Pose) holds the position of the hips and one rotation per joint, in the space of the character: origin on the ground below it, +Z
//! ahead. [`start_from_character`](gait::GaitGenerator::start_from_character) is the character's place relative to its start. An engine puts its
//! object there and the rotations on its bones: [`rig`] measures a character and writes poses to it, whatever the axes of its bones. Pass
//! [`GaitGenerator::new`](gait::GaitGenerator::new) the lengths of your character as a [`Skeleton`](body::Skeleton), and its feet meet the ground exactly.
//!
//! # A game loop
//!
//! Uneven ground needs three things: the [`Terrain`](ground::Terrain) of your game, a [`FootPlacer`](ground::FootPlacer), and code that moves the
//! character up and down. One frame looks like this:
//!
//! ```
//! use footfall::body::Pose;
//! use footfall::gait::{Controls, GaitChoice, GaitGenerator};
//! use footfall::glam::Vec3;
//! use footfall::ground::{FootPlacer, Frame, Ground, PlacementInput, Terrain};
//!
//! /// A kerb, 15 cm high, across the way two metres ahead: the ground that is met from a point on a way down. A game casts a ray here.
//! fn street(from: Vec3, way: Vec3) -> Option<Ground> {
//!     let height = if from.z < 2.0 { 0.0 } else { 0.15 };
//!     let met = (height..=height - way.y).contains(&from.y);
//!     met.then(|| Ground { position: from.with_y(height), normal: Vec3::Y, support: 0 })
//! }
//!
//! struct Character {
//!     walker: GaitGenerator,
//!     placer: FootPlacer,
//!     height: f32,
//!     pose: Pose,
//! }
//!
//! impl Character {
//!     /// Advances one frame; returns the character's place in the world. `pose` is the pose to show there.
//!     fn frame(&mut self, dt_secs: f32, speed_mps: f32, terrain: &mut impl Terrain) -> Frame {
//!         // People slow down uphill, lean into it, and do not run up stairs.
//!         self.walker.set_grade(self.placer.way_grade());
//!         let gait = if self.placer.is_steep() { GaitChoice::Walk } else { GaitChoice::Auto };
//!         let speed_mps = speed_mps * self.placer.pace();
//!         let controls = Controls { speed_mps, gait, ..Controls::STAND };
//!         self.walker.step(dt_secs, &controls, &mut self.pose);
//!         // The character rises and falls with the ground below its feet; a physics body may do this instead.
//!         self.height += (1.0 - (-dt_secs / 0.12).exp()) * self.placer.ground_offset_m();
//!         let mut world_from_floor = Frame::from(self.walker.start_from_character());
//!         world_from_floor.position.y = self.height;
//!         let mut input = PlacementInput {
//!             world_from_floor,
//!             contacts: Some(self.walker.feet_in_contact()),
//!             landings: self.walker.landings(),
//!             airborne: false,
//!         };
//!         if self.placer.pace() < 1.0 {
//!             // The foothold of this step is chosen: new controls wait for the next step.
//!             self.walker.keep_step();
//!         }
//!         // A step that would end on an edge becomes shorter or longer.
//!         if let Some(share) = self.placer.step_share(&input, terrain) {
//!             self.walker.stretch_step(share);
//!             input.landings = self.walker.landings();
//!         }
//!         self.placer.step(dt_secs, &input, terrain, &mut self.pose);
//!         world_from_floor
//!     }
//! }
//! #
//! # use footfall::gait::{GeneratorConfig, StyleSpace};
//! # use footfall::ground::PlacementConfig;
//! # use std::sync::Arc;
//! # std::env::set_current_dir("../../..")?;
//! # let bytes = std::fs::read("addons/footfall/models/locomotion.footfall")?;
//! # let model = Arc::new(footfall::model::GaitModel::from_bytes(&bytes)?);
//! # let styles = Arc::new(StyleSpace::new(&model, &[])?);
//! # let body = model.skeleton.clone();
//! # let config = GeneratorConfig { seed: 1, phase: 0.0, variation: 1.0 };
//! # let walker = GaitGenerator::new(&styles, &[], &body, &config)?;
//!
//! let placer = FootPlacer::new(&body, &PlacementConfig::default());
//! let mut character = Character { walker, placer, height: 0.0, pose: Pose::rest(&body) };
//! let mut place = Frame::IDENTITY;
//! for _ in 0..240 {
//!     place = character.frame(1.0 / 60.0, 1.2, &mut street);
//! }
//! assert!(place.position.z > 3.0 && (place.position.y - 0.15).abs() < 0.02, "{place:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A sensor
//!
//! One inertial sensor on a foot or in a pocket moves a whole body. Here a recording is played back; with the feature `live`,
#![cfg_attr(
    feature = "live",
    doc = "[`sensor::live`] has samples come from phones, serial ports and networks."
)]
#![cfg_attr(
    not(feature = "live"),
    doc = "`sensor::live` has samples come from phones, serial ports and networks."
)]
//!
//! ```
//! use footfall::body::Pose;
//! use footfall::model::ImuModel;
//! use footfall::reconstruction::{Prepared, ReconConfig, Reconstructor};
//! use footfall::sensor;
//! use std::path::Path;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/right_foot.footimu")?;
//! let model = Arc::new(ImuModel::from_bytes(&bytes)?);
//! let body = model.skeleton.clone();
//! let prepared = Arc::new(Prepared::new(model)?);
//! let mut reconstructor = Reconstructor::new(&prepared, &body, &ReconConfig::default())?;
//!
//! let recording = sensor::csv::read(Path::new("tests/data/walker_1_slow.right_foot.csv"))?;
//! let mut samples = recording.samples.iter().peekable();
//! let mut pose = Pose::rest(&body);
//! for frame in 0..240 {
//!     let now = f64::from(frame) / 60.0;
//!     while let Some(sample) = samples.next_if(|sample| sample.time_secs <= now) {
//!         reconstructor.push(0, *sample);
//!     }
//!     reconstructor.step(1.0 / 60.0, &mut pose);
//!     // Draw `pose`: its hips are where the body has come to. `split` divides it into a place and the pose above it.
//! }
//! assert!(pose.root_position.z > 2.0, "four seconds of a walk: {}", pose.root_position);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A sensor in another orientation than the axes of the foot must be rotated first: [`reconstruction::find_mounting`] finds its mounting from a few steps.
//!
//! # What it promises
//!
//! - `new` checks everything and returns an error that says what to do. `step` cannot fail and does not allocate.
//! - The same model, seed and sequence of time steps give the same poses, bit for bit on one machine.
//! - The library reads no clock, file or global randomness, except [`sensor::csv::read`], which reads the given file, and the ports of the feature `live`.
//! - A model file of any released version loads, or an error states its version and what to do.
//!
//! # Space and units
//!
//! Metres, seconds, radians and kilograms. Y is up, axes are right-handed, a character faces +Z and its left is +X. Headings are positive to the left.
//! Joints have the names of Godot's `SkeletonProfileHumanoid`; in the T-pose all their rotations are the identity. A transform is named
//! `target_from_source`. Vectors and quaternions are those of [`glam`].
//!
//! # Features
//!
//! `live` opens serial ports and sockets for sensors; it adds an HTTP server, TLS and their dependencies. It is off by default.
//!
//! Modules in suggested reading order: [`body`], [`model`], [`gait`], [`rig`], [`ground`], [`handover`], [`crowd`], [`network`], [`sensor`], [`reconstruction`].

pub mod body;
pub mod crowd;
pub mod gait;
pub mod ground;
pub mod handover;
pub mod model;
pub mod network;
pub mod reconstruction;
pub mod rig;
pub mod sensor;

pub use glam;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
