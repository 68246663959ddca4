//! Steps that peers still have to receive, and the position error that they have without them.

use super::step::StepUpdate;
use footfall_synth::Controls;

/// Typical duration of a step, seconds, and the lateral error in one for each rad/s of turning, metres.
const STEP_SECS: f32 = 0.55;
const TURN_M: f32 = 0.4;

/// Error that each step adds if it is not sent, even with unchanged controls, metres.
const DRIFT_M: f32 = 0.02;
/// The same for coming to rest and for leaving it, metres; and for each second of rest, m/s.
const REST_M: f32 = 0.2;
const RESTING_MPS: f32 = 0.0001;

/// Expected share of lost messages, with a margin: steps with large changes are sent three times.
const LOSS: f32 = 0.1;
/// Shortest time before a step is sent again, seconds: a cause that delays or loses one packet affects the next one, too.
pub(super) const AGAIN_SECS: f32 = 0.1;
/// Errors below this are not worth a message, metres.
const LEAST_M: f32 = 0.000_4;

/// State of a row as peers know it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PendingStep {
    pub(super) name: i32,
    pub(super) look: u64,
    number: u16,
    rests: bool,
    controls: Controls,
    /// Expected error of peers, metres.
    off_m: f32,
    /// Time since the step was sent, seconds.
    since_secs: f32,
}

impl PendingStep {
    /// An unused row.
    pub(super) const NOBODY: Self = Self {
        name: -1,
        look: 0,
        number: 0,
        rests: false,
        controls: Controls::STAND,
        off_m: 0.0,
        since_secs: 0.0,
    };

    /// A walker of which nothing was sent yet.
    pub(super) const fn somebody(name: i32, look: u64) -> Self {
        Self {
            name,
            look,
            off_m: REST_M,
            since_secs: AGAIN_SECS,
            ..Self::NOBODY
        }
    }

    /// Advances the time since the last message.
    pub(super) fn pass(&mut self, secs: f32) {
        self.since_secs += secs;
        if self.rests {
            self.off_m += secs * RESTING_MPS;
        }
    }

    /// Adds the error of a step that peers do not know yet.
    pub(super) fn observe(&mut self, step: &StepUpdate) {
        if step.rests != self.rests {
            self.off_m += REST_M;
        } else if step.number != self.number {
            let speed = (step.controls.speed_mps - self.controls.speed_mps).abs();
            let turn = (step.controls.turn_rate_radps - self.controls.turn_rate_radps).abs();
            self.off_m += DRIFT_M + STEP_SECS * speed + TURN_M * turn;
        } else {
            return;
        }
        (self.number, self.rests, self.controls) = (step.number, step.rests, step.controls);
        self.since_secs = AGAIN_SECS;
    }

    /// Error that sending the step now would remove, metres; `None` if that is not worth a message.
    pub(super) fn worth(&self) -> Option<f32> {
        (self.off_m >= LEAST_M && self.since_secs >= AGAIN_SECS).then_some(self.off_m)
    }

    /// Records that the step was sent.
    pub(super) fn mark_sent(&mut self) {
        self.off_m *= LOSS;
        self.since_secs = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_synth::GroundTransform;

    fn step(number: u16, turn_rate_radps: f32) -> StepUpdate {
        StepUpdate {
            row: 0,
            turn: 0,
            number,
            age_secs: 0.0,
            controls: Controls {
                speed_mps: 1.3,
                turn_rate_radps,
                ..Controls::STAND
            },
            rests: false,
            aim: GroundTransform::default(),
        }
    }

    #[test]
    fn a_step_is_sent_twice_and_turning_walkers_come_first() {
        let mut walkers = [PendingStep::somebody(0, 0); 2];
        for walker in &mut walkers {
            walker.observe(&step(3, 0.0));
            for _ in 0..4 {
                walker.mark_sent();
            }
        }
        for (walker, turn) in walkers.iter_mut().zip([0.0, 1.0]) {
            walker.observe(&step(4, turn));
        }
        assert!(walkers[1].worth() > walkers[0].worth());
        let mut sent = 0;
        for _ in 0..20 {
            if walkers[0].worth().is_some() {
                walkers[0].mark_sent();
                sent += 1;
                assert_eq!(walkers[0].worth(), None, "not again at once");
            }
            walkers[0].pass(0.03);
        }
        assert_eq!(sent, 2);
    }
}
