//! Clock: from the sender's time to ours, with a delay that hides late and lost updates.

/// Unit of a sender's time, seconds.
pub(super) const TICK_SECS: f64 = 0.004;

/// Rate at which a slower sender's clock is followed, seconds per second.
const DRIFT: f64 = 0.01;

/// Delay behind the quickest update: this many intervals between updates, so that three may be lost, plus this multiple of their mean lateness: twice the mean is the most where frames are long.
const INTERVALS: f64 = 3.2;
const LATENESSES: f64 = 2.0;
const MARGIN_SECS: [f64; 2] = [0.03, 0.5];

/// Interval between updates before any is known, and the longest that counts, seconds.
const INTERVAL_SECS: f64 = 0.05;
const LONGEST_SECS: f64 = 0.25;

/// Weight of a new value.
const NEWS: f64 = 0.05;

/// Largest relative change of tempo to stay in time, and time in which a delay is made up for, seconds.
const MOST_HASTE: f64 = 0.12;
const IN_TIME_SECS: f64 = 0.4;

/// Lead from which a walk slows down further, seconds, and by how much at most: it ends its steps before it has heard of them, elsewhere than a sender whose machine stood still.
const LEAD_SECS: f64 = 0.1;
const MOST_WAIT: f64 = 0.2;

/// Silence after which any time counts as later, seconds: half of the range of the ticks.
pub(super) const HALF_ROUND_SECS: f64 = 120.0;

/// Returns the relative increase of tempo that brings a walk in time that is this late, seconds; negative for one that is ahead.
pub fn haste(late_secs: f64) -> f64 {
    let wait = ((late_secs + LEAD_SECS) / IN_TIME_SECS).clamp(-MOST_WAIT, 0.0);
    (late_secs / IN_TIME_SECS).clamp(-MOST_HASTE, MOST_HASTE) + wait
}

/// Sender's time and ours.
///
/// A sender sends its time in [ticks](Self::ticks) of 4 ms, which wrap.
#[derive(Clone, Copy, Debug)]
pub struct ReplicaClock {
    heard: Option<Heard>,
    interval_secs: f64,
    lateness_secs: f64,
}

/// Time of the last update.
#[derive(Clone, Copy, Debug)]
struct Heard {
    ticks: u16,
    sent_secs: f64,
    at_secs: f64,
    /// Our time less the sender's, for the quickest updates.
    offset_secs: f64,
}

impl Default for ReplicaClock {
    fn default() -> Self {
        Self::new()
    }
}

impl ReplicaClock {
    /// Creates a clock without updates.
    pub const fn new() -> Self {
        Self {
            heard: None,
            interval_secs: INTERVAL_SECS,
            lateness_secs: 0.0,
        }
    }

    /// Returns a sender's time, seconds, in ticks.
    pub fn ticks(secs: f64) -> u16 {
        (secs / TICK_SECS) as u64 as u16
    }

    /// Registers an update that arrives at `now_secs` of our time; returns the sender's time, seconds. An update overtaken by later ones does not change the clock.
    pub fn hear(&mut self, now_secs: f64, ticks: u16) -> f64 {
        let Some(last) = self.heard else {
            self.heard = Some(Heard {
                ticks,
                sent_secs: 0.0,
                at_secs: now_secs,
                offset_secs: now_secs,
            });
            return 0.0;
        };
        let ahead = ticks.wrapping_sub(last.ticks);
        if ahead.cast_signed() <= 0 && now_secs - last.at_secs < HALF_ROUND_SECS {
            return last.sent_secs + f64::from(ahead.cast_signed()) * TICK_SECS;
        }
        let passed = f64::from(ahead) * TICK_SECS;
        let sent_secs = last.sent_secs + passed;
        let sample = now_secs - sent_secs;
        let drifted = last.offset_secs + DRIFT * (now_secs - last.at_secs).max(0.0);
        let offset_secs = sample.min(drifted);
        let late = sample - offset_secs;
        if late > LONGEST_SECS {
            // The sender or its clock was paused: a new time begins.
            self.heard = Some(Heard {
                ticks,
                sent_secs,
                at_secs: now_secs,
                offset_secs: sample,
            });
            return sent_secs;
        }
        self.lateness_secs += NEWS * (late - self.lateness_secs);
        self.interval_secs += NEWS * (passed.min(LONGEST_SECS) - self.interval_secs);
        self.heard = Some(Heard {
            ticks,
            sent_secs,
            at_secs: now_secs,
            offset_secs,
        });
        sent_secs
    }

    /// Returns our time at which an event of the sender's time is due.
    pub fn due_secs(&self, sent_secs: f64) -> f64 {
        let margin = INTERVALS * self.interval_secs + LATENESSES * self.lateness_secs;
        let [least, most] = MARGIN_SECS;
        let offset = self.heard.map_or(0.0, |heard| heard.offset_secs);
        sent_secs + offset + margin.clamp(least, most)
    }

    /// Returns our time at which the quickest update about an event of the sender's time arrives.
    pub fn quickest_secs(&self, sent_secs: f64) -> f64 {
        sent_secs + self.heard.map_or(0.0, |heard| heard.offset_secs)
    }

    /// Returns the time since the last update, seconds.
    pub fn silent_secs(&self, now_secs: f64) -> f64 {
        self.heard.map_or(0.0, |heard| now_secs - heard.at_secs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delay_is_that_of_the_quickest_update_and_a_margin() {
        let mut clock = ReplicaClock::new();
        let mut sent = 0.0;
        for n in 0..600_u32 {
            let late = f64::from(n % 5) * 0.01;
            let ticks = (50_000 + n * 12) as u16;
            sent = clock.hear(f64::from(n) * 12.0 * TICK_SECS + 0.2 + late, ticks);
        }
        // The first update set zero.
        let first = 0.2;
        let delay = clock.due_secs(sent) - (sent + first);
        assert!((0.1..0.2).contains(&delay), "{delay} s");
    }

    #[test]
    fn what_is_overtaken_was_sent_before() {
        let mut clock = ReplicaClock::new();
        clock.hear(0.0, 100);
        let sent = clock.hear(0.05, 112);
        assert!((clock.hear(0.06, 109) - (sent - 3.0 * TICK_SECS)).abs() < 1e-9);
        assert!((clock.hear(0.1, 124) - (sent + 12.0 * TICK_SECS)).abs() < 1e-9);
    }

    #[test]
    fn a_time_that_wraps_goes_on() {
        let mut clock = ReplicaClock::new();
        clock.hear(0.0, 65_530);
        let sent = clock.hear(0.05, 6);
        assert!((sent - 12.0 * TICK_SECS).abs() < 1e-9, "{sent}");
    }
}
