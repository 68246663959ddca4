//! A crowd that follows another one: received messages.

use super::CrowdReplicaError;
use super::early::EarlySteps;
use super::led::LedWalker;
use super::message::{self, Kind};
use super::person::Person;
use super::step::{STEP_BYTES, StepUpdate};
use crate::crowd::agent::Agent;
use crate::crowd::maker::Order;
use crate::crowd::{Crowd, MOST_AGENTS};
use footfall_core::hash::fnv1a;
use footfall_synth::replica::ReplicaClock;
use footfall_synth::{GeneratorConfig, GroundTransform};

/// Most bytes that are received in a second: those of the largest crowd, sent whole.
const MOST_BYTES_A_SECOND: u32 = 8_000_000;

/// Delay of steps beyond that of the quickest message, seconds: a lost step is sent again after 0.1 s and 0.2 s, and steps of walkers far from the sender's camera are
/// sent a few frames late.
const LATER_SECS: f64 = 0.3;

/// Time without a message after which all walkers stand, seconds.
const SILENCE_SECS: f64 = 3.0;

/// State of a crowd that follows another one.
#[derive(Debug)]
pub(in crate::crowd) struct Following {
    session: Option<u16>,
    fingerprint: u32,
    clock: ReplicaClock,
    early: EarlySteps,
    /// Bytes that may still be received, and the time of the last update.
    left: f64,
    left_secs: f64,
}

impl Following {
    /// Our time at which a step begins that began at this time of the sender.
    pub(super) fn due_secs(&self, sent_secs: f64) -> f64 {
        self.clock.due_secs(sent_secs) + LATER_SECS
    }

    /// Returns true if no message has come for long.
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
    /// A number that is equal for crowds of the same model and styles; 0 if the model has none.
    pub(super) fn fingerprint(&self) -> u32 {
        let recipe = self.maker.recipe();
        let model = recipe.model.fingerprint().unwrap_or_default();
        let names = recipe.styles.iter().map(|style| style.name.as_str());
        let styles = names.flat_map(|name| name.bytes().chain([0]));
        let hash = fnv1a(model.to_le_bytes().into_iter().chain(styles));
        (hash ^ hash >> 32) as u32
    }

    /// Follows another machine's crowd from now on: all walkers leave, and [`hear`](Self::hear) adds those of the other crowd. Returns the rows of those that left. Add no walkers
    /// while it follows.
    pub fn follow(&mut self) -> Vec<usize> {
        self.following = Some(Following {
            session: None,
            fingerprint: self.fingerprint(),
            clock: ReplicaClock::new(),
            early: EarlySteps::default(),
            left: f64::from(MOST_BYTES_A_SECOND),
            left_secs: self.time_secs,
        });
        self.clear()
    }

    /// Stops following: the walkers continue by themselves.
    pub fn lead(&mut self) {
        if self.following.take().is_some() {
            for agent in &mut self.agents {
                agent.led = None;
                self.routing.take_up(agent);
            }
        }
    }

    /// Returns true if it follows another crowd.
    pub const fn is_following(&self) -> bool {
        self.following.is_some()
    }

    /// Returns true if it follows another crowd whose walkers were introduced.
    pub fn is_introduced(&self) -> bool {
        let following = self.following.as_ref();
        following.is_some_and(|following| following.session.is_some())
    }

    /// Takes a message of the crowd that it follows; a crowd that follows none ignores it. Returns the rows of walkers that left.
    ///
    /// # Errors
    /// [`CrowdReplicaError`] if the message is refused.
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
            Kind::Steps if known => {
                let heard = self.hear_steps(session, now_secs, content, damaged);
                heard.map(|()| Vec::new())
            }
            Kind::Left if known => self.hear_left(content, damaged),
            // From a crowd whose walkers were not introduced yet.
            Kind::Steps => {
                split_steps(content).ok_or(damaged)?;
                following.early.keep(session, now_secs, content);
                Ok(Vec::new())
            }
            Kind::Left => Ok(Vec::new()),
        }
    }

    /// Takes steps that arrived at this time of ours.
    fn hear_steps(
        &mut self,
        session: u16,
        arrived_secs: f64,
        content: &[u8],
        damaged: CrowdReplicaError,
    ) -> Result<(), CrowdReplicaError> {
        let (ticks, steps) = split_steps(content).ok_or(damaged)?;
        let Some(following) = &mut self.following else {
            return Ok(());
        };
        let sent_secs = following.clock.hear(arrived_secs, ticks);
        let mut is_early = false;
        for step in steps.iter().map(StepUpdate::unpack) {
            let row = step.row as usize;
            let (_, turn) = StepUpdate::row_and_turn(self.roster.name(row));
            let led = self
                .agents
                .get_mut(row)
                .and_then(|agent| agent.led.as_mut());
            match led.filter(|_| turn == step.turn) {
                Some(led) => led.hear(&step, sent_secs),
                // It is not introduced yet, or has left.
                None => is_early = true,
            }
        }
        if is_early {
            following.early.keep(session, arrived_secs, content);
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
        // All of it is checked before anything changes.
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
        // Reliable messages arrive in order, after earlier ones that had to be waited for.
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
        self.hear_early_steps(session)?;
        Ok(left)
    }

    /// Takes steps that have arrived before the introduction of their walkers.
    fn hear_early_steps(&mut self, session: u16) -> Result<(), CrowdReplicaError> {
        let Some(following) = &mut self.following else {
            return Ok(());
        };
        for early in following.early.take(session).collect::<Vec<_>>() {
            let damaged = CrowdReplicaError::Damaged(early.content.len());
            self.hear_steps(session, early.arrived_secs, &early.content, damaged)?;
        }
        Ok(())
    }

    /// Takes in somebody who was introduced; returns the order to make it.
    fn greet(&mut self, row: usize, name: i32, person: &Person, step: &StepUpdate) -> Order {
        self.roster.enter_as(name);
        self.make_room(row + 1);
        self.tickets += 1;
        let GroundTransform { position, heading } = step.aim;
        let mut agent = Agent::new(self.tickets, position, heading, person.seed);
        person.dress(&mut agent);
        agent.mixture = person.mixture(self.maker.styles());
        agent.led = Some(Box::new(LedWalker::new(
            step.number,
            person.chance_position,
        )));
        self.drawn[row] = agent.drawn(position, heading, 0.0);
        let order = Order {
            place: row,
            ticket: self.tickets,
            mixture: agent.mixture.clone(),
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
        let mixture = person.mixture(self.maker.styles());
        if self.agents[row].mixture != mixture {
            self.wear(row, &mixture.weights());
        }
    }
}

/// The sender's time, in ticks, and the packed steps in the content of a message about steps; `None` for a damaged one.
fn split_steps(content: &[u8]) -> Option<(u16, &[[u8; STEP_BYTES]])> {
    let (ticks, steps) = content.split_first_chunk()?;
    let (steps, rest) = steps.as_chunks();
    rest.is_empty()
        .then_some((u16::from_le_bytes(*ticks), steps))
}
