//! Follower: a generator that repeats the steps of a walker on another machine.

mod amended;

use super::clock::{ReplicaClock, haste};
use super::gate::Gate;
use super::led::Beginning;
use super::numbering::{FRESH_STEPS, next_number};
use super::queue::{Planning, Queue};
use super::update::{Planned, WalkUpdate};
use super::{ReplicaError, WalkIdentity};
use crate::config::MAX_DT_SECS;
use crate::controls::Controls;
use crate::generator::GaitGenerator;
use crate::source::Aim;
use footfall_core::{GroundTransform, Pose};

/// Errors of place, heading and time beyond which a walk is restarted, metres, radians and seconds.
const LOST_M: f32 = 0.75;
const LOST_HEIGHT_M: f32 = 1.5;
const LOST_RAD: f32 = 1.6;
const LOST_SECS: f64 = 1.5;

/// Errors beyond which a resting walker steps to its place, metres and radians, and the time of rest before it does, seconds.
const OFF_M: f32 = 0.04;
const OFF_RAD: f32 = 0.17;
const OFF_SECS: f32 = 0.4;

/// Tiny turn rate that makes a walker step on the spot, rad/s.
const ON_THE_SPOT_RADPS: f32 = 0.06;

/// Silence after which a walker stands, seconds.
const SILENCE_SECS: f64 = 3.0;

/// Outcome of a frame of following.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Followed {
    /// No update has arrived yet; the walker stands.
    Waiting,
    /// The walk continued.
    Walking,
    /// The walk was restarted, with its start at this place of the shared space. The caller lets the previous pose fade.
    Anew(GroundTransform),
}

/// Leads a [`GaitGenerator`] through the steps of a walker on another machine.
///
/// The generator has to be made with the identity's [`config`](WalkIdentity::config), the same model and a body of the same proportions. The follower replaces
/// [`GaitGenerator::step`]: nothing else may advance the generator. It allocates nothing in [`step`](Self::step) and [`hear`](Self::hear).
#[derive(Clone, Debug)]
pub struct WalkFollower {
    gate: Gate,
    clock: ReplicaClock,
    queue: Queue,
    now_secs: f64,
    /// The last update.
    heard: Option<WalkUpdate>,
    /// Current step, as the sender planned it.
    made: Option<Planning>,
    /// True once the walker stands and waits for its first update.
    waits: bool,
    begun: bool,
    /// Step that was replanned to correct its end.
    amended: Option<Planned>,
    /// Time since the walker came to rest, seconds.
    rested_secs: f32,
    /// True during a jump of the sender.
    jumped: bool,
}

impl WalkFollower {
    /// Creates a follower of the walker of this identity.
    pub fn new(identity: &WalkIdentity) -> Self {
        Self {
            gate: Gate::new(identity.tag()),
            clock: ReplicaClock::new(),
            queue: Queue::default(),
            now_secs: 0.0,
            heard: None,
            made: None,
            waits: false,
            begun: false,
            amended: None,
            rested_secs: 0.0,
            jumped: false,
        }
    }

    /// Accepts a new identity of the walker, as after a teleport; create a new generator unless
    /// [`is_same_walker`](WalkIdentity::is_same_walker) returns true.
    ///
    /// # Errors
    /// [`ReplicaError::Flood`] when identities come too often.
    pub fn become_walker(&mut self, identity: &WalkIdentity) -> Result<(), ReplicaError> {
        if self.gate.become_walker(identity.tag())? {
            self.queue.pass_all();
            (self.heard, self.made, self.amended) = (None, None, None);
            self.begun = false;
        }
        Ok(())
    }

    /// Receives an update.
    ///
    /// # Errors
    /// [`ReplicaError`] when it is refused; then nothing changes.
    pub fn hear(&mut self, bytes: &[u8], generator: &GaitGenerator) -> Result<(), ReplicaError> {
        let update = WalkUpdate::unpack(bytes)?;
        self.gate.check(&update)?;
        let sent_secs = self.clock.hear(self.now_secs, update.time);
        let planning = Planning::of(&update, sent_secs, generator.frame_rate_hz);
        if self.queue.hear(planning)
            && let Some(made) = &mut self.made
        {
            made.correct(&planning);
        }
        self.heard = Some(update);
        Ok(())
    }

    /// Returns the delay of the replica beyond the latency of the messages, seconds.
    pub fn delay_secs(&self) -> f64 {
        self.clock.due_secs(0.0) - self.clock.quickest_secs(0.0)
    }

    /// Advances by a time and writes the pose, as [`GaitGenerator::step`] does. `shared_from_start` is the start of the walk in the space that all machines share.
    pub fn step(
        &mut self,
        dt_secs: f32,
        generator: &mut GaitGenerator,
        shared_from_start: &GroundTransform,
        out: &mut Pose,
    ) -> Followed {
        let dt_secs = if dt_secs.is_finite() {
            dt_secs.clamp(0.0, MAX_DT_SECS)
        } else {
            0.0
        };
        self.now_secs += f64::from(dt_secs);
        self.gate.pass(dt_secs);
        let Some(heard) = self.heard else {
            if !self.waits {
                generator.stand();
                self.waits = true;
            }
            generator.step(dt_secs, &Controls::STAND, out);
            return Followed::Waiting;
        };
        if !self.begun || self.is_lost(generator, shared_from_start) {
            return self.begin(&heard, generator, out);
        }
        let controls = self.controls();
        generator.begin_frame(&controls);
        let mut before = generator.position;
        let mut rested = generator.has_ended();
        let pace = 1.0 + self.haste(generator);
        generator.pass_led(dt_secs * generator.frame_rate_hz * pace as f32);
        while generator.has_ended() {
            generator.end_step(&mut rested);
            if !self.next_step(dt_secs, generator, shared_from_start) {
                generator.rest();
                break;
            }
            before = 0.0;
        }
        self.obey(generator, shared_from_start, before);
        self.jump(&heard, generator, shared_from_start);
        let controls = Controls {
            crouch: heard.controls.crouch,
            ..self.controls()
        };
        generator.show(dt_secs, &controls, out);
        Followed::Walking
    }

    /// Returns the controls of the current step.
    fn controls(&self) -> Controls {
        self.made.map_or(Controls::STAND, |made| made.controls)
    }

    /// Returns true when the walk is too far from its place to walk there.
    fn is_lost(&self, generator: &GaitGenerator, shared_from_start: &GroundTransform) -> bool {
        let late = self
            .queue
            .next()
            .is_some_and(|next| self.now_secs - self.clock.due_secs(next.at_secs) > LOST_SECS);
        let (number, _) = generator.progress();
        let aim = if generator.is_standing() {
            self.resting(shared_from_start)
        } else {
            let made = self.made.filter(|made| made.planned.number == number);
            made.map(|made| made.aim(shared_from_start))
        };
        let Some(aim) = aim.filter(|_| generator.jump_phase().is_none()) else {
            return late;
        };
        let off = generator.off(&aim);
        late || aim.place.position.y.abs() > LOST_HEIGHT_M
            || off.way.length() > LOST_M
            || off.turn.abs() > LOST_RAD
    }

    /// Restarts from the last update.
    fn begin(
        &mut self,
        heard: &WalkUpdate,
        generator: &mut GaitGenerator,
        out: &mut Pose,
    ) -> Followed {
        let newest = self.queue.newest().copied().or(self.made);
        let Some(mut newest) = newest else {
            return Followed::Waiting;
        };
        if heard.rests {
            newest.rest(heard.aim);
        }
        let since = self.now_secs - self.clock.due_secs(newest.at_secs);
        let frames = generator.shape().timing.frames as f32;
        let passed = since.max(0.0) as f32 * generator.frame_rate_hz / frames;
        let at = Beginning {
            number: newest.planned.number,
            share: newest.planned.share() + passed,
            controls: newest.controls,
            rests: heard.rests || newest.controls.is_standing(),
        };
        if !generator.begin_led(&at) {
            return Followed::Waiting;
        }
        self.queue.pass_all();
        self.made = Some(newest);
        self.begun = true;
        self.rested_secs = 0.0;
        generator.begin_frame(&newest.controls);
        generator.show(0.0, &newest.controls, out);
        Followed::Anew(newest.start(generator))
    }

    /// Returns the relative increase of tempo that brings the walk in time.
    fn haste(&self, generator: &GaitGenerator) -> f64 {
        if generator.is_standing() {
            return 0.0;
        }
        let rate = f64::from(generator.frame_rate_hz);
        let (number, _) = generator.progress();
        let steps_from = |made: &Planning| f64::from(made.planned.steps_from(number));
        let late = match (self.queue.next(), &self.made) {
            (Some(next), _) if next.planned.steps_from(number) == 1 => {
                let ends = self.now_secs + f64::from(generator.frames_left()) / rate;
                ends - self.clock.due_secs(next.at_secs)
            }
            (_, Some(made)) if steps_from(made).abs() <= FRESH_STEPS => {
                // Where a machine has stood still, the walks may be a step apart.
                let whole = generator.frames_since(0.0) + generator.frames_left();
                let ahead = f64::from(generator.frames_since(made.planned.share()))
                    - steps_from(made) * f64::from(whole);
                let since = self.now_secs - self.clock.due_secs(made.at_secs);
                since - ahead / rate
            }
            _ => 0.0,
        };
        haste(late)
    }

    /// Generates the next step, if there is one.
    fn next_step(
        &mut self,
        dt_secs: f32,
        generator: &mut GaitGenerator,
        shared_from_start: &GroundTransform,
    ) -> bool {
        let rests = generator.comes_to_rest();
        let natural = if rests {
            generator.progress().0.wrapping_add(1)
        } else {
            self.next_number(generator)
        };
        let due = |next: &&Planning| self.clock.due_secs(next.at_secs) <= self.now_secs;
        let next = self.queue.next().copied();
        if rests {
            if generator.jump_phase().is_some() {
                return false;
            }
            self.rested_secs += dt_secs;
            let Some(next) = self.queue.next().filter(due).copied() else {
                return self.step_over(natural, generator, shared_from_start);
            };
            if next.controls.is_standing() {
                self.made = self.queue.take();
                return false;
            }
        }
        self.rested_secs = 0.0;
        let out_of_step = next.map(|next| next.planned.steps_from(natural.wrapping_sub(1)));
        let number = match (next, out_of_step) {
            // A standing walker can start with either foot.
            (Some(next), _) if rests => next.planned.number,
            (Some(next), Some(..=0)) if next.planned.steps_from(natural) % 2 == 0 => {
                next.planned.number
            }
            (Some(next), Some(..=0)) => next.planned.number.wrapping_add(1),
            _ => natural,
        };
        // A step whose beginning is lost begins like the one before, and changes when the sender's did.
        let begins =
            |next: Planning| next.planned.number == number && (rests || next.planned.passed == 0);
        if next.is_some_and(begins) {
            self.made = self.queue.take();
        }
        let made = self.made.filter(|made| made.planned.number == number);
        let silent = self.clock.silent_secs(self.now_secs) > SILENCE_SECS;
        let stands = silent || (next.is_none() && self.heard.is_some_and(|heard| heard.rests));
        let controls = if stands && made.is_none() {
            Controls::STAND
        } else {
            self.controls()
        };
        generator.leave_step();
        generator.next_led(number, &controls, made.as_ref());
        if let Some(made) = made {
            generator.aim_at(&made.aim(shared_from_start));
        } else if stands && let Some(resting) = self.resting(shared_from_start) {
            generator.aim_at(&resting);
        }
        true
    }

    /// Returns the number of the next step of a walk that goes on.
    fn next_number(&self, generator: &GaitGenerator) -> u16 {
        let natural = generator.progress().0.wrapping_add(1);
        let Some(last) = self.queue.newest().or(self.made.as_ref()) else {
            return natural;
        };
        let since_secs = self.now_secs - self.clock.due_secs(last.at_secs);
        let since_frames = since_secs * f64::from(generator.frame_rate_hz);
        let step_frames = f64::from(generator.frames_since(0.0));
        let steps_since = since_frames / step_frames + f64::from(last.planned.share());
        next_number(natural, last.planned.number, steps_since)
    }

    /// Steps to the place of the resting sender, if the walk came to rest beside it.
    fn step_over(
        &mut self,
        number: u16,
        generator: &mut GaitGenerator,
        shared_from_start: &GroundTransform,
    ) -> bool {
        let Some(resting) = self.resting(shared_from_start) else {
            return false;
        };
        let off = generator.off(&resting);
        let far = off.way.length() > OFF_M || off.turn.abs() > OFF_RAD;
        if !far || self.queue.next().is_some() || self.rested_secs < OFF_SECS {
            return false;
        }
        let controls = Controls {
            turn_rate_radps: ON_THE_SPOT_RADPS.copysign(off.turn),
            ..Controls::STAND
        };
        self.rested_secs = 0.0;
        generator.leave_step();
        generator.next_led(number, &controls, None);
        generator.aim_at(&resting);
        true
    }

    /// Returns the place of a sender that rests and does not jump.
    fn resting(&self, shared_from_start: &GroundTransform) -> Option<Aim> {
        let heard = self
            .heard
            .filter(|heard| heard.rests && heard.rise_m == 0.0)?;
        Some(Aim {
            place: shared_from_start.local(&heard.aim),
            rests: true,
        })
    }
}
