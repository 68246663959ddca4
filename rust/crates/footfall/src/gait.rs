//! Walks in real time, whole walks, and loops.
//!
//! A [`StyleSpace`] prepares a model and its styles once for all walkers. A [`GaitGenerator`] is one walker; its [`GeneratorConfig`] distinguishes it from others.
//! [`Controls`] hold the requested speed, turning and direction. A [`SynthError`] reports an unusable model, body or setting.
//!
//! ```
//! use footfall::body::Pose;
//! use footfall::gait::{Controls, Detail, Footstep, GaitGenerator, GeneratorConfig, GroundTransform, StyleSpace};
//! use footfall::model::{GaitModel, GaitStyle};
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let read = |name: &str| std::fs::read(format!("addons/footfall/models/{name}"));
//! let model = Arc::new(GaitModel::from_bytes(&read("locomotion.footfall")?)?);
//! let sad = Arc::new(GaitStyle::from_bytes(&read("sad.footstyle")?)?);
//! let styles = Arc::new(StyleSpace::new(&model, &[sad])?);
//! let body = model.skeleton.clone();
//! let config = GeneratorConfig { seed: 7, phase: 0.0, variation: 1.0 };
//! // Half sad.
//! let mut walker = GaitGenerator::new(&styles, &[0.5], &body, &config)?;
//!
//! let turning = Controls { speed_mps: 1.0, turn_rate_radps: 0.5, ..Controls::STAND };
//! let mut pose = Pose::rest(&body);
//! let mut footprints: Vec<Footstep> = Vec::new();
//! for _ in 0..300 {
//!     walker.step(1.0 / 60.0, &turning, &mut pose);
//!     footprints.extend(walker.footsteps());
//! }
//! let GroundTransform { position, heading } = walker.start_from_character();
//! assert!(footprints.len() >= 7 && heading > 1.5 && position.x > 1.0);
//!
//! walker.set_style_weights(&[0.0]); // From the next step on it is not sad,
//! walker.set_detail(Detail::Full.for_height(100.0)); // and 100 pixels tall: every second frame is placed on the ground.
//! for _ in 0..180 {
//!     walker.step(1.0 / 60.0, &Controls::STAND, &mut pose);
//! }
//! assert!(walker.is_standing() && walker.feet_in_contact() == [true, true]);
//!
//! // A saved game: the whole walk in about 1.5 kB.
//! let state = walker.state();
//! let mut other = GaitGenerator::new(&styles, &[], &body, &config)?;
//! other.restore(&state)?;
//! assert_eq!(other.start_from_character(), walker.start_from_character());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Above about 2 m/s a walker runs, if its model can: [`Controls::gait`] is a [`GaitChoice`], and [`GaitGenerator::gait`] returns the [`Gait`] of the current step.
//! [`synthesize_moves`] makes a clip of a sequence of [`Move`]s.
//!
//! ```
//! use footfall::gait::{Controls, Gait, GaitChoice, Move, StandConfig, StyleSpace, synthesize_moves};
//! use footfall::gait::{GaitGenerator, GeneratorConfig};
//! use footfall::body::Pose;
//! use footfall::model::GaitModel;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let model = Arc::new(GaitModel::from_bytes(&std::fs::read("addons/footfall/models/locomotion.footfall")?)?);
//! let styles = Arc::new(StyleSpace::new(&model, &[])?);
//! let body = model.skeleton.clone();
//! let config = GeneratorConfig { seed: 1, phase: 0.0, variation: 1.0 };
//! let mut runner = GaitGenerator::new(&styles, &[], &body, &config)?;
//! let fast = Controls { speed_mps: 3.2, ..Controls::STAND };
//! let mut pose = Pose::rest(&body);
//! for _ in 0..180 {
//!     runner.step(1.0 / 60.0, &fast, &mut pose);
//! }
//! assert_eq!(runner.gait(), Gait::Run);
//!
//! let moves = [
//!     Move { time_secs: 0.5, controls: Controls { gait: GaitChoice::Walk, ..fast }, jump_m: 0.3 },
//!     Move { time_secs: 3.0, controls: Controls::STAND, jump_m: 0.0 },
//! ];
//! let config = StandConfig { seconds: 6.0, seed: 1, variation: 1.0, motion: 1.0, frame_rate_hz: None };
//! let clip = synthesize_moves(&model, &body, &moves, &config)?.clip;
//! assert!((clip.duration_secs() - 6.0).abs() < 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A walker jumps on request, to a height or to a place; [`GaitGenerator::jump_phase`] returns the [`JumpPhase`]. [`Controls::crouch`]
//! lowers it.
//!
//! ```
//! use footfall::body::Pose;
//! use footfall::gait::{Controls, GaitGenerator, GeneratorConfig, JumpPhase, StyleSpace};
//! use footfall::glam::Vec3;
//! use footfall::model::GaitModel;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let model = Arc::new(GaitModel::from_bytes(&std::fs::read("addons/footfall/models/locomotion.footfall")?)?);
//! let styles = Arc::new(StyleSpace::new(&model, &[])?);
//! let body = model.skeleton.clone();
//! let config = GeneratorConfig { seed: 1, phase: 0.0, variation: 1.0 };
//! let mut jumper = GaitGenerator::new(&styles, &[], &body, &config)?;
//! jumper.stand();
//! // Onto a stone 30 cm high, 60 cm ahead.
//! assert!(jumper.jump_to(Vec3::new(0.0, 0.3, 0.6)));
//! let mut pose = Pose::rest(&body);
//! let mut flew = false;
//! for _ in 0..150 {
//!     jumper.step(1.0 / 60.0, &Controls { crouch: 0.5, ..Controls::STAND }, &mut pose);
//!     flew |= jumper.jump_phase() == Some(JumpPhase::Flight);
//! }
//! assert!(flew && (jumper.start_from_character().position.y - 0.3).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`StateError`] reports a state that cannot be restored; the walker then continues as before.
//!
//! [`GaitGenerator::switching`] creates a generator of a [`DynamicsModel`](crate::model::DynamicsModel), which is used in the same way.
//!
//! ```
//! use footfall::body::{Pose, Skeleton};
//! use footfall::gait::{Controls, GaitGenerator, GeneratorConfig};
//! use footfall::model::DynamicsModel;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let bytes = std::fs::read("addons/footfall/models/walk.footdyn")?;
//! let model = Arc::new(DynamicsModel::from_bytes(&bytes)?);
//! let body = Skeleton::standard();
//! let config = GeneratorConfig { seed: 1, phase: 0.0, variation: 1.0 };
//! let mut walker = GaitGenerator::switching(&model, &body, &config)?;
//! let controls = Controls { speed_mps: walker.usual_speed_mps(), ..Controls::STAND };
//! let mut pose = Pose::rest(&body);
//! for _ in 0..120 {
//!     walker.step(1.0 / 60.0, &controls, &mut pose);
//! }
//! assert!(walker.start_from_character().position.z > 1.5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`synthesize`] solves a whole walk at once, by a [`WalkConfig`]. The [`SynthesizedWalk`] holds the clip, each foot's contacts as [`FrameSpan`]s, and
//! its [`GaitEvent`]s, each of an [`EventKind`]. [`synthesize_standing`] (with a [`StandConfig`]) and [`synthesize_switching`] (with a [`SwitchingWalkConfig`]) make clips of
//! a standing person and of a switching model.
//!
//! ```
//! use footfall::gait::{
//!     EventKind, FrameSpan, GaitChoice, GaitEvent, StandConfig, SwitchingWalkConfig, SynthesizedWalk, WalkConfig,
//!     synthesize, synthesize_standing, synthesize_switching,
//! };
//! use footfall::model::{DynamicsModel, GaitModel};
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let read = |name: &str| std::fs::read(format!("addons/footfall/models/{name}"));
//! let model = Arc::new(GaitModel::from_bytes(&read("locomotion.footfall")?)?);
//! let config = WalkConfig {
//!     steps: 6,
//!     seed: 1,
//!     variation: 1.0,
//!     speed_mps: Some(1.3),
//!     turn_rate_radps: 0.0,
//!     frame_rate_hz: Some(60.0),
//!     direction_rad: 0.0,
//!     gait: GaitChoice::Auto,
//!     from_standing: true,
//! };
//! let walk: SynthesizedWalk = synthesize(&model, &model.skeleton, &config)?;
//! let last: &FrameSpan = walk.contacts[0].last().expect("it ends standing");
//! assert_eq!(last.last, walk.clip.poses.len() - 1);
//! let landings = |event: &&GaitEvent| event.kind == EventKind::InitialContact;
//! assert_eq!(walk.events().iter().filter(landings).count(), 6);
//!
//! let config = StandConfig { seconds: 2.0, seed: 1, variation: 1.0, motion: 1.0, frame_rate_hz: Some(30.0) };
//! let standing = synthesize_standing(&model, &model.skeleton, &config)?;
//! assert_eq!(standing.clip.poses.len(), 61);
//!
//! let systems = Arc::new(DynamicsModel::from_bytes(&read("walk.footdyn")?)?);
//! let config = SwitchingWalkConfig {
//!     seconds: 4.0,
//!     seed: 1,
//!     variation: 1.0,
//!     speed_mps: None,
//!     turn_rate_radps: 0.0,
//!     direction_rad: 0.0,
//!     frame_rate_hz: None,
//! };
//! let walk = synthesize_switching(&systems, &model.skeleton, &config)?;
//! assert!((walk.clip.duration_secs() - 4.0).abs() < 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`LoopedWalk`] is a looping clip, for engines and platforms that only play animations.
//!
//! ```
//! use footfall::gait::{GaitGenerator, GeneratorConfig, LoopedWalk, StyleSpace};
//! use footfall::model::GaitModel;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let model = GaitModel::from_bytes(&std::fs::read("addons/footfall/models/locomotion.footfall")?)?;
//! let styles = Arc::new(StyleSpace::new(&Arc::new(model), &[])?);
//! let body = styles.model().skeleton.clone();
//! let config = GeneratorConfig { seed: 1, phase: 0.0, variation: 0.5 };
//! let make = || GaitGenerator::new(&styles, &[], &body, &config).ok();
//! let walk = LoopedWalk::record(make, 1.3, 4.0).expect("it walks");
//! assert_eq!(walk.poses.first(), walk.poses.last());
//! assert!((3.0..5.0).contains(&walk.duration_secs()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use footfall_core::{EventKind, FrameSpan, GaitEvent};
pub use footfall_synth::{
    Controls, Detail, Footstep, Gait, GaitChoice, GaitGenerator, GeneratorConfig, GroundTransform,
    JumpPhase, LoopedWalk, Move, StandConfig, StateError, StyleSpace, SwitchingWalkConfig,
    SynthError, SynthesizedWalk, WalkConfig, synthesize, synthesize_moves, synthesize_standing,
    synthesize_switching,
};
