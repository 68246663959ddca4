//! Walks and their steps.
//!
//! A step runs from one foot's initial contact to the other's (Tilmanne et al. 2012, section 4: left and right steps
//! alternate, and a step's place in the walk matters for the first two and the last two).

mod running;

pub(crate) use running::free_falls;
pub use running::running_parts;

use crate::contacts::Contacts;
use footfall_core::{Clip, ModelPose, Side, StepPosition, forward_kinematics};
use glam::Vec3;

/// From a foot's initial contact to the other foot's next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The foot that came down at `first` and carries the body.
    pub side: Side,
    /// Frame of this foot's initial contact. In the first step out of standing, whose foot was down all along, as long
    /// before the other foot lifts as in the steps that follow.
    pub first: usize,
    /// Frame of the other foot's next initial contact; the step ends before it.
    pub end: usize,
    /// Place in the walk.
    pub position: StepPosition,
    /// Last frame in which the other foot, still behind, bears on the ground, if it does within the step.
    pub other_terminal: Option<usize>,
    /// First frame within the step in which this foot's heel has left the ground for good.
    pub heel_rise: Option<usize>,
    /// Last frame in which this foot bears before the body flies until the step ends: a running step.
    pub take_off: Option<usize>,
}

impl Step {
    /// A step in the midst of a walk, of which it is not known when feet leave the ground.
    pub const fn inside(side: Side, first: usize, end: usize) -> Self {
        Self {
            side,
            first,
            end,
            position: StepPosition::Inside,
            other_terminal: None,
            heel_rise: None,
            take_off: None,
        }
    }

    /// Returns true for a running step: the body flies at its end.
    pub const fn flies(&self) -> bool {
        self.take_off.is_some()
    }

    /// Length in frames.
    pub const fn frames(&self) -> usize {
        self.end - self.first
    }
}

/// Steps that follow each other without a break, sides alternating.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Walk {
    /// At least one step.
    pub steps: Vec<Step>,
}

/// Limits of a plausible step: shorter ones in time are jumps onto both feet, longer ones pauses.
pub(crate) const SHORTEST_STEP_SECS: f64 = 0.15;
pub(crate) const LONGEST_STEP_SECS: f64 = 1.5;
/// A longer stride of the canonical body, metres, is a jump or an error of capture.
const LONGEST_STEP_M: f32 = 3.0;
/// Initial contacts of both feet so close together are a landing from a jump.
const JUMP_SECS: f64 = 0.1;
/// Time with both feet on the ground, and hips slower than [`STANDING_SPEED`], from which on a body stands.
const STANDING_SECS: f64 = 0.2;
/// As a share of the walk's speed, and at least [`LEAST_STANDING_SPEED_MPS`].
const STANDING_SPEED: f32 = 0.3;
const LEAST_STANDING_SPEED_MPS: f32 = 0.1;

/// Finds the walks of a clip: runs of steps whose sides alternate.
///
/// Steps shorter than 0.15 s or longer than 1.5 s or 3 m break a walk, as do jumps (both feet land within 0.1 s) and hops (the
/// same foot lands twice). A walk starts with [`StepPosition::First`] only if the clip shows both feet standing before it, and
/// ends with [`StepPosition::Last`] only if it shows them standing after it.
pub fn segment_walks(clip: &Clip, contacts: &Contacts) -> Vec<Walk> {
    let motion = Motion { clip, contacts };
    let landings = motion.landings();
    let mut walks = Vec::new();
    let mut steps: Vec<Step> = Vec::new();
    for pair in landings.windows(2) {
        if let Some(step) = motion.step_between(&pair[0], &pair[1]) {
            steps.push(step);
        } else if !steps.is_empty() {
            walks.push(motion.walk(core::mem::take(&mut steps)));
        }
    }
    if !steps.is_empty() {
        walks.push(motion.walk(steps));
    }
    walks
}

/// A foot that comes down.
#[derive(Clone, Copy, Debug)]
struct Landing {
    side: Side,
    frame: usize,
    /// True when the clip shows the foot in the air before, and the other foot does not land with it.
    starts_a_step: bool,
}

struct Motion<'a> {
    clip: &'a Clip,
    contacts: &'a Contacts,
}

impl Motion<'_> {
    fn secs(&self, frames: usize) -> f64 {
        frames as f64 / self.contacts.frame_rate_hz
    }

    fn frames(&self, secs: f64) -> usize {
        (secs * self.contacts.frame_rate_hz).round() as usize
    }

    fn landings(&self) -> Vec<Landing> {
        let seen: Vec<(Side, usize)> = Side::BOTH
            .into_iter()
            .flat_map(|side| {
                let stances = &self.contacts.foot(side).stances;
                stances.iter().map(move |stance| (side, stance.first))
            })
            .collect();
        let mut landings: Vec<Landing> = seen
            .iter()
            .map(|&(side, frame)| {
                let with_other = seen
                    .iter()
                    .any(|&(other, at)| other != side && self.secs(at.abs_diff(frame)) < JUMP_SECS);
                Landing {
                    side,
                    frame,
                    starts_a_step: frame > self.contacts.first_frame && !with_other,
                }
            })
            .collect();
        landings.sort_by_key(|landing| (landing.frame, landing.side));
        landings
    }

    fn ankle(&self, side: Side, frame: usize) -> Vec3 {
        let mut model = ModelPose::default();
        if let Some(pose) = self.clip.poses.get(frame) {
            forward_kinematics(&self.clip.skeleton, pose, &mut model);
        }
        model.position(side.foot()).with_y(0.0)
    }

    fn step_between(&self, here: &Landing, next: &Landing) -> Option<Step> {
        let is_alternating = here.side != next.side && here.starts_a_step && next.starts_a_step;
        let (first, end) = (here.frame, next.frame);
        let is_timely = (SHORTEST_STEP_SECS..=LONGEST_STEP_SECS).contains(&self.secs(end - first));
        let length = self
            .ankle(here.side, first)
            .distance(self.ankle(next.side, end));
        (is_alternating && is_timely && length < LONGEST_STEP_M)
            .then(|| self.step(here.side, first, end))
    }

    fn step(&self, side: Side, first: usize, end: usize) -> Step {
        let other_terminal = self
            .contacts
            .foot(side.other())
            .stances
            .iter()
            .map(|stance| stance.last)
            .rfind(|last| (first..end).contains(last));
        let heel = &self.contacts.foot(side).heel;
        // A run on the toes has no heel contact to rise from: then the whole step is without it.
        let heel_rise = (first..end)
            .rev()
            .take_while(|&frame| !heel[frame])
            .last()
            .filter(|&frame| frame > first);
        Step {
            side,
            first,
            end,
            position: StepPosition::Inside,
            other_terminal,
            heel_rise,
            take_off: running::take_off(self.clip, first, end),
        }
    }

    /// Adds the step out of standing, if the walk starts so, and labels all.
    fn walk(&self, mut steps: Vec<Step>) -> Walk {
        let speed = self.hips_speed(steps[0].first, steps[steps.len() - 1].end);
        let stops = self.stands_after(steps[steps.len() - 1].end, speed);
        let start = self.step_from_standing(&steps, speed);
        let starts = start.is_some();
        if let Some(step) = start {
            steps.insert(0, step);
        }
        let count = steps.len();
        // In a walk of three steps or fewer, the first and the last count most.
        let mut label = |index: Option<usize>, position: StepPosition| {
            if let Some(step) = index.and_then(|index| steps.get_mut(index)) {
                step.position = position;
            }
        };
        if starts {
            label(Some(1), StepPosition::Second);
        }
        if stops {
            label(count.checked_sub(2), StepPosition::LastButOne);
        }
        if starts {
            label(Some(0), StepPosition::First);
        }
        if stops {
            label(Some(count - 1), StepPosition::Last);
        }
        Walk { steps }
    }

    /// Mean horizontal speed of the hips, metres a second.
    fn hips_speed(&self, first: usize, last: usize) -> f32 {
        let poses = &self.clip.poses[first..=last.min(self.clip.poses.len() - 1)];
        let path: f32 = poses
            .windows(2)
            .map(|pair| {
                (pair[1].root_position - pair[0].root_position)
                    .with_y(0.0)
                    .length()
            })
            .sum();
        path * self.contacts.frame_rate_hz as f32 / (poses.len() - 1).max(1) as f32
    }

    /// Returns true when both feet bear and the hips rest over a run of frames.
    fn stands(&self, first: usize, last: usize, walking_speed: f32) -> bool {
        let limit = (STANDING_SPEED * walking_speed).max(LEAST_STANDING_SPEED_MPS);
        (first..=last).all(|frame| {
            Side::BOTH
                .into_iter()
                .all(|side| self.contacts.bears(side, frame))
        }) && self.hips_speed(first, last) < limit
    }

    fn stands_after(&self, end: usize, walking_speed: f32) -> bool {
        // The body still swings forward for a moment over the feet that have come to rest.
        let settle = self.frames(0.15);
        let last = end + settle + self.frames(STANDING_SECS);
        last < self.contacts.frames && self.stands(end + settle, last, walking_speed)
    }

    /// The step that led to the walk's first landing, if the walker stood before.
    fn step_from_standing(&self, steps: &[Step], walking_speed: f32) -> Option<Step> {
        let landing = &steps[0];
        let lift = self
            .contacts
            .foot(landing.side)
            .stances
            .iter()
            .map(|stance| stance.last)
            .rfind(|&last| last < landing.first)?;
        let carrier = landing.side.other();
        let standing = self.frames(STANDING_SECS);
        let carries = (lift..=landing.first).all(|frame| self.contacts.bears(carrier, frame));
        let is_timely = self.secs(landing.first - lift) < LONGEST_STEP_SECS;
        // Weight shifts before the foot lifts as it does in the steps that follow.
        let mut leads: Vec<usize> = steps
            .iter()
            .filter_map(|step| step.other_terminal.map(|terminal| terminal - step.first))
            .collect();
        leads.sort_unstable();
        let lead = leads
            .get(leads.len() / 2)
            .copied()
            .unwrap_or(self.frames(0.12));
        let first = lift.checked_sub(lead)?;
        let stood_from = first.checked_sub(standing)?;
        let stood = stood_from >= self.contacts.first_frame
            && self.stands(stood_from, first, walking_speed);
        (carries && is_timely && stood).then(|| self.step(carrier, first, landing.first))
    }
}
