//! Crowds: thousands of walkers who come and go, find their ways round each other, and are drawn by how near they are.
//!
//! A [`Crowd`] is one row for each walker: an [`Agent`], its [`Tier`] and what is [`Drawn`] of it. Names last while rows are used again. In every frame a game lets walkers
//! begin ([`Crowd::begin_some`]), lets time pass ([`Crowd::advance`]) and draws the rows.

mod agent;
mod avoidance;
mod begin;
mod kit;
mod maker;
mod motion;
mod neighbours;
mod pick;
mod roster;
mod save;
mod tiers;
mod way;

use agent::WHITE;
pub use agent::{Agent, Drawn, Goal};
use footfall_core::{ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_synth::GeneratorConfig;
use glam::{Vec2, Vec3};
pub use kit::CrowdRecipe;
use kit::{Kit, Outfit};
use maker::{Maker, Order};
pub use motion::{FETCHED, GROUPS};
use neighbours::Neighbours;
pub use roster::Roster;
use save::SavedAgent;
pub use save::{CrowdStateError, SavedCrowd};
use std::collections::VecDeque;
use std::sync::Arc;
use tiers::Chooser;
pub use tiers::{Limits, Tier};
pub use way::{Path, Way};

/// Most walkers of a crowd: the steps of more alone would take gigabytes.
pub const MOST_AGENTS: u32 = 100_000;

/// The golden ratio spreads phases evenly, and the plastic number places in a rectangle, however many there are.
const GOLDEN: f32 = 0.618_034;
const PLASTIC: [f32; 2] = [0.754_877_7, 0.569_840_3];

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
    /// Tints of which each walker gets one: red, green, blue and opacity. None is white.
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

/// Everybody. Whoever is in the crowd has a row in [`agents`](Self::agents), [`tiers`](Self::tiers) and [`drawn`](Self::drawn) for as long as it is there.
#[derive(Debug)]
pub struct Crowd {
    agents: Vec<Agent>,
    tiers: Vec<Tier>,
    drawn: Vec<Drawn>,
    roster: Roster,
    began: Vec<i32>,
    frame: u64,
    time_secs: f64,
    /// Height of the character's highest joint in the T-pose.
    height_m: f32,
    kit: Option<Arc<Kit>>,
    neighbours: Neighbours,
    way: Way,
    chooser: Chooser,
    /// True when walkers far away repeat their last two steps instead of taking new ones.
    pub repeats: bool,
    /// Amount of motion of those who stand: 0 rests in a still pose, 1 moves as people do.
    pub standing_motion: f32,
    maker: Maker,
    settings: CrowdSettings,
    /// Number of walkers that there ever were: the number of the next, which identifies it.
    made: u64,
    tickets: u64,
    /// Walkers who have names and no rows yet, in the order in which they came.
    coming: VecDeque<Coming>,
}

/// A walker with a name and no row yet: where it will stand, and its heading.
#[derive(Debug)]
struct Coming {
    place: usize,
    start: Vec3,
    heading: f32,
}

impl Crowd {
    /// A crowd of nobody yet; what its walkers are made with is prepared meanwhile.
    pub fn new(recipe: CrowdRecipe, way: Way, settings: CrowdSettings) -> Self {
        Self {
            agents: Vec::new(),
            tiers: Vec::new(),
            drawn: Vec::new(),
            roster: Roster::default(),
            began: Vec::new(),
            // So that nobody's pose seems to have been written just now.
            frame: 1000,
            time_secs: 0.0,
            height_m: height_m(&recipe.body),
            kit: None,
            neighbours: Neighbours::default(),
            way,
            chooser: Chooser::default(),
            repeats: true,
            standing_motion: 1.0,
            maker: Maker::new(recipe),
            settings,
            made: 0,
            tickets: 0,
            coming: VecDeque::new(),
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

    /// Number of frames so far.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// Ways that walkers take by themselves.
    pub fn way(&self) -> &Way {
        &self.way
    }

    /// Chooses everybody's tier by the distance from the camera, given in the crowd's space.
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

    /// Makes the crowd's own walkers, those that no script added, so many. Who is too much leaves, the last first; returns their
    /// places.
    pub fn set_count(&mut self, count: usize) -> Vec<usize> {
        self.come_in(usize::MAX);
        let own = |place: &u32| self.agents[*place as usize].counted;
        let there = self
            .roster
            .order()
            .iter()
            .filter(|place| own(place))
            .count();
        if there > count {
            let last = self.roster.order().iter().rev().filter(|place| own(place));
            let leaving: Vec<usize> = last
                .take(there - count)
                .map(|place| *place as usize)
                .collect();
            self.leave(&leaving);
            return leaving;
        }
        self.reserve(count - there);
        let fresh = self.made == 0;
        let orders: Vec<Order> = (there..count)
            .map(|index| self.add_own(index, if fresh { Some(count) } else { None }))
            .collect();
        self.maker.take(orders.into_iter());
        Vec::new()
    }

    /// Adds the crowd's own walker of this index, one of so many that begin together.
    fn add_own(&mut self, index: usize, together: Option<usize>) -> Order {
        let share = |axis: usize| (0.5 + (index + 1) as f32 * PLASTIC[axis]).fract();
        let (level, heading, progress, aside) = match &self.way {
            Way::Path(path) => {
                let along = together.map_or_else(
                    || ((index + 1) as f32 * GOLDEN).fract(),
                    |count| index as f32 / count as f32,
                );
                let progress = path.length() * along;
                let aside = self.settings.path_width * (share(0) - 0.5);
                let (place, direction) = path.beside(progress, aside);
                (place, direction.x.atan2(direction.y), progress, aside)
            }
            Way::Told | Way::Wander { .. } | Way::Navigate => {
                let across = Vec2::new(share(0), share(1)) * 2.0 - Vec2::ONE;
                let heading = core::f32::consts::TAU * (index as f32 * GOLDEN * GOLDEN).fract();
                (across * self.settings.half_area, heading, 0.0, 0.0)
            }
        };
        let (place, order) = self.enter(Vec3::new(level.x, 0.0, level.y), heading);
        let agent = &mut self.agents[place];
        agent.counted = true;
        if self.way.is_navigated() {
            agent.goal = Goal::Place(level);
        }
        agent.progress_m = progress;
        agent.aside_m = aside;
        order
    }

    /// Adds walkers at these places under these headings; returns their names. Their rows come with [`come_in`](Self::come_in).
    pub fn add(&mut self, starts: impl ExactSizeIterator<Item = (Vec3, f32)>) -> Vec<i32> {
        self.roster.reserve(starts.len());
        self.coming.reserve(starts.len());
        starts
            .map(|(start, heading)| {
                let place = self.roster.enter();
                self.coming.push_back(Coming {
                    place,
                    start,
                    heading,
                });
                self.roster.name(place)
            })
            .collect()
    }

    /// Returns whether there are walkers without rows.
    fn are_coming(&self) -> bool {
        !self.coming.is_empty()
    }

    /// Gives so many of those who were added their rows, and orders them to be made. The memory of ten thousand rows takes the system
    /// longer than a frame to come by.
    pub fn come_in(&mut self, most: usize) {
        let count = self.coming.len().min(most);
        if count == 0 {
            return;
        }
        self.reserve(self.coming.len());
        let mut orders = Vec::with_capacity(count);
        for _ in 0..count {
            if let Some(Coming {
                place,
                start,
                heading,
            }) = self.coming.pop_front()
            {
                orders.push(self.put_next(place, start, heading));
            }
        }
        self.maker.take(orders.into_iter());
    }

    /// Goes on with those who were saved, when nobody is there.
    pub fn restore(&mut self, saved: &SavedCrowd) {
        self.made = saved.made;
        if let Some(roster) = &saved.roster {
            self.roster = roster.clone();
        } else {
            for _ in &saved.agents {
                self.roster.enter();
            }
        }
        self.make_room(self.roster.places());
        let places: Vec<usize> = self
            .roster
            .order()
            .iter()
            .map(|place| *place as usize)
            .collect();
        let mut orders = Vec::with_capacity(places.len());
        for (index, (place, agent)) in places.into_iter().zip(&saved.agents).enumerate() {
            let start = (Vec3::from(agent.place), agent.heading);
            let order = self.put(place, 0, start, Some(agent));
            self.agents[place].counted = saved.counted.get(index) == Some(&true);
            orders.push(order);
        }
        self.maker.take(orders.into_iter());
    }

    /// Removes those who have these places.
    pub fn leave(&mut self, places: &[usize]) {
        self.roster.leave(places);
        let mut left = Vec::new();
        for place in places {
            let agent = core::mem::replace(&mut self.agents[*place], Agent::absent());
            left.extend(agent.walker);
            self.tiers[*place] = Tier::Far;
            self.drawn[*place] = Drawn::default();
        }
        self.maker.forget(left);
    }

    /// Removes everybody; returns the places that they had.
    pub fn clear(&mut self) -> Vec<usize> {
        self.come_in(usize::MAX);
        self.maker.cancel();
        let everybody: Vec<usize> = self
            .roster
            .order()
            .iter()
            .map(|place| *place as usize)
            .collect();
        self.leave(&everybody);
        everybody
    }

    /// Everybody as bytes: who walks where, how, in which phase and by which name. Their next steps are drawn anew after [`restore`](Self::restore).
    pub fn save(&self) -> Vec<u8> {
        let places = self.roster.order().iter();
        let agents = places.map(|place| &self.agents[*place as usize]);
        save::write(self.made, &self.roster, agents)
    }

    fn reserve(&mut self, more: usize) {
        self.agents.reserve(more);
        self.tiers.reserve(more);
        self.drawn.reserve(more);
    }

    /// Gives every one of the first so many places its row.
    fn make_room(&mut self, places: usize) {
        let places = places.max(self.agents.len());
        self.agents.resize_with(places, Agent::absent);
        self.tiers.resize(places, Tier::Far);
        self.drawn.resize(places, Drawn::default());
    }

    /// Adds one walker; returns its place, and the order to make it.
    fn enter(&mut self, start: Vec3, heading: f32) -> (usize, Order) {
        let place = self.roster.enter();
        (place, self.put_next(place, start, heading))
    }

    /// Puts the next walker into its row; returns the order to make it.
    fn put_next(&mut self, place: usize, start: Vec3, heading: f32) -> Order {
        self.make_room(place + 1);
        let number = self.made;
        self.made += 1;
        self.put(place, number, (start, heading), None)
    }

    /// Puts a walker into its row, as it was saved or as its number has it.
    fn put(
        &mut self,
        place: usize,
        number: u64,
        (start, heading): (Vec3, f32),
        saved: Option<&SavedAgent>,
    ) -> Order {
        let settings = &self.settings;
        let seed = settings
            .seed
            .wrapping_mul(1_000_003)
            .wrapping_add(number + 1);
        let seed = saved.map_or(seed, |saved| saved.seed);
        let phase = saved.map_or_else(
            || ((number + 1) as f32 * GOLDEN).fract(),
            |saved| saved.phase,
        );
        self.tickets += 1;
        let mut agent = Agent::new(self.tickets, start, heading, seed);
        agent.start_phase = phase;
        let between = |[low, high]: [f32; 2], share: f32| low + share * (high - low);
        agent.speed_mps = between(settings.speeds_mps, agent.chance());
        agent.size = between(settings.sizes, agent.chance()).max(0.05);
        let tint = (agent.chance() * settings.tints.len() as f32) as usize;
        agent.tint = settings.tints.get(tint).copied().unwrap_or(WHITE);
        let styles = self.maker.styles();
        // One of the styles, or none.
        let style = (agent.chance() * (styles + 1) as f32) as usize;
        let amount = settings.style_amount * (0.5 + 0.5 * agent.chance());
        if style < styles {
            agent.outfit = Outfit::of_one(style, amount);
        }
        if let Some(saved) = saved {
            agent.speed_mps = saved.speed_mps;
            agent.size = saved.size;
            agent.tint = saved.tint;
            agent.ground_m = saved.place[1];
            agent.progress_m = saved.progress_m;
            agent.aside_m = saved.aside_m;
            agent.goal = saved.target.map_or(Goal::Turn(saved.turn_rate), |target| {
                Goal::Place(Vec2::from(target))
            });
            agent.outfit = Outfit::of(&saved.weights[..saved.weights.len().min(styles)]);
        }
        self.drawn[place] = agent.drawn(start, heading);
        let order = Order {
            place,
            ticket: self.tickets,
            outfit: agent.outfit.clone(),
            config: Some(GeneratorConfig {
                seed,
                phase,
                variation: 1.0,
            }),
        };
        self.agents[place] = agent;
        order
    }
}

/// Height of a body's highest joint in the T-pose.
fn height_m(body: &Skeleton) -> f32 {
    let mut t_pose = ModelPose::default();
    forward_kinematics(body, &Pose::rest(body), &mut t_pose);
    let heights = t_pose.positions.iter().map(|place| place.y);
    heights.fold(0.0, f32::max)
}
