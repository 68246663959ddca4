//! Sender of a crowd: the messages from which peers show the same crowd.

use super::message::{self, CrowdMessage, HEAD_BYTES, Kind, MOST_BYTES};
use super::pending::PendingStep;
use super::person::Person;
use super::step::STEP_BYTES;
use crate::crowd::Crowd;
use footfall_synth::replica::ReplicaClock;
use std::collections::VecDeque;

/// Interval between messages about steps, seconds, and the longest time without one.
const INTERVAL_SECS: f32 = 1.0 / 30.0;
const SILENT_SECS: f32 = 0.2;

/// Time for which unused bytes of the budget accumulate, seconds.
const SAVED_SECS: f32 = 0.25;

/// Shortest time between two introductions of the whole crowd to one peer, seconds.
const ASKED_SECS: f32 = 1.0;

/// Number of frames in which the looks of all walkers are compared once.
const LOOKS_EVERY: usize = 32;

/// Length of a message about steps before the first of them.
const STEPS_AT: usize = HEAD_BYTES + 2;

/// Names in a message about walkers that left.
const NAMES: usize = (MOST_BYTES - HEAD_BYTES) / 4;

/// A peer that follows the crowd.
#[derive(Debug)]
struct Peer {
    number: i32,
    /// Names of walkers that are still to be introduced.
    unknown: VecDeque<i32>,
    /// True until the first message to it.
    is_new: bool,
    asked_secs: f32,
    /// Bytes of the budget that are left for it.
    left: f32,
}

/// Makes the messages from which peers show the same crowd. Without peers it does nothing.
#[derive(Debug)]
pub struct CrowdSender {
    session: u16,
    fingerprint: Option<u32>,
    rows: Vec<PendingStep>,
    peers: Vec<Peer>,
    messages: Vec<CrowdMessage>,
    /// Number of messages of this frame; the others are kept for their memory.
    count: usize,
    /// Rows by the error that sending them removes, kept for its memory.
    order: Vec<(f32, u32)>,
    left: f32,
    since_secs: f32,
    frame: usize,
}

impl CrowdSender {
    /// Creates a sender. Give a crowd that was created again another session number.
    pub const fn new(session: u16) -> Self {
        Self {
            session,
            fingerprint: None,
            rows: Vec::new(),
            peers: Vec::new(),
            messages: Vec::new(),
            count: 0,
            order: Vec::new(),
            left: 0.0,
            since_secs: 0.0,
            frame: 0,
        }
    }

    /// Sends the crowd to a peer from now on: first its walkers, about 40 bytes each, as fast as the budget allows. A repeated call introduces them again, at most once a second.
    pub fn join(&mut self, peer: i32) {
        let at = self.peers.iter().position(|other| other.number == peer);
        let at = at.unwrap_or_else(|| {
            self.peers.push(Peer {
                number: peer,
                unknown: VecDeque::new(),
                is_new: true,
                asked_secs: ASKED_SECS,
                left: 0.0,
            });
            self.peers.len() - 1
        });
        let peer = &mut self.peers[at];
        if peer.asked_secs >= ASKED_SECS {
            peer.asked_secs = 0.0;
            peer.is_new = true;
            peer.unknown.clear();
            // Walkers without a row yet are added by the next step.
            let known = self.rows.iter().map(|row| row.name);
            peer.unknown
                .extend(known.filter(|name| *name != PendingStep::NOBODY.name));
        }
    }

    /// Stops sending to a peer.
    pub fn leave(&mut self, peer: i32) {
        self.peers.retain(|other| other.number != peer);
    }

    /// Returns the peers that follow the crowd.
    pub fn peers(&self) -> impl Iterator<Item = i32> {
        self.peers.iter().map(|peer| peer.number)
    }

    /// Makes this frame's [`messages`](Self::messages), after the crowd has moved: at most `bytes_per_second` about steps, and as many for introductions to each peer.
    /// Walkers must not [share](Crowd::repeats) steps; one that still does is introduced with its first own step.
    pub fn step(&mut self, dt_secs: f32, crowd: &Crowd, bytes_per_second: u32) {
        self.count = 0;
        if self.peers.is_empty() {
            self.rows.clear();
            return;
        }
        let dt_secs = if dt_secs > 0.0 { dt_secs.min(1.0) } else { 0.0 };
        self.frame += 1;
        self.since_secs += dt_secs;
        let (more, most) = (
            bytes_per_second as f32 * dt_secs,
            bytes_per_second as f32 * SAVED_SECS,
        );
        let most = most.max(MOST_BYTES as f32);
        self.left = (self.left + more).min(most);
        for peer in &mut self.peers {
            peer.asked_secs += dt_secs;
            peer.left = (peer.left + more).min(most);
        }
        self.find_changes(crowd);
        self.find_steps(dt_secs, crowd);
        self.introduce(crowd);
        if self.since_secs >= INTERVAL_SECS {
            self.send_steps(crowd);
        }
    }

    /// Returns the messages of the last [`step`](Self::step), in the order in which they must be sent.
    pub fn messages(&self) -> &[CrowdMessage] {
        &self.messages[..self.count]
    }

    /// The next message to be written, in reused memory.
    fn message(&mut self, to: Option<i32>, kind: Kind) -> &mut Vec<u8> {
        if self.count == self.messages.len() {
            self.messages.push(CrowdMessage::default());
        }
        let message = &mut self.messages[self.count];
        self.count += 1;
        message.to = to;
        message.reliable = kind != Kind::Steps;
        message::begin(kind, self.session, &mut message.bytes);
        &mut message.bytes
    }

    /// Finds walkers that came, left, or changed their looks.
    fn find_changes(&mut self, crowd: &Crowd) {
        let agents = crowd.agents();
        self.rows.resize(agents.len(), PendingStep::NOBODY);
        let mut left = Vec::new();
        for (index, (row, agent)) in self.rows.iter_mut().zip(agents).enumerate() {
            let name = crowd.roster().name(index);
            let there = crowd.roster().place(name).is_some();
            let same = there && row.name == name;
            if row.name != PendingStep::NOBODY.name && !same {
                left.push(row.name);
                *row = PendingStep::NOBODY;
            }
            let due = index % LOOKS_EVERY == self.frame % LOOKS_EVERY;
            if !agent.takes_own_steps() || !there || (same && !due) {
                continue;
            }
            let look = Person::look(agent);
            if !same {
                *row = PendingStep::somebody(name, look);
            } else if row.look == look {
                continue;
            }
            row.look = look;
            for peer in &mut self.peers {
                peer.unknown.push_back(name);
            }
        }
        for names in left.chunks(NAMES) {
            let names = names.iter().flat_map(|name| name.to_le_bytes());
            self.message(None, Kind::Left).extend(names);
        }
    }

    /// Finds new steps.
    fn find_steps(&mut self, dt_secs: f32, crowd: &Crowd) {
        for (index, row) in self.rows.iter_mut().enumerate() {
            if row.name == PendingStep::NOBODY.name {
                continue;
            }
            row.pass(dt_secs);
            if let Some(step) = crowd.agents()[index].step_update(row.name, crowd.time_secs) {
                row.observe(&step);
            }
        }
    }

    /// Introduces walkers to peers that do not know them.
    fn introduce(&mut self, crowd: &Crowd) {
        let ticks = ReplicaClock::ticks(crowd.time_secs);
        let mut peers = core::mem::take(&mut self.peers);
        for peer in &mut peers {
            while (peer.is_new || !peer.unknown.is_empty()) && peer.left > 0.0 {
                let fingerprint = *self.fingerprint.get_or_insert_with(|| crowd.fingerprint());
                let bytes = self.message(Some(peer.number), Kind::People);
                bytes.extend(fingerprint.to_le_bytes());
                bytes.extend(ticks.to_le_bytes());
                while let Some(name) = peer.unknown.front().copied() {
                    let before = bytes.len();
                    if let Some(person) = introduction(name, crowd) {
                        // Writing to memory does not fail.
                        bytes.extend(postcard::to_stdvec(&person).unwrap_or_default());
                    }
                    if bytes.len() > MOST_BYTES {
                        bytes.truncate(before);
                        break;
                    }
                    peer.unknown.pop_front();
                }
                peer.left -= bytes.len() as f32;
                peer.is_new = false;
            }
        }
        self.peers = peers;
    }

    /// Sends steps, as many as the budget allows, those with the largest errors first.
    fn send_steps(&mut self, crowd: &Crowd) {
        let mut order = core::mem::take(&mut self.order);
        order.clear();
        let rows = self.rows.iter().enumerate();
        order.extend(rows.filter_map(|(index, row)| Some((row.worth()?, index as u32))));
        let room = (self.left.max(0.0) / STEP_BYTES as f32) as usize;
        if room < order.len() {
            if room > 0 {
                order.select_nth_unstable_by(room - 1, |a, b| b.0.total_cmp(&a.0));
            }
            order.truncate(room);
        }
        let is_due = !order.is_empty() || self.since_secs >= SILENT_SECS;
        if is_due {
            self.since_secs = 0.0;
        }
        let mut rest = order.as_slice();
        let mut first = is_due;
        while first || !rest.is_empty() {
            first = false;
            let (sent, later) = rest.split_at(rest.len().min((MOST_BYTES - STEPS_AT) / STEP_BYTES));
            rest = later;
            for (_, index) in sent {
                self.rows[*index as usize].mark_sent();
            }
            let ticks = ReplicaClock::ticks(crowd.time_secs);
            let bytes = self.message(None, Kind::Steps);
            bytes.extend(ticks.to_le_bytes());
            for (_, index) in sent {
                let index = *index as usize;
                let name = crowd.roster().name(index);
                let step = crowd.agents()[index].step_update(name, crowd.time_secs);
                // A walker beyond the range of the format is left out.
                bytes.extend(step.and_then(|step| step.pack()).iter().flatten());
            }
            let length = bytes.len();
            self.left -= length as f32;
        }
        self.order = order;
    }
}

/// Introduction of a walker, if it is in the crowd, takes its own steps and is within the range of the format.
fn introduction(name: i32, crowd: &Crowd) -> Option<Person> {
    let agent = &crowd.agents()[crowd.roster().place(name)?];
    let step = agent.step_update(name, crowd.time_secs)?.pack()?;
    Some(Person::of(name, agent, step))
}
