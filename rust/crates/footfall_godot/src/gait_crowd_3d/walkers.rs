//! Everybody in a crowd, moved on many threads at once.

use super::agent::{Agent, Drawn, Goal, WHITE};
use super::crowd_mesh::CrowdMesh;
use super::neighbours::Neighbours;
use super::save::SavedAgent;
use super::tiers::Tier;
use super::way::Way;
use footfall_core::Side;
use footfall_synth::{CrowdWalker, Detail, GeneratorConfig, StyleSpace, StyledBody, Workshop};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Walkers that one thread takes at a time.
const CHUNK: usize = 128;
/// Walkers whose memory is fetched together.
pub(super) const FETCHED: usize = 16;
/// Walkers far away are in so many groups, of which one moves in each frame.
pub(super) const GROUPS: usize = 4;
/// Who is near whom is looked at in every so many frames.
const NEIGHBOURS_EVERY: u64 = 4;
/// Weights of styles are rounded to such parts.
const WEIGHT_PARTS: f32 = 8.0;
/// The golden ratio spreads phases evenly, and the plastic number places in a rectangle, however many there are.
const GOLDEN: f32 = 0.618_034;
const PLASTIC: [f32; 2] = [0.754_877_7, 0.569_840_3];

/// How walkers differ.
pub(super) struct Settings {
    pub(super) seed: u64,
    pub(super) speeds_mps: [f32; 2],
    pub(super) sizes: [f32; 2],
    pub(super) style_amount: f32,
    pub(super) tints: Vec<[f32; 4]>,
    pub(super) half_area: Vec2,
    pub(super) path_width: f32,
}

/// Everybody.
pub(super) struct Walkers {
    pub(super) agents: Vec<Agent>,
    pub(super) tiers: Vec<Tier>,
    /// What is drawn of each.
    pub(super) drawn: Vec<Drawn>,
    /// How many frames there were.
    pub(super) frame: u64,
    time_secs: f64,
    pub(super) mesh: CrowdMesh,
    space: Arc<StyleSpace>,
    outfits: HashMap<Vec<i8>, StyledBody>,
    plain: StyledBody,
    workshops: Vec<Mutex<Workshop>>,
    neighbours: Neighbours,
    way: Way,
    settings: Settings,
    repeats: bool,
    made: u64,
}

impl Walkers {
    /// # Errors
    /// Why nobody can walk, for the user.
    pub(super) fn new(
        space: &Arc<StyleSpace>,
        mesh: CrowdMesh,
        way: Way,
        settings: Settings,
    ) -> Result<Self, String> {
        let plain = StyledBody::new(space, &[], &mesh.body)
            .map_err(|error| format!("The walk cannot start: {error}"))?;
        // One for each thread, and one for who calls.
        let threads = rayon::current_num_threads() + 1;
        let workshop = |_| Mutex::new(Workshop::new(&plain));
        Ok(Self {
            workshops: (0..threads).map(workshop).collect(),
            agents: Vec::new(),
            tiers: Vec::new(),
            drawn: Vec::new(),
            // So that nobody's pose seems to have been written just now.
            frame: 1000,
            time_secs: 0.0,
            mesh,
            space: Arc::clone(space),
            outfits: HashMap::new(),
            plain,
            neighbours: Neighbours::default(),
            way,
            settings,
            repeats: true,
            made: 0,
        })
    }

    /// Puts so many walkers where they begin.
    pub(super) fn populate(&mut self, count: usize) {
        self.agents.reserve(count);
        for index in 0..count {
            let share = |axis: usize| (0.5 + (index + 1) as f32 * PLASTIC[axis]).fract();
            let (place, heading, progress, aside) = match &self.way {
                Way::Path(path) => {
                    let progress = path.length() * index as f32 / count as f32;
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
            self.add(Vec3::new(place.x, 0.0, place.y), heading, None);
            if let Some(agent) = self.agents.last_mut() {
                if self.way.is_navigated() {
                    agent.goal = Goal::Place(place);
                }
                agent.progress_m = progress;
                agent.aside_m = aside;
            }
        }
    }

    /// Adds one walker, as it was saved or as its number has it.
    pub(super) fn add(&mut self, place: Vec3, heading: f32, saved: Option<&SavedAgent>) {
        let number = self.made;
        self.made += 1;
        let seed = saved.map_or_else(
            || {
                self.settings
                    .seed
                    .wrapping_mul(1_000_003)
                    .wrapping_add(number + 1)
            },
            |saved| saved.seed,
        );
        let phase = saved.map_or_else(
            || ((number + 1) as f32 * GOLDEN).fract(),
            |saved| saved.phase,
        );
        let config = GeneratorConfig {
            seed,
            phase,
            variation: 1.0,
        };
        let plain = self.plain.clone();
        let Ok(workshop) = self.workshops[0].get_mut() else {
            return;
        };
        let Ok(walker) = CrowdWalker::new(&plain, &config, false, workshop) else {
            return;
        };
        let mut agent = Agent::new(walker, place, heading, seed);
        let between = |[low, high]: [f32; 2], share: f32| low + share * (high - low);
        agent.speed_mps = between(self.settings.speeds_mps, agent.chance());
        agent.size = between(self.settings.sizes, agent.chance()).max(0.05);
        let tints = &self.settings.tints;
        let tint = (agent.chance() * tints.len() as f32) as usize;
        agent.tint = tints.get(tint).copied().unwrap_or(WHITE);
        let styles = self.space.styles().len();
        // One of the styles, or none.
        let style = (agent.chance() * (styles + 1) as f32) as usize;
        let amount = self.settings.style_amount * (0.5 + 0.5 * agent.chance());
        let mut weights = vec![0.0; styles];
        if let Some(weight) = weights.get_mut(style) {
            *weight = amount;
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
            weights.clone_from(&saved.weights);
        }
        agent.walker.set_detail(Detail::Quarter);
        agent.clock_secs = self.time_secs;
        self.drawn.push(agent.drawn(place, heading));
        self.agents.push(agent);
        self.wear(self.agents.len() - 1, &weights);
    }

    /// Removes everybody.
    pub(super) fn clear(&mut self) {
        self.agents.clear();
        self.tiers.clear();
        self.drawn.clear();
    }

    /// Lets a walker wear a mixture of styles.
    pub(super) fn wear(&mut self, index: usize, weights: &[f32]) {
        let Some(agent) = self.agents.get_mut(index) else {
            return;
        };
        let styles = self.space.styles().len();
        let parts: Vec<i8> = (0..styles)
            .map(|style| {
                let weight = weights.get(style).copied().unwrap_or(0.0);
                let weight = if weight.is_finite() { weight } else { 0.0 };
                (weight * WEIGHT_PARTS).round().clamp(-32.0, 32.0) as i8
            })
            .collect();
        let rounded: Vec<f32> = parts
            .iter()
            .map(|part| f32::from(*part) / WEIGHT_PARTS)
            .collect();
        if !self.outfits.contains_key(&parts)
            && let Ok(styled) = StyledBody::new(&self.space, &rounded, self.plain.skeleton())
        {
            self.outfits.insert(parts.clone(), styled);
        }
        if let Some(styled) = self.outfits.get(&parts) {
            agent.walker.wear(styled);
            agent.weights = rounded;
        }
    }

    /// Whether walkers go from place to place of the navigation map.
    pub(super) fn is_navigated(&self) -> bool {
        self.way.is_navigated()
    }

    /// Whether walkers far away repeat their steps.
    pub(super) fn repeat_far(&mut self, repeats: bool) {
        self.repeats = repeats;
    }

    /// Lets time pass for everybody.
    pub(super) fn advance(&mut self, dt_secs: f32, avoidance: bool) {
        self.drawn.truncate(self.agents.len());
        if dt_secs <= 0.0 {
            for agent in &mut self.agents {
                agent.landed = None;
            }
            return;
        }
        self.frame += 1;
        self.time_secs += f64::from(dt_secs);
        self.tiers.resize(self.agents.len(), Tier::Far);
        let frame = self.frame;
        if avoidance && frame.is_multiple_of(NEIGHBOURS_EVERY) {
            self.neighbours.rebuild(self.agents.iter().map(Agent::seen));
        }
        let Self {
            agents,
            tiers,
            drawn,
            workshops,
            neighbours,
            way,
            repeats,
            time_secs,
            ..
        } = self;
        let (workshops, neighbours, way) = (&*workshops, &*neighbours, &*way);
        let (repeats, now_secs) = (*repeats, *time_secs);
        let chunks = agents
            .par_chunks_mut(CHUNK)
            .zip(tiers.par_chunks(CHUNK))
            .zip(drawn.par_chunks_mut(CHUNK))
            .enumerate();
        chunks.for_each(|(chunk, ((agents, tiers), drawn))| {
            let thread = rayon::current_thread_index().map_or(0, |index| index + 1);
            let workshop = &workshops[thread.min(workshops.len() - 1)];
            let mut workshop = workshop.lock().unwrap_or_else(PoisonError::into_inner);
            let moves = |index: usize, tier: Tier| {
                // Those far away move in their group's frame, for all frames since the last one.
                let group = (chunk * CHUNK + index) % GROUPS;
                tier != Tier::Far || frame % GROUPS as u64 == group as u64
            };
            for index in 0..agents.len() {
                if index.is_multiple_of(FETCHED) {
                    let together = index..agents.len().min(index + FETCHED);
                    let moving = together.filter(|index| moves(*index, tiers[*index]));
                    moving.for_each(|index| agents[index].fetch());
                }
                let (agent, tier, drawn) = (&mut agents[index], &tiers[index], &mut drawn[index]);
                if !moves(index, *tier) {
                    continue;
                }
                let secs = (now_secs - agent.clock_secs) as f32;
                agent.clock_secs = now_secs;
                agent.walker.set_detail(match tier {
                    Tier::Full => Detail::Full,
                    // Fifteen frames a second, blended: from a dozen metres on nobody sees the difference.
                    Tier::Near | Tier::Far => Detail::Quarter,
                });
                agent.walker.set_repeating(repeats && *tier == Tier::Far);
                if agent.is_about_to_step(secs) {
                    way.lead(agent);
                    if avoidance {
                        agent.decide(neighbours.around(agent.level()));
                    } else {
                        agent.decide(core::iter::empty());
                    }
                }
                let (from, heading) = (agent.place, agent.heading);
                agent.advance(secs, &mut workshop);
                *drawn = agent.drawn(from, heading);
            }
        });
    }

    /// Whether a walker moved in the last frame.
    pub(super) fn moved(&self, index: usize) -> bool {
        self.tiers.get(index) != Some(&Tier::Far)
            || self.frame % GROUPS as u64 == (index % GROUPS) as u64
    }

    /// Whose feet landed in the last frame, which, and where.
    pub(super) fn landed(&self) -> impl Iterator<Item = (usize, Side, Vec3)> {
        let agents = self.agents.iter().enumerate();
        agents.filter_map(|(index, agent)| {
            let (side, place) = agent.landed.filter(|_| self.moved(index))?;
            Some((index, side, place))
        })
    }
}
