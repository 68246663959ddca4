//! News of a walker that peers still have to be told: how far they would err without.

use super::step::ToldStep;
use footfall_synth::Controls;

/// Steps last about so long, seconds, and a walk turns in one by this for each rad/s, metres.
const STEP_SECS: f32 = 0.55;
const TURN_M: f32 = 0.4;

/// Steps of which nothing is told err by this more each, metres, though nothing else was asked for.
const DRIFT_M: f32 = 0.02;
/// The same for who comes to rest, or stops doing so, and for each second of rest.
const REST_M: f32 = 0.2;
const RESTING_MPS: f32 = 0.0001;

/// Share of what is told that gets lost, with a margin: steps in which much changes are told three times.
const LOSS: f32 = 0.1;
/// The same is told again no sooner: what delays or loses one packet does so to the next, seconds.
pub(super) const AGAIN_SECS: f32 = 0.1;
/// Errors below this are not worth telling, metres.
const LEAST_M: f32 = 0.000_4;

/// A row, as far as peers know it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Untold {
    pub(super) name: i32,
    pub(super) look: u64,
    number: u16,
    rests: bool,
    controls: Controls,
    /// Error to be expected of peers, metres.
    off_m: f32,
    /// Since the step was told, seconds.
    since_secs: f32,
}

impl Untold {
    /// Nobody.
    pub(super) const NOBODY: Self = Self {
        name: -1,
        look: 0,
        number: 0,
        rests: false,
        controls: Controls::STAND,
        off_m: 0.0,
        since_secs: 0.0,
    };

    /// Somebody of whom nothing was told.
    pub(super) const fn somebody(name: i32, look: u64) -> Self {
        Self {
            name,
            look,
            off_m: REST_M,
            since_secs: AGAIN_SECS,
            ..Self::NOBODY
        }
    }

    /// Lets time pass.
    pub(super) fn pass(&mut self, secs: f32) {
        self.since_secs += secs;
        if self.rests {
            self.off_m += secs * RESTING_MPS;
        }
    }

    /// Sees which step the walker is in.
    pub(super) fn look_at(&mut self, step: &ToldStep) {
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

    /// Error that telling its step now would spare, metres; nothing where that is not worth it.
    pub(super) fn worth(&self) -> Option<f32> {
        (self.off_m >= LEAST_M && self.since_secs >= AGAIN_SECS).then_some(self.off_m)
    }

    /// Its step is told.
    pub(super) fn tell(&mut self) {
        self.off_m *= LOSS;
        self.since_secs = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_synth::GroundTransform;

    fn step(number: u16, turn_rate_radps: f32) -> ToldStep {
        ToldStep {
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
    fn a_step_is_told_twice_and_who_turns_comes_first() {
        let mut walkers = [Untold::somebody(0, 0); 2];
        for walker in &mut walkers {
            walker.look_at(&step(3, 0.0));
            for _ in 0..4 {
                walker.tell();
            }
        }
        for (walker, turn) in walkers.iter_mut().zip([0.0, 1.0]) {
            walker.look_at(&step(4, turn));
        }
        assert!(walkers[1].worth() > walkers[0].worth());
        let mut told = 0;
        for _ in 0..20 {
            if walkers[0].worth().is_some() {
                walkers[0].tell();
                told += 1;
                assert_eq!(walkers[0].worth(), None, "not again at once");
            }
            walkers[0].pass(0.03);
        }
        assert_eq!(told, 2);
    }
}
