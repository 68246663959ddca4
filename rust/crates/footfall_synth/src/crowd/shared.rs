//! Shared steps of distant walkers: one for each speed and side of a few people, and their standing, recorded once for each mixture of styles on a body.

use super::ending::Ending;
use super::frames::POSE_NUMBERS;
use crate::footstep::Footstep;
use crate::ground::PlantedFrame;
use crate::plan::StepShape;
use crate::standing::Life;
use footfall_core::{GroundTransform, Side};
use glam::Vec2;

/// Number of poses of a step; the last is the first of the next step.
pub(super) const STEP_POSES: usize = 9;
/// Number of poses of standing, time between them, seconds, and number of poses that lead back to the first.
pub(super) const REST_POSES: usize = 24;
pub(super) const REST_APART_SECS: f32 = 0.4;
pub(super) const REST_LOOPED: usize = 6;

/// Speeds of the steps, m/s, each nearly a quarter above the previous one. The first two are standing and turning on the spot.
pub(super) const SPEEDS_MPS: [f32; 15] = [
    0.0, 0.0, 0.35, 0.5, 0.7, 0.9, 1.1, 1.35, 1.65, 2.0, 2.5, 3.1, 3.9, 4.8, 5.9,
];
pub(super) const STAND: usize = 0;
pub(super) const SPOT: usize = 1;
/// Number of people.
pub(super) const PEOPLE: usize = 2;
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
    pub(super) courses: Vec<Course>,
    pub(super) steps: Vec<Option<Shared>>,
    /// Poses of all steps, then those of standing, each sequence with its first pose repeated at the end.
    pub(super) poses: Vec<[i16; POSE_NUMBERS]>,
}

impl Kind {
    pub(super) fn index(self) -> usize {
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
