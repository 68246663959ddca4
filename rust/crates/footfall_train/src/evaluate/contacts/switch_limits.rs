//! Switches person by person, under limits that were chosen on the other people.

use super::left_out::best_without;
use super::{Agreement, ContactsError};
use footfall_motion::recording::Recording;
use footfall_motion::switches::SwitchConfig;
use serde::Serialize;
use std::collections::BTreeMap;

/// Times that are tried when a person is left out, the shipped ones first, seconds and seconds a radian.
const LANDING_SECS: [f64; 5] = [0.006, 0.003, 0.009, 0.0, 0.012];
const BEND_SECS_PER_RAD: [f64; 3] = [0.012, 0.0, 0.023];

/// Two limits of the detector of switches, as [`SwitchConfig`] has them.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SwitchLimits {
    /// Time by which a leg lands after it is stretched ahead, seconds.
    pub landing_secs: f64,
    /// Time by which it lands later for each radian that the knee bent more, seconds.
    pub bend_secs_per_rad: f64,
}

type People = BTreeMap<String, Agreement>;

/// Judges the switches of all people in the recordings; the limits are absent if no person is left out.
pub(super) fn judge(
    clips: &[Recording],
    tolerance_ms: f64,
    leave_one_out: bool,
) -> Result<BTreeMap<String, (Option<SwitchLimits>, Agreement)>, ContactsError> {
    let mut trials: Vec<(SwitchLimits, People)> = Vec::new();
    for landing_secs in LANDING_SECS {
        for bend_secs_per_rad in BEND_SECS_PER_RAD {
            if !leave_one_out && !trials.is_empty() {
                break;
            }
            let limits = SwitchLimits {
                landing_secs,
                bend_secs_per_rad,
            };
            trials.push((limits, with_limits(clips, tolerance_ms, limits)?));
        }
    }
    let names: Vec<String> = trials[0].1.keys().cloned().collect();
    let judged = names.into_iter().map(|name| {
        let best = best_without(&trials, &name, |switches| vec![switches]);
        let (limits, people) = best.unwrap_or(&trials[0]);
        let agreement = people[&name].clone();
        (name, (leave_one_out.then_some(*limits), agreement))
    });
    Ok(judged.collect())
}

fn with_limits(
    clips: &[Recording],
    tolerance_ms: f64,
    limits: SwitchLimits,
) -> Result<People, ContactsError> {
    let config = SwitchConfig {
        landing_secs: limits.landing_secs,
        bend_secs_per_rad: limits.bend_secs_per_rad,
        ..SwitchConfig::default()
    };
    let mut people = People::new();
    for clip in clips {
        let person = people.entry(clip.row.subject().to_owned()).or_default();
        person.add_switches(clip, &config, tolerance_ms)?;
    }
    people.values_mut().for_each(Agreement::summarise);
    Ok(people)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_without_trials_are_the_shipped_ones() {
        let shipped = SwitchConfig::default();
        assert_eq!(
            (LANDING_SECS[0], BEND_SECS_PER_RAD[0]),
            (shipped.landing_secs, shipped.bend_secs_per_rad)
        );
    }
}
