//! A crowd that follows another one: what it hears.

use super::CrowdReplicaError;
use super::led::Led;
use super::message::{self, Kind};
use super::person::Person;
use super::step::{STEP_BYTES, ToldStep};
use crate::crowd::agent::Agent;
use crate::crowd::maker::Order;
use crate::crowd::{Crowd, MOST_AGENTS};
use footfall_core::hash::fnv1a;
use footfall_synth::replica::ReplicaClock;
use footfall_synth::{GeneratorConfig, GroundTransform};

/// Bytes that are heard in a second: those of the largest crowd, told everything.
const MOST_BYTES_A_SECOND: u32 = 8_000_000;

/// Steps are taken so much later than the quickest message would allow, seconds: one that is lost is told again after a tenth and two, and who is far away from the sender's camera is
/// seen to step a few frames late.
const LATER_SECS: f64 = 0.3;

/// Without a message for so long everybody stands, seconds.
const SILENCE_SECS: f64 = 3.0;

/// Knowledge of a crowd about the one that it follows.
#[derive(Clone, Copy, Debug)]
pub(in crate::crowd) struct Following {
    session: Option<u16>,
    fingerprint: u32,
    clock: ReplicaClock,
    /// Bytes that may still be heard, and since when.
    left: f64,
    left_secs: f64,
}

impl Following {
    /// Our time at which a step is taken that began at a time of the sender's.
    pub(super) fn due_secs(&self, sent_secs: f64) -> f64 {
        self.clock.due_secs(sent_secs) + LATER_SECS
    }

    /// Returns true when nothing has come for long.
    pub(super) fn is_silent(&self, now_secs: f64) -> bool {
        self.clock.silent_secs(now_secs) > SILENCE_SECS
    }

    fn check(&mut self, now_secs: f64, length: usize) -> Result<(), CrowdReplicaError> {
        let most = f64::from(MOST_BYTES_A_SECOND);
        self.left = (self.left + most * (now_secs - self.left_secs)).min(most);
        self.left_secs = now_secs;
        let length = length as f64;
        if length > self.left {
            return Err(CrowdReplicaError::Flood(MOST_BYTES_A_SECOND));
        }
        self.left -= length;
        Ok(())
    }
}

impl Crowd {
    /// A number that crowds of the same model and styles share; 0 where the model has none.
    pub(super) fn fingerprint(&self) -> u32 {
        let recipe = self.maker.recipe();
        let model = recipe.model.fingerprint().unwrap_or_default();
        let names = recipe.styles.iter().map(|style| style.name.as_str());
        let styles = names.flat_map(|name| name.bytes().chain([0]));
        let hash = fnv1a(model.to_le_bytes().into_iter().chain(styles));
        (hash ^ hash >> 32) as u32
    }

    /// Follows another machine's crowd from now on: everybody leaves, and who comes is told by [`hear`](Self::hear). Returns the places of those who left. Add nobody meanwhile.
    pub fn follow(&mut self) -> Vec<usize> {
        self.following = Some(Following {
            session: None,
            fingerprint: self.fingerprint(),
            clock: ReplicaClock::new(),
            left: f64::from(MOST_BYTES_A_SECOND),
            left_secs: self.time_secs,
        });
        self.clear()
    }

    /// Follows no more: who is there goes on by itself.
    pub fn lead(&mut self) {
        if self.following.take().is_some() {
            for agent in &mut self.agents {
                agent.led = None;
                self.way.take_up(agent);
            }
        }
    }

    /// Returns true when it follows another one.
    pub const fn is_following(&self) -> bool {
        self.following.is_some()
    }

    /// Returns true when it follows another one and has heard who is in it.
    pub fn is_introduced(&self) -> bool {
        self.following
            .is_some_and(|following| following.session.is_some())
    }

    /// Hears a message of the crowd that it follows; other crowds hear nothing. Returns the places of those who left.
    ///
    /// # Errors
    /// [`CrowdReplicaError`] when it is refused.
    pub fn hear(&mut self, bytes: &[u8]) -> Result<Vec<usize>, CrowdReplicaError> {
        let now_secs = self.time_secs;
        let Some(following) = &mut self.following else {
            return Ok(Vec::new());
        };
        following.check(now_secs, bytes.len())?;
        let (kind, session, content) = message::open(bytes)?;
        let damaged = CrowdReplicaError::Damaged(bytes.len());
        let known = following.session == Some(session);
        match kind {
            Kind::People => self.hear_people(session, content, damaged),
            Kind::Steps if known => self.hear_steps(content, damaged).map(|()| Vec::new()),
            Kind::Left if known => self.hear_left(content, damaged),
            // Of a crowd whose people were not introduced yet.
            Kind::Steps | Kind::Left => Ok(Vec::new()),
        }
    }

    fn hear_steps(
        &mut self,
        content: &[u8],
        damaged: CrowdReplicaError,
    ) -> Result<(), CrowdReplicaError> {
        let (ticks, steps) = content.split_first_chunk().ok_or(damaged)?;
        let (steps, rest) = steps.as_chunks::<STEP_BYTES>();
        let Some(following) = self.following.as_mut().filter(|_| rest.is_empty()) else {
            return Err(damaged);
        };
        let ticks = u16::from_le_bytes(*ticks);
        let sent_secs = following.clock.hear(self.time_secs, ticks);
        for step in steps.iter().map(ToldStep::unpack) {
            let row = step.row as usize;
            let (_, turn) = ToldStep::row_and_turn(self.roster.name(row));
            let led = self
                .agents
                .get_mut(row)
                .and_then(|agent| agent.led.as_mut());
            // Of somebody who is not introduced yet, or has left.
            if let Some(led) = led.filter(|_| turn == step.turn) {
                led.hear(&step, sent_secs);
            }
        }
        Ok(())
    }

    fn hear_left(
        &mut self,
        content: &[u8],
        damaged: CrowdReplicaError,
    ) -> Result<Vec<usize>, CrowdReplicaError> {
        let (names, rest) = content.as_chunks::<4>();
        if !rest.is_empty() {
            return Err(damaged);
        }
        let names = names.iter().map(|name| i32::from_le_bytes(*name));
        let mut places: Vec<usize> = names.filter_map(|name| self.roster.place(name)).collect();
        places.sort_unstable();
        places.dedup();
        self.leave(&places);
        Ok(places)
    }

    fn hear_people(
        &mut self,
        session: u16,
        content: &[u8],
        damaged: CrowdReplicaError,
    ) -> Result<Vec<usize>, CrowdReplicaError> {
        let (fingerprint, content) = content.split_first_chunk().ok_or(damaged)?;
        let (ticks, mut content) = content.split_first_chunk().ok_or(damaged)?;
        let Some(following) = &mut self.following else {
            return Ok(Vec::new());
        };
        if u32::from_le_bytes(*fingerprint) != following.fingerprint {
            return Err(CrowdReplicaError::OtherModel);
        }
        // Nothing changes before all of it is known to be sound.
        let mut people = Vec::new();
        while !content.is_empty() {
            let (person, rest): (Person, &[u8]) =
                postcard::take_from_bytes(content).map_err(|_broken| damaged)?;
            let (name, step) = person.checked().ok_or(CrowdReplicaError::Nonsense)?;
            if step.row >= MOST_AGENTS {
                return Err(CrowdReplicaError::TooMany);
            }
            people.push((person, name, step));
            content = rest;
        }
        let ticks = u16::from_le_bytes(*ticks);
        // It came in order, after others that were sent before it and waited for.
        let sent_secs = following.clock.hear(self.time_secs, ticks);
        let another = following.session != Some(session);
        following.session = Some(session);
        let mut left = if another { self.clear() } else { Vec::new() };
        let mut orders = Vec::new();
        for (person, name, step) in people {
            let row = step.row as usize;
            let there = self.roster.place(self.roster.name(row)).is_some();
            let same = self.roster.place(name).is_some() && self.agents[row].seed == person.seed;
            if there && !same {
                self.leave(&[row]);
                left.push(row);
            }
            if same {
                self.greet_again(row, &person);
            } else {
                orders.push(self.greet(row, name, &person, &step));
            }
            if let Some(led) = &mut self.agents[row].led {
                led.hear(&step, sent_secs);
            }
        }
        self.maker.take(orders.into_iter());
        Ok(left)
    }

    /// Takes in somebody who was introduced; returns the order to make it.
    fn greet(&mut self, row: usize, name: i32, person: &Person, step: &ToldStep) -> Order {
        self.roster.enter_as(name);
        self.make_room(row + 1);
        self.tickets += 1;
        let GroundTransform { position, heading } = step.aim;
        let mut agent = Agent::new(self.tickets, position, heading, person.seed);
        person.dress(&mut agent);
        agent.outfit = person.outfit(self.maker.styles());
        agent.led = Some(Box::new(Led::new(step.number, person.chance_position)));
        self.drawn[row] = agent.drawn(position, heading, 0.0);
        let order = Order {
            place: row,
            ticket: self.tickets,
            outfit: agent.outfit.clone(),
            config: Some(GeneratorConfig {
                seed: person.seed,
                phase: 0.0,
                variation: 1.0,
            }),
            alone: true,
        };
        self.agents[row] = agent;
        order
    }

    /// Takes up the looks of somebody who is known.
    fn greet_again(&mut self, row: usize, person: &Person) {
        person.dress(&mut self.agents[row]);
        let outfit = person.outfit(self.maker.styles());
        if self.agents[row].outfit != outfit {
            self.wear(row, &outfit.weights());
        }
    }
}
