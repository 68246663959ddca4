//! Changes of the current step: replanning as by the sender, and jumps.

use super::WalkFollower;
use crate::generator::GaitGenerator;
use crate::replica::update::WalkUpdate;
use footfall_core::GroundTransform;

/// Error of the end from which a step received late is replanned, metres.
const LATE_OFF_M: f32 = 0.03;

impl WalkFollower {
    /// Applies the sender's new controls in the middle of the current step.
    pub(super) fn obey(
        &mut self,
        generator: &mut GaitGenerator,
        shared_from_start: &GroundTransform,
        before: f32,
    ) {
        while let Some(next) = self.queue.next().copied() {
            let (number, share) = generator.progress();
            let steps = next.planned.steps_from(number);
            let walks = !generator.is_standing();
            if steps > 0 || !walks || (steps == 0 && next.planned.is_after(share)) {
                break;
            }
            self.made = self.queue.take();
            let replanned = generator.replan_led(&next, (before, false));
            if replanned && steps == 0 {
                generator.aim_at(&next.aim(shared_from_start));
            }
        }
        self.amend(generator, shared_from_start);
    }

    /// Replans the current step if its end is wrong because an update was late or lost.
    fn amend(&mut self, generator: &mut GaitGenerator, shared_from_start: &GroundTransform) {
        let (number, _) = generator.progress();
        let made = self.made.filter(|made| made.planned.number == number);
        let Some(made) = made.filter(|made| self.amended != Some(made.planned)) else {
            return;
        };
        let aim = made.aim(shared_from_start);
        let off = generator.off(&aim).way.length() > LATE_OFF_M;
        if off && generator.replan_led(&made, (f32::INFINITY, true)) {
            generator.aim_at(&aim);
            self.amended = Some(made.planned);
        }
    }

    /// Jumps when the standing sender does.
    pub(super) fn jump(
        &mut self,
        heard: &WalkUpdate,
        generator: &mut GaitGenerator,
        shared_from_start: &GroundTransform,
    ) {
        let jumps = heard.rests && heard.rise_m > 0.0;
        if jumps && !self.jumped && generator.is_standing() {
            let lands = shared_from_start.local(&heard.aim).position;
            generator.request_jump(Some(heard.rise_m), Some(generator.seen_from_start(lands)));
        }
        self.jumped = jumps && (self.jumped || generator.is_standing());
    }
}
