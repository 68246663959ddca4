//! The rate at which samples come, beside the one that was promised.

use super::fault::StreamFault;
use crate::checks::LEAST_RATE_HZ;

/// Time over which samples are counted, seconds.
const COUNTED_SECS: f64 = 2.0;

/// A rate that is lower or higher than the promised one by these factors is another one.
const OTHER: [f64; 2] = [0.65, 1.5];

/// Samples of one sensor, counted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// Samples a second that were promised.
    promised_hz: Option<f64>,
    /// Rate at the beginning, if none was promised.
    first_hz: Option<f64>,
    secs: f64,
    steps: u32,
    rate_hz: Option<f64>,
}

impl Pace {
    pub(super) const fn new(promised_hz: Option<f64>) -> Self {
        Self {
            promised_hz,
            first_hz: None,
            secs: 0.0,
            steps: 0,
            rate_hz: None,
        }
    }

    pub(super) const fn promised_hz(&self) -> Option<f64> {
        self.promised_hz
    }

    /// Samples do not come evenly: the count begins anew.
    pub(super) const fn pause(&mut self) {
        (self.secs, self.steps) = (0.0, 0);
    }

    pub(super) fn step(&mut self, step_secs: f64) {
        self.secs += step_secs;
        self.steps += 1;
        if self.secs < COUNTED_SECS {
            return;
        }
        let rate_hz = f64::from(self.steps) / self.secs;
        self.pause();
        self.rate_hz = Some(rate_hz);
        // A sensor without a promise that becomes quicker was set to it.
        self.first_hz = Some(self.first_hz.map_or(rate_hz, |first| first.max(rate_hz)));
    }

    pub(super) fn fault(&self) -> Option<StreamFault> {
        let rate_hz = self.rate_hz?;
        if rate_hz < LEAST_RATE_HZ {
            return Some(StreamFault::Slow {
                rate_hz: rate_hz as f32,
            });
        }
        let promised_hz = self.promised_hz.or(self.first_hz)?;
        let [less, more] = OTHER.map(|factor| factor * promised_hz);
        (!(less..more).contains(&rate_hz)).then_some(StreamFault::Pace {
            rate_hz: rate_hz as f32,
            promised_hz: promised_hz as f32,
        })
    }
}
