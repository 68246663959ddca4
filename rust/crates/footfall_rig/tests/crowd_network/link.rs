//! Crowds on two machines and the network between them.

use footfall_core::Side;
use footfall_model::GaitModel;
use footfall_rig::crowd::{Crowd, CrowdMessage, CrowdRecipe, CrowdSender, CrowdSettings, Routing};
use glam::{Vec2, Vec3};
use std::collections::{BTreeMap, VecDeque};
use std::path::Path;
use std::sync::{Arc, LazyLock};

pub(crate) const DT_SECS: f32 = 1.0 / 60.0;
pub(crate) const GUEST: i32 = 7;

static MODEL: LazyLock<Arc<GaitModel>> = LazyLock::new(|| {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let bytes = std::fs::read(root.join("addons/footfall/models/locomotion.footfall"))
        .expect("the shipped walk");
    Arc::new(GaitModel::from_bytes(&bytes).expect("a walk"))
});

pub(crate) fn crowd(routing: Routing) -> Crowd {
    let recipe = CrowdRecipe {
        model: Arc::clone(&MODEL),
        styles: Vec::new(),
        space: None,
        body: MODEL.skeleton.clone(),
    };
    Crowd::new(recipe, routing, CrowdSettings::default())
}

pub(crate) fn wander() -> Routing {
    Routing::Wander {
        half: Vec2::splat(20.0),
    }
}

/// A footstep, and when it was made.
#[derive(Clone, Copy)]
pub(crate) struct Print {
    pub(crate) secs: f32,
    pub(crate) side: Side,
    pub(crate) place: Vec3,
}

pub(crate) type Prints = BTreeMap<i32, Vec<Print>>;

fn note(prints: &mut Prints, crowd: &Crowd, secs: f32) {
    for (row, side, place) in crowd.landed() {
        let name = crowd.roster().name(row);
        prints
            .entry(name)
            .or_default()
            .push(Print { secs, side, place });
    }
}

/// A crowd here, the same there, and messages on their way.
pub(crate) struct Link {
    pub(crate) here: Crowd,
    pub(crate) there: Crowd,
    pub(crate) sender: CrowdSender,
    pub(crate) under_way: VecDeque<(f32, CrowdMessage)>,
    pub(crate) secs: f32,
    pub(crate) loss: f32,
    pub(crate) delay_secs: f32,
    /// Further delay of reliable messages.
    pub(crate) reliable_secs: f32,
    pub(crate) bytes_per_second: u32,
    pub(crate) chance: u32,
    pub(crate) made: Prints,
    pub(crate) shown: Prints,
    /// Bytes that were sent about steps, and about people.
    pub(crate) sent: [usize; 2],
    /// Machines that stand still, as while they load: here, there.
    pub(crate) pauses: [bool; 2],
    /// Fastest that anybody went there, m/s, who was there the frame before.
    pub(crate) fastest_mps: f32,
}

impl Link {
    pub(crate) fn new(routing: Routing, count: usize) -> Self {
        let mut here = crowd(routing);
        here.repeats = false;
        here.set_count(count);
        let mut there = crowd(Routing::Scripted);
        there.follow();
        Self {
            here,
            there,
            sender: CrowdSender::new(1),
            under_way: VecDeque::new(),
            secs: 0.0,
            loss: 0.05,
            delay_secs: 0.2,
            reliable_secs: 0.0,
            bytes_per_second: 1_000_000,
            chance: 5,
            made: Prints::new(),
            shown: Prints::new(),
            sent: [0; 2],
            pauses: [false; 2],
            fastest_mps: 0.0,
        }
    }

    fn chance(&mut self) -> f32 {
        self.chance = self
            .chance
            .wrapping_mul(1_664_525)
            .wrapping_add(1_013_904_223);
        (self.chance >> 8) as f32 / (1 << 24) as f32
    }

    pub(crate) fn join(&mut self) {
        self.sender.join(GUEST);
    }

    /// Lets a frame pass here and there.
    pub(crate) fn frame(&mut self) {
        self.secs += DT_SECS;
        let [here, there] = self.pauses;
        if !here {
            self.frame_here();
        }
        if !there {
            self.frame_there();
        }
    }

    fn frame_here(&mut self) {
        self.here.begin_all().expect("a walk");
        self.here.advance(DT_SECS, true);
        note(&mut self.made, &self.here, self.secs);
        self.sender.step(DT_SECS, &self.here, self.bytes_per_second);
        for message in self.sender.messages().to_vec() {
            self.sent[usize::from(message.reliable)] += message.bytes.len();
            let late = 0.01 * self.chance();
            let lost = self.chance() < self.loss;
            let again = if lost { 0.5 } else { 0.0 };
            if message.reliable || !lost {
                let reliably = if message.reliable {
                    self.reliable_secs
                } else {
                    0.0
                };
                let at = self.secs + self.delay_secs + late + again + reliably;
                // What is reliable keeps its order.
                let before = self.under_way.iter().rev();
                let least = before
                    .filter(|(_, other)| other.reliable && message.reliable)
                    .map(|(at, _)| *at)
                    .next();
                self.under_way
                    .push_back((at.max(least.unwrap_or(0.0)), message));
            }
        }
    }

    fn frame_there(&mut self) {
        let now = self.secs;
        let mut waiting = VecDeque::new();
        for (at, message) in core::mem::take(&mut self.under_way) {
            if at <= now {
                self.there.hear(&message.bytes).expect("an honest message");
            } else {
                waiting.push_back((at, message));
            }
        }
        self.under_way = waiting;
        let before = places(&self.there);
        self.there.begin_all().expect("a walk");
        self.there.advance(DT_SECS, true);
        note(&mut self.shown, &self.there, self.secs);
        for (name, place) in places(&self.there) {
            if let Some(then) = before.get(&name) {
                let row = self.there.roster().place(name).expect("its row");
                // Those far away move once in four frames.
                let frames = if self.there.moved(row) { 4.0 } else { 1.0 };
                let speed = place.distance(*then) / (frames * DT_SECS);
                self.fastest_mps = self.fastest_mps.max(speed);
            }
        }
    }

    pub(crate) fn walk(&mut self, secs: f32) {
        for _ in 0..(secs / DT_SECS) as usize {
            self.frame();
        }
    }

    /// Distances between the steps that were shown from a time on and those that were made, and how many were made in that time.
    pub(crate) fn differences(&self, from_secs: f32) -> Vec<f32> {
        let mut all = Vec::new();
        for (name, shown) in &self.shown {
            let made = &self.made[name];
            for print in shown.iter().filter(|print| print.secs > from_secs) {
                let near = made.iter().filter(|other| {
                    let late = print.secs - other.secs;
                    other.side == print.side && (-0.3..2.0).contains(&late)
                });
                let near = near.map(|other| other.place.distance(print.place));
                all.push(near.fold(f32::INFINITY, f32::min));
            }
        }
        all.sort_by(f32::total_cmp);
        all
    }

    pub(crate) fn shares(&self, from_secs: f32) -> [f32; 4] {
        let all = self.differences(from_secs);
        let at = |share: f32| all[((all.len() - 1) as f32 * share) as usize];
        [at(0.5), at(0.99), at(0.999), at(1.0)]
    }
}

/// Places of those who are shown, by name.
pub(crate) fn places(crowd: &Crowd) -> BTreeMap<i32, Vec3> {
    let rows = crowd.roster().order().iter().map(|row| *row as usize);
    rows.filter(|row| crowd.agents()[*row].is_made())
        .map(|row| (crowd.roster().name(row), crowd.agents()[row].place))
        .collect()
}
