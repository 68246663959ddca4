//! Shared steps of distant walkers: one for each speed and side of a few people, and their standing, recorded once for each mixture of styles on a body.

use super::frames::{CrowdPose, POSE_NUMBERS};
use super::own::{Ending, OwnWalk};
use super::workshop::{StyledBody, Workshop};
use crate::config::GeneratorConfig;
use crate::controls::Controls;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::footstep::Footstep;
use crate::ground::PlantedFrame;
use crate::plan::StepShape;
use crate::standing::Life;
use footfall_core::{GroundTransform, Joint, Side};
use glam::Vec2;

/// Number of poses of a step; the last is the first of the next step.
pub(super) const STEP_POSES: usize = 9;
/// Number of poses of standing, time between them, seconds, and number of poses that lead back to the first.
const REST_POSES: usize = 24;
pub(super) const REST_APART_SECS: f32 = 0.4;
const REST_LOOPED: usize = 6;

/// Speeds of the steps, m/s, each nearly a quarter above the previous one. The first two are standing and turning on the spot.
pub(super) const SPEEDS_MPS: [f32; 15] = [
    0.0, 0.0, 0.35, 0.5, 0.7, 0.9, 1.1, 1.35, 1.65, 2.0, 2.5, 3.1, 3.9, 4.8, 5.9,
];
pub(super) const STAND: usize = 0;
pub(super) const SPOT: usize = 1;
/// Turn rate on the spot, rad/s, and speed from which a stop is recorded, m/s.
const SPOT_RADPS: f32 = 0.5;
const STOPPED_FROM_MPS: f32 = 1.1;

/// Number of people.
pub(super) const PEOPLE: usize = 2;
/// Number of steps after which the previous speed has no influence.
const SETTLING: usize = 4;

/// Kind of a step: person, leading foot, and index of the speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    pub(super) person: u8,
    pub(super) side: Side,
    pub(super) speed: u8,
}

/// Course of a step over the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) secs: f32,
    pub(super) speed_mps: f32,
    /// Places at each pose relative to the first, to the left and forwards, metres.
    pub(super) places: [Vec2; STEP_POSES],
    pub(super) contacts: [[bool; 2]; STEP_POSES],
    /// Initial contact relative to the place at the beginning.
    pub(super) landing: Option<Footstep>,
}

/// End of a shared step, from which own steps continue.
#[derive(Clone, Debug)]
pub(super) struct Shared {
    pub(super) ending: Ending,
    pub(super) shape: StepShape,
    /// Place of the end in the plan of the step.
    pub(super) end: GroundTransform,
    /// Pose in which it stops, and the standing motion there.
    pub(super) still: Option<(PlantedFrame, Life)>,
}

/// All shared steps of a body.
#[derive(Debug)]
pub(super) struct SharedSteps {
    courses: Vec<Course>,
    steps: Vec<Option<Shared>>,
    /// Poses of all steps, then those of standing, each sequence with its first pose repeated at the end.
    poses: Vec<[i16; POSE_NUMBERS]>,
}

impl Kind {
    fn index(self) -> usize {
        let person = 2 * usize::from(self.person) + self.side.index();
        person * SPEEDS_MPS.len() + usize::from(self.speed)
    }

    const KINDS: usize = 2 * PEOPLE * SPEEDS_MPS.len();

    /// Returns the index of its first pose.
    pub(super) fn first_pose(self) -> usize {
        self.index() * STEP_POSES
    }

    /// Returns the index of the pose of standing at this time, and the weight of the next one.
    pub(super) fn rest_pose(self, rest_secs: f32) -> (usize, f32) {
        let person = 2 * usize::from(self.person) + self.side.index();
        let at = (rest_secs / REST_APART_SECS).rem_euclid(REST_POSES as f32);
        let pose = (at as usize).min(REST_POSES - 1);
        let first = Self::KINDS * STEP_POSES + person * (REST_POSES + 1);
        (first + pose, at - pose as f32)
    }
}

/// Returns the index of the nearest speed.
pub(super) fn nearest_speed(speed_mps: f32) -> usize {
    let faster = |pair: &[f32]| speed_mps * speed_mps > pair[0] * pair[1];
    // The limit between turning on the spot and the slowest walk is half of that.
    if speed_mps < 0.5 * SPEEDS_MPS[SPOT + 1] {
        return SPOT;
    }
    let walks = SPEEDS_MPS[SPOT + 1..].windows(2);
    SPOT + 1 + walks.take_while(|pair| faster(pair)).count()
}

impl SharedSteps {
    /// Records some people walking at all speeds and standing.
    ///
    /// # Errors
    /// [`SynthError`] when the model gives no trajectory.
    pub(super) fn record(styled: &StyledBody, workshop: &mut Workshop) -> Result<Self, SynthError> {
        let mut steps = Self::default();
        for person in 0..PEOPLE as u8 {
            let config = GeneratorConfig {
                seed: u64::from(person) + 2,
                phase: 0.0,
                variation: 1.0,
            };
            let mut walker = OwnWalk::new(styled, &config, false, workshop)?;
            walker.take_mean_steps();
            steps.record_walks(person, &mut walker, workshop);
            steps.record_stands(person, &mut walker, workshop);
        }
        Ok(steps)
    }

    fn record_walks(&mut self, person: u8, walker: &mut OwnWalk, workshop: &mut Workshop) {
        for (speed, speed_mps) in SPEEDS_MPS.into_iter().enumerate().skip(SPOT) {
            let controls = Controls {
                speed_mps,
                turn_rate_radps: if speed == SPOT { SPOT_RADPS } else { 0.0 },
                ..Controls::STAND
            };
            for step in 0..SETTLING + 2 {
                let recorded = step >= SETTLING;
                walker.detail = if recorded {
                    Detail::Full
                } else {
                    Detail::Quarter
                };
                walker.next_step(controls, None, workshop);
                if recorded {
                    let kind = Kind {
                        person,
                        side: walker.shape.timing.leading,
                        speed: speed as u8,
                    };
                    self.take(kind, walker, None);
                }
            }
        }
    }

    /// Records stops with either foot, and standing.
    fn record_stands(&mut self, person: u8, walker: &mut OwnWalk, workshop: &mut Workshop) {
        walker.detail = Detail::Quarter;
        let walks = Controls {
            speed_mps: STOPPED_FROM_MPS,
            ..Controls::STAND
        };
        // An odd number of steps between two stops.
        for steps in [2 * SETTLING, SETTLING + 2] {
            for _ in 0..steps {
                walker.next_step(walks, None, workshop);
            }
            walker.next_step(Controls::STAND, None, workshop);
            let kind = Kind {
                person,
                side: walker.shape.timing.leading,
                speed: STAND as u8,
            };
            walker.rest_for(0.0, workshop);
            let still = walker.still();
            self.take(kind, walker, still);
            self.record_rest(kind, walker, workshop);
        }
    }

    /// Keeps the current step of a walker.
    fn take(&mut self, kind: Kind, walker: &OwnWalk, still: Option<(PlantedFrame, Life)>) {
        let frames = walker.shape.timing.frames as f32;
        let end = walker.place_at(frames);
        let start = walker.place_at(0.0);
        let at = |pose: usize| frames * pose as f32 / (STEP_POSES - 1) as f32;
        let places: [Vec2; STEP_POSES] = core::array::from_fn(|pose| {
            let place = start.local(&walker.place_at(at(pose))).position;
            Vec2::new(place.x, place.z)
        });
        let secs = walker.step_secs();
        self.courses[kind.index()] = Course {
            secs,
            speed_mps: places[STEP_POSES - 1].length() / secs,
            places,
            contacts: core::array::from_fn(|pose| walker.contacts_at(at(pose))),
            landing: walker.landing_from(&start),
        };
        self.steps[kind.index()] = Some(Shared {
            ending: (*walker.ending).clone(),
            shape: walker.shape,
            end,
            still,
        });
        let mut shown = CrowdPose::default();
        let first = kind.first_pose();
        for (pose, out) in self.poses[first..first + STEP_POSES].iter_mut().enumerate() {
            walker.pose_at(at(pose), &mut shown);
            shown.shrink(out);
        }
    }

    fn record_rest(&mut self, kind: Kind, walker: &mut OwnWalk, workshop: &mut Workshop) {
        let mut still = CrowdPose::default();
        walker.pose(&mut still);
        let (first, _) = kind.rest_pose(0.0);
        let mut shown = still.clone();
        for pose in 0..=REST_POSES {
            // It begins and ends still.
            let after = pose.saturating_sub(REST_POSES - REST_LOOPED) as f32;
            let out = shown.mixed(&still, after / REST_LOOPED as f32);
            out.shrink(&mut self.poses[first + pose]);
            walker.rest_for(REST_APART_SECS, workshop);
            walker.pose(&mut shown);
        }
        // Steps that stop and start lead to and from the first pose.
        let rest = self.poses[first];
        let step = kind.first_pose();
        self.poses[step..step + STEP_POSES].fill(rest);
        let ankle = [Joint::LeftFoot, Joint::RightFoot][kind.side.index()];
        self.courses[kind.index()] = Course {
            landing: Some(Footstep {
                side: kind.side,
                position: still.position(ankle).with_y(0.0),
                heading: 0.0,
            }),
            ..Course::default()
        };
    }

    /// Returns the course of a step.
    pub(super) fn course(&self, kind: Kind) -> &Course {
        &self.courses[kind.index()]
    }

    /// Returns the end of a step, from which own steps continue, if there is one.
    pub(super) fn step(&self, kind: Kind) -> Option<&Shared> {
        self.steps[kind.index()].as_ref()
    }

    /// Returns all poses.
    pub(super) fn poses(&self) -> &[[i16; POSE_NUMBERS]] {
        &self.poses
    }
}

impl Default for SharedSteps {
    /// Steps without any motion.
    fn default() -> Self {
        let poses = Kind::KINDS * STEP_POSES + 2 * PEOPLE * (REST_POSES + 1);
        Self {
            courses: vec![Course::default(); Kind::KINDS],
            steps: vec![None; Kind::KINDS],
            poses: vec![[0; POSE_NUMBERS]; poses],
        }
    }
}

impl Default for Course {
    fn default() -> Self {
        Self {
            secs: 0.5,
            speed_mps: 0.0,
            places: [Vec2::ZERO; STEP_POSES],
            contacts: [[true; 2]; STEP_POSES],
            landing: None,
        }
    }
}
