//! Place of the pelvis when the next foot lands.

use crate::leg::reach_height;
use crate::placement::FootPlacer;
use crate::placement::carry::{EASY_EXTENSION, Moment};
use crate::placement::correction::Correction;
use crate::placement::foot::Mode;
use crate::placement::frame::Frame;
use crate::placement::landings::Landing;
use crate::placement::pelvis::plane_height;
use crate::placement::terrain::Terrain;
use footfall_core::ease::smooth_step;
use glam::{Quat, Vec3};

/// Pitch of the foot behind, from which people push off as the other lands on a higher tread, radians, and the rises at which they begin to and do so
/// fully, metres.
const PUSH_OFF: f32 = 0.42;
const PUSH_RISE_M: [f32; 2] = [0.05, 0.15];
/// Height by which the heel of the foot behind rises further than on level ground when the other lands higher on a slope, as a share of that rise, and at
/// most, metres: so much of the leg's length keeps the hips as high over the slope in the middle of stance as over level ground.
const HEEL_SHARE: f32 = 0.5;
const MOST_HEEL_M: f32 = 0.05;
/// Height by which hips that go down a slope are above the even way in the middle of a step, as a share of its fall, and at most, as a share of the
/// leg: people stand on a leg that is little bent and come down late. On stairs they bend it at once.
const BOW_SHARE: f32 = 0.4;
const MOST_BOW: f32 = 0.028;
/// Time after a landing in which such a way begins, seconds.
const BOW_BEGINS_SECS: f32 = 0.1;
/// Typical duration of a step of a walk, and the least time over which its rise is spread, seconds.
const STEP_SECS: f32 = 0.6;
const LEAST_STEP_SECS: f32 = 0.2;
/// Shortest step of a run whose length gives a grade, metres, and the least time until its landing, seconds.
const SHORT_STEP_M: f32 = 0.2;
const LEAST_FLIGHT_SECS: f32 = 0.05;
/// Farthest place of the hips on the way from one foothold of a run to the next, as a part of it.
const FARTHEST: f32 = 1.2;

/// Place of the pelvis at a landing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// Above the animation's floor, metres, and how fast it rises then, m/s.
    pub(super) offset_m: f32,
    pub(super) rise_mps: f32,
    /// Height by which the way there is bowed up in its middle, metres.
    pub(super) bow_m: f32,
    pub(super) secs: f32,
}

impl FootPlacer {
    /// Place of the pelvis at the next landing, for an animation that knows it.
    pub(super) fn arrival(
        &self,
        moment: &Moment<'_>,
        terrain: &mut impl Terrain,
        hips_rotation: Quat,
    ) -> Option<Arrival> {
        let (input, animated) = (moment.input, moment.animated);
        let floor = input.world_from_floor;
        let index = input.landings.iter().position(Option::is_some)?;
        let landing = input.landings[index]?;
        let plan = self.feet[index].plan?;
        let sole = floor.local(&plan.foothold.world_from_sole(terrain)?);
        let other = 1 - index;
        let standing = &self.feet[other];
        let pitch = plan.foothold.on_ball.then_some(plan.foothold.pitch);
        let reach = |leg: usize, flat: &Frame, correction: &Correction, pitch: Option<f32>| {
            let ankle = landing.ankles[leg];
            let hip = hips_rotation * self.hips_from_hip[leg];
            let limit = |ankle: Vec3| {
                let length = self.leg_lengths[leg];
                reach_height(landing.hips, hip, ankle, length, EASY_EXTENSION)
                    .map_or(0.0, |height| height - landing.hips.y)
            };
            // In a landing on the ball of the foot the ankle is above the flat sole.
            let above = pitch.map_or(ankle - flat.position, |pitch| {
                let rocker = &self.rockers[leg];
                Vec3::Y * rocker.ankle_height() + flat.rotation * rocker.roll(pitch)
            });
            let real = flat.position + correction.shift + correction.tilt * above;
            // What the leg lacks on the animation's own floor is the animation's affair.
            limit(real) - limit(ankle).min(0.0)
        };
        let lands = Correction::between(&landing.flat, &sole);
        let reached = reach(index, &landing.flat, &lands, pitch);
        if standing.mode != Mode::Locked || self.is_off(other, &landing) {
            let from = floor.local_point(self.stood_at?);
            let (height, rise_mps) = over_the_way(from, sole.position, plan.next_rise_m, &landing);
            return Some(Arrival {
                offset_m: height.min(reached),
                rise_mps,
                bow_m: 0.0,
                secs: landing.secs,
            });
        }
        let plane = |sole: &Frame| plane_height(sole.position, sole.up(), landing.hips);
        let between = 0.5 * (plane(&sole) + plane(&standing.sole));
        let rise = sole.position.y - standing.sole.position.y;
        let stays_at = |pitch| reach(other, &animated[other].flat, &standing.correction, pitch);
        let mut stays = stays_at(None);
        let mut bow_m = 0.0;
        if plan.foothold.on_ball {
            let [least, most] = PUSH_RISE_M;
            let push = PUSH_OFF * smooth_step((rise - least) / (most - least));
            stays = stays.max(stays_at(Some(push)));
        } else {
            stays += (HEEL_SHARE * rise).clamp(0.0, MOST_HEEL_M);
            if standing.swing_secs < BOW_BEGINS_SECS {
                bow_m = (BOW_SHARE * -rise).clamp(0.0, MOST_BOW * self.leg_lengths[other]);
            }
        }
        let offset_m = between.min(reached).min(stays);
        let floor_height = floor.position.dot(floor.up());
        let secs = landing.secs.max(LEAST_STEP_SECS);
        // It passes a landing at the pace of the way there and of that to come, and turns where they differ.
        let coming = 0.5 * (rise + plan.next_rise_m) / STEP_SECS;
        let going = (floor_height + offset_m - self.pelvis.value) / secs;
        let rise_mps = if coming * going > 0.0 {
            coming.signum() * coming.abs().min(going.abs())
        } else {
            0.0
        };
        Some(Arrival {
            offset_m,
            rise_mps,
            bow_m,
            secs: landing.secs,
        })
    }

    /// Returns true when a foot no longer stands when the other lands, as in a run: no heel of a standing foot lifts its ankle so high.
    pub(super) fn is_off(&self, index: usize, landing: &Landing) -> bool {
        landing.ankles[index].y > self.highest_ankles_m[index]
    }
}

/// Height of the ground's line from one foothold of a run to the next under the hips of a landing, and how fast the line rises under them, m/s.
///
/// The planes of the footholds say nothing here: the hips are up to a metre away from the first.
fn over_the_way(from: Vec3, to: Vec3, next_rise_m: f32, landing: &Landing) -> (f32, f32) {
    let way = (to - from).with_y(0.0);
    let length = way.length().max(SHORT_STEP_M);
    let rise = to.y - from.y;
    let passed = (landing.hips - from).dot(way) / (length * length);
    let speed = landing.hips.with_y(0.0).length() / landing.secs.max(LEAST_FLIGHT_SECS);
    let grade = 0.5 * (rise + next_rise_m) / length;
    (from.y + passed.clamp(0.0, FARTHEST) * rise, grade * speed)
}
