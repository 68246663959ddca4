//! Addition and removal of walkers.

use super::Crowd;
use super::agent::{Agent, WHITE};
use super::disposal;
use super::drawn::Drawn;
use super::goal::Goal;
use super::maker::Order;
use super::mixtures::StyleMixture;
use super::motion::Stir;
use super::neighbours::Passerby;
use super::routing::Routing;
use super::save::{self, SavedAgent, SavedCrowd};
use super::tiers::Tier;
use footfall_synth::GeneratorConfig;
use glam::{Vec2, Vec3};

/// The golden ratio spreads phases evenly, and the plastic number places in a rectangle, however many there are.
const GOLDEN: f32 = 0.618_034;
const PLASTIC: [f32; 2] = [0.754_877_7, 0.569_840_3];

/// A walker with a name and no row yet: where it will stand, and its heading.
#[derive(Debug)]
pub(super) struct Coming {
    place: usize,
    start: Vec3,
    heading: f32,
}

impl Crowd {
    /// Sets the number of the crowd's own walkers, which no script added. Surplus walkers leave, the latest first; returns their
    /// rows. In a crowd that [follows](Self::follow) another, that one determines the number.
    pub fn set_count(&mut self, count: usize) -> Vec<usize> {
        if self.is_following() {
            return Vec::new();
        }
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

    /// Adds the crowd's own walker of this index among those that begin together.
    fn add_own(&mut self, index: usize, together: Option<usize>) -> Order {
        let share = |axis: usize| (0.5 + (index + 1) as f32 * PLASTIC[axis]).fract();
        let (level, heading, progress, aside) = match &self.routing {
            Routing::Path(path) => {
                let along = together.map_or_else(
                    || ((index + 1) as f32 * GOLDEN).fract(),
                    |count| index as f32 / count as f32,
                );
                let progress = path.length() * along;
                let aside = self.settings.path_width * (share(0) - 0.5);
                let (place, direction) = path.beside(progress, aside);
                (place, direction.x.atan2(direction.y), progress, aside)
            }
            Routing::Scripted | Routing::Wander { .. } | Routing::Navigate => {
                let across = Vec2::new(share(0), share(1)) * 2.0 - Vec2::ONE;
                let heading = core::f32::consts::TAU * (index as f32 * GOLDEN * GOLDEN).fract();
                (across * self.settings.half_area, heading, 0.0, 0.0)
            }
        };
        let (place, order) = self.enter(Vec3::new(level.x, 0.0, level.y), heading);
        let agent = &mut self.agents[place];
        agent.counted = true;
        if self.routing.is_navigated() {
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
    pub(super) fn are_coming(&self) -> bool {
        !self.coming.is_empty()
    }

    /// Gives rows to this many of the added walkers, and orders their walks. Allocating ten thousand rows at once would take
    /// longer than a frame.
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

    /// Continues with saved walkers in an empty crowd.
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

    /// Removes the walkers in these rows.
    pub fn leave(&mut self, places: &[usize]) {
        self.roster.leave(places);
        let mut left = Vec::with_capacity(places.len());
        for place in places {
            left.push(core::mem::replace(
                &mut self.agents[*place],
                Agent::absent(),
            ));
            self.tiers[*place] = Tier::Far;
            self.drawn[*place] = Drawn::default();
            self.stirs[*place] = Stir::default();
            self.seen[*place] = Passerby::NOWHERE;
        }
        disposal::dispose(left);
    }

    /// Removes all walkers; returns their rows.
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

    /// Saves all walkers: names, places, looks, goals and phases. After [`restore`](Self::restore) their next steps are drawn again.
    pub fn save(&self) -> Vec<u8> {
        let places = self.roster.order().iter();
        let agents = places.map(|place| &self.agents[*place as usize]);
        save::write(self.made, &self.roster, agents)
    }

    fn reserve(&mut self, more: usize) {
        self.agents.reserve(more);
        self.tiers.reserve(more);
        self.drawn.reserve(more);
        self.stirs.reserve(more);
        self.seen.reserve(more);
    }

    /// Creates rows up to this number.
    pub(super) fn make_room(&mut self, places: usize) {
        let places = places.max(self.agents.len());
        self.agents.resize_with(places, Agent::absent);
        self.tiers.resize(places, Tier::Far);
        self.drawn.resize(places, Drawn::default());
        self.stirs.resize(places, Stir::default());
        self.seen.resize(places, Passerby::NOWHERE);
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

    /// Puts a walker into its row, as saved or as derived from its number.
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
            agent.mixture = StyleMixture::of_one(style, amount);
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
            agent.mixture = StyleMixture::of(&saved.weights[..saved.weights.len().min(styles)]);
        }
        self.drawn[place] = agent.drawn(start, heading, 0.0);
        let order = Order {
            place,
            ticket: self.tickets,
            mixture: agent.mixture.clone(),
            config: Some(GeneratorConfig {
                seed,
                phase,
                variation: 1.0,
            }),
            alone: !self.repeats,
        };
        self.agents[place] = agent;
        order
    }
}
