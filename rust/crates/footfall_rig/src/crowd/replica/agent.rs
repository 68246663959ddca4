//! Network part of a walker: its own steps for peers, or the steps of a peer's walker.

use super::following::Following;
use super::led::Now;
use super::step::StepUpdate;
use crate::crowd::agent::Agent;
use footfall_synth::{Controls, Gait, GaitChoice, GroundTransform, LedBeginning, Workshop};
use glam::Vec2;

impl Agent {
    /// Its current step, or the place where it rests, for peers; `None` before it is made and while it shares steps.
    pub(super) fn step_update(&self, name: i32, now_secs: f64) -> Option<StepUpdate> {
        let walker = self.walker.as_ref().filter(|_| self.takes_own_steps())?;
        let rests = walker.is_standing();
        let start_from_aim = if rests {
            walker.start_from_character()
        } else {
            walker.start_from_aim()?
        };
        let aim = self.start().global(&start_from_aim);
        let secs = walker.secs_of_step() * self.size.sqrt();
        let stops = walker.comes_to_rest();
        let turn_rate_radps = self.controls.turn_rate_radps;
        let (row, turn) = StepUpdate::row_and_turn(name);
        Some(StepUpdate {
            row,
            turn,
            number: walker.number(),
            age_secs: secs + (now_secs - self.clock_secs) as f32,
            controls: if stops {
                Controls::STAND
            } else {
                Controls {
                    speed_mps: walker.speed_mps(),
                    turn_rate_radps,
                    gait: match walker.gait() {
                        Gait::Walk => GaitChoice::Walk,
                        Gait::Run => GaitChoice::Run,
                    },
                    ..Controls::STAND
                }
            },
            rests,
            aim: GroundTransform {
                position: aim.position.with_y(self.ground_m),
                ..aim
            },
        })
    }

    /// Begins to walk at its place if it follows another machine's walker and knows the place.
    pub(in crate::crowd) fn begin_led(
        &mut self,
        following: &Following,
        now_secs: f64,
        workshop: &mut Workshop,
    ) {
        if !self.led.as_ref().is_some_and(|led| led.is_waiting()) {
            return;
        }
        let now = self.now(following, now_secs, 0.0);
        let Some(led) = &mut self.led else { return };
        let lost = led.is_lost;
        let Some(due) = led.due(&now) else { return };
        let Some(mut walker) = led.walker.take().or(self.walker.take()) else {
            return;
        };
        if !lost {
            let (number, chance_position) = led.chance;
            walker.take_chance(number, chance_position);
        }
        led.is_lost = false;
        led.made = Some(due);
        let secs = now.late_secs(&due) as f32 / self.size.sqrt();
        let of_step = walker.secs_of_step() + walker.secs_to_next_step();
        walker.begin_led(
            &LedBeginning {
                number: due.number,
                share: secs / of_step,
                controls: due.controls,
                rests: due.rests || due.controls.is_standing(),
            },
            workshop,
        );
        let own = walker.start_from_aim().filter(|_| !due.rests);
        let own = own.unwrap_or_default();
        let start_from_aim = own.local(&GroundTransform::default());
        let place = due.aim.global(&GroundTransform {
            position: start_from_aim.position * self.size,
            ..start_from_aim
        });
        self.ground_m = due.aim.position.y;
        self.place = place.position.with_y(self.ground_m);
        self.heading = place.heading;
        self.walker = Some(walker);
        self.walked = GroundTransform::default();
        self.velocity = Vec2::ZERO;
        self.clock_secs = now_secs;
    }

    /// Advances its walk in the steps of another machine's walker.
    pub(in crate::crowd) fn follow(
        &mut self,
        dt_secs: f32,
        following: &Following,
        workshop: &mut Workshop,
    ) {
        let now = self.now(following, self.clock_secs, dt_secs);
        let Some(mut led) = self.led.take() else {
            return;
        };
        self.travel(dt_secs, |walker, secs| {
            let pace = 1.0 + led.haste(walker, &now) as f32;
            walker.step_led(secs * pace, workshop, |walker| led.next(walker, &now));
            led.is_lost = led.loses(walker, &now);
        });
        if let Some(made) = led.made {
            self.controls = made.controls;
            self.ground_m = made.aim.position.y;
        }
        self.led = Some(led);
    }

    fn now<'a>(&self, following: &'a Following, secs: f64, dt_secs: f32) -> Now<'a> {
        Now {
            secs,
            dt_secs,
            following,
            is_silent: following.is_silent(secs),
            start: self.start(),
        }
    }
}
