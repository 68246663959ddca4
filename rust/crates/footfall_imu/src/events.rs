//! Gait events of a foot that wears a sensor, from how it pitches.
//!
//! Whatever its mounting, a foot turns mostly about one level axis (`pitch.rs`). Out of rest the heel rises (the rate of pitch is positive), fastest at
//! push-off; in the swing the foot turns back; when it lands, the ground turns it down again. Terminal contact is where the rate has fallen from its
//! push-off peak to 0.7 of it, initial contact where it has risen to 0.4 of the peak that landing gives; of a foot that lands flat, where the jolt of
//! landing has risen to 0.7 of its largest. Steps that hardly pitch the foot are motion between two rests (`flat.rs`).
//!
//! Against the events of public recordings of real feet, walks with a U-turn, first and last steps included (hits within 50 ms; negative: ours is earlier):
//!
//! | recordings | contacts | events | F1 | bias, ms | spread, ms |
//! | --- | --- | --- | --- | --- | --- |
//! | ipol, subjects 1 to 4, on whom limits were chosen, 100 Hz | initial | 284 | 0.95 | 0 | 13 |
//! | the same | terminal | 284 | 0.98 | +2 | 8 |
//! | ipol, subjects 5 to 8 | initial | 296 | 0.95 | -1 | 11 |
//! | the same | terminal | 296 | 0.97 | +5 | 9 |
//! | gaitmap example, two feet, 204.8 Hz | initial | 59 | 0.99 | +19 | 9 |
//! | the same | terminal | 57 | 0.99 | +2 | 5 |
//!
//! Most of what is missed are steps on the spot. Turns on the spot that follow each other without rest, crouched walks and jumps are found less well. The two
//! references define initial contact 20 ms apart.

mod flat;
mod pitch;

use self::flat::flat_steps;
use self::pitch::pitch_rates;
use crate::filter::{frames_of, low_pass, strongest};
use crate::sample::ImuRecording;
use core::ops::Range;
use footfall_core::EventKind;
use glam::Vec3;

/// Cut-off of the low-pass filter, Hz.
const CUT_OFF_HZ: f64 = 12.0;

/// Least backward rotation of the foot in a swing, radians.
const LEAST_SWING: f32 = 0.2;

/// Push-off turns the heel up at least so fast, rad/s, within this time before the swing, seconds.
const LEAST_PUSH_RADPS: f32 = 0.5;
const PUSH_SECS: f64 = 0.25;

/// Landing turns the foot down within this time after the swing, seconds.
const STRIKE_SECS: f64 = 0.15;

/// Shares of the peaks of push-off and landing at which contact ends and begins.
const TERMINAL_SHARE: f32 = 0.7;
const INITIAL_SHARE: f32 = 0.4;

/// A foot whose landing turns it by less than this share of what is usual lands flat. Contact begins where the jolt of landing has risen to a share of its
/// largest, looked for from so long before the end of the swing to so long after it, seconds. A jolt is the change of force within a time to either side.
const FLAT_SHARE: f32 = 0.5;
const JOLT_SHARE: f32 = 0.7;
const JOLT_LEAD_SECS: f64 = 0.02;
const JOLT_SECS: f64 = 0.2;
const JOLT_REACH_SECS: f64 = 0.01;

/// Contact ends within this time after the peak of push-off, seconds: a runner's heel rises on in the air.
const TERMINAL_SECS: f64 = 0.05;

/// An event of the foot that wears the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorEvent {
    /// On the recording's clock, seconds.
    pub time_secs: f64,
    /// End of the stance that it is.
    pub kind: EventKind,
}

/// The time that a foot is off the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// Its terminal contact, on the recording's clock, seconds.
    pub terminal_secs: f64,
    /// Its next initial contact.
    pub initial_secs: f64,
}

/// Finds the swings of a foot, in order. A recording without a walk has none.
pub fn detect_swings(recording: &ImuRecording) -> Vec<Swing> {
    let rate_hz = recording.rate_hz();
    let even = recording.evenly_spaced();
    let forces: Vec<Vec3> = even.samples.iter().map(|sample| sample.force).collect();
    let rates: Vec<Vec3> = even.samples.iter().map(|sample| sample.rate).collect();
    let rates = low_pass(&rates, rate_hz, CUT_OFF_HZ);
    let pitch = pitch_rates(&forces, &rates, rate_hz);
    let jolts = jolts(&forces, rate_hz);
    let mut swings = pitched_swings(&pitch, &jolts, rate_hz);
    // One swing cannot begin before the one before it has ended.
    swings.dedup_by(|next, last| next[0] <= last[1]);
    let mut flat = flat_steps(&rates, &pitch, &jolts, &swings, rate_hz);
    swings.append(&mut flat);
    swings.sort_unstable();
    let time = |n: usize| recording.start_secs() + n as f64 / rate_hz;
    let swings = swings.into_iter().map(|[terminal, initial]| Swing {
        terminal_secs: time(terminal),
        initial_secs: time(initial),
    });
    swings.collect()
}

/// Terminal and initial contact, as samples, of the swings that show in the rate of pitch.
fn pitched_swings(pitch: &[f32], jolts: &[f32], rate_hz: f64) -> Vec<[usize; 2]> {
    let frames = |secs: f64| frames_of(secs, rate_hz);
    let back = turns_back(pitch).filter_map(|back| {
        let turned = -pitch[back.clone()].iter().sum::<f32>() / rate_hz as f32;
        let pushes = back.start.saturating_sub(frames(PUSH_SECS))..back.start + 1;
        let push = strongest(pitch, pushes);
        let strike = strongest(pitch, back.end..back.end + frames(STRIKE_SECS));
        (turned > LEAST_SWING && pitch[push] > LEAST_PUSH_RADPS).then_some((back, push, strike))
    });
    let back: Vec<_> = back.collect();
    let mut strikes: Vec<f32> = back.iter().map(|(_, _, strike)| pitch[*strike]).collect();
    strikes.sort_by(f32::total_cmp);
    let usual = strikes.get(strikes.len() / 2).copied().unwrap_or(0.0);
    let swings = back.into_iter().map(|(back, push, strike)| {
        let fallen = TERMINAL_SHARE * pitch[push];
        let latest = back.start.min(push + frames(TERMINAL_SECS));
        let terminal = (push..latest).find(|&n| pitch[n] <= fallen);
        let (first, risen, values) = if pitch[strike] < FLAT_SHARE * usual {
            let first = back.end.saturating_sub(frames(JOLT_LEAD_SECS));
            let jolt = strongest(jolts, first..back.end + frames(JOLT_SECS));
            (first, JOLT_SHARE * jolts[jolt], jolts)
        } else {
            (back.end, INITIAL_SHARE * pitch[strike], pitch)
        };
        let initial = (first..values.len()).find(|&n| values[n] >= risen);
        [terminal.unwrap_or(latest), initial.unwrap_or(strike)]
    });
    swings.collect()
}

/// Stretches in which the foot turns back, each up to where it turns forwards again.
fn turns_back(pitch: &[f32]) -> impl Iterator<Item = Range<usize>> {
    let mut from = 0;
    core::iter::from_fn(move || {
        let first = from + pitch[from..].iter().position(|rate| *rate < 0.0)?;
        from = first + pitch[first..].iter().position(|rate| *rate >= 0.0)?;
        Some(first..from)
    })
}

/// Change of the specific force around each sample.
fn jolts(forces: &[Vec3], rate_hz: f64) -> Vec<f32> {
    let reach = frames_of(JOLT_REACH_SECS, rate_hz);
    let last = forces.len().saturating_sub(1);
    let around = |n: usize| forces[(n + reach).min(last)].distance(forces[n.saturating_sub(reach)]);
    (0..forces.len()).map(around).collect()
}

/// The events of swings, in order.
pub fn events_of(swings: &[Swing]) -> Vec<SensorEvent> {
    let both = swings.iter().flat_map(|swing| {
        [
            (swing.terminal_secs, EventKind::TerminalContact),
            (swing.initial_secs, EventKind::InitialContact),
        ]
    });
    both.map(|(time_secs, kind)| SensorEvent { time_secs, kind })
        .collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::sample::{GRAVITY_MPS2, ImuSample};
    use core::f32::consts::{PI, TAU};
    use footfall_core::rotation::exp_map;
    use glam::Quat;

    /// Ten strides of a second and 1.2 m each: rest, push-off until 0.5 s, swing until 0.9 s, landing; in axes of its own.
    pub(crate) fn walk(rate_hz: f64, sensor_from_foot: Quat) -> ImuRecording {
        let bump = |time: f32, from: f32, to: f32| {
            let inside = (from..to).contains(&time);
            f32::from(u8::from(inside)) * ((time - from) / (to - from) * PI).sin().powi(2)
        };
        let mut foot_from_level = Quat::IDENTITY;
        let samples = (0..(11.0 * rate_hz) as usize).map(|n| {
            let time_secs = n as f64 / rate_hz;
            let time = time_secs.fract() as f32;
            let walks = f32::from(u8::from((0.5..10.5).contains(&time_secs)));
            let rate = 9.0 * bump(time, 0.3, 0.52) - 6.0 * bump(time, 0.5, 0.88)
                + 2.5 * bump(time, 0.86, 0.98);
            let swung = ((time - 0.5) / 0.4).clamp(0.0, 1.0);
            let forward = 1.2 * TAU * (TAU * swung).sin() / (0.4 * 0.4);
            let rate = Vec3::X * rate * walks;
            let force = Vec3::Y * GRAVITY_MPS2 + Vec3::Z * forward * walks;
            let sample = ImuSample {
                time_secs,
                force: sensor_from_foot * (foot_from_level * force),
                rate: sensor_from_foot * rate,
            };
            foot_from_level = exp_map(-rate / rate_hz as f32) * foot_from_level;
            sample
        });
        ImuRecording {
            samples: samples.collect(),
        }
    }

    #[test]
    fn swings_are_found_at_any_rate_and_in_any_mounting() {
        for rate_hz in [60.0, 100.0, 204.8] {
            for turn in [
                Vec3::ZERO,
                Vec3::new(2.0, 1.0, -0.5),
                Vec3::new(0.0, 0.0, 3.1),
            ] {
                let mut swings = detect_swings(&walk(rate_hz, Quat::from_scaled_axis(turn)));
                // The first begins and the last ends in the middle of a step.
                swings.retain(|swing| (1.0..10.0).contains(&swing.terminal_secs));
                assert_eq!(swings.len(), 9, "{rate_hz} {turn}");
                for (n, swing) in swings.iter().enumerate() {
                    let second = n as f64 + 1.0;
                    assert!(
                        (swing.terminal_secs - second - 0.46).abs() < 0.04,
                        "{swing:?}"
                    );
                    assert!(
                        (swing.initial_secs - second - 0.90).abs() < 0.04,
                        "{swing:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_way_tells_which_way_a_foot_pitches_when_its_heel_does_not() {
        // A foot that first sinks on its heel out of every rest: the votes of the heel are all wrong.
        let mut walk = walk(100.0, Quat::IDENTITY);
        for sample in &mut walk.samples {
            let time = sample.time_secs.fract() as f32;
            let sinks = f32::from(u8::from((0.05..0.25).contains(&time)));
            sample.rate.x -= 1.2 * sinks * ((time - 0.05) / 0.2 * PI).sin().powi(2);
            sample.rate.x += 2.4 * f32::from(u8::from((0.25..0.3).contains(&time)));
        }
        let swings = detect_swings(&walk);
        let seen = |second: f64| {
            let known = Swing {
                terminal_secs: second + 0.46,
                initial_secs: second + 0.90,
            };
            swings.iter().any(|swing| {
                (swing.terminal_secs - known.terminal_secs).abs() < 0.05
                    && (swing.initial_secs - known.initial_secs).abs() < 0.05
            })
        };
        assert!((1..10).all(|second| seen(f64::from(second))), "{swings:?}");
    }

    #[test]
    fn a_step_that_turns_the_foot_about_the_vertical_is_a_swing() {
        // Steps of 0.5 s, a second apart, that turn the foot by 0.8 rad and end with a jolt.
        let samples = (0..1000).map(|n| {
            let time = (n % 200) as f32 * 0.01;
            let moves = f32::from(u8::from((1.0..1.5).contains(&time)));
            let jolt = f32::from(u8::from((1.44..1.47).contains(&time)));
            ImuSample {
                time_secs: f64::from(n) * 0.01,
                force: Vec3::Y * (GRAVITY_MPS2 + 8.0 * jolt),
                rate: Vec3::Y * 3.2 * moves * ((time - 1.0) / 0.5 * PI).sin().powi(2),
            }
        });
        let recording = ImuRecording {
            samples: samples.collect(),
        };
        let swings = detect_swings(&recording);
        assert_eq!(swings.len(), 5, "{swings:?}");
        for (n, swing) in swings.iter().enumerate() {
            let start = 2.0 * n as f64 + 1.0;
            assert!(
                (swing.terminal_secs - start - 0.14).abs() < 0.08,
                "{swing:?}"
            );
            assert!(
                (swing.initial_secs - start - 0.45).abs() < 0.04,
                "{swing:?}"
            );
        }
    }

    #[test]
    fn a_foot_at_rest_has_no_events() {
        let mut still = walk(100.0, Quat::IDENTITY);
        for (n, sample) in still.samples.iter_mut().enumerate() {
            sample.rate = Vec3::splat(0.02 * (n as f32).sin());
        }
        assert!(detect_swings(&still).is_empty());
    }
}
