//! Random numbers and the ways in which recordings begin and end.

use footfall_prob::duration::DurationDist;
use footfall_prob::hsmm::{Boundary, Edge};

/// A small deterministic generator (`SplitMix64`), so that tests need no random crate.
pub(crate) struct Rng(pub(crate) u64);

impl Rng {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    pub(crate) fn duration(&mut self, dist: &DurationDist) -> usize {
        let mut left = self.uniform();
        for d in 1..=dist.max_duration() {
            left -= dist.log_pmf(d).exp();
            if left < 0.0 {
                return d;
            }
        }
        dist.max_duration()
    }
}

pub(crate) const BOUNDARIES: [Boundary; 4] = [
    Boundary {
        start: Edge::Complete,
        end: Edge::Complete,
    },
    Boundary {
        start: Edge::Complete,
        end: Edge::Censored,
    },
    Boundary {
        start: Edge::Censored,
        end: Edge::Complete,
    },
    Boundary {
        start: Edge::Censored,
        end: Edge::Censored,
    },
];
