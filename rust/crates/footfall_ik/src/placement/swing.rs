//! Swing of a foot: to a planned foothold, or over unplanned ground.

use crate::leg::FootTarget;
use crate::placement::aim::{Aim, Step};
use crate::placement::correction::{Correction, Residual};
use crate::placement::foot::{Animated, FOLLOW_SECS, Foot, REPLANT_SECS, Scene, WayOrigin};
use crate::placement::foothold::Foothold;
use crate::placement::frame::Frame;
use crate::placement::terrain::{Terrain, rise_along};
use crate::placement::way::{LATE_RISE_M, Way, held_back, passed};
use crate::rocker::RockerFoot;
use core::f32::consts::PI;
use footfall_core::ease::smooth_step;
use glam::{Quat, Vec3};

/// Times before its landing at which a descending foot is over its foothold, and at which it begins to hurry there, seconds; and the
/// descent from which this applies, metres.
const EARLY_SECS: [f32; 2] = [0.28, 0.07];
const EARLY_FALL_M: f32 = 0.08;
/// Part of the swing over which a foot that has less time than that gets up its hurry.
const HURRIED_SHARE: f32 = 0.5;
/// Greatest distance by which a foot swings past a foothold with an edge above it, metres.
const MOST_PAST_M: f32 = 0.008;
/// Way ahead from its last place to a foothold from which a foot is kept before that edge, metres.
const ONWARD_M: f32 = 0.15;
/// Height to which a foot is lifted that is planted anew, metres.
const REPLANT_LIFT_M: f32 = 0.04;
/// Time before a landing on the ball from which the toes are no higher than the heel, and duration of the rotation before that, seconds.
const LEVEL_SECS: [f32; 2] = [0.25, 0.02];
/// Share of its height over the toes by which the heel then descends, until this part of the swing; otherwise the knee would bend for it.
const LEVEL_HEEL: f32 = 0.7;
const LEVEL_HEEL_SHARE: f32 = 0.4;
/// A planned foothold is kept as long as the animation's landing moved less than this, metres.
const SAME_LANDING_M: f32 = 0.1;

/// A place chosen for the end of a swing.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlannedFoothold {
    pub(super) foothold: Foothold,
    /// Approximate rise of the ground from there to the next foothold, metres.
    pub(super) next_rise_m: f32,
    /// Landing of the animation, relative to the foothold; `None` until it is announced again, since the animation may adapt its step to this
    /// foothold.
    flat_from_sole: Option<Vec3>,
    /// Way there; `None` until it leaves the ground.
    way: Option<Way>,
}

impl Foot {
    /// Returns the target of a swinging foot, above the ground below it.
    pub(super) fn swing<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        animated: &Animated,
    ) -> FootTarget {
        let mut lift = 0.0;
        let mut before = self.correction;
        before.shift.y -= scene.floor_m() - self.floor_m;
        self.held = 0.0;
        // In the frame of the contact itself there is nothing more to land.
        let here = (animated.flat, 0.0);
        let announced = animated.landing.map(|landing| (landing.flat, landing.secs));
        let ends = announced.or_else(|| animated.contact.then_some(here));
        let follows = matches!(self.origin, WayOrigin::Unplanned(_));
        if follows && ends.is_some() && self.plan.is_some() {
            self.join_way(scene, animated);
        }
        let planned = ends.and_then(|end| Some((end, self.toward(scene, animated, &end.0)?)));
        let secs_left = planned.map(|((_, secs), _)| secs);
        let share = self.swing_secs / (self.swing_secs + secs_left.unwrap_or(0.0)).max(1e-3);
        self.lands = planned.map(|((flat, _), (toward, _))| flat.position + toward.shift);
        if let (Some(lands), Some(((flat, secs), (toward, way)))) = (self.lands, planned) {
            self.over_ground = true;
            let from = self.lifted(scene);
            let start = self.start(scene, animated);
            let passed = passed(start, flat.position, animated.flat.position);
            (self.correction, lift) = way.at(&from, &toward, share, passed);
            if self.origin == WayOrigin::Foothold {
                let fall = (1.0 - way.even) * (from.shift.y - toward.shift.y);
                self.hurry(animated, &flat, [secs, share], fall);
                self.hold_back(animated, [start, lands], [&from, &toward], share);
            }
            self.stay_before_edge(animated, [start, lands]);
        } else {
            self.dropped = None;
            self.follow(scene, rocker, animated);
            if self.replant_secs > 0.0 {
                let share = 1.0 - self.replant_secs / REPLANT_SECS;
                lift = REPLANT_LIFT_M * (PI * share).sin();
            }
        }
        if let Some(dropped) = self.dropped.take() {
            // It turns to another foothold without a jump.
            let went_on = corrected(&before, dropped, animated, &animated.foot);
            let turned = corrected(&self.correction, lift, animated, &animated.foot);
            self.residual = Residual::of(&self.residual.apply(&went_on), &turned);
        }
        self.lift = lift;
        let mut foot = animated.foot;
        if let Some(((_, secs), _)) = planned
            && let Some(hold) = self.plan.map(|plan| plan.foothold)
            && hold.on_ball
        {
            level(rocker, animated, [secs, share, hold.pitch], &mut foot);
        }
        let mut target = corrected(&self.correction, lift, animated, &foot);
        if let Some(((_, secs), (_, way))) = planned {
            self.hang(1.0 - way.even, secs, &mut target);
        }
        self.guard(scene, rocker, animated, secs_left, &mut target);
        self.sole = Frame {
            position: animated.flat.position + self.correction.shift,
            rotation: (self.correction.tilt * animated.flat.rotation).normalize(),
        };
        target
    }

    /// Place that the animation gave the foot when its way began, relative to its floor now.
    fn start<T: Terrain>(&mut self, scene: &Scene<'_, T>, animated: &Animated) -> Vec3 {
        let place = scene.world_from_floor.point(animated.flat.position);
        let start = *self.left_from.get_or_insert(place);
        scene.world_from_floor.local_point(start)
    }

    /// Begins the way to a foothold where a foot is that has followed the ground until now. It goes on as it does, high over edges.
    fn join_way<T: Terrain>(&mut self, scene: &Scene<'_, T>, animated: &Animated) {
        self.lifted_with = self.correction;
        self.lifted_from_m = scene.floor_m();
        self.left_from = Some(scene.world_from_floor.point(animated.flat.position));
        self.swing_secs = 0.0;
        self.origin = WayOrigin::Air;
    }

    /// Brings a foot that goes down by so much over its foothold early: its heel keeps clear of the edge behind it.
    fn hurry(&mut self, animated: &Animated, flat: &Frame, [secs, share]: [f32; 2], fall_m: f32) {
        let [from, until] = EARLY_SECS;
        let early = smooth_step((from - secs) / (from - until))
            * smooth_step(share / HURRIED_SHARE)
            * smooth_step(fall_m / EARLY_FALL_M);
        let left = flat.position - animated.flat.position;
        self.correction.shift += early * left * Vec3::new(1.0, 0.0, 1.0);
    }

    /// Holds a foot that rises over an edge above its last place, in the first part of the swing.
    fn hold_back(
        &mut self,
        animated: &Animated,
        [start, lands]: [Vec3; 2],
        [lifted, toward]: [&Correction; 2],
        share: f32,
    ) {
        let way = lands - (start + lifted.shift);
        // A slope on which it stood goes on: it is no edge.
        let normal = lifted.tilt * Vec3::Y;
        let rise = toward.shift.y - lifted.shift.y - rise_along(normal, way);
        self.held = held_back(share, rise);
        let come = start - animated.flat.position;
        self.correction.shift += self.held * come * Vec3::new(1.0, 0.0, 1.0);
    }

    /// Keeps a foot that swings past its foothold, and back to it, from the edge above that: it would be thrown over it.
    fn stay_before_edge(&mut self, animated: &Animated, [start, lands]: [Vec3; 2]) {
        let rise = self.plan.map_or(0.0, |plan| plan.next_rise_m);
        let past = (animated.flat.position + self.correction.shift - lands).with_y(0.0);
        let forward = animated.flat.forward().with_y(0.0).normalize_or_zero();
        // Not where it steps backwards or aside.
        let onward = smooth_step((lands - start).dot(forward) / ONWARD_M);
        let past_m = past.dot(forward).max(0.0);
        let back_m = past_m * past_m / (past_m + MOST_PAST_M);
        self.correction.shift -= forward * (onward * back_m * smooth_step(rise / LATE_RISE_M));
    }

    /// Correction that carried the foot when it was lifted, over the floor as it is now.
    pub(super) fn lifted<T: Terrain>(&self, scene: &Scene<'_, T>) -> Correction {
        let mut lifted = self.lifted_with;
        lifted.shift.y -= scene.floor_m() - self.lifted_from_m;
        lifted
    }

    /// The correction at the landing and the way there; `None` without a planned foothold.
    fn toward<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        animated: &Animated,
        flat: &Frame,
    ) -> Option<(Correction, Way)> {
        let plan = self.plan?;
        let sole = scene.sole(&plan.foothold)?;
        let way = plan.way.unwrap_or_else(|| {
            let lifted = self.lifted(scene);
            let from = animated.flat.position + lifted.shift;
            let stood = self.origin == WayOrigin::Foothold;
            Way::look(scene, (from, lifted.tilt * Vec3::Y), &sole, stood)
        });
        if plan.way.is_none() {
            let mut foothold = plan.foothold;
            // Nobody reaches down to where the ground goes anyway.
            foothold.pitch *= 1.0 - way.even;
            self.plan = Some(PlannedFoothold {
                foothold,
                way: Some(way),
                ..plan
            });
        }
        Some((Correction::between(flat, &sole), way))
    }

    /// Plans the next foothold; a plan is kept while the animation's landing stays.
    pub(super) fn plan<T: Terrain>(&mut self, scene: &mut Scene<'_, T>, step: &Step<'_>) {
        let flat = scene.world_from_floor.child(&step.landing.flat);
        if let Some(plan) = &mut self.plan
            && let Some(sole) = plan.foothold.world_from_sole(scene.terrain)
        {
            let place = sole.local_point(flat.position);
            let seen = *plan.flat_from_sole.get_or_insert(place);
            // How high the animation's floor is says nothing about where it lands.
            let way = sole.rotation * (place - seen);
            if way
                .reject_from_normalized(scene.world_from_floor.up())
                .length()
                < SAME_LANDING_M
            {
                return;
            }
            self.dropped = plan.way.map(|_| self.lift);
        }
        let again = self
            .missed_at
            .is_some_and(|place| place.distance(flat.position) < SAME_LANDING_M);
        if self.plan.is_none() && again {
            return;
        }
        let aim = step.aim(scene);
        self.missed_at = aim.is_none().then_some(flat.position);
        self.set_plan(aim.as_ref());
    }

    /// Sets the place of the next landing, or none.
    pub(super) fn set_plan(&mut self, aim: Option<&Aim>) {
        self.plan = aim.map(|aim| PlannedFoothold {
            foothold: aim.foothold,
            next_rise_m: aim.next_rise_m,
            flat_from_sole: None,
            way: None,
        });
    }

    /// Follows the ground under a foot without a known landing.
    fn follow<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        animated: &Animated,
    ) {
        let mut flat = animated.flat;
        flat.position += self.correction.shift * Vec3::new(1.0, 0.0, 1.0);
        let [heel, ball, tip] = rocker
            .sole_points()
            .map(|point| scene.ground(flat.point(point)));
        let mut toward = Correction::NONE;
        let below = ball.or(heel).or(tip);
        self.over_ground = below.is_some();
        if let Some((_, normal)) = below {
            let heights = [heel, ball, tip].into_iter().flatten();
            toward.shift.y = heights.map(|(height, _)| height).fold(f32::MIN, f32::max);
            let tilt = Quat::from_rotation_arc(Vec3::Y, normal);
            let angle = tilt.angle_between(Quat::IDENTITY);
            let share = (scene.config.max_tilt / angle.max(1e-4)).min(1.0);
            toward.tilt = Quat::IDENTITY.slerp(tilt, share);
            if let (Some((heel, _)), Some((tip, _))) = (heel, tip) {
                // Announced under the ankle, which is not the middle of the sole.
                let [back, _, front] = rocker.sole_points();
                toward.shift.y = heel - (tip - heel) * back.z / (front.z - back.z);
            }
        }
        // Along the plane that it follows it does so without delay.
        let place = scene.world_from_floor.point(animated.flat.position);
        if let WayOrigin::Unplanned(before) = self.origin {
            let way = scene.world_from_floor.rotation.conjugate() * (place - before);
            let normal = self.correction.tilt * Vec3::Y;
            self.correction.shift.y -= way.y - rise_along(normal, way);
        }
        self.origin = WayOrigin::Unplanned(place);
        let share = 1.0 - (-scene.dt_secs / FOLLOW_SECS).exp();
        self.correction = self.correction.toward(&toward, share, share);
    }
}

/// Levels a foot that comes down on its ball: the heel comes down to the toes in the first part of the swing, and the toes to the heel before the
/// landing.
fn level(
    rocker: &RockerFoot,
    animated: &Animated,
    [secs, share, pitch]: [f32; 3],
    foot: &mut FootTarget,
) {
    let [from, until] = LEVEL_SECS;
    let landing = smooth_step((from - secs) / (from - until));
    let heel = LEVEL_HEEL * smooth_step(share / LEVEL_HEEL_SHARE) * animated.pitch.max(0.0);
    let level = landing * animated.pitch.min(0.0) + heel;
    // Toes that come down first lie flat.
    let down = landing * pitch;
    let roll = rocker.roll(animated.pitch - level + down) - rocker.roll(animated.pitch);
    foot.ankle += animated.flat.rotation * roll;
    foot.foot = (foot.foot * Quat::from_rotation_x(down - level)).normalize();
    foot.toes = (foot.toes * Quat::from_rotation_x(-level)).normalize();
}

/// A foot of the animation with a correction and a lift.
fn corrected(
    correction: &Correction,
    lift: f32,
    animated: &Animated,
    foot: &FootTarget,
) -> FootTarget {
    let mut foot = correction.apply(&animated.flat, foot);
    foot.ankle.y += lift;
    foot
}
