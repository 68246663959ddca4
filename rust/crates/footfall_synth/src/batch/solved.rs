//! Whole walks whose trajectory is solved at once.

use super::streamed::from_standing;
use super::walk::{SynthesizedWalk, WalkConfig};
use crate::error::SynthError;
use crate::gait::{Gait, Manner};
use crate::ground::{
    Course, Displacement, GeneratedFrame, PlantedFrame, Planter, SpeedChange, Stride,
};
use crate::plan::{Planner, Statistics, StepDraw, StepPlan};
use crate::source::{StyleSpace, measure_paces};
use crate::trajectory::{FineBuffers, FineTables, neighbours, variance};
use footfall_core::lanes::f32x8;
use footfall_core::rotation::from_heading;
use footfall_core::{Clip, FrameSpan, Joint, Pose, Side, Skeleton};
use footfall_model::{FEATURE_COUNT, GaitModel, layout};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Number of hidden steps at either end of the walk.
const LEAD_STEPS: usize = 1;

/// Slowest speed of a whole walk, m/s.
const MIN_SPEED_MPS: f64 = 0.1;

/// Tolerance with which a frame counts as reached: times add up with rounding.
const TIME_SLACK_SECS: f64 = 1e-9;

/// Generates a walk. The trajectory is solved over the whole sequence of steps (equations 9 to 15 of the paper), except for a
/// walk [`from_standing`](WalkConfig::from_standing) or in another direction than forwards, which is streamed.
///
/// # Errors
/// [`SynthError`] when the model or the skeleton cannot be used or a setting is not finite.
pub fn synthesize(
    model: &Arc<GaitModel>,
    skeleton: &Skeleton,
    config: &WalkConfig,
) -> Result<SynthesizedWalk, SynthError> {
    model.check()?;
    skeleton.check()?;
    check_finite("speed", config.speed_mps.unwrap_or(0.0))?;
    check_finite("turn rate", config.turn_rate_radps)?;
    check_finite("variation", config.variation)?;
    check_finite("direction", config.direction_rad)?;
    if config.from_standing || config.direction_rad != 0.0 {
        return from_standing(model, skeleton, config);
    }
    let space = StyleSpace::new(model, &[])?;
    let blend = space.blend(&[]);
    let blend = blend.of_gait(gait_of(model, skeleton, config));
    let model = &blend.model;
    let mut planner = Planner::new(
        model,
        config.seed,
        f64::from(config.variation.clamp(0.0, 2.0)),
    );
    let speed = config
        .speed_mps
        .map_or(model.speed.reference_mps, f64::from);
    let paces = space.with_buffers(|buffers| measure_paces(&planner, skeleton, blend, buffers))?;
    let pace = paces.pace(speed.max(MIN_SPEED_MPS));

    let mut side = if LEAD_STEPS.is_multiple_of(2) {
        Side::Left
    } else {
        Side::Right
    };
    let statistics = Statistics::new(model);
    let plans: Vec<StepPlan<f64>> = (0..config.steps.max(1) + 2 * LEAD_STEPS)
        .map(|_| {
            let draw: StepDraw = planner.draw(side);
            side = side.other();
            let mut plan = StepPlan::empty();
            planner.plan_step(&draw, Manner::inside(pace), &statistics, &mut plan);
            plan
        })
        .collect();
    let trajectory = variance::solve_walk(model, &statistics, &plans)?;
    Ok(plant(
        model,
        skeleton,
        config,
        &plans,
        &trajectory,
        paces.facing,
    ))
}

/// Returns the gait of a whole walk.
fn gait_of(model: &GaitModel, skeleton: &Skeleton, config: &WalkConfig) -> Gait {
    if model.running.is_none() {
        return Gait::Walk;
    }
    let speed = config.speed_mps.unwrap_or(model.speed.reference_mps as f32);
    let leg_length = skeleton.mean_leg_length();
    let gait = config.gait;
    gait.of_step(Gait::Walk, speed * Vec2::Y, leg_length, false)
}

/// Places planned steps on the ground; the first and the last [`LEAD_STEPS`] are hidden.
pub(crate) fn plant(
    model: &GaitModel,
    skeleton: &Skeleton,
    config: &WalkConfig,
    plans: &[StepPlan<f64>],
    trajectory: &[f64],
    facing: f32,
) -> SynthesizedWalk {
    let model_rate_hz = model.frame_rate_hz;
    let frame_secs = 1.0 / model_rate_hz;
    let fine = model
        .fine
        .as_ref()
        .zip(FineTables::of(model))
        .map(|(fine, tables)| (tables, FineTables::scale(fine)));
    let mut buffers = FineBuffers::new();
    let mut planter: Option<Planter> = None;
    let mut course = Course {
        step_secs: 0.0,
        turn_rate: config.turn_rate_radps,
        facing: [facing; 2],
        keeps_lengths: true,
        lands_softly: false,
        direction: Some(0.0),
        change: SpeedChange::default(),
        displacement: Displacement::NONE,
    };
    let mut poses: Vec<Pose> = Vec::new();
    let mut stances: [Vec<[f64; 2]>; 2] = [vec![], vec![]];
    let shown = LEAD_STEPS..plans.len() - LEAD_STEPS;
    let mut begin = 0;
    let mut elapsed = 0.0;
    let mut start_heading = 0.0;
    for (index, plan) in plans[..shown.end].iter().enumerate() {
        let timing = &plan.shape.timing;
        let mut generated = vec![GeneratedFrame::default(); timing.frames + 1];
        let stride = plan.shape.stride as f32;
        let rows = trajectory[begin * FEATURE_COUNT..].chunks_exact(FEATURE_COUNT);
        let mut frames = vec![PlantedFrame::default(); timing.frames + 1];
        if let Some((tables, _)) = &fine {
            buffers.prepare(tables, timing.leading, &neighbours(plans, index));
        }
        for (number, (frame, features)) in frames.iter_mut().zip(rows).enumerate() {
            let mut narrow = [0.0; FEATURE_COUNT];
            for (narrow, feature) in narrow.iter_mut().zip(features) {
                *narrow = *feature as f32;
            }
            if let Some((_, scale)) = &fine {
                buffers.add(
                    number as f32 / timing.frames as f32,
                    1.0,
                    [scale; 2],
                    &mut narrow,
                );
            }
            layout::decode(&narrow, &mut frame.pose.rotations);
        }
        GeneratedFrame::fill(&mut generated, &frames, skeleton, |_| Stride {
            scale: f32x8::splat(stride),
            upright: f32x8::ONE,
        });
        begin += timing.frames;
        course.step_secs = (timing.frames as f64 * frame_secs) as f32;
        let planter = planter.get_or_insert_with(|| {
            Planter::new(skeleton, frame_secs as f32, &generated[0], timing, facing)
        });
        let timing = planter.plant_step(&mut generated, timing, course, &mut frames);
        if index < shown.start {
            continue;
        }
        planter.solve_legs(&generated, &mut frames);
        if index == shown.start {
            start_heading = frames[0].ground_heading;
        }
        poses.truncate(poses.len().saturating_sub(1));
        poses.extend(frames.iter().map(|frame| frame.pose.clone()));
        if !timing.airborne {
            let leaves = elapsed + timing.terminal as f64 * frame_secs;
            match stances[timing.leading.other().index()].last_mut() {
                Some(stance) => stance[1] = leaves,
                None => stances[timing.leading.other().index()].push([0.0, leaves]),
            }
        }
        let leaves = timing
            .take_off
            .map(|last| elapsed + last as f64 * frame_secs);
        stances[timing.leading.index()].push([elapsed, leaves.unwrap_or(f64::INFINITY)]);
        elapsed += timing.frames as f64 * frame_secs;
    }
    let shown = &plans[shown];
    if let Some(last) = shown.last() {
        // The last frame is the next initial contact.
        stances[last.shape.timing.leading.other().index()].push([elapsed, f64::INFINITY]);
    }
    start_at_origin(&mut poses, start_heading);
    let clip = Clip {
        skeleton: skeleton.clone(),
        frame_rate_hz: model_rate_hz,
        poses,
    };
    let clip = match config.frame_rate_hz {
        Some(rate) if (rate - model_rate_hz).abs() > 1e-9 => clip.resampled(rate),
        _ => clip,
    };
    let last = clip.poses.len() - 1;
    let frame = |time: f64, round: fn(f64) -> f64| {
        round(time.min(elapsed + TIME_SLACK_SECS) * clip.frame_rate_hz).clamp(0.0, last as f64)
            as usize
    };
    let contacts = stances.map(|stances| {
        stances
            .iter()
            .map(|[first, end]| FrameSpan {
                first: frame(*first - TIME_SLACK_SECS, f64::ceil),
                last: frame(*end + TIME_SLACK_SECS, f64::floor),
            })
            .collect()
    });
    SynthesizedWalk { clip, contacts }
}

/// Moves a walk with any initial heading to the origin and to +Z.
fn start_at_origin(poses: &mut [Pose], heading: f32) {
    let Some(first) = poses.first() else { return };
    let from = Vec3::new(first.root_position.x, 0.0, first.root_position.z);
    let level = from_heading(-heading);
    for pose in poses {
        pose.root_position = level * (pose.root_position - from);
        let hips = Joint::Hips.index();
        pose.rotations[hips] = (level * pose.rotations[hips]).normalize();
    }
}

fn check_finite(setting: &'static str, value: f32) -> Result<(), SynthError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(SynthError::Setting { setting, value })
    }
}
