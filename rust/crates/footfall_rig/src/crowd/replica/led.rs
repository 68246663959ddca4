//! A walker that takes the steps of another machine's walker.

use super::following::Following;
use super::start::Start;
use super::step::StepUpdate;
use footfall_core::rotation::wrap_angle;
use footfall_synth::replica::{haste, next_number};
use footfall_synth::{Controls, CrowdWalker, GroundTransform, LedAim, LedStep};

/// Most steps that wait; a further one drops the oldest.
const ROOM: usize = 4;

/// Greatest distance, in steps, of a received step from the current one for a comparison of their times: without updates a walk may be whole steps ahead or late.
const NEAR_STEPS: u16 = 2;

/// Distance, in metres, and delay, in seconds, beyond which a walk begins again at its place.
const LOST_M: f32 = 5.0;
const LOST_SECS: f64 = 1.5;

/// Time after which a due step is skipped, seconds: the sender's walker is in the next one.
const OVER_SECS: f64 = 0.6;

/// Errors of a resting walker's place, in metres, and heading, in radians, that it corrects by a step, after resting for this time, seconds.
const OFF_M: f32 = 0.04;
const OFF_RAD: f32 = 0.17;
const OFF_SECS: f32 = 0.4;

/// Turn rate that makes a walker step on the spot, rad/s.
const ON_THE_SPOT_RADPS: f32 = 0.06;

/// Decay of the turn rate from one missing step to the next: turns are short.
const TURNS_ON: f32 = 0.5;

/// Error of the heading, radians, beyond which even a step that came too late turns the walk; below, it comes right with the first step in time.
const LOST_RAD: f32 = 1.5;

/// Error of the heading that one step cannot correct, radians; the walk then turns by this much more at most, rad/s, and slows down. Typical duration of a step, seconds.
const ASTRAY_RAD: f32 = 0.6;
const TURNS_BACK_RADPS: f32 = 1.3;
const STEP_SECS: f32 = 0.55;

/// A received step, on our clock.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScheduledStep {
    pub(super) number: u16,
    /// The sender's time when it began, seconds.
    at_secs: f64,
    pub(super) controls: Controls,
    pub(super) rests: bool,
    /// Place to which it leads, or at which the walker rests, in the crowd's space.
    pub(super) aim: GroundTransform,
}

/// Received steps of another machine's walker.
#[derive(Debug)]
pub(in crate::crowd) struct LedWalker {
    /// Steps that are not taken yet, in order.
    steps: [Option<ScheduledStep>; ROOM],
    /// The step that was received last, which may have been taken.
    last: Option<ScheduledStep>,
    /// The current step.
    pub(super) made: Option<ScheduledStep>,
    /// Number of a step, and the position of the random numbers in it.
    pub(super) chance: (u16, u64),
    /// The walker, until it knows where to begin.
    pub(super) walker: Option<CrowdWalker>,
    pub(super) is_lost: bool,
    /// Time since the walker came to rest, seconds.
    rested_secs: f32,
}

impl LedWalker {
    /// A walker that is not made yet, with its random numbers at this position in the step of this number.
    pub(super) fn new(number: u16, chance_position: u64) -> Self {
        Self {
            steps: [None; ROOM],
            last: None,
            made: None,
            chance: (number, chance_position),
            walker: None,
            is_lost: false,
            rested_secs: 0.0,
        }
    }

    /// Keeps a walker until its place is known.
    pub(in crate::crowd) fn wait(&mut self, walker: CrowdWalker) {
        self.walker = Some(walker);
    }

    /// The walker that waits.
    pub(in crate::crowd) fn waiting(&mut self) -> Option<&mut CrowdWalker> {
        self.walker.as_mut()
    }

    /// Returns true if the walker has to begin, or to begin again.
    pub(in crate::crowd) const fn is_waiting(&self) -> bool {
        self.walker.is_some() || self.is_lost
    }

    /// Takes a step that was sent at this time of the sender.
    pub(super) fn hear(&mut self, step: &StepUpdate, sent_secs: f64) {
        let scheduled = ScheduledStep {
            number: step.number,
            at_secs: sent_secs - f64::from(step.age_secs),
            controls: step.controls,
            rests: step.rests,
            aim: step.aim,
        };
        let Some(last) = self.last else {
            self.push(scheduled);
            return;
        };
        if scheduled.at_secs < last.at_secs && scheduled.number != last.number {
            // Overtaken by later ones.
            return;
        }
        if scheduled.number != last.number {
            self.push(scheduled);
        } else if scheduled.rests && !last.rests {
            // The step is over; a walker that has not taken it comes to rest there at once.
            self.last = Some(scheduled);
        }
    }

    fn push(&mut self, scheduled: ScheduledStep) {
        self.last = Some(scheduled);
        if self.steps[ROOM - 1].is_some() {
            self.take();
        }
        if let Some(free) = self.steps.iter_mut().find(|step| step.is_none()) {
            *free = Some(scheduled);
        }
    }

    /// The step that waits longest.
    const fn first(&self) -> Option<&ScheduledStep> {
        self.steps[0].as_ref()
    }

    fn take(&mut self) -> Option<ScheduledStep> {
        let taken = self.steps[0].take();
        self.steps.rotate_left(1);
        taken
    }

    /// The latest step that is due and not over.
    pub(super) fn due(&mut self, now: &Now<'_>) -> Option<ScheduledStep> {
        let mut due = None;
        while let Some(next) = self.first().filter(|next| now.late_secs(next) >= 0.0) {
            due = Some(*next);
            self.take();
        }
        let resting = self
            .last
            .filter(|last| last.rests && self.first().is_none());
        due.filter(|due| now.late_secs(due) < OVER_SECS).or(resting)
    }

    /// The step that follows when the current one is over.
    pub(super) fn next(&mut self, walker: &CrowdWalker, now: &Now<'_>) -> Option<LedStep> {
        if walker.comes_to_rest() {
            return self.leave_rest(walker, now);
        }
        let number = walker.number();
        let natural = self.next_number(walker, now);
        let (mut moved, mut astray_rad) = (LedAim::None, 0.0);
        while let Some(next) = self.first().copied() {
            let steps = next.number.wrapping_sub(natural).cast_signed();
            if steps > 0 {
                break;
            }
            self.made = self.take();
            if steps == 0 {
                return Some(next.step(natural, walker, now));
            }
            // It came too late to be taken: the next step corrects the walker's error.
            if steps == -1
                && let Some(own) = walker.start_from_aim()
            {
                let aim = now.start.local(&next.aim);
                astray_rad = wrap_angle(aim.heading - own.heading);
                moved = LedAim::Moved(aim.global(&own.local(&GroundTransform::default())));
            }
        }
        if let Some(made) = self.made.as_mut().filter(|made| made.number != number) {
            made.controls.turn_rate_radps *= TURNS_ON;
        }
        let stands = now.is_silent || self.last.is_some_and(|last| last.rests);
        Some(LedStep {
            number: natural,
            controls: if stands && self.first().is_none() {
                Controls::STAND
            } else {
                let made = self.made.map_or(Controls::STAND, |made| made.controls);
                if astray_rad.abs() > LOST_RAD {
                    turned_back(made, astray_rad)
                } else {
                    made
                }
            },
            aim: match self.last {
                Some(last) if last.rests && self.first().is_none() => {
                    LedAim::Rest(now.start.local(&last.aim))
                }
                _ => moved,
            },
        })
    }

    /// Number of the next step of a walk that goes on.
    fn next_number(&self, walker: &CrowdWalker, now: &Now<'_>) -> u16 {
        let natural = walker.number().wrapping_add(1);
        let Some(last) = self.last.filter(|last| !last.rests) else {
            return natural;
        };
        let own_secs = walker.secs_of_step() + walker.secs_to_next_step();
        let step_secs = f64::from(now.start.size.sqrt() * own_secs);
        next_number(natural, last.number, now.late_secs(&last) / step_secs)
    }

    /// The step with which a walker leaves its rest, if it is time.
    fn leave_rest(&mut self, walker: &CrowdWalker, now: &Now<'_>) -> Option<LedStep> {
        let natural = walker.number().wrapping_add(1);
        self.rested_secs += now.dt_secs;
        while let Some(next) = self.first().filter(|next| now.late_secs(next) >= 0.0) {
            let next = *next;
            self.made = self.take();
            if !next.controls.is_standing() {
                self.rested_secs = 0.0;
                // A standing walker can begin with either foot.
                return Some(next.step(next.number, walker, now));
            }
        }
        let resting = self
            .last
            .filter(|last| last.rests && self.first().is_none())?;
        let aim = now.start.local(&resting.aim);
        let own = walker.start_from_character();
        let turn = wrap_angle(aim.heading - own.heading);
        let far = (aim.position - own.position).with_y(0.0).length();
        if (far < OFF_M && turn.abs() < OFF_RAD) || self.rested_secs < OFF_SECS {
            return None;
        }
        self.rested_secs = 0.0;
        Some(LedStep {
            number: natural,
            controls: Controls {
                turn_rate_radps: ON_THE_SPOT_RADPS.copysign(turn),
                ..Controls::STAND
            },
            aim: LedAim::Rest(aim),
        })
    }

    /// Share by which the walk has to speed up to be in time.
    pub(super) fn haste(&self, walker: &CrowdWalker, now: &Now<'_>) -> f64 {
        if walker.is_standing() {
            return 0.0;
        }
        let passed_secs = walker.secs_of_step();
        let step_secs = passed_secs + walker.secs_to_next_step();
        let late_secs = |step: &ScheduledStep| {
            let ahead = step.number.wrapping_sub(walker.number()).cast_signed();
            let begins_secs = f32::from(ahead) * step_secs - passed_secs;
            let own_secs = now.start.size.sqrt() * begins_secs;
            (ahead.unsigned_abs() <= NEAR_STEPS).then(|| now.late_secs(step) + f64::from(own_secs))
        };
        let mut known = [self.first(), self.made.as_ref()].into_iter().flatten();
        let late_secs = known.find_map(late_secs).unwrap_or(0.0);
        haste(late_secs)
    }

    /// Returns true if a walker is too far from its place to walk there.
    pub(super) fn loses(&self, walker: &CrowdWalker, now: &Now<'_>) -> bool {
        let late = self
            .first()
            .is_some_and(|next| now.late_secs(next) > LOST_SECS);
        let off = if walker.is_standing() {
            let rests = self.last.filter(|last| last.rests);
            rests.map(|last| (last.aim, walker.start_from_character()))
        } else {
            let made = self.made.filter(|made| made.number == walker.number());
            made.zip(walker.start_from_aim())
                .map(|(made, own)| (made.aim, own))
        };
        let off = off.map_or(0.0, |(aim, own)| {
            let off = aim.position - now.start.global(&own).position;
            off.with_y(0.0).length()
        });
        late || off > LOST_M
    }
}

impl ScheduledStep {
    /// The step for the walker, under another number if the feet require one.
    fn step(&self, number: u16, walker: &CrowdWalker, now: &Now<'_>) -> LedStep {
        let aim = now.start.local(&self.aim);
        let turn = wrap_angle(aim.heading - walker.start_from_character().heading);
        let off = turn - STEP_SECS * self.controls.turn_rate_radps;
        LedStep {
            number,
            controls: turned_back(self.controls, off),
            aim: if self.rests {
                LedAim::Rest(aim)
            } else {
                LedAim::Place(aim)
            },
        }
    }
}

/// Returns the controls of a step for a walker whose heading will be off by this angle, radians.
fn turned_back(mut controls: Controls, off: f32) -> Controls {
    if off.abs() > ASTRAY_RAD && !controls.is_standing() {
        controls.turn_rate_radps += off.clamp(-TURNS_BACK_RADPS, TURNS_BACK_RADPS);
        controls.speed_mps *= (1.2 - off.abs()).clamp(0.25, 1.0);
    }
    controls
}

/// Time and place of a walker in one frame.
pub(super) struct Now<'a> {
    pub(super) secs: f64,
    pub(super) dt_secs: f32,
    pub(super) following: &'a Following,
    pub(super) is_silent: bool,
    pub(super) start: Start,
}

impl Now<'_> {
    /// Time since a step was due, seconds.
    pub(super) fn late_secs(&self, step: &ScheduledStep) -> f64 {
        self.secs - self.following.due_secs(step.at_secs)
    }
}
