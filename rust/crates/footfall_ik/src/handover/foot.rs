//! A foot in the transition between two motions: a standing foot keeps its place.

use super::fading::Fading;
use crate::leg::FootTarget;
use crate::rocker::{RockerFoot, foot_heading, foot_pitch};
use footfall_core::ease::hump;
use footfall_core::rotation::{exp_map, from_heading, log_map, wrap_angle};
use glam::{Quat, Vec3};

/// Time within which a held foot moves to its place in the new motion once that lifts it, and duration of a step of its own, seconds.
const SWING_SECS: f32 = 0.3;
/// Distance of places that need no step, metres.
const NEAR_M: f32 = 0.01;
/// Distance that equals a turn of a radian, metres.
const METRES_A_RADIAN: f32 = 0.1;
/// Lift of a step of its own, as a share of its length, and the limits of that, metres.
const RISE: f32 = 0.35;
const RISES_M: [f32; 2] = [0.02, 0.1];
/// Remaining distance at which a foot has landed, metres.
const LANDED_M: f32 = 0.02;
/// Distance that equals a radian of remaining roll of the sole, metres.
const ROLL_LEVER_M: f32 = 0.1;
/// Share of its time before which a foot from the air has not landed, however near it is.
const LANDED_SHARE: f32 = 0.7;
/// Fastest roll of a landing sole, in its pitches per handover: it stops at the ground and does not roll beyond.
const SLAP: f32 = 2.8;
/// Time within which a foot in the air that stands in the new motion lands in place, seconds, and the greatest distance for that, metres.
const LANDING_SECS: f32 = 0.15;
const REACH_M: f32 = 0.35;
/// Greatest speeds of a foot, m/s and rad/s.
const MAX_SPEED: f32 = 12.0;

/// A foot of a motion in two frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingFoot {
    pub(super) before: FootTarget,
    pub(super) now: FootTarget,
    pub(super) stands: bool,
}

/// Transition of a foot from its place in the old motion to that in the new one.
///
/// The difference has two parts. On the ground and about the vertical the foot is held in place, so that a rolling foot rolls about its
/// plant, until the new motion lifts it. Its pitch decays as a roll about that plant, and so does the rest: height, tilt and speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct HeldFoot {
    rocker: RockerFoot,
    /// Plant and heading while it is held.
    held: Option<(Vec3, f32)>,
    going: Option<Going>,
    /// Offset on the ground from the new motion, x and z, with the turn in y; and its rate.
    parted: Vec3,
    parting: Vec3,
    /// Pitch beyond that of the new motion, for a foot that stands in both, radians in x.
    roll: Fading,
    /// True for a foot that came from the air.
    lands: bool,
    place: Fading,
    tilt: Fading,
    toes: Fading,
}

/// Motion of a formerly held foot to its place in the new motion.
#[derive(Clone, Copy, Debug)]
struct Going {
    parted: Fading,
    /// Lift of a step of its own, metres.
    rise: Option<f32>,
}

impl HeldFoot {
    /// Transition between the foot of the old motion and that of the new one, both with frames `dt_secs` apart.
    pub(super) fn new(
        rocker: RockerFoot,
        from: &MovingFoot,
        to: &MovingFoot,
        dt_secs: f32,
        secs: f32,
    ) -> Self {
        let mut foot = Self {
            rocker,
            held: None,
            going: None,
            parted: Vec3::ZERO,
            parting: Vec3::ZERO,
            roll: Fading::default(),
            lands: false,
            place: Fading::default(),
            tilt: Fading::default(),
            toes: Fading::default(),
        };
        let mut parted_before = Vec3::ZERO;
        let mut from_before = from.before;
        let mut rolls = [0.0; 2];
        let mut secs = secs;
        let stood = foot.footprint(&from.now);
        let apart = parted(stood, foot.footprint(&to.now));
        if to.stands && (from.stands || level(apart).length() < REACH_M) {
            foot.held = Some(stood);
            foot.parted = apart;
            parted_before = parted(stood, foot.footprint(&to.before));
            if from.stands {
                // It may just have landed: it takes along how it rolls, and nothing else.
                from_before = foot.moved(&from.before, parted(stood, foot.footprint(&from.before)));
                from_before.ankle.y +=
                    rocker.lowest_point(&from.now) - rocker.lowest_point(&from_before);
                rolls = [(&from.now, &to.now), (&from_before, &to.before)]
                    .map(|(from, to)| foot_pitch(from.foot) - foot_pitch(to.foot));
            } else {
                foot.lands = true;
                secs = secs.min(LANDING_SECS);
            }
        }
        let rest = |from: &FootTarget, to: &FootTarget, parted: Vec3, roll: f32| {
            let to = foot.rolled(&foot.moved(to, parted), roll);
            let parted = |from: Quat, to: Quat| log_map(from * to.conjugate());
            [
                from.ankle - to.ankle,
                parted(from.foot, to.foot),
                parted(from.toes, to.toes),
            ]
        };
        let now = rest(&from.now, &to.now, foot.parted, rolls[0]);
        let before = rest(&from_before, &to.before, parted_before, rolls[1]);
        let [roll, rolled] = rolls.map(|roll| Vec3::X * roll);
        let mut rolling = speed(roll - rolled, dt_secs);
        if rolling.x * roll.x < 0.0 {
            let most = SLAP * roll.x.abs() / secs.max(f32::MIN_POSITIVE);
            rolling = rolling.clamp_length_max(most);
        }
        foot.roll = Fading::new(roll, rolling, secs);
        [foot.place, foot.tilt, foot.toes] = core::array::from_fn(|part| {
            let velocity = speed(now[part] - before[part], dt_secs);
            Fading::new(now[part], velocity, secs)
        });
        foot.parting = speed(foot.parted - parted_before, dt_secs);
        foot
    }

    /// Advances the handover. Takes the foot's place in the new motion and whether it stands there; returns the place to show.
    pub(super) fn step(&mut self, dt_secs: f32, to: &FootTarget, stands: bool) -> FootTarget {
        self.roll.advance(dt_secs);
        self.place.advance(dt_secs);
        self.tilt.advance(dt_secs);
        self.toes.advance(dt_secs);
        let flat = self.footprint(to);
        let before = self.parted;
        let mut lift = 0.0;
        if self.held.is_some() && !stands {
            // It goes along with the new motion from this very frame on, instead of standing for a frame longer.
            self.go(None);
        }
        if let Some(held) = self.held {
            self.parted = parted(held, flat);
        } else if let Some(going) = &mut self.going {
            going.parted.advance(dt_secs);
            self.parted = going.parted.left();
            let s = going.parted.share();
            lift = going.rise.unwrap_or(0.0) * hump(s);
            if s >= 1.0 {
                self.going = None;
            } else if stands && going.rise.is_none() {
                // It lands before it gets there: here it stays until it is lifted again.
                let turned = self.parted.y + flat.1;
                self.held = Some((flat.0 + level(self.parted), turned));
                self.going = None;
            }
        } else {
            self.parted = Vec3::ZERO;
        }
        if dt_secs > 0.0 {
            self.parting = speed(self.parted - before, dt_secs);
        }
        let mut target = self.rolled(&self.moved(to, self.parted), self.roll.left().x);
        target.ankle += self.place.left() + Vec3::Y * lift;
        target.foot = (exp_map(self.tilt.left()) * target.foot).normalize();
        target.toes = (exp_map(self.toes.left()) * target.toes).normalize();
        target
    }

    /// Distance from the held place to the place in the new motion, metres; 0 for a foot that is not held.
    pub(super) fn distance(&self) -> f32 {
        if self.held.is_none() {
            return 0.0;
        }
        self.parted_m() + METRES_A_RADIAN * self.parted.y.abs()
    }

    /// Returns true if it is held away from its place in the new motion.
    pub(super) fn is_held_apart(&self) -> bool {
        self.distance() > 0.0
    }

    /// Distance on the ground from its place in the new motion, metres.
    pub(super) fn parted_m(&self) -> f32 {
        level(self.parted).length()
    }

    /// Returns true if it stands, or nearly so.
    pub(super) fn has_landed(&self) -> bool {
        let rolling = ROLL_LEVER_M * self.roll.left().x.abs();
        let settled = !self.lands || self.place.share() >= LANDED_SHARE;
        self.going.is_none() && settled && self.place.left().length() + rolling < LANDED_M
    }

    /// Returns true if it is at its place in the new motion.
    pub(super) fn is_over(&self) -> bool {
        self.place.is_over() && self.going.is_none() && self.distance() == 0.0
    }

    /// Begins a step of its own to its place in the new motion.
    pub(super) fn step_over(&mut self) {
        let [low, high] = RISES_M;
        let distance = self.distance();
        let rise = if distance < NEAR_M {
            0.0
        } else {
            (RISE * distance).clamp(low, high)
        };
        self.go(Some(rise));
    }

    fn go(&mut self, rise: Option<f32>) {
        self.held = None;
        self.going = Some(Going {
            parted: Fading::new(self.parted, self.parting, SWING_SECS),
            rise,
        });
    }

    /// A foot moved on the ground and turned about its flat place.
    fn moved(&self, foot: &FootTarget, parted: Vec3) -> FootTarget {
        if parted == Vec3::ZERO {
            return *foot;
        }
        let (about, _) = self.footprint(foot);
        let turn = from_heading(parted.y);
        FootTarget {
            ankle: about + level(parted) + turn * (foot.ankle - about),
            foot: (turn * foot.foot).normalize(),
            toes: (turn * foot.toes).normalize(),
        }
    }

    /// A foot rolled on its sole by a difference in pitch, radians.
    fn rolled(&self, foot: &FootTarget, roll: f32) -> FootTarget {
        if roll == 0.0 {
            return *foot;
        }
        let pitch = foot_pitch(foot.foot);
        let plant = self
            .rocker
            .plant_under(foot.ankle, foot_heading(foot.foot), pitch);
        let [from, to] = [pitch, pitch + roll].map(|pitch| self.rocker.stand(&plant, pitch));
        let turned = |from: Quat, to: Quat, part: Quat| (to * from.conjugate() * part).normalize();
        FootTarget {
            ankle: foot.ankle + to.ankle - from.ankle,
            foot: turned(from.foot, to.foot, foot.foot),
            toes: turned(from.toes, to.toes, foot.toes),
        }
    }

    /// Returns its place if it were put down flat, and its heading.
    fn footprint(&self, foot: &FootTarget) -> (Vec3, f32) {
        let heading = foot_heading(foot.foot);
        let pitch = foot_pitch(foot.foot);
        let plant = self.rocker.plant_under(foot.ankle, heading, pitch);
        (RockerFoot::footprint(&plant), heading)
    }
}

/// Offset between two places on the ground: x and z; y is the turn.
fn parted(stood: (Vec3, f32), stands: (Vec3, f32)) -> Vec3 {
    let mut parted = stood.0 - stands.0;
    parted.y = wrap_angle(stood.1 - stands.1);
    parted
}

fn level(parted: Vec3) -> Vec3 {
    Vec3::new(parted.x, 0.0, parted.z)
}

fn speed(way: Vec3, dt_secs: f32) -> Vec3 {
    if dt_secs > 0.0 {
        (way / dt_secs).clamp_length_max(MAX_SPEED)
    } else {
        Vec3::ZERO
    }
}
