//! A range of speeds as it is written on the command line.

use core::fmt;
use core::ops::RangeInclusive;
use core::str::FromStr;

/// Least and greatest speed, m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Speeds {
    least: f64,
    greatest: f64,
}

impl Speeds {
    /// Runs that are neither a slow jog nor a sprint.
    pub(super) const RUNS: Self = Self {
        least: 2.5,
        greatest: 4.5,
    };

    pub(super) fn range(self) -> RangeInclusive<f64> {
        self.least..=self.greatest
    }
}

impl FromStr for Speeds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once(':').and_then(|(least, greatest)| {
            let speeds = Self {
                least: least.trim().parse().ok()?,
                greatest: greatest.trim().parse().ok()?,
            };
            let is_range = speeds.least >= 0.0 && speeds.least < speeds.greatest;
            is_range.then_some(speeds)
        });
        ends.ok_or_else(|| "write the least and the greatest speed, for example 2.5:4.5".to_owned())
    }
}

impl fmt::Display for Speeds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", self.least, self.greatest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_two_numbers_in_order() {
        assert_eq!("2.5:4.5".parse(), Ok(Speeds::RUNS));
        for text in ["", "3", "4:3", "a:b", "-1:2", "nan:3", "1:2:3"] {
            assert!(text.parse::<Speeds>().is_err(), "{text}");
        }
    }
}
