//! A foot on its way: to a planned foothold, or over ground that nobody planned for.

use crate::leg::FootTarget;
use crate::placement::correction::{Correction, Residual};
use crate::placement::foot::{Animated, FOLLOW_SECS, Foot, Landing, Lands, REPLANT_SECS, Scene};
use crate::placement::foothold::Foothold;
use crate::placement::frame::Frame;
use crate::placement::terrain::Terrain;
use crate::rocker::RockerFoot;
use core::f32::consts::PI;
use footfall_core::ease::smooth_step;
use glam::{Quat, Vec3};

/// How long a foot that would pass through something takes for half of its way over it, seconds.
const GUARD_HALF_LIFE_SECS: f32 = 0.03;
/// So long before it lands it is no longer held up, seconds: it comes down where it was meant to.
const COMING_DOWN_SECS: f32 = 0.15;
/// How high it is lifted then, metres.
const REPLANT_LIFT_M: f32 = 0.04;
/// Part of the swing in which a foot that goes up, or down, does so: it clears the edge before it, or after it.
const RISE_SHARE: f32 = 0.6;
/// A swinging foot keeps this far from ground that it passes over, metres.
const CLEARANCE_M: f32 = 0.03;
/// The lift that walkers have over flat ground in the middle of the swing, about, metres.
const USUAL_LIFT_M: f32 = 0.05;
/// Ground that is higher than the way of the sole by less is no obstacle, metres.
const FLAT_WAY_M: f32 = 0.01;
/// At how many places of its way the ground is looked at.
const WAY_POINTS: usize = 6;
/// A planned foothold is kept as long as the animation's landing moved less than this, metres.
const SAME_LANDING_M: f32 = 0.03;

/// A place chosen for the end of a swing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    pub(super) foothold: Foothold,
    /// Where the animation would put the foot, as it is seen from the foothold.
    flat_from_sole: Vec3,
    lift_m: f32,
}

impl Foot {
    /// Where a foot is on its way, over what it passes.
    pub(super) fn swing<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        animated: &Animated,
    ) -> FootTarget {
        let mut lift = 0.0;
        // In the frame of the contact itself there is nothing more to land.
        let here = Landing {
            flat: animated.flat,
            secs: 0.0,
        };
        let landed = (self.plan.is_some() && animated.contact).then_some(here);
        let planned = landed
            .or(animated.landing)
            .and_then(|landing| Some((landing, self.plan(scene, rocker, animated, &landing)?)));
        if let Some((landing, (toward, height))) = planned {
            self.over_ground = true;
            let share = self.swing_secs / (self.swing_secs + landing.secs).max(1e-3);
            (self.correction, lift) = self.on_way(&toward, height, share);
            if let Some((old_toward, old_height)) = self.dropped.take() {
                // It turns to another foothold without a jump.
                let (correction, old_lift) = self.on_way(&old_toward, old_height, share);
                let mut was = correction.apply(&animated.flat, &animated.foot);
                was.ankle.y += old_lift;
                let mut now = self.correction.apply(&animated.flat, &animated.foot);
                now.ankle.y += lift;
                self.residual = Residual::of(&self.residual.apply(&was), &now);
            }
        } else {
            self.plan = None;
            self.follow(scene, rocker, animated);
            if self.replant_secs > 0.0 {
                let share = 1.0 - self.replant_secs / REPLANT_SECS;
                lift = REPLANT_LIFT_M * (PI * share).sin();
            }
        }
        let mut target = self.correction.apply(&animated.flat, &animated.foot);
        target.ankle.y += lift;
        self.lands = planned.map(|(landing, (toward, _))| Lands {
            flat: landing.flat.position,
            sole: landing.flat.position + toward.shift,
            secs: landing.secs,
        });
        let secs_left = planned.map(|(landing, _)| landing.secs);
        self.guard(scene, rocker, secs_left, &mut target);
        self.sole = Frame {
            position: animated.flat.position + self.correction.shift,
            rotation: (self.correction.tilt * animated.flat.rotation).normalize(),
        };
        target
    }

    /// The correction on the way to another, and how much the foot is lifted there.
    fn on_way(&self, toward: &Correction, height: f32, share: f32) -> (Correction, f32) {
        let rises = toward.shift.y > self.lifted_with.shift.y;
        let up = smooth_step(rising(share, rises));
        let correction = self.lifted_with.toward(toward, smooth_step(share), up);
        (correction, height * (share * (1.0 - share) * 4.0).powi(2))
    }

    /// The correction at the landing and how high the foot has to be lifted before; plans them where they are not yet.
    fn plan<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        animated: &Animated,
        landing: &Landing,
    ) -> Option<(Correction, f32)> {
        let floor = scene.world_from_floor;
        let world_from_flat = floor.child(&landing.flat);
        if let Some(plan) = self.plan
            && let Some(sole) = plan.foothold.world_from_sole(scene.terrain)
        {
            let way = sole.point(plan.flat_from_sole) - world_from_flat.position;
            let toward = Correction::between(&landing.flat, &floor.local(&sole));
            // How high the animation's floor is says nothing about where it lands.
            if way.reject_from_normalized(floor.up()).length() < SAME_LANDING_M {
                return Some((toward, plan.lift_m));
            }
            self.dropped = Some((toward, plan.lift_m));
        }
        let foothold = scene
            .search()
            .find(scene.terrain, &world_from_flat, rocker)?;
        let sole = foothold.world_from_sole(scene.terrain)?;
        let on_floor = floor.local(&sole);
        let lift_m = self.way_lift(scene, animated, &on_floor);
        self.plan = Some(Plan {
            foothold,
            flat_from_sole: sole.local_point(world_from_flat.position),
            lift_m,
        });
        Some((Correction::between(&landing.flat, &on_floor), lift_m))
    }

    /// How much higher than usual the foot has to be lifted in the middle of its way to `sole`.
    fn way_lift<T: Terrain>(
        &self,
        scene: &mut Scene<'_, T>,
        animated: &Animated,
        sole: &Frame,
    ) -> f32 {
        let from = animated.flat.position + self.lifted_with.shift;
        let rises = sole.position.y > from.y;
        let mut lift = 0.0_f32;
        for point in 1..=WAY_POINTS {
            let share = point as f32 / (WAY_POINTS + 1) as f32;
            let at = from.lerp(sole.position, smooth_step(share));
            // The toes meet an edge before the ankle is there.
            let Some((height, _)) = scene.ground(at + sole.forward() * 0.1) else {
                continue;
            };
            let foot = from.y + (sole.position.y - from.y) * smooth_step(rising(share, rises));
            let shape = (4.0 * share * (1.0 - share)).powi(2);
            let short = height + CLEARANCE_M - foot - USUAL_LIFT_M * shape.sqrt();
            // What lies no higher than the way from one foothold to the other is cleared by any walk.
            if height > foot + FLAT_WAY_M && short > 0.0 {
                lift = lift.max(short / shape.max(0.2));
            }
        }
        lift
    }

    /// Follows the ground under a foot of which nobody knows where it will land.
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
                // Told under the ankle, which is not the middle of the sole.
                let [back, _, front] = rocker.sole_points();
                toward.shift.y = heel - (tip - heel) * back.z / (front.z - back.z);
            }
        }
        // Along the plane that it follows it does so without delay.
        let place = scene.world_from_floor.point(animated.flat.position);
        if let Some(before) = self.followed {
            let way = scene.world_from_floor.rotation.conjugate() * (place - before);
            let normal = self.correction.tilt * Vec3::Y;
            let along = (normal.x * way.x + normal.z * way.z) / normal.y.max(0.5);
            self.correction.shift.y -= along + way.y;
        }
        self.followed = Some(place);
        let share = 1.0 - (-scene.dt_secs / FOLLOW_SECS).exp();
        self.correction = self.correction.toward(&toward, share, share);
    }

    /// Lifts a foot that would pass through the ground.
    fn guard<T: Terrain>(
        &mut self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        secs_left: Option<f32>,
        target: &mut FootTarget,
    ) {
        let [heel, _, tip] = rocker.points(target);
        let short = [heel, tip]
            .into_iter()
            .filter_map(|point| Some(scene.ground(point)?.0 - point.y))
            .fold(0.0, f32::max)
            // What is a step's height below is a wall and not ground.
            .min(scene.config.max_step_m);
        self.guard
            .follow(short, GUARD_HALF_LIFE_SECS, scene.dt_secs);
        let share = secs_left.map_or(1.0, |secs| smooth_step(secs / COMING_DOWN_SECS));
        target.ankle.y += share * self.guard.value.max(0.0);
    }
}

/// How much of its rise a foot has behind it: one that goes up does so early, one that goes down late.
fn rising(share: f32, rises: bool) -> f32 {
    if rises {
        share / RISE_SHARE
    } else {
        (share - 1.0 + RISE_SHARE) / RISE_SHARE
    }
}
