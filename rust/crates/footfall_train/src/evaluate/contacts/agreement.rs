//! Agreement of two lists of events in time.

use super::ContactsError;
use footfall_core::{EventKind, Side};
use footfall_motion::recording::Recording;
use footfall_motion::switches::{SwitchConfig, detect_switches_by};
use footfall_prob::switching::median;
use serde::Serialize;

/// Events nearer to an end than this are left out, seconds.
const EDGE_SECS: f64 = 0.1;

/// Agreement of found events with known ones.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Agreement {
    /// Number of recordings.
    pub recordings: usize,
    /// Events of the reference.
    pub known: usize,
    /// Events of what is judged.
    pub found: usize,
    /// Known events with a found one within the tolerance.
    pub matched: usize,
    /// Harmonic mean of the matched shares of known and of found events.
    pub f1: f64,
    /// Mean of found less known time over matched events.
    pub bias_ms: f64,
    /// Median of the same.
    pub median_ms: f64,
    /// Standard deviation of the same.
    pub spread_ms: f64,
    #[serde(skip)]
    delays_ms: Vec<f64>,
}

impl Agreement {
    /// Adds the switches of a recording against its initial contacts.
    pub(super) fn add_switches(
        &mut self,
        recording: &Recording,
        config: &SwitchConfig,
        tolerance_ms: f64,
    ) -> Result<(), ContactsError> {
        let motion = &recording.retargeted;
        let rate = motion.clip.frame_rate_hz;
        let secs = |frame: usize| frame as f64 / rate;
        let (first, last) = (secs(motion.first_frame), secs(motion.clip.poses.len() - 1));
        let inside = |time: &f64| (first + EDGE_SECS..=last - EDGE_SECS).contains(time);
        let switches = detect_switches_by(&motion.clip, motion.first_frame, config)
            .map_err(|error| ContactsError::file(&recording.row.path, error))?;
        let events = recording.contacts.events();
        self.recordings += 1;
        for side in Side::BOTH {
            let known = events
                .iter()
                .filter(|e| e.side == side && e.kind == EventKind::InitialContact)
                .map(|event| secs(event.frame))
                .filter(inside);
            let found = switches
                .iter()
                .filter(|switch| switch.side == side)
                .map(|switch| secs(switch.frame))
                .filter(inside);
            self.add(known.collect(), found.collect(), tolerance_ms);
        }
        Ok(())
    }

    /// Matches times, in seconds: every known one to the nearest found one that is left.
    pub(super) fn add(&mut self, known: Vec<f64>, mut found: Vec<f64>, tolerance_ms: f64) {
        self.known += known.len();
        self.found += found.len();
        for time in known {
            let nearest = (0..found.len()).min_by(|a, b| {
                let [a, b] = [found[*a], found[*b]].map(|found| (found - time).abs());
                a.total_cmp(&b)
            });
            if let Some(index) = nearest {
                let delay_ms = 1000.0 * (found[index] - time);
                if delay_ms.abs() <= tolerance_ms {
                    found.remove(index);
                    self.delays_ms.push(delay_ms);
                }
            }
        }
    }

    /// Works out the figures of all events that were added.
    pub(super) fn summarise(&mut self) {
        self.matched = self.delays_ms.len();
        let count = self.matched.max(1) as f64;
        self.f1 = 2.0 * self.matched as f64 / (self.known + self.found).max(1) as f64;
        self.bias_ms = self.delays_ms.iter().sum::<f64>() / count;
        self.median_ms = median(&self.delays_ms);
        let squares = self.delays_ms.iter().map(|d| (d - self.bias_ms).powi(2));
        self.spread_ms = (squares.sum::<f64>() / count).sqrt();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_known_event_takes_the_nearest_found_one_once() {
        let mut agreement = Agreement::default();
        let found = vec![1.01, 1.02, 2.03, 4.02, 9.0];
        agreement.add(vec![1.0, 2.0, 3.0, 4.0], found, 33.4);
        agreement.summarise();
        assert_eq!(
            (agreement.known, agreement.found, agreement.matched),
            (4, 5, 3)
        );
        let figures = [
            (agreement.f1, 6.0 / 9.0),
            (agreement.bias_ms, 20.0),
            (agreement.median_ms, 20.0),
            (agreement.spread_ms, (200.0_f64 / 3.0).sqrt()),
        ];
        for (figure, truth) in figures {
            assert!((figure - truth).abs() < 1e-6, "{agreement:?}");
        }
    }
}
