//! One walker of a crowd: its place, its goal and its motion.

use super::drawn::Drawn;
use super::goal::{Goal, Guidance};
use super::mixtures::StyleMixture;
use super::motion::Steps;
use super::neighbours::Passerby;
use super::replica::LedWalker;
use footfall_core::Side;
use footfall_core::rotation::{from_heading, wrap_angle};
use footfall_ik::placement::{Frame, Landing};
use footfall_synth::{Controls, CrowdPose, CrowdWalker, GroundTransform, SharedPose, Workshop};
use glam::{Vec2, Vec3};

/// Time constant with which a walker rises and falls with the ground, seconds.
const RISE_SECS: f32 = 0.15;

/// Frames in which the ground is searched for under a new walker: bodies that come with it are there some frames later.
const SEARCHES: u8 = 8;

/// A tint that changes nothing: red, green, blue and opacity.
pub(super) const WHITE: [f32; 4] = [1.0; 4];

/// One walker in the space of the crowd: +Y up.
#[derive(Debug)]
pub struct Agent {
    /// Its walk; `None` before it is made, and in unused rows.
    pub(super) walker: Option<CrowdWalker>,
    /// Number that distinguishes it from earlier and later walkers of its row.
    pub(super) ticket: u64,
    /// True when it is one of the node's `count`, not one that a script added.
    pub(super) counted: bool,
    /// Phase of the stride at which it begins.
    pub(super) start_phase: f32,
    pub(super) goal: Goal,
    /// Preferred speed, m/s.
    pub speed_mps: f32,
    /// Its height against that of the character.
    pub size: f32,
    /// Its tint: red, green, blue and opacity.
    pub tint: [f32; 4],
    pub(super) seed: u64,
    /// Its place, on the ground.
    pub place: Vec3,
    /// Heading about +Y from +Z, radians.
    pub heading: f32,
    /// Height of the ground to which it rises or falls, metres.
    pub ground_m: f32,
    /// Frames that are left to find the ground under a walker that has taken no step.
    searches: u8,
    pub(super) velocity: Vec2,
    /// Weights of its styles.
    pub(super) mixture: StyleMixture,
    /// Places to go to after its goal, the next one last.
    pub(super) route: Vec<Vec2>,
    pub(super) guidance: Guidance,
    /// Place along a path and beside its middle, metres.
    pub(super) progress_m: f32,
    pub(super) aside_m: f32,
    /// The foot that landed in the last frame and where, if one did.
    pub(super) landed: Option<(Side, Vec3)>,
    /// The crowd's time until which it has walked, seconds.
    pub(super) clock_secs: f64,
    chance: u64,
    pub(super) walked: GroundTransform,
    pub(super) controls: Controls,
    /// Received steps of another machine's walker, if it follows one.
    pub(super) led: Option<Box<LedWalker>>,
}

impl Agent {
    /// A walker that stands at its place until its walk is made.
    pub(super) fn new(ticket: u64, place: Vec3, heading: f32, seed: u64) -> Self {
        Self {
            walked: GroundTransform::default(),
            walker: None,
            ticket,
            counted: false,
            start_phase: 0.0,
            goal: Goal::Turn(0.0),
            speed_mps: 1.3,
            size: 1.0,
            tint: WHITE,
            seed,
            place,
            heading,
            ground_m: place.y,
            searches: SEARCHES,
            velocity: Vec2::ZERO,
            mixture: StyleMixture::default(),
            route: Vec::new(),
            guidance: Guidance::None,
            progress_m: 0.0,
            aside_m: 0.0,
            landed: None,
            clock_secs: 0.0,
            chance: seed,
            controls: Controls::STAND,
            led: None,
        }
    }

    /// An unused row.
    pub(super) fn absent() -> Self {
        Self::new(u64::MAX, Vec3::ZERO, 0.0, 0)
    }

    /// Begins to walk, or to stand if its preferred speed is 0, at this time of the crowd.
    pub(super) fn begin(&mut self, mut walker: CrowdWalker, now_secs: f64) {
        if let Some(led) = &mut self.led {
            led.wait(walker);
            return;
        }
        let asked = Controls {
            speed_mps: self.speed_mps,
            ..Controls::STAND
        };
        if asked.is_standing() {
            walker.stand();
        }
        self.walked = walker.start_from_character();
        self.clock_secs = now_secs;
        self.walker = Some(walker);
    }

    /// Its walk, even where it has not begun.
    pub(super) fn own_walker(&mut self) -> Option<&mut CrowdWalker> {
        let waiting = self.led.as_mut().and_then(|led| led.waiting());
        self.walker.as_mut().or(waiting)
    }

    /// Phase of its stride: 0 at the left initial contact, 0.5 at the right.
    pub fn phase(&self) -> f32 {
        let walker = self.walker.as_ref();
        walker.map_or(self.start_phase, CrowdWalker::phase)
    }

    /// Returns whether it walks: its walk was made and has begun.
    pub fn is_made(&self) -> bool {
        self.walker.is_some()
    }

    /// Velocity over the ground, m/s, x and z of the crowd's space.
    pub fn velocity(&self) -> Vec2 {
        self.velocity
    }

    /// Returns whether a foot has landed in the last frame in which it moved.
    pub fn has_landed(&self) -> bool {
        self.landed.is_some()
    }

    /// Feet that bear on the ground.
    pub fn feet_in_contact(&self) -> [bool; 2] {
        let walker = self.walker.as_ref();
        walker.map_or([true; 2], CrowdWalker::feet_in_contact)
    }

    /// The next landing of each foot in the space of the character, for a body of its size: a large one takes longer for its steps.
    pub fn landings(&self) -> [Option<Landing>; 2] {
        let Some(walker) = &self.walker else {
            return [None; 2];
        };
        walker.landings().map(|landing| {
            let landing = landing?;
            let flat = Frame {
                position: landing.flat.position * self.size,
                ..landing.flat
            };
            Some(Landing {
                flat,
                secs: landing.secs * self.size.sqrt(),
                hips: landing.hips * self.size,
                ankles: landing.ankles.map(|ankle| ankle * self.size),
            })
        })
    }

    /// Advances its walk.
    pub(super) fn advance(&mut self, dt_secs: f32, workshop: &mut Workshop) {
        let controls = self.controls;
        self.travel(dt_secs, |walker, secs| {
            walker.step(secs, controls, workshop);
        });
    }

    /// Moves with its walk, which `step` advances by the time scaled to its size.
    pub(super) fn travel(&mut self, dt_secs: f32, step: impl FnOnce(&mut CrowdWalker, f32)) {
        let Some(walker) = &mut self.walker else {
            return;
        };
        step(walker, dt_secs / self.size.sqrt());
        let now = walker.start_from_character();
        let back = from_heading(-self.walked.heading);
        let moved = back * (now.position - self.walked.position) * self.size;
        let step = from_heading(self.heading) * moved;
        self.landed = walker.footstep().map(|footstep| {
            let from = back * (footstep.position - self.walked.position) * self.size;
            (
                footstep.side,
                self.place + from_heading(self.heading) * from,
            )
        });
        self.place += step;
        let rise = 1.0 - (-dt_secs / RISE_SECS).exp();
        self.place.y += (self.ground_m - self.place.y) * rise;
        self.heading = wrap_angle(self.heading + now.heading - self.walked.heading);
        self.walked = now;
        if dt_secs > 0.0 {
            let blend = 1.0 - (-dt_secs / 0.3).exp();
            self.velocity += (Vec2::new(step.x, step.z) / dt_secs - self.velocity) * blend;
        }
    }

    /// Returns true in the first frames of its walk, until it is [put on](Self::put_on) the ground.
    pub fn searches_ground(&mut self) -> bool {
        let searches = self.searches > 0 && self.is_made();
        self.searches -= u8::from(searches);
        searches
    }

    /// Stands on ground of this height from now on.
    pub fn put_on(&mut self, ground_m: f32) {
        self.ground_m = ground_m;
        self.place.y = ground_m;
        self.searches = 0;
    }

    /// Places for drawing, after a motion from this place and heading.
    pub(super) fn drawn(&self, from: Vec3, from_heading: f32, secs: f32) -> Drawn {
        let turned = wrap_angle(self.heading - from_heading);
        Drawn {
            places: [from, self.place],
            headings: [from_heading, from_heading + turned],
            secs,
            size: self.size,
            tint: self.tint,
        }
    }

    /// The next pseudo-random number between 0 and 1 of its seed (`SplitMix64`).
    pub fn chance(&mut self) -> f32 {
        self.chance = self.chance.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.chance;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 40) as f32 / 16_777_216.0
    }

    pub(super) fn level(&self) -> Vec2 {
        Vec2::new(self.place.x, self.place.z)
    }

    pub(super) fn seen(&self) -> Passerby {
        Passerby {
            place: self.level(),
            velocity: self.velocity,
        }
    }

    /// Prefetches the memory that [`advance`](Self::advance) reads.
    pub(super) fn fetch(&self) {
        core::hint::black_box((self.seed, self.clock_secs, self.controls));
        if let Some(walker) = &self.walker {
            walker.fetch_place();
        }
    }

    /// Prefetches the memory that [`shared_pose`](Self::shared_pose) reads.
    pub fn fetch_shared(&self) {
        core::hint::black_box((self.size, self.is_made()));
    }

    /// Prefetches the memory that [`pose`](Self::pose) reads.
    pub fn fetch_pose(&self) {
        if let Some(walker) = &self.walker {
            walker.fetch_pose();
        }
    }

    /// Its shared pose, this many seconds ago, and the number of its style mixture; `None` while it takes steps of its own.
    pub fn shared_pose(&self, ago_secs: f32) -> Option<(u32, SharedPose)> {
        let walker = self.walker.as_ref()?;
        walker.shared_pose(ago_secs / self.size.sqrt())
    }

    /// Returns whether it walks in steps of its own: only these can be sent to others.
    pub(super) fn takes_own_steps(&self) -> bool {
        let walker = self.walker.as_ref();
        walker.is_some_and(|walker| !walker.is_sharing())
    }

    /// Steps that show in its pose.
    pub(super) fn steps(&self) -> Steps {
        match &self.walker {
            None => Steps::None,
            Some(walker) if walker.has_own_steps() => Steps::Own,
            Some(_) => Steps::Shared,
        }
    }

    /// Writes its pose in the space of the character; returns whether there is one.
    pub fn pose(&self, out: &mut CrowdPose) -> bool {
        if let Some(walker) = &self.walker {
            walker.pose(out);
        }
        self.walker.is_some()
    }
}
