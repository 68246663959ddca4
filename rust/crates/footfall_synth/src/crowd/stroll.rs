//! Walk in shared steps: the current step, its progress, and the place.

use super::frames::{CrowdPose, POSE_NUMBERS};
use super::shared::{Course, Kind, PEOPLE, SPOT, STAND, STEP_POSES, SharedSteps, nearest_speed};
use crate::controls::{Controls, FASTEST_RUN_MPS};
use crate::footstep::Footstep;
use crate::gait::{Gait, STOPPABLE_MPS};
use footfall_core::ease::smooth_step;
use footfall_core::rotation::{from_heading, wrap_angle};
use footfall_core::{GroundTransform, Side};
use glam::{Vec2, Vec3};

/// Time in which a walk stops, seconds.
const STOP_SECS: f32 = 0.4;
/// Bounds of the factor on the tempo of a shared step.
const PACES: [f32; 2] = [0.85, 1.15];
/// Resolution of the weight of the previous speed, limited by half floats.
const LEAVING_PARTS: f32 = 64.0;

/// Place of a walker among shared steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroll {
    /// Place where the step began.
    pub(super) start: GroundTransform,
    /// Turn from there to its end, radians.
    turn: f32,
    /// Share of the step that has passed.
    share: f32,
    /// Factor on the tempo of the step.
    pace: f32,
    /// Time since it stopped, and the part of it with standing motion, seconds.
    stood_secs: f32,
    rest_secs: f32,
    person: u8,
    side: Side,
    /// Indices of the speeds at the end and the beginning of the step.
    speed: u8,
    from: u8,
}

/// Pose among the shared ones of a [`StyledBody`](super::StyledBody): a blend of two consecutive poses, and of the same two at another speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SharedPose {
    /// Index of the first of the two.
    pub pose: u32,
    /// Weight of the second one.
    pub blend: f32,
    /// Offset to the same two poses of the previous speed, in steps of nine poses each.
    pub beside: i8,
    /// Weight of the previous speed, in 64ths, below 1.
    pub leaving: f32,
}

impl Stroll {
    /// Begins a walk at this speed, in this phase of the stride.
    pub(super) fn new(seed: u64, speed_mps: f32, phase: f32) -> Self {
        let halves = 2.0 * phase.rem_euclid(1.0);
        let mut stroll = Self {
            start: GroundTransform::default(),
            turn: 0.0,
            share: halves.fract(),
            pace: 1.0,
            stood_secs: 0.0,
            rest_secs: 0.0,
            person: (seed % PEOPLE as u64) as u8,
            side: if halves < 1.0 {
                Side::Left
            } else {
                Side::Right
            },
            speed: 0,
            from: 0,
        };
        stroll.go_at(speed_mps);
        stroll
    }

    /// Begins standing, with this foot as the last that landed.
    pub(super) fn standing(seed: u64, phase: f32) -> Self {
        Self {
            speed: STAND as u8,
            from: STAND as u8,
            share: 1.0,
            ..Self::new(seed, 0.0, phase)
        }
    }

    /// Begins at the end of an own step: its place, the foot that began it, and its speed; `None` for a walker that has stopped.
    pub(super) fn after(
        seed: u64,
        end: &GroundTransform,
        (side, speed_mps): (Side, Option<f32>),
        steps: &SharedSteps,
    ) -> Self {
        let mut stroll = speed_mps.map_or_else(
            || Self::standing(seed, 0.0),
            |speed_mps| Self::new(seed, speed_mps, 0.0),
        );
        stroll.side = side;
        stroll.share = 1.0;
        if let Some(speed_mps) = speed_mps {
            stroll.keep_pace(speed_mps, steps);
        }
        stroll.be_at(end, steps);
        stroll
    }

    /// Moves the walk to this place.
    pub(super) fn be_at(&mut self, place: &GroundTransform, steps: &SharedSteps) {
        self.start = GroundTransform {
            position: Vec3::ZERO,
            ..*place
        };
        self.start.position = place.position - self.place(steps).position;
    }

    /// Adapts the tempo of the step to this speed, within the bounds.
    fn keep_pace(&mut self, speed_mps: f32, steps: &SharedSteps) {
        let course = steps.course(self.ending());
        self.pace = if usize::from(self.speed) > SPOT {
            (speed_mps / course.speed_mps.max(1e-3)).clamp(PACES[0], PACES[1])
        } else {
            1.0
        };
    }

    fn go_at(&mut self, speed_mps: f32) {
        self.speed = nearest_speed(speed_mps) as u8;
        self.from = self.speed;
    }

    fn kind(&self, speed: u8) -> Kind {
        Kind {
            person: self.person,
            side: self.side,
            speed,
        }
    }

    /// Returns the first shared pose of the current step.
    pub(super) fn first_pose(&self) -> usize {
        self.kind(self.from).first_pose()
    }

    /// Returns the shared step at whose end the walker is, or will be.
    pub(super) fn ending(&self) -> Kind {
        self.kind(self.speed)
    }

    fn courses<'a>(&self, steps: &'a SharedSteps) -> [&'a Course; 2] {
        [self.from, self.speed].map(|speed| steps.course(self.kind(speed)))
    }

    /// Returns the duration of the step, seconds.
    fn secs(&self, steps: &SharedSteps) -> f32 {
        let [from, to] = self.courses(steps);
        if usize::from(self.speed) == STAND {
            STOP_SECS
        } else if usize::from(self.from) == STAND {
            to.secs / self.pace
        } else {
            0.5 * (from.secs + to.secs) / self.pace
        }
    }

    /// Returns true when the walker has stopped.
    pub(super) fn is_standing(&self) -> bool {
        usize::from(self.speed) == STAND && self.share >= 1.0
    }

    pub(super) fn secs_to_next_step(&self, steps: &SharedSteps) -> f32 {
        (1.0 - self.share).max(0.0) * self.secs(steps)
    }

    pub(super) fn secs_of_step(&self, steps: &SharedSteps) -> f32 {
        self.share.min(1.0) * self.secs(steps)
    }

    pub(super) fn phase(&self) -> f32 {
        (0.5 * (self.side.index() as f32 + self.share.min(1.0))).fract()
    }

    pub(super) fn rest_secs(&self) -> f32 {
        self.rest_secs
    }

    /// Returns the weight of the fading own pose, in the first step or while standing for this long.
    pub(super) fn leaving(&self, stand_secs: f32) -> f32 {
        let passed = if self.is_standing() {
            self.stood_secs / stand_secs
        } else {
            self.share
        };
        1.0 - smooth_step(passed)
    }

    /// Advances within the step; returns the remaining time after its end, seconds.
    pub(super) fn pass(&mut self, dt_secs: f32, lives: bool, steps: &SharedSteps) -> Option<f32> {
        if self.is_standing() {
            self.stood_secs += dt_secs;
            self.rest_secs = if lives { self.rest_secs + dt_secs } else { 0.0 };
            return Some(0.0);
        }
        let secs = self.secs(steps);
        self.share += dt_secs / secs;
        (self.share >= 1.0).then(|| {
            let left = (self.share - 1.0) * secs;
            self.share = 1.0;
            left
        })
    }

    /// Begins the next step at the end of this one; returns its initial contact. `None` if the walker stays standing.
    pub(super) fn next(&mut self, controls: Controls, steps: &SharedSteps) -> Option<Footstep> {
        let stands = usize::from(self.speed) == STAND;
        if stands && controls.is_standing() {
            return None;
        }
        let now = steps.course(self.kind(self.speed)).speed_mps * self.pace;
        let wanted = controls.speed();
        let slows = now > STOPPABLE_MPS;
        let (speed, speed_mps) = if controls.is_standing() && !slows {
            (STAND, 0.0)
        } else {
            let speed_mps = if stands {
                wanted.min(STOPPABLE_MPS)
            } else {
                let gait = if now > STOPPABLE_MPS {
                    Gait::Run
                } else {
                    Gait::Walk
                };
                let most = gait.most_change_mps(false);
                now + (wanted - now).clamp(-most, most)
            };
            (nearest_speed(speed_mps), speed_mps.min(FASTEST_RUN_MPS))
        };
        self.start = self.place(steps);
        self.side = self.side.other();
        self.from = self.speed;
        self.speed = speed as u8;
        self.share = 0.0;
        (self.rest_secs, self.stood_secs) = (0.0, 0.0);
        self.keep_pace(speed_mps, steps);
        self.turn = controls.turn_rate() * self.secs(steps);
        if usize::from(self.speed) == STAND {
            self.turn = 0.0;
        }
        let landing = steps.course(self.kind(self.from)).landing?;
        let place = self.start.global(&GroundTransform {
            position: landing.position,
            heading: landing.heading,
        });
        Some(Footstep {
            position: place.position,
            heading: place.heading,
            ..landing
        })
    }

    /// Returns the place and heading relative to the start.
    pub(super) fn place(&self, steps: &SharedSteps) -> GroundTransform {
        let share = self.share.min(1.0);
        let [from, to] = self.courses(steps);
        let along = if self.from == self.speed {
            to.place_at(share)
        } else {
            // The speed changes smoothly.
            let gone_over = share * share * share * (1.0 - 0.5 * share);
            let [from, to] = [from, to].map(|course| course.places[STEP_POSES - 1]);
            from * (share - gone_over) + to * gone_over
        };
        // The step as a whole goes in the direction of the middle of its turn.
        let middle = from_heading(self.start.heading + 0.5 * self.turn);
        GroundTransform {
            position: self.start.position + middle * Vec3::new(along.x, 0.0, along.y),
            heading: wrap_angle(self.start.heading + self.turn * share),
        }
    }

    pub(super) fn contacts(&self, steps: &SharedSteps) -> [bool; 2] {
        let [from, to] = self.courses(steps);
        let course = if self.share < 0.5 { from } else { to };
        let pose = (self.share.min(1.0) * (STEP_POSES - 1) as f32).round();
        course.contacts[pose as usize]
    }

    /// Returns the pose among the shared ones this long ago: in this step or the previous one.
    pub(super) fn look(&self, ago_secs: f32, steps: &SharedSteps) -> SharedPose {
        if self.is_standing() {
            let rest_secs = (self.rest_secs - ago_secs).max(0.0);
            let (pose, blend) = self.ending().rest_pose(rest_secs);
            return SharedPose {
                pose: pose as u32,
                blend,
                ..SharedPose::default()
            };
        }
        let share = self.share - ago_secs / self.secs(steps);
        if share < 0.0 {
            let before = Self {
                side: self.side.other(),
                speed: self.from,
                from: self.from,
                share: (1.0 + share).max(0.0),
                ..*self
            };
            return before.within();
        }
        Self { share, ..*self }.within()
    }

    /// Returns the pose within the step.
    fn within(&self) -> SharedPose {
        let share = self.share.clamp(0.0, 1.0);
        let at = share * (STEP_POSES - 1) as f32;
        let pose = (at as usize).min(STEP_POSES - 2);
        let leaves = self.from != self.speed;
        let leaving = if leaves {
            1.0 - smooth_step(share)
        } else {
            0.0
        };
        SharedPose {
            pose: (self.ending().first_pose() + pose) as u32,
            blend: at - pose as f32,
            beside: self.from.cast_signed() - self.speed.cast_signed(),
            leaving: (leaving * LEAVING_PARTS).floor().min(LEAVING_PARTS - 1.0) / LEAVING_PARTS,
        }
    }
}

impl Course {
    fn place_at(&self, share: f32) -> Vec2 {
        let at = share * (STEP_POSES - 1) as f32;
        let pose = (at as usize).min(STEP_POSES - 2);
        self.places[pose].lerp(self.places[pose + 1], at - pose as f32)
    }
}

impl SharedSteps {
    /// Writes a pose.
    pub(super) fn write(&self, look: &SharedPose, out: &mut CrowdPose) {
        let poses = self.poses();
        let first = look.pose as usize;
        out.blend(&poses[first], &poses[first + 1], look.blend);
        if look.leaving > 0.0 {
            let first =
                first.saturating_add_signed(isize::from(look.beside) * STEP_POSES.cast_signed());
            let mut left = CrowdPose::default();
            left.blend(&poses[first], &poses[first + 1], look.blend);
            *out = out.mixed(&left, look.leaving);
        }
    }

    /// Adds the difference between another pose and a shared one by a weight.
    pub(super) fn shift(
        &self,
        out: &mut CrowdPose,
        first: usize,
        other: &[i16; POSE_NUMBERS],
        weight: f32,
    ) {
        let [mut shared, mut own] = [(); 2].map(|()| CrowdPose::default());
        let pose = &self.poses()[first];
        shared.blend(pose, pose, 0.0);
        own.blend(other, other, 0.0);
        out.shift(&shared, &own, weight);
    }

    /// Returns the last pose of a step, with which the next one begins.
    pub(super) fn last_pose(&self, kind: Kind) -> &[i16; POSE_NUMBERS] {
        &self.poses()[kind.first_pose() + STEP_POSES - 1]
    }
}
