//! A walk whose character is out of the tree for a while.

use super::GaitGenerator3D;
use super::session::WalkSession;
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// State that goes on when the character comes back.
pub(super) struct Absent {
    skeleton: InstanceId,
    pub(super) elapsed_secs: f64,
    pub(super) state: Vec<u8>,
}

/// Requests that wait for the next frame.
#[derive(Default)]
pub(super) struct Pending {
    /// The time of the walk to go to, seconds.
    pub(super) seek: Option<f64>,
    /// A state that the next walk goes on from.
    pub(super) state: Option<PackedByteArray>,
}

impl GaitGenerator3D {
    /// Begins a walk by another model or in other styles.
    pub(super) fn renew(&mut self) {
        self.source = None;
        self.restart();
    }

    /// Puts the walk aside: nodes around it change, and who travels is asked anew.
    pub(super) fn put_aside(&mut self) {
        self.announced.problem = None;
        if let Some(session) = self.session.take() {
            self.absent = Some(Absent {
                skeleton: session.traveller.skeleton(),
                elapsed_secs: session.elapsed_secs,
                state: session.generator.state(),
            });
        }
    }

    /// Goes on with the walk that was put aside, if this is the skeleton that walked it.
    pub(super) fn resume(&mut self, session: &mut WalkSession, skeleton: &Gd<Skeleton3D>) {
        if let Some(absent) = self.absent.take()
            && absent.skeleton == skeleton.instance_id()
            // A model that was replaced meanwhile walks anew.
            && session.restore(&absent.state).is_ok()
        {
            session.elapsed_secs = absent.elapsed_secs;
        }
    }
}
