//! Ownership of the skeleton: by the walk, by other animation, or in transition.

use super::GaitGenerator3D;
use super::session::WalkSession;
use crate::root_motion::frame_clock;
use crate::travel::Travel;
use footfall_synth::{Controls, GaitChoice};
use glam::Vec3;
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// Distance between hips and walk beyond which the character is moved to its hips, metres: a ragdoll lies where it fell.
const FAR_M: f32 = 0.4;
/// Longest transition, seconds.
const MOST_SECS: f64 = 10.0;
/// Time of the transition of a walk that was measured again, seconds.
const RESIZE_SECS: f64 = 0.3;

/// Owner of the skeleton.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Ownership {
    #[default]
    Walking,
    /// Other animation fades in.
    Leaving,
    /// Other animation poses the skeleton.
    Away,
}

/// Requests that have not begun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Request {
    TakeOver(f64),
    HandOver(f64),
}

#[godot_api(secondary)]
impl GaitGenerator3D {
    /// Starts to walk from the current pose and speed of the skeleton: after an attack, a landing, a ragdoll. The walk begins at
    /// the best matching side and phase of the stride, or with a first step if the body stands. Feet on the ground stay there until
    /// they lift. The difference between the two motions fades out in `seconds`; then `taken_over` is emitted.
    ///
    /// Call it after `hand_over()`, so that the node knows the body's speed; otherwise it first observes the skeleton for two frames. A
    /// `PhysicalBoneSimulator3D` must be above this node under the skeleton; the character then moves to where the body fell.
    #[func]
    fn take_over(&mut self, seconds: f64) {
        if self.ownership == Ownership::Walking {
            self.ownership = Ownership::Away;
            if let Some(session) = &mut self.session {
                session.watched = super::watch::Watch::default();
            }
        }
        self.request = Some(Request::TakeOver(within_reason(seconds)));
    }

    /// Gives the skeleton to other animation, such as an `AnimationPlayer`: its pose fades in within `seconds`, the character comes
    /// to rest, and feet on the ground stay in place, or take a step if the animation has them elsewhere, which may take half a
    /// second more. Then `handed_over` is emitted, and the node does nothing until `take_over()`.
    ///
    /// With 0 seconds it does nothing from the next frame on.
    #[func]
    fn hand_over(&mut self, seconds: f64) {
        self.request = match self.ownership {
            Ownership::Walking => Some(Request::HandOver(within_reason(seconds))),
            Ownership::Leaving | Ownership::Away => None,
        };
    }

    /// Returns `true` while other animation has the skeleton: after `hand_over()`, until `take_over()`.
    #[func]
    fn is_handed_over(&self) -> bool {
        self.ownership == Ownership::Away
    }
}

impl GaitGenerator3D {
    /// Carries out a request as soon as the motion is known.
    pub(super) fn fulfil(
        &mut self,
        session: &mut WalkSession,
        skeleton: &Gd<Skeleton3D>,
        dt_secs: f64,
    ) -> Result<(), String> {
        match (self.ownership, self.request) {
            (Ownership::Away, request) => {
                // Only frames before this one count: a ragdoll may just have been switched off.
                if let Some(Request::TakeOver(secs)) = request
                    && session.watched.in_world.is_known()
                {
                    self.begin(session, secs)?;
                } else {
                    session.watch(skeleton, dt_secs as f32);
                }
            }
            (Ownership::Leaving, Some(Request::TakeOver(secs))) => {
                session.leaving = None;
                let from = session.shown_here();
                self.go_on(session, &from, secs)?;
            }
            (Ownership::Walking, Some(Request::HandOver(secs))) => {
                session.watch(skeleton, dt_secs as f32);
                if secs <= 0.0 || !session.shown.is_known() {
                    session.handover = None;
                    self.ownership = Ownership::Away;
                    self.request = None;
                    self.announced.left = true;
                } else if session.watched.in_world.is_known() {
                    session.leave(secs, self.velocity.0, self.velocity.1);
                    self.ownership = Ownership::Leaving;
                    self.request = None;
                }
            }
            (Ownership::Walking, _) if session.has_new_size() => self.resize(session, skeleton)?,
            _ => {}
        }
        Ok(())
    }

    /// Remembers how fast the character goes.
    pub(super) fn remember_velocity(&mut self, travel: &Travel, dt_secs: f64) {
        if dt_secs > 0.0 {
            self.velocity = travel.per_second(dt_secs as f32);
        }
    }

    /// Time passes while other animation poses the skeleton.
    pub(super) fn rest(&mut self, session: WalkSession) {
        self.session = Some(session);
        self.travelled.add(Transform3D::IDENTITY, frame_clock());
        self.velocity = (Vec3::ZERO, 0.0);
        if core::mem::take(&mut self.announced.left) {
            self.signals().handed_over().emit();
        }
    }

    fn begin(&mut self, session: &mut WalkSession, secs: f64) -> Result<(), String> {
        let hips = session.watched_here().hips();
        let away = Vec3::new(hips.x, 0.0, hips.z) * session.traveller.scale();
        if self.root_motion && away.length() > FAR_M {
            let _released = self.base_mut();
            session.traveller.shift(away);
        }
        let from = session.watched_here();
        self.go_on(session, &from, secs)
    }

    fn go_on(
        &mut self,
        session: &mut WalkSession,
        from: &super::observed_motion::ObservedMotion,
        secs: f64,
    ) -> Result<(), String> {
        self.ownership = Ownership::Walking;
        self.request = None;
        let (config, controls) = (self.config(), self.controls());
        let weights = self.style_weights.as_slice();
        session.go_on_from(from, weights, &config, controls, secs)?;
        session.watched = super::watch::Watch::default();
        Ok(())
    }

    /// Measures a character that has grown, and walks on.
    fn resize(
        &mut self,
        session: &mut WalkSession,
        skeleton: &Gd<Skeleton3D>,
    ) -> Result<(), String> {
        let shown = session.shown.is_known().then(|| session.shown_here());
        let mut grown = self.new_session(skeleton)?;
        if let Some(shown) = shown {
            self.go_on(&mut grown, &shown, RESIZE_SECS)?;
        }
        *session = grown;
        Ok(())
    }

    /// The controls that a walk follows now.
    pub(super) fn controls(&self) -> Controls {
        if self.replica.is_led() {
            // Until the first update of its walker.
            return Controls::STAND;
        }
        Controls {
            speed_mps: self.speed as f32 * self.slowed,
            turn_rate_radps: self.turn_rate as f32,
            direction_rad: self.direction as f32,
            gait: if self.climbs {
                GaitChoice::Walk
            } else {
                self.gait.into()
            },
            crouch: self.crouch as f32,
        }
    }
}

fn within_reason(seconds: f64) -> f64 {
    if seconds.is_finite() {
        seconds.clamp(0.0, MOST_SECS)
    } else {
        0.0
    }
}
