//! Times of samples: counters that go round, clocks of devices against ours, and times of arrival where a device sends none.

/// A counter of few bits that goes on without end.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counter {
    last: Option<u64>,
}

impl Counter {
    /// The count without wrapping, from a counter of this many bits: the one nearest to the last.
    pub fn unwrapped(&mut self, value: u64, bits: u32) -> u64 {
        let round = 1_u64 << bits;
        let value = value & (round - 1);
        let count = self.last.map_or(value, |last| {
            let ahead = value.wrapping_sub(last) & (round - 1);
            if ahead <= round / 2 {
                last.saturating_add(ahead)
            } else {
                last.saturating_sub(round - ahead)
            }
        });
        self.last = Some(count);
        count
    }
}

/// Greatest assumed difference in rate between a device's clock and ours.
const MOST_DRIFT: f64 = 2e-4;

/// An estimate follows the least delay that fast, seconds a second: slower than anyone sees, faster than clocks drift.
const FOLLOW: f64 = 2e-3;

/// A device's time that goes back, or forth beyond the time of arrival, by more than this has been set anew, seconds.
const RESET_SECS: f64 = 1.0;

/// Weight of a new delay in the mean.
const JITTER_GAIN: f64 = 0.02;

/// Maps a device's clock to ours: the delay of a sample is at least that of the quickest one, so the least difference between arrival and the
/// device's time is the offset. It is let grow slowly, since clocks drift.
#[derive(Clone, Copy, Debug, Default)]
pub struct DeviceClock {
    state: Option<DeviceClockState>,
}

#[derive(Clone, Copy, Debug)]
struct DeviceClockState {
    /// Least difference between arrival and the device's time, seconds.
    least: f64,
    /// Offset in use: it follows `least` without jumps.
    offset: f64,
    device_secs: f64,
    arrival_secs: f64,
    /// Mean delay beyond the least, seconds.
    jitter: f64,
}

impl DeviceClock {
    /// Our time of a reading: rises with the device's.
    pub fn ours(&mut self, device_secs: f64, arrival_secs: f64) -> f64 {
        let difference = arrival_secs - device_secs;
        let fresh = DeviceClockState {
            least: difference,
            offset: difference,
            device_secs,
            arrival_secs,
            jitter: 0.0,
        };
        let state = self.state.get_or_insert(fresh);
        let step = device_secs - state.device_secs;
        let waited = arrival_secs - state.arrival_secs;
        if step < -RESET_SECS || step > waited + RESET_SECS {
            *state = fresh;
            return arrival_secs;
        }
        state.least = (state.least + MOST_DRIFT * waited.max(0.0)).min(difference);
        if step > 0.0 {
            let most = FOLLOW * step;
            state.offset += (state.least - state.offset).clamp(-most, most);
            state.device_secs = device_secs;
        }
        state.arrival_secs = arrival_secs;
        state.jitter += JITTER_GAIN * (difference - state.least - state.jitter);
        device_secs + state.offset
    }

    /// Mean delay of arrival beyond the least, seconds.
    pub fn jitter_secs(&self) -> f64 {
        self.state.map_or(0.0, |state| state.jitter)
    }
}

/// Gains by which the smoothed time follows arrivals, and its period their steps.
const PHASE_GAIN: f64 = 0.05;
const PERIOD_GAIN: f64 = 0.002;

/// Steps after which the period is known well enough to be kept.
const LEARN_STEPS: u32 = 50;

/// Times of arrival further than this from what was expected begin anew, in periods and in seconds.
const LOST_PERIODS: f64 = 8.0;
const LOST_SECS: f64 = 0.25;

/// Smooths times of arrival: samples are taken at even intervals, however unevenly they come.
#[derive(Clone, Copy, Debug, Default)]
pub struct ArrivalClock {
    last_secs: Option<f64>,
    period_secs: f64,
    steps: u32,
    jitter: f64,
}

impl ArrivalClock {
    /// The smoothed time of what arrives now; it rises with every call.
    pub fn smoothed(&mut self, arrival_secs: f64) -> f64 {
        let Some(last) = self.last_secs else {
            self.last_secs = Some(arrival_secs);
            return arrival_secs;
        };
        let expected = last + self.period_secs;
        let late = arrival_secs - expected;
        if late > LOST_SECS.max(LOST_PERIODS * self.period_secs) {
            // A gap: what was learnt of the period still holds.
            self.last_secs = Some(arrival_secs);
            return arrival_secs;
        }
        let learning = self.steps < LEARN_STEPS;
        let gain = if learning {
            1.0 / f64::from(self.steps + 1)
        } else {
            PERIOD_GAIN
        };
        if learning {
            self.period_secs += gain * (arrival_secs - last - self.period_secs);
            self.steps += 1;
        } else {
            self.period_secs = (self.period_secs + gain * late).max(0.0);
        }
        self.jitter += JITTER_GAIN * (late.abs() - self.jitter);
        let time = expected + PHASE_GAIN.max(gain.min(0.5)) * late;
        let time = time.max(last + 1e-6);
        self.last_secs = Some(time);
        time
    }

    /// Mean distance between arrivals and smoothed times, seconds.
    pub const fn jitter_secs(&self) -> f64 {
        self.jitter
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn a_counter_goes_round_and_takes_late_values() {
        let mut counter = Counter::default();
        let counts: Vec<u64> = [250, 254, 3, 1, 10]
            .map(|v| counter.unwrapped(v, 8))
            .to_vec();
        assert_eq!(counts, [250, 254, 259, 257, 266]);
    }

    /// Delays of a wireless network: most are short, some are long.
    fn delay(random: &mut ChaCha8Rng) -> f64 {
        0.004 - 0.006 * (1.0 - random.random::<f64>()).ln()
    }

    #[test]
    fn a_clock_that_drifts_is_followed_through_jitter() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut clock = DeviceClock::default();
        let mut last = f64::NEG_INFINITY;
        // Ten minutes; the device's clock is an hour off and gains 50 parts in a million.
        for n in 0..60_000 {
            let truth = f64::from(n) * 0.01;
            let device = 3600.0 + truth * (1.0 + 50e-6);
            let ours = clock.ours(device, truth + delay(&mut random));
            assert!(ours > last, "time rises");
            last = ours;
            if n > 3000 {
                let off = ours - truth;
                assert!((0.003..0.008).contains(&off), "{off} s off after {truth} s");
            }
        }
        assert!(
            (clock.jitter_secs() - 0.006).abs() < 0.003,
            "{}",
            clock.jitter_secs()
        );
        // The device restarts: time goes on.
        let again = clock.ours(0.5, last + 3.0);
        assert!(again > last);
    }

    #[test]
    fn arrivals_become_even() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let mut clock = ArrivalClock::default();
        let mut arrived = 0.0_f64;
        let mut worst = 0.0_f64;
        let mut last = f64::NEG_INFINITY;
        for n in 0..20_000 {
            let truth = f64::from(n) * 0.01;
            arrived = arrived.max(truth + delay(&mut random));
            let time = clock.smoothed(arrived);
            if n > 1000 {
                worst = worst.max((time - last - 0.01).abs());
            }
            assert!(time > last);
            last = time;
        }
        assert!(worst < 0.005, "steps are off by up to {worst} s");
        // A gap of two seconds stays one.
        assert!(clock.smoothed(arrived + 2.0) - last > 1.9);
    }
}
