//! Recording of the steps that distant walkers share, without chance.

use super::frames::CrowdPose;
use super::own::OwnWalk;
use super::shared::{
    Course, Kind, PEOPLE, REST_APART_SECS, REST_LOOPED, REST_POSES, SPEEDS_MPS, SPOT, STAND,
    STEP_POSES, Shared, SharedSteps,
};
use super::styled_body::{Styled, StyledBody};
use super::tools::StepTools;
use crate::config::GeneratorConfig;
use crate::controls::Controls;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::footstep::Footstep;
use crate::ground::PlantedFrame;
use crate::plan::Planner;
use crate::source::{MeasuredBlend, StyleSpace};
use crate::standing::Life;
use footfall_core::{GroundTransform, Joint, Skeleton};
use glam::Vec2;
use std::sync::{Arc, OnceLock};

/// Turn rate on the spot, rad/s, and speed from which a stop is recorded, m/s.
const SPOT_RADPS: f32 = 0.5;
const STOPPED_FROM_MPS: f32 = 1.1;

/// Number of steps after which the previous speed has no influence.
const SETTLING: usize = 4;

impl StyledBody {
    /// Mixes the space's styles, weights as of [`GaitGenerator::set_style_weights`](crate::GaitGenerator::set_style_weights), and
    /// measures their paces on this body, and generates the steps that distant walkers share: about ten milliseconds.
    ///
    /// # Errors
    /// [`SynthError`] when the model or the skeleton cannot be used.
    pub fn new(
        space: &Arc<StyleSpace>,
        style_weights: &[f32],
        skeleton: &Skeleton,
    ) -> Result<Self, SynthError> {
        skeleton.check()?;
        let blend = space.blend(style_weights);
        let average = Planner::new(&blend.model, 0, 0.0);
        let measured = space
            .with_buffers(|buffers| MeasuredBlend::measure(&average, skeleton, blend, buffers))?;
        let styled = Arc::new(Styled {
            space: Arc::clone(space),
            skeleton: skeleton.clone(),
            measured,
            shared: OnceLock::new(),
        });
        let made = Self(styled, 0);
        let steps = SharedSteps::record(&made, &mut StepTools::new(&made))?;
        made.0.shared.get_or_init(|| steps);
        Ok(made)
    }
}

impl SharedSteps {
    /// Records some people walking at all speeds and standing.
    ///
    /// # Errors
    /// [`SynthError`] when the model gives no trajectory.
    pub(super) fn record(styled: &StyledBody, tools: &mut StepTools) -> Result<Self, SynthError> {
        let mut steps = Self::default();
        for person in 0..PEOPLE as u8 {
            let config = GeneratorConfig {
                seed: u64::from(person) + 2,
                phase: 0.0,
                variation: 1.0,
            };
            let mut walker = OwnWalk::new(styled, &config, false, tools)?;
            walker.take_mean_steps();
            steps.record_walks(person, &mut walker, tools);
            steps.record_stands(person, &mut walker, tools);
        }
        Ok(steps)
    }

    fn record_walks(&mut self, person: u8, walker: &mut OwnWalk, tools: &mut StepTools) {
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
                walker.next_step(controls, None, tools);
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
    fn record_stands(&mut self, person: u8, walker: &mut OwnWalk, tools: &mut StepTools) {
        walker.detail = Detail::Quarter;
        let walks = Controls {
            speed_mps: STOPPED_FROM_MPS,
            ..Controls::STAND
        };
        // An odd number of steps between two stops.
        for steps in [2 * SETTLING, SETTLING + 2] {
            for _ in 0..steps {
                walker.next_step(walks, None, tools);
            }
            walker.next_step(Controls::STAND, None, tools);
            let kind = Kind {
                person,
                side: walker.shape.timing.leading,
                speed: STAND as u8,
            };
            walker.rest_for(0.0, tools);
            let still = walker.still();
            self.take(kind, walker, still);
            self.record_rest(kind, walker, tools);
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

    fn record_rest(&mut self, kind: Kind, walker: &mut OwnWalk, tools: &mut StepTools) {
        let mut still = CrowdPose::default();
        walker.pose(&mut still);
        let (first, _) = kind.rest_pose(0.0);
        let mut shown = still.clone();
        for pose in 0..=REST_POSES {
            // It begins and ends still.
            let after = pose.saturating_sub(REST_POSES - REST_LOOPED) as f32;
            let out = shown.mixed(&still, after / REST_LOOPED as f32);
            out.shrink(&mut self.poses[first + pose]);
            walker.rest_for(REST_APART_SECS, tools);
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
}

impl OwnWalk {
    /// Takes only mean steps from now on.
    pub(super) fn take_mean_steps(&mut self) {
        self.even = true;
        for draw in &mut self.ending.draws {
            *draw = Planner::mean_draw(draw.side);
        }
    }

    /// Stands for this long, at the end of its step.
    pub(super) fn rest_for(&mut self, secs: f32, tools: &mut StepTools) {
        self.position = self.shape.timing.frames as f32;
        self.live(secs, tools);
    }

    /// Returns the pose in which it stands still, and its standing motion.
    pub(super) fn still(&self) -> Option<(PlantedFrame, Life)> {
        let still = self.rest.as_ref()?.still.clone();
        Some((still, self.life.clone()?))
    }

    /// Returns the duration of its step, seconds.
    pub(super) fn step_secs(&self) -> f32 {
        self.shape.timing.frames as f32 / self.frame_rate_hz
    }

    /// Writes the pose this many frames after the step began.
    pub(super) fn pose_at(&self, position: f32, out: &mut CrowdPose) {
        let (frame, weight) = self.frame_at(position);
        self.frames.blend(frame, weight, out);
    }

    /// Returns the initial contact of the step, relative to a place of the plan.
    pub(super) fn landing_from(&self, place: &GroundTransform) -> Option<Footstep> {
        let side = self.shape.timing.leading;
        let landing = self.landing_of_step()?;
        Some(Footstep::seen_from(place, side, &landing))
    }
}
