//! Jumps and pushes of a character, and the signals of a flight.

use super::GaitGenerator3D;
use super::session::WalkSession;
use crate::convert;
use footfall_core::Side;
use footfall_synth::JumpPhase;
use glam::{Vec2, Vec3};
use godot::prelude::*;

/// Mass of a body, kilograms.
const BODY_KG: f32 = 70.0;

/// Events of a jump within a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Flight {
    pub(super) took_off: bool,
    pub(super) landed: bool,
}

impl Flight {
    /// Events of a frame before which the body was in this phase of a jump.
    pub(super) fn between(before: Option<JumpPhase>, now: Option<JumpPhase>) -> Self {
        let [flew, flies] = [before, now].map(|phase| phase == Some(JumpPhase::Flight));
        Self {
            took_off: flies && !flew,
            landed: flew && !flies,
        }
    }
}

#[godot_api(secondary)]
impl GaitGenerator3D {
    /// Requests one jump in which the hips rise by `height` metres; 0.1 to 0.5 is typical of adults.
    ///
    /// A standing character jumps off both feet. One that walks or runs forwards leaps with the next step, off one foot onto the other. One that goes sideways
    /// or backwards stops first. The body bends its knees; `took_off` is emitted as it leaves the ground and `landed` as it returns. The root motion of a
    /// two-footed jump moves the character up and down; a leap lifts the body above the character. Further requests while a jump is
    /// pending or under way have no effect.
    ///
    /// Returns `true` if the character will jump. It will not before the first frame of the walk, with a model without jumps (any `.footdyn`, and
    /// `.footfall` files trained without `footfall train --jumping`), or for an invalid height.
    #[func]
    fn jump(&mut self, height: f64) -> bool {
        self.with_session(|session| {
            let scale = session.traveller.scale();
            session.generator.jump(height as f32 / scale)
        })
    }

    /// Requests one jump that lands at `position`, in global space: onto a wall, over a gap, down from a ledge. The character does not turn: face the place before the jump. The
    /// jump is as high as its distance requires.
    ///
    /// A character that walks or runs forwards towards a level place leaps there without stopping, off one foot onto the other, as soon as it is near enough: the foot lands on the
    /// place, along the way. It stops first, and jumps off both feet, if the place is nearer than about 0.6 s or farther than 4 s of its way, more than 0.15 m higher or lower, or more than 0.35 m beside
    /// its way, and if it goes sideways or backwards.
    ///
    /// A place beyond the reach of a two-footed jump (about twice the leg length ahead, two thirds of it to the side or back, and six tenths of it up) is not
    /// reached; the jump goes as far as it can in that direction. Returns `true` if the character will jump, as `jump()` does.
    #[func]
    fn jump_to(&mut self, position: Vector3) -> bool {
        self.with_session(|session| {
            let ground = session.traveller.world_from_ground();
            let from_ground = convert::vec3(position) - ground.position;
            let place: Vec3 = ground.rotation.inverse() * from_ground;
            session.generator.jump_to(place / session.traveller.scale())
        })
    }

    /// Pushes the character by an impulse in newton seconds, in global space; only its horizontal part counts. The body's mass is 70 kg: 20 make it sway over
    /// its feet, 60 take a step or two, and more than 140 count as 140.
    ///
    /// The character then stands again or continues as controlled. In a two-footed jump, before the first frame of the walk and with a `.footdyn` model
    /// a push has no effect.
    #[func]
    fn push(&mut self, impulse: Vector3) {
        if let Some(session) = &mut self.session
            && !self.replica.is_led()
        {
            let ground = session.traveller.world_from_ground();
            let way = ground.rotation.inverse() * convert::vec3(impulse);
            let velocity = Vec2::new(way.x, way.z) / (BODY_KG * session.traveller.scale());
            session.generator.push(velocity);
        }
    }

    fn with_session(&mut self, ask: impl FnOnce(&mut WalkSession) -> bool) -> bool {
        let session = self.session.as_mut();
        session.filter(|_| !self.replica.is_led()).is_some_and(ask)
    }

    /// Emits what became of a jump.
    pub(super) fn emit_flight(&mut self, flight: Flight, footsteps: &[(Side, Vector3)]) {
        if flight.took_off {
            self.signals().took_off().emit();
        }
        if flight.landed {
            for (side, _) in footsteps {
                let foot = StringName::from(side.name());
                self.signals().landed().emit(&foot);
            }
        }
    }
}
