//! Messages about a crowd to others.

use super::message::{self, CrowdMessage, HEAD_BYTES, Kind, MOST_BYTES};
use super::person::Person;
use super::step::STEP_BYTES;
use super::untold::Untold;
use crate::crowd::Crowd;
use footfall_synth::replica::ReplicaClock;
use std::collections::VecDeque;

/// Interval between messages about steps, seconds, and the longest without any.
const INTERVAL_SECS: f32 = 1.0 / 30.0;
const SILENT_SECS: f32 = 0.2;

/// Bytes that were not sent are saved up for so long, seconds.
const SAVED_SECS: f32 = 0.25;

/// Whoever asks again to be told everything waits so long, seconds.
const ASKED_SECS: f32 = 1.0;

/// Looks are looked at anew in every so many frames.
const LOOKS_EVERY: usize = 32;

/// Length of a message about steps before the first of them.
const STEPS_AT: usize = HEAD_BYTES + 2;

/// Names in a message about those who left.
const NAMES: usize = (MOST_BYTES - HEAD_BYTES) / 4;

/// A peer that is told.
#[derive(Debug)]
struct Peer {
    number: i32,
    /// Names of those to be introduced.
    unknown: VecDeque<i32>,
    /// True until the first message to it.
    is_new: bool,
    asked_secs: f32,
    /// Bytes that may be spent on it.
    left: f32,
}

/// Teller of a crowd: it makes the messages from which others show the same one. As long as nobody has joined it does nothing.
#[derive(Debug)]
pub struct CrowdSender {
    session: u16,
    fingerprint: Option<u32>,
    rows: Vec<Untold>,
    peers: Vec<Peer>,
    messages: Vec<CrowdMessage>,
    /// Messages that count; the others are kept for their memory.
    count: usize,
    /// Worth of telling each row, for their memory.
    order: Vec<(f32, u32)>,
    left: f32,
    since_secs: f32,
    frame: usize,
}

impl CrowdSender {
    /// A teller; a crowd that was made anew has another session than the one before.
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

    /// Has a peer told everything from now on: first who is there, at the pace of the budget, some 40 bytes each. Who asks again is told again, once a second.
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
            // Others are noticed with the next step.
            let known = self.rows.iter().map(|row| row.name);
            peer.unknown
                .extend(known.filter(|name| *name != Untold::NOBODY.name));
        }
    }

    /// Has a peer told no more.
    pub fn leave(&mut self, peer: i32) {
        self.peers.retain(|other| other.number != peer);
    }

    /// The peers that are told.
    pub fn peers(&self) -> impl Iterator<Item = i32> {
        self.peers.iter().map(|peer| peer.number)
    }

    /// Makes this frame's [`messages`](Self::messages), after the crowd has moved: at most so many bytes a second about steps, and as many to each peer that has
    /// people to be introduced to. Walkers must not [share](Crowd::repeats) steps; those who still do are introduced with their first own step.
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
        self.see_who_is_there(crowd);
        self.see_steps(dt_secs, crowd);
        self.introduce(crowd);
        if self.since_secs >= INTERVAL_SECS {
            self.tell_steps(crowd);
        }
    }

    /// The messages of the last [`step`](Self::step), in the order in which they are to be sent.
    pub fn messages(&self) -> &[CrowdMessage] {
        &self.messages[..self.count]
    }

    /// The next message, to be written; its memory is used again.
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

    /// Notices who came, left, or looks otherwise.
    fn see_who_is_there(&mut self, crowd: &Crowd) {
        let agents = crowd.agents();
        self.rows.resize(agents.len(), Untold::NOBODY);
        let mut left = Vec::new();
        for (index, (row, agent)) in self.rows.iter_mut().zip(agents).enumerate() {
            let name = crowd.roster().name(index);
            let there = crowd.roster().place(name).is_some();
            let same = there && row.name == name;
            if row.name != Untold::NOBODY.name && !same {
                left.push(row.name);
                *row = Untold::NOBODY;
            }
            let due = index % LOOKS_EVERY == self.frame % LOOKS_EVERY;
            if !agent.takes_own_steps() || !there || (same && !due) {
                continue;
            }
            let look = Person::look(agent);
            if !same {
                *row = Untold::somebody(name, look);
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

    /// Notices which steps are new.
    fn see_steps(&mut self, dt_secs: f32, crowd: &Crowd) {
        for (index, row) in self.rows.iter_mut().enumerate() {
            if row.name == Untold::NOBODY.name {
                continue;
            }
            row.pass(dt_secs);
            if let Some(step) = crowd.agents()[index].told(row.name, crowd.time_secs) {
                row.look_at(&step);
            }
        }
    }

    /// Introduces walkers to peers who do not know them.
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

    /// Writes of steps, as many as the budget allows, the most worthwhile first.
    fn tell_steps(&mut self, crowd: &Crowd) {
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
            let (told, later) = rest.split_at(rest.len().min((MOST_BYTES - STEPS_AT) / STEP_BYTES));
            rest = later;
            for (_, index) in told {
                self.rows[*index as usize].tell();
            }
            let ticks = ReplicaClock::ticks(crowd.time_secs);
            let bytes = self.message(None, Kind::Steps);
            bytes.extend(ticks.to_le_bytes());
            for (_, index) in told {
                let index = *index as usize;
                let name = crowd.roster().name(index);
                let step = crowd.agents()[index].told(name, crowd.time_secs);
                // Who is farther away than can be told is not.
                bytes.extend(step.and_then(|step| step.pack()).iter().flatten());
            }
            let length = bytes.len();
            self.left -= length as f32;
        }
        self.order = order;
    }
}

/// Introduction of a walker who is there and can be told of.
fn introduction(name: i32, crowd: &Crowd) -> Option<Person> {
    let agent = &crowd.agents()[crowd.roster().place(name)?];
    let step = agent.told(name, crowd.time_secs)?.pack()?;
    Some(Person::of(name, agent, step))
}
