//! Guided calibration: stand for two seconds, then take four steps.
//!
//! Standing gives the errors of the sensor, steps give its mounting. The guide holds the next request to the wearer. The owner of the body passes it the samples and looks for
//! the mounting when it [requests it](CalibrationGuide::wants_mounting).

use footfall_imu::ImuSample;

/// Time to stand, seconds.
const STAND_SECS: f32 = 2.0;

/// Time after which a wearer who does not stand is asked to walk, seconds.
const PATIENCE_SECS: f32 = 6.0;

/// Angular rate below which the sensor stands, and above which it moves, rad/s.
const STANDS_RADPS: f32 = 0.3;
const MOVES_RADPS: f32 = 0.5;

/// Time of movement in four steps, seconds; the mounting is looked for then, and after as much again.
const WALK_SECS: f32 = 2.0;

/// Certainty of a mounting that counts as found.
const CERTAIN: f32 = 0.8;

/// Time between samples that counts as a pause, seconds.
const PAUSE_SECS: f64 = 0.5;

/// Request to the wearer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GuideStep {
    /// Switch on the sensor.
    #[default]
    Connect,
    /// Stand.
    Stand,
    /// Walk four steps.
    Walk,
    /// Walk on: the steps did not determine the mounting.
    WalkOn,
    /// Anything.
    Done,
}

impl GuideStep {
    /// Name for scripts, for example `stand`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Connect => "connect",
            Self::Stand => "stand",
            Self::Walk => "walk",
            Self::WalkOn => "walk_on",
            Self::Done => "done",
        }
    }

    /// Message for the wearer.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Connect => "Switch the sensor on and connect it",
            Self::Stand => "Stand still for two seconds",
            Self::Walk => "Walk four steps straight ahead",
            Self::WalkOn => "Walk a few more steps straight ahead: the mounting is not known yet",
            Self::Done => "Calibrated: move as you like",
        }
    }
}

/// Guides a wearer through the calibration of one sensor.
#[derive(Clone, Copy, Debug, Default)]
pub struct CalibrationGuide {
    step: GuideStep,
    last_secs: Option<f64>,
    stood_secs: f32,
    waited_secs: f32,
    walked_secs: f32,
    /// Movement after which the mounting was looked for last, seconds.
    looked_secs: f32,
    looks: bool,
}

impl CalibrationGuide {
    /// Current request to the wearer.
    pub const fn step(&self) -> GuideStep {
        self.step
    }

    /// Progress of this step, 0 to 1.
    pub fn progress(&self) -> f32 {
        match self.step {
            GuideStep::Connect => 0.0,
            GuideStep::Stand => (self.stood_secs / STAND_SECS).min(1.0),
            GuideStep::Walk | GuideStep::WalkOn => {
                ((self.walked_secs - self.looked_secs) / WALK_SECS).min(1.0)
            }
            GuideStep::Done => 1.0,
        }
    }

    /// Takes a sample in the sensor's axes.
    pub fn push(&mut self, sample: &ImuSample) {
        if !sample.is_finite() {
            return;
        }
        let last = self.last_secs.replace(sample.time_secs);
        let step_secs = last.map_or(0.0, |last| sample.time_secs - last);
        if !(0.0..PAUSE_SECS).contains(&step_secs) {
            return;
        }
        let dt_secs = step_secs as f32;
        let turns = sample.rate.length();
        match self.step {
            GuideStep::Connect => self.enter(GuideStep::Stand),
            GuideStep::Stand => {
                self.waited_secs += dt_secs;
                self.stood_secs = if turns < STANDS_RADPS {
                    self.stood_secs + dt_secs
                } else {
                    0.0
                };
                if self.stood_secs > STAND_SECS || self.waited_secs > PATIENCE_SECS {
                    self.enter(GuideStep::Walk);
                }
            }
            GuideStep::Walk | GuideStep::WalkOn => {
                if turns > MOVES_RADPS {
                    self.walked_secs += dt_secs;
                }
                if self.walked_secs - self.looked_secs > WALK_SECS {
                    self.looks = true;
                }
            }
            GuideStep::Done => {}
        }
    }

    fn enter(&mut self, step: GuideStep) {
        *self = Self {
            step,
            last_secs: self.last_secs,
            ..Self::default()
        };
    }

    /// Returns true when enough steps were taken to look for the mounting; it stays so until [`found`](Self::found) is called.
    pub const fn wants_mounting(&self) -> bool {
        self.looks
    }

    /// Takes what was found: how certain the mounting is, 0 where none was found.
    pub fn found(&mut self, certainty: f32) {
        if certainty >= CERTAIN {
            self.enter(GuideStep::Done);
        } else if self.looks {
            (self.step, self.looks) = (GuideStep::WalkOn, false);
            self.looked_secs = self.walked_secs;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const DT_SECS: f64 = 0.01;

    /// Runs the guide for a time with a sensor of this angular rate; returns the time at which the step changed.
    fn go(guide: &mut CalibrationGuide, now: &mut f64, secs: f64, radps: f32) -> Option<f64> {
        let begin = (*now, guide.step());
        while *now < begin.0 + secs {
            *now += DT_SECS;
            guide.push(&ImuSample {
                time_secs: *now,
                force: Vec3::Y,
                rate: Vec3::X * radps,
            });
            if guide.step() != begin.1 || guide.wants_mounting() {
                return Some(*now - begin.0);
            }
        }
        None
    }

    #[test]
    fn standing_and_four_steps_take_five_seconds() {
        let (mut guide, mut now) = (CalibrationGuide::default(), 0.0);
        assert_eq!(guide.step().name(), "connect");
        go(&mut guide, &mut now, 0.1, 0.0);
        assert_eq!(guide.step(), GuideStep::Stand);
        assert_eq!(go(&mut guide, &mut now, 1.5, 0.02), None, "not long enough");
        assert!(
            (guide.progress() - 0.75).abs() < 0.02,
            "{}",
            guide.progress()
        );
        go(&mut guide, &mut now, 0.6, 0.02);
        assert_eq!(guide.step(), GuideStep::Walk);
        assert!(guide.step().message().contains("four steps"));
        assert!(go(&mut guide, &mut now, 3.0, 2.0).is_some());
        assert!(guide.wants_mounting() && now < 5.0, "{now} s");
        guide.found(0.95);
        assert_eq!(
            (guide.step(), guide.wants_mounting()),
            (GuideStep::Done, false)
        );
        assert!(guide.progress() >= 1.0);
        assert_eq!(go(&mut guide, &mut now, 5.0, 2.0), None, "it is over");
    }

    #[test]
    fn who_does_not_stand_is_not_held_up_and_who_is_not_understood_walks_on() {
        let (mut guide, mut now) = (CalibrationGuide::default(), 0.0);
        go(&mut guide, &mut now, 0.1, 2.0);
        let waited = go(&mut guide, &mut now, 8.0, 2.0);
        assert!(
            waited.is_some_and(|secs| (secs - 6.0).abs() < 0.1),
            "{waited:?}"
        );
        assert_eq!(
            go(&mut guide, &mut now, 5.0, 0.1),
            None,
            "standing is no walk"
        );
        go(&mut guide, &mut now, 3.0, 2.0);
        guide.found(0.4);
        assert_eq!(
            (guide.step(), guide.wants_mounting()),
            (GuideStep::WalkOn, false)
        );
        assert!(guide.progress() < 0.05);
        go(&mut guide, &mut now, 3.0, 2.0);
        assert!(guide.wants_mounting());
        guide.found(0.0);
        assert_eq!(guide.step(), GuideStep::WalkOn);
        guide.found(0.9);
        assert_eq!(
            guide.step(),
            GuideStep::Done,
            "a later look may find it, too"
        );
    }

    #[test]
    fn fidgeting_begins_the_two_seconds_anew_and_nonsense_counts_for_nothing() {
        let (mut guide, mut now) = (CalibrationGuide::default(), 0.0);
        go(&mut guide, &mut now, 0.1, 0.0);
        go(&mut guide, &mut now, 1.8, 0.0);
        go(&mut guide, &mut now, 0.1, 1.0);
        assert_eq!(go(&mut guide, &mut now, 1.8, 0.0), None);
        for time_secs in [f64::NAN, 0.0, 1e9] {
            guide.push(&ImuSample {
                time_secs,
                force: Vec3::Y,
                rate: Vec3::ZERO,
            });
        }
        assert_eq!(guide.step(), GuideStep::Stand);
    }
}
