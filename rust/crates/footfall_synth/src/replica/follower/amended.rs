//! Changes of the step that is made: what the sender was asked for in its middle, and jumps.

use super::WalkFollower;
use crate::generator::GaitGenerator;
use crate::moves::Leap;
use crate::replica::update::WalkUpdate;
use footfall_core::GroundTransform;

/// A step that was heard of late is planned anew when it ends so far from where it should, metres.
const LATE_OFF_M: f32 = 0.03;

impl WalkFollower {
    /// Takes up what the sender was asked for in the middle of the step that is made.
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
            if steps > 0 || !walks || (steps == 0 && share < next.planned.share()) {
                break;
            }
            self.made = self.queue.take();
            let replanned = generator.replan_led(next.planned, &next.controls, (before, false));
            if replanned && steps == 0 {
                generator.aim_at(&next.aim(shared_from_start));
            }
        }
        self.amend(generator, shared_from_start);
    }

    /// Plans the step that is made anew where it leads elsewhere than it should: it was heard of late, or what came between was lost.
    fn amend(&mut self, generator: &mut GaitGenerator, shared_from_start: &GroundTransform) {
        let (number, _) = generator.progress();
        let made = self.made.filter(|made| made.planned.number == number);
        let Some(made) = made.filter(|made| self.amended != Some(made.planned)) else {
            return;
        };
        let aim = made.aim(shared_from_start);
        let off = generator.off(&aim).way.length() > LATE_OFF_M;
        if off && generator.replan_led(made.planned, &made.controls, (f32::INFINITY, true)) {
            generator.aim_at(&aim);
            self.amended = Some(made.planned);
        }
    }

    /// Jumps when the sender does, who stands.
    pub(super) fn jump(
        &mut self,
        heard: &WalkUpdate,
        generator: &mut GaitGenerator,
        shared_from_start: &GroundTransform,
    ) {
        let jumps = heard.rests && heard.rise_m > 0.0;
        if jumps && !self.jumped && generator.is_standing() {
            let lands = shared_from_start.local(&heard.aim).position;
            generator.request_jump(Leap {
                rise_m: heard.rise_m,
                way: generator
                    .start_from_character()
                    .local(&GroundTransform {
                        position: lands,
                        heading: 0.0,
                    })
                    .position,
            });
        }
        self.jumped = jumps && (self.jumped || generator.is_standing());
    }
}
