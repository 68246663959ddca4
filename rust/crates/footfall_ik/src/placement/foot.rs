//! One foot: locked to its place, or swinging to the next.

mod ankle;
mod heel;

use crate::leg::FootTarget;
use crate::placement::PlacementConfig;
use crate::placement::correction::{Correction, Residual};
use crate::placement::foothold::{Foothold, MOST_ASIDE_M, Search};
use crate::placement::frame::Frame;
use crate::placement::landings::Landing;
use crate::placement::pelvis::Follower;
use crate::placement::swing::PlannedFoothold;
use crate::placement::terrain::Terrain;
use crate::rocker::{Plant, RockerFoot};
pub(super) use ankle::Ankle;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::{heading, wrap_angle};
use glam::{Quat, Vec3};
pub(super) use heel::MAX_PITCH;

/// Time constant with which a discontinuity fades, seconds.
const RESIDUAL_SECS: f32 = 0.06;
/// Time constant with which a foot without a known landing follows the ground under it, seconds.
pub(super) const FOLLOW_SECS: f32 = 0.08;
/// Least time between two new plants of a foot that has drifted from its lock, seconds.
pub(super) const REPLANT_SECS: f32 = 0.22;
/// Duration of the lowering of a heel that landed after its toes, seconds.
const LOWER_SECS: f32 = 0.16;

/// One foot of the animation, relative to its floor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Animated {
    pub(super) foot: FootTarget,
    /// Place at which it would lie if it were put down flat.
    pub(super) flat: Frame,
    pub(super) pitch: f32,
    pub(super) contact: bool,
    pub(super) landing: Option<Landing>,
}

/// Activity of a foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// As the animation has it.
    Free,
    Swinging,
    Locked,
}

/// Origin of a swinging foot's way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum WayOrigin {
    /// The foothold that it left.
    Foothold,
    /// None: it follows the ground. Place in the world that the animation gave it.
    Unplanned(Vec3),
    /// Its place in the air when its foothold became known, as in a run.
    Air,
}

/// State of a foot from frame to frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub(super) mode: Mode,
    pub(super) hold: Option<Foothold>,
    /// True when there is ground within reach.
    pub(super) over_ground: bool,
    /// Place of the sole, also if it were put down, relative to the floor of the animation.
    pub(super) sole: Frame,
    /// Place at which it will stand next, relative to the floor of the animation, as far as that is known.
    pub(super) lands: Option<Vec3>,
    pub(super) plan: Option<PlannedFoothold>,
    /// Place in the world of the animation's landing when no ground was found for it.
    pub(super) missed_at: Option<Vec3>,
    /// Lift over edges on its way in the last frame, metres.
    pub(super) lift: f32,
    /// The same on the way to a foothold that was given up in this frame.
    pub(super) dropped: Option<f32>,
    /// Place in the world of a swinging ankle in the last frame.
    pub(super) passed: Option<Vec3>,
    /// Place in the world that the animation gave the foot when its way to a planned foothold began.
    pub(super) left_from: Option<Vec3>,
    /// Share of it that is still held there.
    pub(super) held: f32,
    pub(super) origin: WayOrigin,
    /// Correction that carried it when it last changed its mode, and the height in the world of the animation's floor then.
    pub(super) lifted_with: Correction,
    pub(super) lifted_from_m: f32,
    /// The same height in the last frame.
    pub(super) floor_m: f32,
    pub(super) correction: Correction,
    pub(super) locked_with: Correction,
    pub(super) swing_secs: f32,
    pub(super) replant_secs: f32,
    /// Pitch below which the ankle would have bent too far in the last frame, radians.
    pub(super) hangs_from: f32,
    pub(super) guard: Follower,
    /// Way by which it is pushed out of a wall, metres.
    pub(super) pushed: Vec3,
    pub(super) residual: Residual,
    /// Residual between the locked foot and the animated one, beyond its correction.
    pub(super) at_lock: Residual,
    pub(super) begun: bool,
    /// True if it was released before the animation lifts it.
    pub(super) let_go_early: bool,
    /// Pitch with which it landed, heel up, radians; 0 on the ball of the foot, on a tread.
    pub(super) landed_pitch: f32,
    /// Pitch by which its heel was raised in the last frame, radians.
    pub(super) raised: f32,
}

/// The floor of the animation, the ground, and how a foot meets it.
pub(super) struct Scene<'a, T> {
    pub(super) terrain: &'a mut T,
    pub(super) world_from_floor: Frame,
    pub(super) config: &'a PlacementConfig,
    /// Heights of the lower and of the higher sole over the animation's floor, metres.
    pub(super) soles_m: [f32; 2],
    pub(super) dt_secs: f32,
}

impl<T: Terrain> Scene<'_, T> {
    /// Height in the world of the animation's floor, metres.
    pub(super) fn floor_m(&self) -> f32 {
        let floor = self.world_from_floor;
        floor.position.dot(floor.up())
    }

    pub(super) fn search(&self) -> Search {
        Search {
            up: self.world_from_floor.up(),
            above_m: self.config.max_step_m + self.soles_m[1].max(0.0),
            below_m: self.config.max_step_m - self.soles_m[0].min(0.0),
            max_tilt: self.config.max_tilt,
            may_shift: self.config.adjust_footholds,
            aside_m: [MOST_ASIDE_M; 2],
            thorough: false,
        }
    }

    pub(super) fn sole(&mut self, foothold: &Foothold) -> Option<Frame> {
        let sole = foothold.world_from_sole(self.terrain)?;
        Some(self.world_from_floor.local(&sole))
    }

    /// Height of the ground above the animation's floor at a place on it.
    pub(super) fn ground(&mut self, at: Vec3) -> Option<(f32, Vec3)> {
        let floor = self.world_from_floor;
        let search = self.search();
        let hit = search.cast(self.terrain, floor.point(Vec3::new(at.x, 0.0, at.z)))?;
        let normal = floor.rotation.conjugate() * hit.normal;
        Some((floor.local_point(hit.position).y, normal))
    }
}

impl Default for Foot {
    fn default() -> Self {
        Self {
            mode: Mode::Free,
            hold: None,
            over_ground: false,
            sole: Frame::IDENTITY,
            lands: None,
            plan: None,
            missed_at: None,
            lift: 0.0,
            dropped: None,
            passed: None,
            left_from: None,
            held: 0.0,
            origin: WayOrigin::Foothold,
            lifted_with: Correction::NONE,
            lifted_from_m: 0.0,
            floor_m: 0.0,
            correction: Correction::NONE,
            locked_with: Correction::NONE,
            swing_secs: 0.0,
            replant_secs: 0.0,
            hangs_from: f32::MIN,
            guard: Follower::default(),
            pushed: Vec3::ZERO,
            residual: Residual::NONE,
            at_lock: Residual::NONE,
            begun: false,
            let_go_early: false,
            landed_pitch: 0.0,
            raised: 0.0,
        }
    }
}

impl Foot {
    /// Returns the target of the foot in this frame, relative to the floor of the animation.
    pub(super) fn step<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        animated: &Animated,
        airborne: bool,
    ) -> FootTarget {
        self.replant_secs = (self.replant_secs - scene.dt_secs).max(0.0);
        if !self.begun {
            self.floor_m = scene.floor_m();
        }
        self.swing_secs += scene.dt_secs;
        let was = self.mode;
        if was == Mode::Locked && (airborne || !animated.contact) {
            self.let_go(if airborne { Mode::Free } else { Mode::Swinging });
        }
        let mut target = self.target(scene, rocker, animated);
        let mode = self.mode;
        if airborne {
            if mode != Mode::Free {
                self.plan = None;
                self.let_go(Mode::Free);
            }
        } else if animated.contact && mode != Mode::Locked && self.replant_secs == 0.0 {
            self.put(scene, rocker, animated);
        } else if mode == Mode::Free {
            self.let_go(Mode::Swinging);
        }
        if self.mode == mode || !self.begun {
            if self.mode != mode {
                target = self.target(scene, rocker, animated);
            }
            // Nothing of it is left at a landing.
            let left = animated.landing.filter(|_| scene.dt_secs > 0.0);
            let left = left.map_or(1.0, |next| next.secs / (next.secs + scene.dt_secs));
            self.residual
                .fade(left * (-scene.dt_secs / RESIDUAL_SECS).exp());
        } else {
            // What it would be had it gone on as it did, so that its own motion is not taken for a jump.
            let was = self.residual.apply(&target);
            target = self.target(scene, rocker, animated);
            self.residual = Residual::of(&was, &target);
        }
        self.begun = true;
        self.floor_m = scene.floor_m();
        let out = self.residual.apply(&target);
        if self.mode == Mode::Locked {
            let unlocked = self.correction.apply(&animated.flat, &animated.foot);
            self.at_lock = Residual::of(&out, &unlocked);
        }
        out
    }

    /// Returns the target of the foot in its mode.
    fn target<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        animated: &Animated,
    ) -> FootTarget {
        if self.mode == Mode::Locked
            && let Some(target) = self.stand(scene, rocker, animated)
        {
            return target;
        }
        match self.mode {
            Mode::Free => self.float(scene, animated),
            Mode::Swinging | Mode::Locked => self.swing(scene, rocker, animated),
        }
    }

    /// Changes the mode; the next landing stays.
    fn let_go(&mut self, mode: Mode) {
        if self.mode == Mode::Locked && mode != Mode::Locked {
            // From here on it goes as the animation does from where the lock had it in the last frame.
            self.residual = self.at_lock;
        }
        self.mode = mode;
        self.hold = None;
        self.lands = None;
        self.lifted_from_m = self.floor_m;
        self.left_from = None;
        self.origin = WayOrigin::Foothold;
        self.passed = None;
        self.lifted_with = self.correction;
        self.swing_secs = 0.0;
        self.guard.jump(0.0);
        self.pushed = Vec3::ZERO;
    }

    /// Locks the foot to the ground at its place, if there is any.
    fn put<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        animated: &Animated,
    ) {
        // One that is planned already for the step to come is not for this contact.
        let to_come = animated.landing.is_some_and(|next| !next.is_now());
        let planned = self.plan.filter(|_| !to_come);
        let planned = planned.map(|plan| plan.foothold);
        let hold = planned.or_else(|| {
            // Where the foot is now and not where the animation has it, so that it need not slide.
            let mut flat = animated.flat;
            flat.position += self.correction.shift * Vec3::new(1.0, 0.0, 1.0);
            let world = scene.world_from_floor.child(&flat);
            scene.search().find(scene.terrain, &world, rocker)
        });
        let Some(hold) = hold else {
            if self.mode == Mode::Free {
                self.let_go(Mode::Swinging);
            }
            return;
        };
        let Some(sole) = scene.sole(&hold) else {
            return;
        };
        self.plan = None;
        self.let_go(Mode::Locked);
        self.hold = Some(hold);
        self.landed_pitch = if hold.on_ball { 0.0 } else { animated.pitch };
        self.locked_with = Correction::between(&animated.flat, &sole);
    }

    /// Returns the target of a locked foot; `None` when it can no longer stand, and swings.
    fn stand<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        animated: &Animated,
    ) -> Option<FootTarget> {
        let sole = self.hold.and_then(|hold| scene.sole(&hold));
        let Some(sole) = sole else {
            self.let_go(Mode::Swinging);
            return None;
        };
        let correction = Correction::between(&animated.flat, &sole);
        let drift = correction.shift - self.locked_with.shift;
        let drift = Vec3::new(drift.x, 0.0, drift.z).length();
        let twist = heading(correction.tilt) - heading(self.locked_with.tilt);
        if drift > scene.config.max_drift_m || wrap_angle(twist).abs() > scene.config.max_twist {
            self.let_go(Mode::Swinging);
            self.replant_secs = REPLANT_SECS;
            return None;
        }
        self.correction = correction;
        self.sole = sole;
        self.over_ground = true;
        Some(self.standing(rocker, animated.pitch))
    }

    /// A foot on its sole at this pitch.
    fn standing(&self, rocker: &RockerFoot, pitch: f32) -> FootTarget {
        let plant = Plant {
            flat_ankle: Vec3::Y * rocker.ankle_height(),
            heading: 0.0,
        };
        let on_sole = rocker.stand_level(&plant, Quat::IDENTITY, self.on_ball(pitch));
        world_target(&self.sole, &on_sole)
    }

    /// Pitch on the foothold for a foot at this pitch: a heel without ground under it does not land first, and one that landed after its toes
    /// comes down.
    pub(super) fn on_ball(&self, pitch: f32) -> f32 {
        // A foot whose heel is up does not roll back onto it.
        let pitch = pitch - self.share_raised() * pitch.min(0.0);
        let Some(hold) = self.hold.filter(|hold| hold.on_ball) else {
            return pitch;
        };
        let share = 1.0 - smooth_step(self.swing_secs / LOWER_SECS);
        pitch.max(0.0).max(share * hold.pitch)
    }

    /// In the air a foot is where the animation has it.
    fn float<T: Terrain>(&mut self, scene: &Scene<'_, T>, animated: &Animated) -> FootTarget {
        let share = 1.0 - (-scene.dt_secs / FOLLOW_SECS).exp();
        self.correction = self.correction.toward(&Correction::NONE, share, share);
        self.sole = animated.flat;
        self.correction.apply(&animated.flat, &animated.foot)
    }
}

fn world_target(frame: &Frame, target: &FootTarget) -> FootTarget {
    FootTarget {
        ankle: frame.point(target.ankle),
        foot: (frame.rotation * target.foot).normalize(),
        toes: (frame.rotation * target.toes).normalize(),
    }
}
