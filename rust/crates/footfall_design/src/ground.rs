//! Hips over the course ([`hips`]), feet on the ground, and legs between them.

mod hips;

use crate::chance::normal;
use crate::course::Course;
use crate::sheet::StyleSheet;
use crate::timeline::Timeline;
use core::f32::consts::PI;
use footfall_core::ease::{hermite, smooth_step};
use footfall_core::lanes::{Vec3x8, f32x8};
use footfall_core::rotation::{exp_map, from_heading, log_map, wrap_angle};
use footfall_core::{Clip, FrameSpan, Joint, ModelPose, Pose, Side, Skeleton, forward_kinematics};
use footfall_ik::{
    FootTarget, Plant, RockerFoot, foot_heading, foot_pitch, settled_pitch, solve_leg,
};
use glam::Vec3;
use hips::MOST_STRETCH;

/// Part of a stance in which a heel begins to rise for a leg that is too short, and from which it does wholly; the most that it rises, radians.
const LATE: [f32; 2] = [0.45, 0.65];
const MOST_RAISED: f32 = 0.4;
/// Least clearance of the sole in the middle of a swing, metres.
const CLEARANCE_M: f32 = 0.012;
/// Feet cross over the course's middle by this much at most, metres.
const MOST_CROSSING_M: f32 = 0.02;

/// Everything about one clip that its feet and hips need.
pub(crate) struct Ground<'a> {
    /// Captured motion in new time, before any edit.
    pub(crate) captured: &'a Clip,
    pub(crate) timeline: &'a Timeline,
    pub(crate) old: &'a Course,
    pub(crate) new: &'a Course,
    pub(crate) sheet: &'a StyleSheet,
    pub(crate) seed: u64,
}

impl Ground<'_> {
    /// Places the hips of the edited poses, plants the feet and solves the legs.
    pub(crate) fn place(&self, poses: &mut [Pose]) {
        self.place_hips(poses);
        let models = models_of(&self.captured.skeleton, &self.captured.poses);
        let soles = Side::BOTH.map(|side| RockerFoot::new(&self.captured.skeleton, side));
        let free = Side::BOTH.map(|side| self.free_targets(side, &models));
        let mut feet = free.clone();
        let plants = Side::BOTH
            .map(|side| self.stand(side, &soles[side.index()], &models, &mut feet[side.index()]));
        self.follow_feet(poses, &models, &soles);
        for side in Side::BOTH {
            let index = side.index();
            self.raise_heels(side, &soles[index], &plants[index], poses, &mut feet[index]);
            self.swing_through(side, &soles[index], &free[index], &mut feet[index]);
        }
        self.give_way(poses, &feet);
        let mut model = ModelPose::default();
        for (frame, pose) in poses.iter_mut().enumerate() {
            let skeleton = &self.captured.skeleton;
            forward_kinematics(skeleton, pose, &mut model);
            for side in Side::BOTH {
                let target = &feet[side.index()][frame];
                solve_leg(skeleton, side, target, pose, &mut model);
            }
        }
    }

    fn secs(&self, frame: usize) -> f32 {
        frame as f32 / self.captured.frame_rate_hz as f32
    }

    /// Returns the free foot, as the course carries it, in every frame; stances and swings replace it.
    fn free_targets(&self, side: Side, models: &[ModelPose]) -> Vec<FootTarget> {
        let stances = &self.timeline.stances[side.index()];
        (0..models.len())
            .map(|frame| self.free(side, frame, models, progress(stances, frame)))
            .collect()
    }

    /// Stands a foot on the ground in its stances; returns its plants.
    fn stand(
        &self,
        side: Side,
        foot: &RockerFoot,
        models: &[ModelPose],
        targets: &mut [FootTarget],
    ) -> Vec<Plant> {
        let stances = &self.timeline.stances[side.index()];
        let stand = |(index, span): (usize, &FrameSpan)| {
            let plant = self.plant(side, foot, *span, index, models);
            for frame in span.first..=span.last {
                let pitch = settled_pitch(foot_pitch(models[frame].rotation(side.foot())));
                let pitch = self.styled_pitch(pitch, progress(stances, frame));
                targets[frame] = foot.stand(&plant, pitch);
            }
            plant
        };
        stances.iter().enumerate().map(stand).collect()
    }

    /// Raises the heel late in a stance as far as the leg needs to reach its foot: people give way to a long step there, not with their hips.
    fn raise_heels(
        &self,
        side: Side,
        foot: &RockerFoot,
        plants: &[Plant],
        poses: &[Pose],
        targets: &mut [FootTarget],
    ) {
        let skeleton = &self.captured.skeleton;
        let reach = f32x8::splat(MOST_STRETCH * skeleton.leg_length(side));
        for (span, plant) in self.timeline.stances[side.index()].iter().zip(plants) {
            for frame in span.first..=span.last {
                let pose = &poses[frame];
                let hip = pose.root_position
                    + pose.rotation(Joint::Hips) * skeleton.offset(side.upper_leg());
                let from_plant = from_heading(-plant.heading) * (hip - plant.flat_ankle);
                let pitch = foot_pitch(targets[frame].foot);
                let least = f32x8::splat(pitch.max(0.0));
                let from_plant = Vec3x8::splat(from_plant);
                let reaching = foot
                    .pitches_within_reach(from_plant, reach, least)
                    .as_array()[0];
                let passed = (frame - span.first) as f32 / (0.6 * self.timeline.stride_frames);
                let late = smooth_step((passed - LATE[0]) / (LATE[1] - LATE[0]));
                let raised = pitch + late * (reaching - pitch).clamp(0.0, MOST_RAISED);
                targets[frame] = foot.stand(plant, raised);
            }
        }
    }

    /// Leads a foot from each stance to the next.
    fn swing_through(
        &self,
        side: Side,
        foot: &RockerFoot,
        free: &[FootTarget],
        targets: &mut [FootTarget],
    ) {
        let mut ends = vec![None];
        let stances = self.timeline.stances[side.index()].iter();
        ends.extend(stances.copied().map(Some));
        ends.push(None);
        for pair in ends.windows(2) {
            self.swing(side, foot, (pair[0], pair[1]), free, targets);
        }
    }

    /// The captured foot moved with the course, before it knows of the ground.
    fn free(&self, side: Side, frame: usize, models: &[ModelPose], at: Progress) -> FootTarget {
        let walk = &self.sheet.walk;
        let model = &models[frame];
        let mut place = self.old.relative(frame, model.position(side.foot()));
        place.z *= self.new.stretch[frame];
        place.x += 0.005 * walk.width * side.sign();
        let captured = model.rotation(side.foot());
        let pitch = foot_pitch(captured);
        let turn = exp_map(Vec3::X * (self.styled_pitch(pitch, at) - pitch));
        let out = from_heading(walk.toe_out.to_radians() * side.sign());
        let rotation = (out * captured * turn).normalize();
        FootTarget {
            ankle: self.new.point(frame, place),
            foot: rotation,
            toes: rotation,
        }
    }

    /// A captured pitch (positive: heel up) in the style.
    fn styled_pitch(&self, pitch: f32, at: Progress) -> f32 {
        let feet = &self.sheet.feet;
        let raise = feet.heel_raise.to_radians();
        let pitch = if pitch < 0.0 {
            pitch * (1.0 - feet.heel_raise / 20.0).clamp(0.15, 1.0)
        } else {
            pitch * feet.push_off / 100.0 * (1.0 - 0.5 * feet.heel_raise / 45.0)
        };
        let landing = match at {
            Progress::Swing(s) => smooth_step(2.0 * s - 1.0),
            Progress::Stance { since } => {
                1.0 - smooth_step(since / (0.14 * self.timeline.stride_frames))
            }
        };
        pitch + raise - feet.landing.to_radians() * landing
    }

    /// Returns the place of a standing foot: the captured one, seen from the course, carried to the new course.
    fn plant(
        &self,
        side: Side,
        foot: &RockerFoot,
        span: FrameSpan,
        index: usize,
        models: &[ModelPose],
    ) -> Plant {
        // A foot is flattest early in its stance; the sum over many frames averages what the capture slips.
        let length = span.frames();
        let (from, to) = match (span.first == 0, span.last + 1 == models.len()) {
            (false, false) => (length / 5, (length * 3 / 5).max(length / 5 + 1)),
            (false, true) => ((length / 5).min(length - 1), length),
            (true, _) => (0, (length * 3 / 5).max(1)),
        };
        let mut ankle = Vec3::ZERO;
        let mut turn = 0.0;
        let reference = foot_heading(models[span.first + from].rotation(side.foot()));
        let count = (to - from) as f32;
        for frame in span.first + from..span.first + to {
            let rotation = models[frame].rotation(side.foot());
            let (pitch, heading) = (foot_pitch(rotation), foot_heading(rotation));
            let position = models[frame].position(side.foot());
            ankle += foot
                .plant_under(position, heading, settled_pitch(pitch))
                .flat_ankle
                / count;
            turn += wrap_angle(heading - reference) / count;
        }
        let middle = span.first + usize::midpoint(from, to).min(length - 1);
        let mut place = self.old.relative(middle, ankle);
        let sheet = self.sheet;
        let stream = 40 + side.index() as u64;
        let chance = normal(self.seed, stream, index as u64);
        let lengths = sheet.sides.each_ref().map(|one| one.step_length / 100.0);
        let mean = 0.5 * (lengths[0] + lengths[1]);
        let way = self.old.place[0].distance(self.old.place[self.old.place.len() - 1]);
        let step = way * 0.5 * self.timeline.stride_frames / models.len() as f32;
        // Half the difference, as the other foot's step loses what this one's gains.
        let ahead = 0.5 * step * (lengths[side.index()] - mean) * sheet.walk.stride / 100.0;
        place.z = place.z * self.new.stretch[middle] + ahead;
        let width = place.x * side.sign() + 0.005 * sheet.walk.width;
        let least = (-MOST_CROSSING_M).min(place.x * side.sign());
        place.x = width.max(least) * side.sign() + 0.01 * sheet.irregular.step_width * chance;
        let out = sheet.walk.toe_out.to_radians() * side.sign();
        let mut flat_ankle = self.new.point(middle, place);
        flat_ankle.y = ankle.y;
        Plant {
            flat_ankle,
            heading: reference + turn + out,
        }
    }

    /// Leads the foot from one stance to the next: the free foot, corrected at both ends to where it stands there.
    fn swing(
        &self,
        side: Side,
        foot: &RockerFoot,
        ends: (Option<FrameSpan>, Option<FrameSpan>),
        free: &[FootTarget],
        targets: &mut [FootTarget],
    ) {
        let last = targets.len().cast_signed() - 1;
        let lift = ends.0.map(|span| span.last);
        let landing = ends.1.map(|span| span.first);
        if (lift.is_none() && landing == Some(0)) || lift == Some(last as usize) {
            return;
        }
        let differences = |frame: usize| -> [Vec3; 3] {
            let (planted, free) = (&targets[frame], &free[frame]);
            [
                planted.ankle - free.ankle,
                log_map(planted.foot * free.foot.inverse()),
                log_map(planted.foot.inverse() * planted.toes),
            ]
        };
        // What the ends disagree about and how fast it changes there, per frame.
        let end_of = |frame: usize, inward: isize| {
            let other = (frame.cast_signed() + 2 * inward).clamp(0, last) as usize;
            let (here, inside) = (differences(frame), differences(other));
            let rate = |n: usize| (here[n] - inside[n]) * (-0.5 * inward as f32);
            (here, [rate(0), rate(1), rate(2)])
        };
        let still = |known: [Vec3; 3]| (known, [Vec3::ZERO; 3]);
        let from = lift.map(|frame| end_of(frame, -1));
        let to = landing.map(|frame| end_of(frame, 1));
        let ((start, departure), (end, arrival)) = match (from, to) {
            (Some(from), Some(to)) => (from, to),
            (Some(from), None) => (from, still(from.0)),
            (None, Some(to)) => (still(to.0), to),
            (None, None) => return,
        };
        // A swing whose other end lies outside the clip is taken to be as long as swings are.
        let usual = 0.4 * self.timeline.stride_frames;
        let first = lift.map_or_else(
            || landing.map_or(0.0, |frame| frame as f32 - usual),
            |frame| frame as f32,
        );
        let until = landing.map_or(first + usual, |frame| frame as f32);
        let frames = until - first;
        let raise = 0.01 * (self.sheet.feet.lift + self.sheet.sides[side.index()].lift);
        let inside = lift.map_or(0, |frame| frame + 1)..landing.unwrap_or(targets.len());
        for frame in inside {
            let s = ((frame as f32 - first) / frames).clamp(0.0, 1.0);
            let blend = |n: usize| {
                hermite(
                    start[n],
                    departure[n] * frames,
                    end[n],
                    arrival[n] * frames,
                    s,
                )
            };
            let rotation = (exp_map(blend(1)) * free[frame].foot).normalize();
            let hump = (PI * s).sin().powi(2);
            // Captured toes are guessed by most marker sets: from their bend at the end of the stance they straighten, and
            // they take on the bend with which they land, or a foot that lands on its toes would push them into the floor.
            let toes =
                start[2] * (1.0 - smooth_step(2.0 * s)) + end[2] * smooth_step(2.0 * s - 1.0);
            let mut target = FootTarget {
                ankle: free[frame].ankle + blend(0) + Vec3::Y * raise * hump,
                foot: rotation,
                toes: rotation * exp_map(toes),
            };
            let short = CLEARANCE_M * hump - foot.lowest_point(&target);
            target.ankle.y += soft_positive(short, 0.004 * (PI * s).sin() + 1e-5);
            targets[frame] = target;
        }
    }
}

/// Progress of a foot in its own cycle.
#[derive(Clone, Copy, Debug)]
enum Progress {
    /// Standing, frames since it landed.
    Stance { since: f32 },
    /// Swinging, 0 at its lift and 1 at its landing.
    Swing(f32),
}

fn progress(stances: &[FrameSpan], frame: usize) -> Progress {
    let next = stances.partition_point(|span| span.last < frame);
    let after = stances.get(next);
    let before = next.checked_sub(1).and_then(|n| stances.get(n));
    match (before, after) {
        (_, Some(span)) if span.first <= frame => {
            // A stance that the clip cuts off began long ago.
            let since = if span.first == 0 {
                f32::INFINITY
            } else {
                (frame - span.first) as f32
            };
            Progress::Stance { since }
        }
        (Some(before), Some(after)) => {
            Progress::Swing((frame - before.last) as f32 / (after.first - before.last) as f32)
        }
        (None, Some(after)) => Progress::Swing(frame as f32 / after.first.max(1) as f32),
        _ => Progress::Swing(0.0),
    }
}

fn models_of(skeleton: &Skeleton, poses: &[Pose]) -> Vec<ModelPose> {
    poses
        .iter()
        .map(|pose| ModelPose::of(skeleton, pose))
        .collect()
}

/// The value where it is positive and zero elsewhere, rounded off over `softness`.
fn soft_positive(value: f32, softness: f32) -> f32 {
    let ratio = value / softness;
    if ratio > 20.0 {
        value
    } else {
        softness * ratio.exp().ln_1p()
    }
}
