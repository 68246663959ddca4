//! Transitions between motions: no jump, and standing feet stay in place.
//!
//! Offsets between the two motions, in place and in speed, decay while the second continues (inertialization, after Bollo,
//! "Inertialization: High-Performance Animation Transitions in Gears of War", GDC 2018). Feet are treated separately: a foot that stands in both
//! motions keeps its place until the new motion lifts it, or takes a step of its own.

mod fading;
mod foot;

use crate::leg::{FootTarget, Leg, reach_height};
use crate::placement::ContactThresholds;
use crate::rocker::RockerFoot;
use fading::Fading;
use foot::{HeldFoot, MovingFoot};
use footfall_core::ease::smooth_step;
use footfall_core::rotation::{exp_map, log_map};
use footfall_core::{JOINT_COUNT, Joint, Pose, Side, Skeleton};
use glam::Vec3;

/// Greatest extension of a leg whose foot is held, as a share of its length, unless the new motion extends it further, or the old one has
/// just done so: the knee of a straight leg snaps when its foot leaves, and when it bends at once.
const EASY_EXTENSION: f32 = 0.985;
/// Greatest extension of a leg, as a share of its length.
const MAX_EXTENSION: f32 = 0.999;
/// Distance before that extension from which the pelvis yields to a foot that is held too far away, metres.
const YIELD_M: f32 = 0.03;
/// Rate of that yielding: it is complete after 1/3 of the handover.
const YIELD_RATE: f32 = 3.0;
/// Greatest descent of the pelvis, metres; a foot that would need more takes a step of its own to its new place.
const MOST_YIELD_M: f32 = 0.15;
/// Share of a leg's length above which the horizontal distance of its foot reduces the pull on the pelvis: a lying leg does not pull it down.
const UPRIGHT_SHARE: f32 = 0.25;
/// Greatest vertical speed of the pelvis by that pull, m/s.
const MOST_YIELD_MPS: f32 = 0.8;
/// Greatest acceleration of the same, m/s².
const MOST_YIELD_MPS2: f32 = 40.0;
/// Limits of the speeds of a body, metres and radians a second: beyond them a clip has jumped, or the character was teleported.
const MAX_SPEED_MPS: f32 = 6.0;
const MAX_TURN_RADPS: f32 = 25.0;

/// A motion at one time: two of its frames, in the axes of the ground, with y = 0 the floor.
#[derive(Clone, Copy, Debug)]
pub struct Moving<'a> {
    /// Previous frame.
    pub before: &'a Pose,
    /// Current frame.
    pub now: &'a Pose,
    /// True for standing feet.
    pub stands: [bool; 2],
}

/// Transition of a body from one motion to another. Does not allocate.
#[derive(Clone, Debug)]
pub struct Handover {
    hips: Fading,
    turns: [Fading; JOINT_COUNT],
    feet: [HeldFoot; 2],
    /// Stretch of the legs as the motion that ended left them, shares of their lengths.
    stretched: [f32; 2],
    /// Lowering of the pelvis towards the feet, metres.
    yielded_m: f32,
    yielding_mps: f32,
    frame: BodyFrame,
}

/// Legs and feet of a body, as their poses are worked out from a skeleton.
#[derive(Clone, Debug)]
struct BodyFrame {
    legs: [Leg; 2],
    rockers: [RockerFoot; 2],
    hip_offsets: [Vec3; 2],
    leg_lengths: [f32; 2],
}

impl Handover {
    /// Starts a transition between motions on the same ground, whose frames are both `dt_secs` apart, within `secs`.
    pub fn new(
        skeleton: &Skeleton,
        from: &Moving<'_>,
        to: &Moving<'_>,
        dt_secs: f32,
        secs: f32,
    ) -> Self {
        let secs = secs.max(0.0);
        let frame = BodyFrame::new(skeleton);
        let per_sec = |way: Vec3, most: f32| {
            if dt_secs > 0.0 {
                (way / dt_secs).clamp_length_max(most)
            } else {
                Vec3::ZERO
            }
        };
        let hips = from.now.root_position - to.now.root_position;
        let hips_before = from.before.root_position - to.before.root_position;
        let turns = core::array::from_fn(|joint| {
            let parted =
                |from: &Pose, to: &Pose| from.rotations[joint] * to.rotations[joint].conjugate();
            let (now, before) = (parted(from.now, to.now), parted(from.before, to.before));
            let speed = per_sec(log_map(now * before.conjugate()), MAX_TURN_RADPS);
            Fading::new(log_map(now), speed, secs)
        });
        let foot = |moving: &Moving<'_>, side: Side| MovingFoot {
            now: frame.foot(side, moving.now),
            before: frame.foot(side, moving.before),
            stands: moving.stands[side.index()],
        };
        let feet = Side::BOTH.map(|side| {
            let rocker = frame.rockers[side.index()];
            HeldFoot::new(rocker, &foot(from, side), &foot(to, side), dt_secs, secs)
        });
        let stretched =
            Side::BOTH.map(|side| frame.extension(side, from.now, &frame.foot(side, from.now)));
        Self {
            stretched,
            hips: Fading::new(hips, per_sec(hips - hips_before, MAX_SPEED_MPS), secs),
            turns,
            feet,
            yielded_m: 0.0,
            yielding_mps: 0.0,
            frame,
        }
    }

    /// Advances time and changes a pose of the new motion to the body's. `stands` marks the feet that the new motion has on the
    /// ground, `rests` whether it leaves them there for good: feet that stand elsewhere then take a step, one after the other.
    pub fn step(&mut self, dt_secs: f32, stands: [bool; 2], rests: bool, pose: &mut Pose) {
        self.hips.advance(dt_secs);
        if rests {
            self.step_over();
        }
        let mut extensions = [EASY_EXTENSION; 2];
        let targets = Side::BOTH.map(|side| {
            let to = self.frame.foot(side, pose);
            let own = self.frame.extension(side, pose, &to);
            let own = own.clamp(EASY_EXTENSION, MAX_EXTENSION);
            let begun = self.stretched[side.index()].clamp(own, MAX_EXTENSION);
            extensions[side.index()] = begun + smooth_step(self.hips.share()) * (own - begun);
            self.feet[side.index()].step(dt_secs, &to, stands[side.index()])
        });
        for (turn, rotation) in self.turns.iter_mut().zip(&mut pose.rotations) {
            turn.advance(dt_secs);
            if !turn.is_over() {
                *rotation = (exp_map(turn.left()) * *rotation).normalize();
            }
        }
        pose.root_position += self.hips.left();
        if self.is_over() {
            return;
        }
        let hips_rotation = pose.rotations[Joint::Hips.index()];
        let begun = smooth_step(YIELD_RATE * self.hips.share());
        let height = pose.root_position.y;
        let mut lowest = height;
        for (index, target) in targets.iter().enumerate() {
            let hip = hips_rotation * self.frame.hip_offsets[index];
            let length = self.frame.leg_lengths[index];
            let extension = extensions[index];
            let highest = reach_height(pose.root_position, hip, target.ankle, length, extension);
            if let Some(highest) = highest {
                let give = begun * self.feet[index].parted_m().min(YIELD_M);
                let way = target.ankle - pose.root_position - hip;
                let aside = way.with_y(0.0).length() / length;
                let upright = smooth_step((1.0 - aside) / UPRIGHT_SHARE);
                if upright * (height - highest) > MOST_YIELD_M && self.feet[index].is_held_apart() {
                    self.feet[index].step_over();
                }
                lowest -= upright * (lowest - below(lowest, highest, give));
            }
        }
        self.yield_to(height - lowest, dt_secs);
        pose.root_position.y -= self.yielded_m;
        for (leg, target) in self.frame.legs.iter().zip(&targets) {
            leg.solve(pose.root_position, hips_rotation, target, pose);
        }
    }

    /// Returns true when the previous motion has decayed completely.
    pub fn is_over(&self) -> bool {
        self.hips.is_over() && self.feet.iter().all(HeldFoot::is_over)
    }

    /// Lowers the pelvis by this much, as far as possible within this time.
    fn yield_to(&mut self, lacks_m: f32, dt_secs: f32) {
        if dt_secs <= 0.0 {
            return;
        }
        let wanted = (lacks_m - self.yielded_m) / dt_secs;
        let wanted = wanted.clamp(-MOST_YIELD_MPS, MOST_YIELD_MPS);
        let most = MOST_YIELD_MPS2 * dt_secs;
        self.yielding_mps = wanted.clamp(self.yielding_mps - most, self.yielding_mps + most);
        self.yielded_m += self.yielding_mps * dt_secs;
    }

    /// Makes the standing foot that is farther from its place step there, if both stand.
    fn step_over(&mut self) {
        if !self.feet.iter().all(HeldFoot::has_landed) {
            return;
        }
        let [left, right] = &mut self.feet;
        let farther = if left.distance() >= right.distance() {
            left
        } else {
            right
        };
        if farther.is_held_apart() {
            farther.step_over();
        }
    }
}

/// A height that comes near a limit gently from `give` below it, and never passes it.
fn below(height: f32, limit: f32, give: f32) -> f32 {
    let into = height - (limit - give);
    if into <= 0.0 || give <= 0.0 {
        return height.min(limit);
    }
    limit - give * (-into / give).exp()
}

/// Detects the standing feet of a motion without known contacts: those that are low and slow. `stood` marks the feet that stood in the previous frame.
pub fn standing_feet(
    skeleton: &Skeleton,
    before: &Pose,
    now: &Pose,
    dt_secs: f32,
    stood: [bool; 2],
) -> [bool; 2] {
    let frame = BodyFrame::new(skeleton);
    Side::BOTH.map(|side| {
        let index = side.index();
        let points = |pose: &Pose| frame.rockers[index].points(&frame.foot(side, pose));
        let (now, before) = (points(now), points(before));
        let height = now.iter().map(|point| point.y).fold(f32::MAX, f32::min);
        let slowest = now
            .iter()
            .zip(&before)
            .map(|(now, before)| now.distance(*before))
            .fold(f32::MAX, f32::min);
        let speed = if dt_secs > 0.0 {
            slowest / dt_secs
        } else {
            0.0
        };
        ContactThresholds::default().stands(stood[index], speed, height)
    })
}

impl BodyFrame {
    fn new(skeleton: &Skeleton) -> Self {
        Self {
            legs: Side::BOTH.map(|side| Leg::new(skeleton, side)),
            rockers: Side::BOTH.map(|side| RockerFoot::new(skeleton, side)),
            hip_offsets: Side::BOTH.map(|side| skeleton.offset(side.upper_leg())),
            leg_lengths: Side::BOTH.map(|side| skeleton.leg_length(side)),
        }
    }

    /// Distance from hip joint to ankle in a pose, as a share of the leg's length.
    fn extension(&self, side: Side, pose: &Pose, foot: &FootTarget) -> f32 {
        let hip = pose.rotations[Joint::Hips.index()] * self.hip_offsets[side.index()];
        let reach = foot.ankle - pose.root_position - hip;
        reach.length() / self.leg_lengths[side.index()]
    }

    /// A foot of a pose.
    fn foot(&self, side: Side, pose: &Pose) -> FootTarget {
        let hips = pose.rotations[Joint::Hips.index()];
        let thigh = hips * pose.rotation(side.upper_leg());
        let shank = thigh * pose.rotation(side.lower_leg());
        let foot = (shank * pose.rotation(side.foot())).normalize();
        let index = side.index();
        FootTarget {
            ankle: pose.root_position
                + hips * self.hip_offsets[index]
                + self.legs[index].ankle_from_hip(thigh, shank),
            foot,
            toes: (foot * pose.rotation(side.toes())).normalize(),
        }
    }
}
