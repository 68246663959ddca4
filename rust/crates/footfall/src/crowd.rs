//! Thousands of walkers, each with a hundredth of a generator's memory.
//!
//! A [`StyledBody`] is a mixture of styles on one body, measured once for all walkers that share it. A [`Workshop`] generates steps: create one per thread. A [`CrowdWalker`] borrows
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
//!
//! A distant walker can walk in steps that all walkers of the same style share ([`CrowdWalker::sharing`]): it then has a [`SharedPose`], which a renderer draws from a texture of poses.
//!
//! # Whole crowds
//!
//! A [`Crowd`] also directs its walkers. It creates them from a [`CrowdRecipe`] on separate threads; [`CrowdSettings`] set their differences. A
//! [`Routing`] sets their goals: places of an area, a [`Path`], or what the game sets for each [`Agent`]. They avoid each other.
//!
//! ```
//! use footfall::crowd::{Crowd, CrowdRecipe, CrowdSettings, Limits, Routing, Tier};
//! use footfall::glam::{Vec2, Vec3};
//! use footfall::model::GaitModel;
//! use std::sync::Arc;
//!
//! # std::env::set_current_dir("../../..")?;
//! let model = Arc::new(GaitModel::from_bytes(&std::fs::read("addons/footfall/models/locomotion.footfall")?)?);
//! let body = model.skeleton.clone();
//! let recipe = CrowdRecipe { model, styles: Vec::new(), space: None, body };
//! let wander = Routing::Wander { half: Vec2::splat(20.0) };
//! let mut crowd = Crowd::new(recipe, wander, CrowdSettings { seed: 7, ..CrowdSettings::default() });
//! crowd.set_count(50);
//!
//! let limits = Limits { counts: [5, 20], distances_m: [8.0, 40.0] };
//! for frame in 0..120 {
//!     // A game calls `begin_some`, which does not block.
//!     crowd.begin_all()?;
//!     crowd.advance(1.0 / 60.0, true);
//!     if frame % 8 == 0 {
//!         crowd.choose_tiers(Vec3::ZERO, &limits);
//!     }
//!     for (drawn, tier) in crowd.drawn().iter().zip(crowd.tiers()) {
//!         // Put a character at `drawn.places[1]`: one with a skeleton for `Tier::Full`, otherwise an instance.
//!         assert!(drawn.places[1].is_finite() && *tier <= Tier::Far);
//!     }
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A walker keeps its name, a number, in the [`Roster`] while it is in the crowd. This example sends one walker to a place, and saves the crowd.
//!
//! ```
//! # use footfall::crowd::{CrowdRecipe, CrowdSettings};
//! use footfall::crowd::{Crowd, Routing, SavedCrowd};
//! use footfall::glam::{Vec2, Vec3};
//! # use footfall::model::GaitModel;
//! # use std::sync::Arc;
//! # std::env::set_current_dir("../../..")?;
//! # let model = Arc::new(GaitModel::from_bytes(&std::fs::read("addons/footfall/models/locomotion.footfall")?)?);
//! # let body = model.skeleton.clone();
//! # let recipe = CrowdRecipe { model, styles: Vec::new(), space: None, body };
//!
//! let mut crowd = Crowd::new(recipe, Routing::Scripted, CrowdSettings::default());
//! let names = crowd.add([(Vec3::ZERO, 0.0), (Vec3::X, 0.0)].into_iter());
//! crowd.begin_all()?;
//! let row = crowd.roster().place(names[1]).expect("it is there");
//! crowd.agents_mut()[row].go_to(Vec2::new(0.0, 6.0));
//! for _ in 0..60 {
//!     crowd.begin_all()?;
//!     crowd.advance(1.0 / 60.0, true);
//! }
//! let place = crowd.agents()[row].place;
//! assert!(place.z > 0.5, "it walks: {place}");
//! assert_eq!(crowd.nearest(Vec3::X, 2.0), Some(row));
//!
//! let saved = SavedCrowd::from_bytes(&crowd.save())?;
//! crowd.clear();
//! crowd.restore(&saved);
//! assert_eq!(crowd.names().collect::<Vec<_>>(), names);
//!
//! // Another thread frees a dropped crowd. A plugin waits for that before its host unloads it.
//! drop(crowd);
//! footfall::crowd::finish_disposals();
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Goal`] is a walker's own target, [`Drawn`] holds its places for drawing. One group of [`GROUPS`] of the distant walkers moves in each frame; a renderer that writes many
//! poses fetches [`FETCHED`] of them together ([`Agent::fetch_pose`]). A crowd has at most [`MOST_AGENTS`]. [`CrowdStateError`] reports invalid bytes.

pub use footfall_rig::crowd::{
    Agent, Crowd, CrowdRecipe, CrowdSettings, CrowdStateError, Drawn, FETCHED, GROUPS, Goal,
    Limits, MOST_AGENTS, Path, Roster, Routing, SavedCrowd, Tier, finish_disposals,
};
pub use footfall_synth::{CrowdPose, CrowdWalker, SharedPose, StyledBody, Workshop};
