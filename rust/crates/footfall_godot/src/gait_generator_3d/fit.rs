//! Phase of the stride at which a walk takes over from another motion: where the two poses resemble each other most.

use super::observed_motion::ObservedMotion;
use crate::walk_source::WalkSource;
use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton};
use footfall_ik::handover::Moving;
use footfall_ik::placement::Frame;
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig, SynthError};
use glam::Vec3;

/// Interval of the compared moments of a stride, seconds, and their greatest number.
const LOOK_SECS: f32 = 1.0 / 30.0;
const MOST_LOOKS: usize = 75;
/// A difference of speed counts as the place that it makes within this time, seconds.
const SPEED_SECS: f32 = 0.12;
/// Distance that equals a contact in one motion only, metres.
const CONTACT_M: f32 = 0.15;
/// Weight of the distance of feet that stand in both motions: such a foot keeps its place, and the body has to follow.
const STANDING_WEIGHT: f32 = 4.0;
/// From standing, the foot that is lifted by then goes first, seconds.
const LIFTED_SECS: f32 = 0.4;

/// A walk, and its last two frames in the space where it began.
pub(super) struct Fitting {
    pub(super) generator: GaitGenerator,
    pub(super) seen: ObservedMotion,
}

/// Settings of the walks that are compared with a motion.
pub(super) struct Maker<'a> {
    pub(super) source: &'a WalkSource,
    pub(super) style_weights: &'a [f32],
    pub(super) body: &'a Skeleton,
    pub(super) config: GeneratorConfig,
    pub(super) controls: Controls,
}

impl Maker<'_> {
    /// A walk that begins as the motion `from`, given on the ground under the character, goes on.
    ///
    /// # Errors
    /// As [`WalkSource::generator`].
    pub(super) fn fitting(&self, from: &ObservedMotion) -> Result<Fitting, SynthError> {
        let wanted = Look::of(self.body, &from.moving(), from.dt_secs);
        let dt_secs = from.dt_secs.max(1e-3);
        let mut standing = self.standing(self.config.phase)?;
        let at_rest = walked(&mut standing, &Controls::STAND, dt_secs);
        let mut least = wanted.distance(&Look::of(self.body, &at_rest.moving(), dt_secs));
        let mut best = None;
        if !self.controls.is_standing() {
            let mut walk = self.walking()?;
            let mut seen = walked(&mut walk, &self.controls, dt_secs);
            let mut footsteps = 0;
            for look in 1..=MOST_LOOKS {
                let place = Frame::from(walk.start_from_character());
                let now = seen.relative_to(&place, 1.0);
                let distance = wanted.distance(&Look::of(self.body, &now.moving(), seen.dt_secs));
                if distance < least {
                    least = distance;
                    best = Some(look);
                }
                one_step(&mut walk, &self.controls, LOOK_SECS, &mut seen);
                footsteps += walk.footsteps().len();
                if footsteps > 2 {
                    break;
                }
            }
        }
        let Some(best) = best else {
            let generator = self.standing(self.first_phase(from)?)?;
            return Ok(Fitting {
                generator,
                seen: at_rest,
            });
        };
        let mut generator = self.walking()?;
        let mut seen = walked(&mut generator, &self.controls, dt_secs);
        for look in 1..best {
            // The last frame is as long as those of the motion before.
            let rest = if look + 1 == best {
                dt_secs.min(LOOK_SECS)
            } else {
                0.0
            };
            one_step(&mut generator, &self.controls, LOOK_SECS - rest, &mut seen);
            if rest > 0.0 {
                one_step(&mut generator, &self.controls, rest, &mut seen);
            }
        }
        Ok(Fitting { generator, seen })
    }

    fn walking(&self) -> Result<GaitGenerator, SynthError> {
        self.source
            .generator(self.style_weights, self.body, &self.config)
    }

    fn standing(&self, phase: f32) -> Result<GaitGenerator, SynthError> {
        let config = GeneratorConfig {
            phase,
            ..self.config
        };
        let mut generator = self
            .source
            .generator(self.style_weights, self.body, &config)?;
        generator.stand();
        Ok(generator)
    }

    /// Phase from which a standing person starts with the foot that is farther behind.
    fn first_phase(&self, from: &ObservedMotion) -> Result<f32, SynthError> {
        if self.controls.is_standing() {
            return Ok(self.config.phase);
        }
        let [left, right] = Look::of(self.body, &from.moving(), 0.0).feet;
        let behind = if left.z < right.z {
            Side::Left
        } else {
            Side::Right
        };
        let mut generator = self.standing(self.config.phase)?;
        let mut pose = Pose::default();
        generator.step(LIFTED_SECS, &self.controls, &mut pose);
        let lifted = !generator.feet_in_contact()[behind.index()];
        Ok(if lifted {
            self.config.phase
        } else {
            (self.config.phase + 0.5).rem_euclid(1.0)
        })
    }
}

/// Features of a motion by which it is compared with moments of a stride.
struct Look {
    /// Ankles, from the hips over the ground, and heights over it.
    feet: [Vec3; 2],
    speeds: [Vec3; 2],
    stands: [bool; 2],
    hips_m: f32,
    hips_mps: Vec3,
}

impl Look {
    fn of(body: &Skeleton, moving: &Moving<'_>, dt_secs: f32) -> Self {
        let models = [moving.before, moving.now].map(|pose| ModelPose::of(body, pose));
        let [before, now] = &models;
        let speed = |joint: Joint| {
            let way = now.position(joint) - before.position(joint);
            if dt_secs > 0.0 {
                way / dt_secs
            } else {
                Vec3::ZERO
            }
        };
        let hips = now.position(Joint::Hips);
        Self {
            feet: Side::BOTH.map(|side| now.position(side.foot()) - Vec3::new(hips.x, 0.0, hips.z)),
            speeds: Side::BOTH.map(|side| speed(side.foot())),
            stands: moving.stands,
            hips_m: hips.y,
            hips_mps: speed(Joint::Hips),
        }
    }

    /// Square metres.
    fn distance(&self, other: &Self) -> f32 {
        let feet: f32 = (0..2)
            .map(|side| {
                let place = self.feet[side].distance_squared(other.feet[side]);
                let speed = self.speeds[side].distance(other.speeds[side]) * SPEED_SECS;
                let differs = match (self.stands[side], other.stands[side]) {
                    (true, true) => STANDING_WEIGHT * place,
                    (false, false) => place,
                    _ => place + CONTACT_M.powi(2),
                };
                differs + speed.powi(2)
            })
            .sum();
        let hips = self.hips_m - other.hips_m;
        let speed = self.hips_mps.distance(other.hips_mps) * SPEED_SECS;
        feet + hips.powi(2) + speed.powi(2)
    }
}

/// The first two frames of a walk.
fn walked(generator: &mut GaitGenerator, controls: &Controls, dt_secs: f32) -> ObservedMotion {
    let mut seen = ObservedMotion::default();
    one_step(generator, controls, 0.0, &mut seen);
    one_step(generator, controls, dt_secs, &mut seen);
    seen
}

/// One frame of a walk, in the space where it began.
fn one_step(
    generator: &mut GaitGenerator,
    controls: &Controls,
    dt_secs: f32,
    seen: &mut ObservedMotion,
) {
    let mut pose = Pose::default();
    generator.step(dt_secs, controls, &mut pose);
    super::observed_motion::raise(&Frame::from(generator.start_from_character()), &mut pose);
    seen.observe(&pose, generator.feet_in_contact(), dt_secs);
}
