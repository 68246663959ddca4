//! Crowds: thousands of walkers that come and go, avoid each other, and are drawn by their distance from the camera.
//!
//! A [`Crowd`] has one row for each walker: an [`Agent`], its [`Tier`] and its [`Drawn`] places. Names stay unique while rows are reused. In every frame, a game starts new walkers
//! ([`Crowd::begin_some`]), advances time ([`Crowd::advance`]) and draws the rows.

mod agent;
mod avoidance;
mod begin;
mod decision;
mod disposal;
mod drawn;
mod eyesight;
mod goal;
mod maker;
mod members;
mod mixtures;
mod motion;
mod neighbours;
mod pick;
mod replica;
mod roster;
mod routing;
mod save;
mod steering;
mod tiers;

pub use agent::Agent;
pub use disposal::finish_disposals;
pub use drawn::Drawn;
pub use eyesight::Eyesight;
use footfall_core::{ModelPose, Pose, Skeleton};
use glam::{Vec2, Vec3};
pub use goal::Goal;
use maker::Maker;
use members::Coming;
pub use mixtures::CrowdRecipe;
use mixtures::Mixtures;
use motion::Stir;
pub use motion::{FETCHED, GROUPS};
use neighbours::Neighbours;
pub use neighbours::Passerby;
use replica::Following;
pub use replica::{CrowdMessage, CrowdReplicaError, CrowdSender, STEP_BYTES};
pub use roster::Roster;
pub use routing::{Path, Routing};
pub use save::{CrowdStateError, SavedCrowd};
use std::collections::VecDeque;
use std::sync::Arc;
use tiers::Chooser;
pub use tiers::{Limits, Tier};

/// Most walkers of a crowd: the rows that fit into a name.
pub const MOST_AGENTS: u32 = 100_000;

/// Settings by which walkers differ.
#[derive(Clone, Debug, PartialEq)]
pub struct CrowdSettings {
    /// Equal seeds give equal crowds.
    pub seed: u64,
    /// The slowest and the fastest walker.
    pub speeds_mps: [f32; 2],
    /// The smallest and the largest walker, against the character.
    pub sizes: [f32; 2],
    /// Greatest weight of a walker's style.
    pub style_amount: f32,
    /// Tints, one of which each walker gets: red, green, blue and opacity. White if empty.
    pub tints: Vec<[f32; 4]>,
    /// Half the sides of the rectangle about the origin in which walkers begin, metres.
    pub half_area: Vec2,
    /// Width of the stream of walkers along a path, metres.
    pub path_width: f32,
}

impl Default for CrowdSettings {
    fn default() -> Self {
        Self {
            seed: 0,
            speeds_mps: [0.95, 1.55],
            sizes: [0.92, 1.08],
            style_amount: 1.0,
            tints: Vec::new(),
            half_area: Vec2::splat(20.0),
            path_width: 4.0,
        }
    }
}

/// A crowd. Each of its walkers has a row in [`agents`](Self::agents), [`tiers`](Self::tiers) and [`drawn`](Self::drawn).
#[derive(Debug)]
pub struct Crowd {
    agents: Vec<Agent>,
    tiers: Vec<Tier>,
    drawn: Vec<Drawn>,
    stirs: Vec<Stir>,
    /// All walkers as others see them; at no place those that are not made.
    seen: Vec<Passerby>,
    roster: Roster,
    began: Vec<i32>,
    frame: u64,
    time_secs: f64,
    /// Height of the character's highest joint in the T-pose.
    height_m: f32,
    mixtures: Option<Arc<Mixtures>>,
    neighbours: Neighbours,
    others: Vec<Passerby>,
    routing: Routing,
    chooser: Chooser,
    /// True when walkers far away walk in steps that they share instead of taking their own. In a crowd that follows another they never do; in a crowd that is [sent](CrowdSender) to others they must not.
    pub repeats: bool,
    /// Motion of standing walkers: 0 is a still pose, 1 moves as people do.
    pub standing_motion: f32,
    maker: Maker,
    settings: CrowdSettings,
    /// Number of walkers so far, which identifies the next one.
    made: u64,
    tickets: u64,
    /// Walkers with names and no rows yet, in the order in which they came.
    coming: VecDeque<Coming>,
    /// Another machine's crowd that this one follows.
    following: Option<Following>,
}

impl Crowd {
    /// An empty crowd; other threads prepare its model and styles meanwhile.
    pub fn new(recipe: CrowdRecipe, routing: Routing, settings: CrowdSettings) -> Self {
        Self {
            agents: Vec::new(),
            tiers: Vec::new(),
            drawn: Vec::new(),
            stirs: Vec::new(),
            seen: Vec::new(),
            roster: Roster::default(),
            began: Vec::new(),
            // Not 0, so that no pose counts as just written.
            frame: 1000,
            time_secs: 0.0,
            height_m: height_m(&recipe.body),
            mixtures: None,
            neighbours: Neighbours::default(),
            others: Vec::new(),
            routing,
            chooser: Chooser::default(),
            repeats: true,
            standing_motion: 1.0,
            maker: Maker::new(recipe),
            settings,
            made: 0,
            tickets: 0,
            coming: VecDeque::new(),
            following: None,
        }
    }

    /// One walker a row; rows that nobody has are of walkers that are not made.
    pub fn agents(&self) -> &[Agent] {
        &self.agents
    }

    /// The same, to be changed.
    pub fn agents_mut(&mut self) -> &mut [Agent] {
        &mut self.agents
    }

    /// Tier of each row.
    pub fn tiers(&self) -> &[Tier] {
        &self.tiers
    }

    /// Places of each row for drawing.
    pub fn drawn(&self) -> &[Drawn] {
        &self.drawn
    }

    /// Names of the rows.
    pub fn roster(&self) -> &Roster {
        &self.roster
    }

    /// Walkers that began in the last frame, by name.
    pub fn began(&self) -> &[i32] {
        &self.began
    }

    /// Sets who else is about, such as players: walkers who go somewhere keep clear of them as of each other. Places that are not finite are left out.
    pub fn set_others(&mut self, others: impl Iterator<Item = Passerby>) {
        self.others.clear();
        self.others
            .extend(others.filter(|other| other.place.is_finite() && other.velocity.is_finite()));
    }

    /// Number of frames so far.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// Time that has passed, seconds.
    pub fn time_secs(&self) -> f64 {
        self.time_secs
    }

    /// Source of the walkers' goals.
    pub fn routing(&self) -> &Routing {
        &self.routing
    }

    /// Chooses the tier of each walker by its distance from the camera, given in the crowd's space.
    pub fn choose_tiers(&mut self, camera: Vec3, limits: &Limits) {
        let agents = self.agents.iter();
        let places = agents.map(|agent| agent.is_made().then_some(agent.place));
        self.chooser.choose(camera, limits, places, &mut self.tiers);
    }

    /// Names of all, in the order in which they came.
    pub fn names(&self) -> impl Iterator<Item = i32> {
        let order = self.roster.order().iter();
        order.map(|place| self.roster.name(*place as usize))
    }
}

impl Drop for Crowd {
    fn drop(&mut self) {
        disposal::dispose(core::mem::take(&mut self.agents));
    }
}

/// Height of a body's highest joint in the T-pose.
fn height_m(body: &Skeleton) -> f32 {
    let t_pose = ModelPose::of(body, &Pose::rest(body));
    let heights = t_pose.positions.iter().map(|place| place.y);
    heights.fold(0.0, f32::max)
}
