//! Strangeness of a wearer: mean squared distance of what sensors measure from what they measured on the people in the model.
//!
//! People in the model, and those who move like them, are shown as they were recorded. A sensor predicts less of a stranger, so that the mean of several people is closer.
//! Means over walks, a simulated sensor, [`KNOWN`] chosen between the first two rows and the third:
//!
//! | | right foot | right thigh |
//! | --- | --- | --- |
//! | CMU's 16 and 35, other recordings of them in the model | 0.4 to 1.1 | 0.4 to 2.2 |
//! | the same people left out: they resemble each other | 0.4 to 1.7 | 0.5 to 2.3 |
//! | Bandai's set 1, neutral | 3.6 | 2.5 |
//! | CMU's 8, other recordings in the model; left out | 0.8 to 2.4; 1.8 to 4.4 | 1.2 to 2.5; 1.9 to 3.2 |
//! | Bandai's set 2, neutral | 2.6 to 3.3 | 2.3 to 3.3 |

use footfall_core::ease::smooth_step;

/// Mean squared distance, in deviations of the model, up to which the wearer moves like one of the people in the model, and from which on like none of them.
const KNOWN: [f32; 2] = [1.2, 2.5];

/// Mean before anything is measured: a stranger's.
const UNKNOWN: f32 = 4.0;

/// Time for which that mean counts, seconds of motion.
const UNKNOWN_SECS: f32 = 0.1;

/// Longest time constant of the mean, seconds of motion.
const MEAN_SECS: f32 = 6.0;

/// Strangeness of a wearer, from the first frame of motion on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strangeness {
    mean: f32,
    moved_secs: f32,
}

impl Strangeness {
    /// A stranger.
    pub(crate) const UNKNOWN: Self = Self {
        mean: UNKNOWN,
        moved_secs: 0.0,
    };

    /// Adds a frame with its squared distance; `moved_secs` is the time in it in which the body moved: standing is the same for all people.
    pub(crate) fn step(&mut self, distance: f32, moved_secs: f32) {
        self.moved_secs += moved_secs;
        let counted_secs = (self.moved_secs + UNKNOWN_SECS).min(MEAN_SECS);
        self.mean += moved_secs / counted_secs * (distance - self.mean);
    }

    /// Strangeness of the wearer: 0 for one of the people in the model, 1 for a person who moves like none of them.
    pub(crate) fn share(self) -> f32 {
        smooth_step((self.mean - KNOWN[0]) / (KNOWN[1] - KNOWN[0]))
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::float_cmp, reason = "both ends of the range are exact")]

    use super::*;

    const FRAME_SECS: f32 = 1.0 / 30.0;

    fn after(strangeness: &mut Strangeness, distance: f32, secs: f32) -> f32 {
        for _ in 0..(secs / FRAME_SECS) as usize {
            strangeness.step(distance, FRAME_SECS);
        }
        strangeness.share()
    }

    #[test]
    fn a_wearer_is_a_stranger_until_a_walk_tells_otherwise() {
        let mut wearer = Strangeness::UNKNOWN;
        assert_eq!(wearer.share(), 1.0);
        wearer.step(0.0, 0.0);
        assert_eq!(wearer.share(), 1.0, "standing is no evidence");
        assert_eq!(after(&mut wearer, 0.6, 3.0), 0.0);
        // A stumble is no other wearer; a walk of some seconds is.
        assert!(after(&mut wearer, 5.0, 0.3) < 0.1);
        assert_eq!(after(&mut wearer, 5.0, 6.0), 1.0);
    }
}
