//! Everybody in a crowd, moved on many threads at once.

use super::Crowd;
use super::agent::Agent;
use super::tiers::Tier;
use super::way::Way;
use footfall_core::Side;
use footfall_synth::Detail;
use glam::Vec3;
use rayon::prelude::*;
use std::sync::PoisonError;

/// Walkers that one thread takes at a time.
const CHUNK: usize = 128;
/// Walkers whose memory is fetched together.
pub const FETCHED: usize = 16;
/// Walkers far away are in so many groups, of which one moves in each frame.
pub const GROUPS: usize = 4;
/// Interval at which neighbours are found anew, in frames.
const NEIGHBOURS_EVERY: u64 = 4;

impl Crowd {
    /// Lets time pass for everybody.
    pub fn advance(&mut self, dt_secs: f32, avoidance: bool) {
        if dt_secs <= 0.0 {
            for agent in &mut self.agents {
                agent.landed = None;
            }
            return;
        }
        self.frame += 1;
        self.time_secs += f64::from(dt_secs);
        let frame = self.frame;
        let Some(kit) = self.kit.clone() else {
            return;
        };
        if avoidance && frame.is_multiple_of(NEIGHBOURS_EVERY) {
            let there = self.agents.iter().filter(|agent| agent.walker.is_some());
            let others = self.others.iter().copied();
            self.neighbours
                .rebuild(there.map(Agent::seen).chain(others));
        }
        let Self {
            agents,
            tiers,
            drawn,
            neighbours,
            way,
            repeats,
            standing_motion,
            time_secs,
            following,
            ..
        } = self;
        let (workshops, neighbours, way) = (&kit.workshops, &*neighbours, &*way);
        let (following, now_secs) = (following.as_ref(), *time_secs);
        let repeats = *repeats && following.is_none();
        let standing_motion = *standing_motion;
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
                if let Some(following) = following {
                    agent.begin_led(following, now_secs, &mut workshop);
                }
                let Some(walker) = &mut agent.walker else {
                    continue;
                };
                walker.set_detail(match tier {
                    Tier::Full => Detail::Full,
                    // Fifteen frames a second, blended: from a dozen metres on nobody sees the difference.
                    Tier::Near | Tier::Far => Detail::Quarter,
                });
                walker.set_repeating(repeats && *tier == Tier::Far);
                walker.set_standing_motion(standing_motion);
                let secs = (now_secs - agent.clock_secs) as f32;
                agent.clock_secs = now_secs;
                let (from, heading) = (agent.place, agent.heading);
                if let Some(following) = following {
                    agent.follow(secs, following, &mut workshop);
                    *drawn = agent.drawn(from, heading);
                    continue;
                }
                if agent.is_about_to_step(secs) {
                    way.lead(agent);
                    let stops = matches!(way, Way::Told);
                    if avoidance {
                        agent.decide(neighbours.around(agent.level()), stops);
                    } else {
                        agent.decide(core::iter::empty(), stops);
                    }
                }
                agent.advance(secs, &mut workshop);
                *drawn = agent.drawn(from, heading);
            }
        });
    }

    /// Returns whether a walker moved in the last frame.
    pub fn moved(&self, index: usize) -> bool {
        self.tiers.get(index) != Some(&Tier::Far)
            || self.frame % GROUPS as u64 == (index % GROUPS) as u64
    }

    /// Landings in the last frame: walker, foot and place.
    pub fn landed(&self) -> impl Iterator<Item = (usize, Side, Vec3)> {
        let agents = self.agents.iter().enumerate();
        agents.filter_map(|(index, agent)| {
            let (side, place) = agent.landed.filter(|_| self.moved(index))?;
            Some((index, side, place))
        })
    }
}
