//! Motion of all walkers, on many threads at once.

use super::Crowd;
use super::neighbours::Sight;
use super::routing::Routing;
use super::tiers::Tier;
use footfall_core::Side;
use footfall_synth::{Detail, StyledBody};
use glam::Vec3;
use rayon::prelude::*;
use std::sync::PoisonError;

/// Walkers that one thread takes at a time.
const CHUNK: usize = 128;
/// Walkers whose memory is fetched together.
pub const FETCHED: usize = 16;
/// Number of groups of distant walkers, one of which moves in each frame.
pub const GROUPS: usize = 4;
/// Interval at which neighbours are found anew, in frames.
const NEIGHBOURS_EVERY: u64 = 4;

/// Steps of a walker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Steps {
    /// The walker is not made.
    #[default]
    None,
    /// It takes shared steps.
    Shared,
    /// It takes steps of its own, or still blends out of them.
    Own,
}

/// Record of a row's last frame, in an array of its own because a frame skips most rows.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stir {
    /// True if the walker moved.
    moved: bool,
    /// True if a foot landed.
    landed: bool,
    pub(super) steps: Steps,
}

impl Crowd {
    /// Advances all walkers.
    pub fn advance(&mut self, dt_secs: f32, avoidance: bool) {
        if dt_secs <= 0.0 {
            for stir in &mut self.stirs {
                stir.landed = false;
            }
            return;
        }
        self.frame += 1;
        self.time_secs += f64::from(dt_secs);
        let frame = self.frame;
        let Some(mixtures) = self.mixtures.clone() else {
            return;
        };
        if avoidance && frame.is_multiple_of(NEIGHBOURS_EVERY) {
            let others = self.others.iter().copied();
            self.neighbours
                .rebuild(self.seen.iter().copied().chain(others));
        }
        let Self {
            agents,
            tiers,
            drawn,
            stirs,
            seen,
            neighbours,
            routing,
            repeats,
            standing_motion,
            time_secs,
            following,
            ..
        } = self;
        let (workshops, neighbours, routing) = (&mixtures.workshops, &*neighbours, &*routing);
        let (following, now_secs) = (following.as_ref(), *time_secs);
        let repeats = *repeats && following.is_none();
        let standing_motion = *standing_motion;
        let chunks = agents
            .par_chunks_mut(CHUNK)
            .zip(tiers.par_chunks(CHUNK))
            .zip(drawn.par_chunks_mut(CHUNK))
            .zip(stirs.par_chunks_mut(CHUNK))
            .zip(seen.par_chunks_mut(CHUNK))
            .enumerate();
        chunks.for_each(|(chunk, ((((agents, tiers), drawn), stirs), seen))| {
            let thread = rayon::current_thread_index().map_or(0, |index| index + 1);
            let workshop = &workshops[thread.min(workshops.len() - 1)];
            let mut workshop = workshop.lock().unwrap_or_else(PoisonError::into_inner);
            let mut sight = Sight::default();
            for (index, (stir, tier)) in stirs.iter_mut().zip(tiers).enumerate() {
                // Distant walkers move in their group's frame, by the time since the last one.
                let group = (chunk * CHUNK + index) % GROUPS;
                let late = *tier == Tier::Far && !(repeats && stir.steps == Steps::Own);
                stir.moved = !late || frame % GROUPS as u64 == group as u64;
                stir.landed = false;
            }
            for index in 0..agents.len() {
                if index.is_multiple_of(FETCHED) {
                    let together = index..agents.len().min(index + FETCHED);
                    let moving = together.filter(|index| stirs[*index].moved);
                    moving.for_each(|index| agents[index].fetch());
                }
                let (agent, tier, drawn) = (&mut agents[index], &tiers[index], &mut drawn[index]);
                let stir = &mut stirs[index];
                if !stir.moved {
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
                    // Fifteen frames a second, blended, look the same from a dozen metres on.
                    Tier::Near | Tier::Far => Detail::Quarter,
                });
                walker.set_repeating(repeats && *tier == Tier::Far);
                walker.set_standing_motion(standing_motion);
                let secs = (now_secs - agent.clock_secs) as f32;
                agent.clock_secs = now_secs;
                let (from, heading) = (agent.place, agent.heading);
                if let Some(following) = following {
                    agent.follow(secs, following, &mut workshop);
                } else {
                    if agent.is_about_to_step(secs) {
                        routing.lead(agent);
                        let stops = matches!(routing, Routing::Scripted);
                        if avoidance {
                            let seen = neighbours.around(agent.level(), &mut sight);
                            agent.decide(seen, stops);
                        } else {
                            agent.decide(&[], stops);
                        }
                    }
                    agent.advance(secs, &mut workshop);
                }
                *drawn = agent.drawn(from, heading, secs);
                stir.landed = agent.has_landed();
                stir.steps = agent.steps();
                seen[index] = agent.seen();
            }
        });
    }

    /// Returns whether a walker moved in the last frame.
    pub fn moved(&self, index: usize) -> bool {
        self.stirs.get(index).is_some_and(|stir| stir.moved)
    }

    /// Returns whether a walker's [pose](super::Agent::shared_pose) is shared.
    pub fn shares(&self, index: usize) -> bool {
        self.takes(index, Steps::Shared)
    }

    /// Returns whether a walker takes steps of its own, or still blends out of them. A distant walker that [repeats](Self::repeats) steps moves in every frame during the blend, less than a second.
    pub fn is_alone(&self, index: usize) -> bool {
        self.takes(index, Steps::Own)
    }

    fn takes(&self, index: usize, steps: Steps) -> bool {
        let stir = self.stirs.get(index);
        stir.is_some_and(|stir| stir.steps == steps)
    }

    /// Number of style mixtures that walkers have or had.
    pub fn worn(&self) -> usize {
        self.mixtures
            .as_ref()
            .map_or(0, |mixtures| mixtures.count())
    }

    /// The bodies of style mixtures with this number and later ones.
    pub fn worn_from(&self, number: u32) -> Vec<StyledBody> {
        let mixtures = self.mixtures.as_ref();
        mixtures
            .map(|mixtures| mixtures.numbered_from(number))
            .unwrap_or_default()
    }

    /// Returns whether a foot of a walker landed in the last frame.
    pub fn has_landed(&self, index: usize) -> bool {
        self.stirs.get(index).is_some_and(|stir| stir.landed)
    }

    /// Landings in the last frame: walker, foot and place.
    pub fn landed(&self) -> impl Iterator<Item = (usize, Side, Vec3)> {
        let stirs = self.stirs.iter().enumerate();
        let landed = stirs.filter(|(_, stir)| stir.landed);
        landed.filter_map(|(index, _)| {
            let (side, place) = self.agents[index].landed?;
            Some((index, side, place))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::agent::Agent;
    use super::super::drawn::Drawn;
    use super::super::neighbours::Passerby;
    use super::*;

    #[test]
    fn a_row_takes_less_than_half_a_kilobyte() {
        let seen = 2 * size_of::<Passerby>();
        let row = size_of::<Agent>() + size_of::<Drawn>() + size_of::<Stir>() + seen;
        assert!(row + size_of::<Tier>() < 512, "{row} bytes");
    }
}
