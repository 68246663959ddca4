//! The behaviour that is shown: one that is sure enough, and none for less than a moment.

use footfall_core::Behaviour;

/// No behaviour is shown for a shorter time, seconds.
pub(crate) const LEAST_SHOWN_SECS: f32 = 0.2;

/// A behaviour that is shown, and for how long it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShownBehaviour {
    behaviour: Behaviour,
    shown_secs: f32,
}

impl ShownBehaviour {
    /// Standing, which may end at once.
    pub(crate) const fn new() -> Self {
        Self {
            behaviour: Behaviour::Stand,
            shown_secs: LEAST_SHOWN_SECS,
        }
    }

    pub(crate) const fn behaviour(self) -> Behaviour {
        self.behaviour
    }

    /// Goes on by a frame to these probabilities, in the order of [`Behaviour::ALL`].
    pub(crate) fn step(
        &mut self,
        probabilities: &[f32; Behaviour::ALL.len()],
        needed: f32,
        dt_secs: f32,
    ) -> Behaviour {
        self.shown_secs += dt_secs;
        let likely = Behaviour::ALL
            .into_iter()
            .find(|behaviour| probabilities[behaviour.index()] > needed);
        // Times are sums of frames.
        if let Some(likely) = likely.filter(|likely| *likely != self.behaviour)
            && self.shown_secs > LEAST_SHOWN_SECS - 1e-4
        {
            (self.behaviour, self.shown_secs) = (likely, 0.0);
        }
        self.behaviour
    }
}

/// Merges runs of fewer frames than this with the run before them, or after them at the beginning.
pub(crate) fn drop_short_runs(behaviours: &mut [Behaviour], least: usize) {
    let mut first = 0;
    while let Some(&own) = behaviours.get(first) {
        let run = behaviours[first..].iter().take_while(|b| **b == own);
        let end = first + run.count();
        let other = match first.checked_sub(1) {
            Some(before) => Some(behaviours[before]),
            None => behaviours.get(end).copied(),
        };
        if let Some(other) = other.filter(|_| end - first < least) {
            behaviours[first..end].fill(other);
        }
        first = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sure(of: Behaviour) -> [f32; Behaviour::ALL.len()] {
        let mut probabilities = [0.05; Behaviour::ALL.len()];
        probabilities[of.index()] = 0.75;
        probabilities
    }

    #[test]
    fn nothing_is_shown_for_a_moment_only() {
        use Behaviour::{Jump, Stand, Walk};
        let mut shown = ShownBehaviour::new();
        let likely = [Walk, Jump, Walk, Walk, Jump, Jump, Stand, Stand, Stand];
        let frames = likely.map(|behaviour| shown.step(&sure(behaviour), 0.6, 0.0667));
        let expected = [Walk, Walk, Walk, Walk, Jump, Jump, Jump, Stand, Stand];
        assert_eq!(frames, expected);
        assert_eq!(shown.step(&[0.3; 6], 0.6, 1.0), Stand);
    }

    #[test]
    fn short_runs_of_a_recording_are_given_away() {
        use Behaviour::{Hop, Jump, Stand, Walk};
        let mut found = [Hop, Walk, Walk, Walk, Jump, Jump, Walk, Stand, Stand, Stand];
        drop_short_runs(&mut found, 3);
        let expected = [
            Walk, Walk, Walk, Walk, Walk, Walk, Walk, Stand, Stand, Stand,
        ];
        assert_eq!(found, expected);
        let mut whole = [Jump; 2];
        drop_short_runs(&mut whole, 3);
        assert_eq!(whole, [Jump; 2]);
    }
}
