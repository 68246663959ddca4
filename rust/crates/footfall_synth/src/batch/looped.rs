//! Looping walks, for tools that play clips.

use crate::controls::Controls;
use crate::footstep::Footstep;
use crate::generator::GaitGenerator;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::{from_heading, wrap_angle};
use footfall_core::{
    GroundTransform, JOINT_COUNT, Joint, ModelPose, Pose, Side, forward_kinematics,
};
use glam::{Quat, Vec3};

/// Time before recording starts, seconds: speed and style settle.
const SETTLING_SECS: f32 = 4.0;
/// Time beyond the requested length in which a beginning and an end are chosen, seconds.
const CHOICE_SECS: f32 = 120.0;
/// Maximum length of a loop, seconds.
const MOST_SECS: f32 = 120.0;
/// Number of corrections of the requested speed, and the relative error that suffices.
const CORRECTIONS: usize = 6;
const SPEED_TOLERANCE: f32 = 0.003;
/// Maximum share by which time is stretched to match the requested speed exactly.
const MOST_STRETCH: f32 = 0.03;
/// Time by which a mismatch of joint velocities is weighted against one of positions, seconds.
const VELOCITY_SECS: f32 = 0.1;
/// Time before the end in which trunk and arms blend to their motion before the beginning, seconds.
const FADE_SECS: f32 = 0.4;
/// The same for a standing person, seconds.
const STANDING_FADE_SECS: f32 = 2.0;
/// Weight of a mismatch of a leg's joints relative to other joints: drifting feet are visible, drifting arms are not.
const LEG_WEIGHT: f32 = 6.0;
/// Weight of a relative error of speed, metres of mismatch.
const SPEED_ERROR_M: f32 = 1.0;

/// Walk of whole strides, straight ahead at constant speed, whose last frame equals its first one, one loop farther.
#[derive(Clone, Debug)]
pub struct LoopedWalk {
    /// Time between two frames, seconds.
    pub frame_secs: f32,
    /// Poses above a point of the ground that moves along +Z at `speed_mps`. The last equals the first.
    pub poses: Vec<Pose>,
    /// Speed of that point.
    pub speed_mps: f32,
    /// Largest distance by which a joint was moved to close the loop, metres, spread evenly over the loop.
    pub seam_m: f32,
}

impl LoopedWalk {
    /// Returns the length of one loop, seconds.
    pub fn duration_secs(&self) -> f32 {
        self.frame_secs * self.poses.len().saturating_sub(1) as f32
    }

    /// Records the loop of about this length at this speed that closes best. It begins and ends with initial contacts of the left foot.
    ///
    /// `make` returns a generator at its beginning; each call gives the same walk. `None` if it returns none or the walk does not move. A speed out of reach becomes the nearest possible one.
    pub fn record(
        make: impl Fn() -> Option<GaitGenerator>,
        speed_mps: f32,
        secs: f32,
    ) -> Option<Self> {
        let secs = secs.clamp(0.0, MOST_SECS);
        let mut controls = Controls {
            speed_mps,
            ..Controls::STAND
        };
        let mut recording = Recording::of(make()?, &controls, secs + CHOICE_SECS);
        for _ in 0..CORRECTIONS {
            let ratio = speed_mps / recording.speed_mps().max(f32::MIN_POSITIVE);
            if (ratio - 1.0).abs() < SPEED_TOLERANCE {
                break;
            }
            controls.speed_mps *= ratio.clamp(0.5, 2.0);
            recording = Recording::of(make()?, &controls, secs + CHOICE_SECS);
        }
        let (from, to) = recording.best_loop(speed_mps, secs)?;
        Some(recording.closed(from, to, speed_mps))
    }

    /// Records a standing person for this long.
    pub fn standing(mut generator: GaitGenerator, secs: f32) -> Self {
        generator.stand();
        let secs = secs.clamp(0.0, MOST_SECS);
        let fade = STANDING_FADE_SECS.min(0.5 * secs);
        let mut recording = Recording::of(generator, &Controls::STAND, secs + fade);
        let first = (fade / recording.frame_secs).round() as usize;
        recording.meet(first);
        let last = recording.poses.len() - 1;
        recording.closed(first, last, 0.0)
    }
}

/// A generated walk, frame by frame.
struct Recording {
    frame_secs: f32,
    skeleton: footfall_core::Skeleton,
    poses: Vec<Pose>,
    places: Vec<GroundTransform>,
    /// Frames of the left foot's initial contacts.
    contacts: Vec<usize>,
}

impl Recording {
    fn of(mut generator: GaitGenerator, controls: &Controls, secs: f32) -> Self {
        let frame_secs = generator.frame_rate_hz.recip();
        let skeleton = generator.skeleton.clone();
        let mut pose = Pose::rest(&skeleton);
        let count = |secs: f32| (secs / frame_secs).ceil() as usize;
        for _ in 0..count(SETTLING_SECS) {
            generator.step(frame_secs, controls, &mut pose);
        }
        let frames = count(secs).max(1) + 1;
        let mut recording = Self {
            frame_secs,
            skeleton,
            poses: Vec::with_capacity(frames),
            places: Vec::with_capacity(frames),
            contacts: Vec::new(),
        };
        for frame in 0..frames {
            generator.step(frame_secs, controls, &mut pose);
            recording.poses.push(pose.clone());
            recording.places.push(generator.start_from_character());
            let lands = |step: &Footstep| step.side == Side::Left;
            if generator.footsteps().iter().any(lands) {
                recording.contacts.push(frame);
            }
        }
        recording
    }

    /// Mean speed of whole strides.
    fn speed_mps(&self) -> f32 {
        match (self.contacts.first(), self.contacts.last()) {
            (Some(&from), Some(&to)) if to > from => self.speed_between(from, to),
            _ => 0.0,
        }
    }

    fn speed_between(&self, from: usize, to: usize) -> f32 {
        let way = self.places[to]
            .position
            .distance(self.places[from].position);
        way / (self.frame_secs * (to - from) as f32)
    }

    /// Returns the best beginning and end of whole strides of about this length; `None` without a walk.
    fn best_loop(&self, speed_mps: f32, secs: f32) -> Option<(usize, usize)> {
        let strides = self
            .contacts
            .len()
            .checked_sub(1)
            .filter(|count| *count > 0)?;
        let stride_frames = (self.contacts[strides] - self.contacts[0]) as f32 / strides as f32;
        let wanted = (secs / (self.frame_secs * stride_frames)).round() as usize;
        let wanted = wanted.clamp(1, strides);
        let looks: Vec<_> = self
            .contacts
            .iter()
            .map(|&frame| self.look(frame))
            .collect();
        let mut best: Option<(f32, usize, usize)> = None;
        for from in 0..=strides - wanted {
            let (begin, end) = (self.contacts[from], self.contacts[from + wanted]);
            let Some((first, last)) = looks[from].as_ref().zip(looks[from + wanted].as_ref())
            else {
                continue;
            };
            let speed = self.speed_between(begin, end);
            let cost = Look::apart(first, last) + SPEED_ERROR_M * (speed / speed_mps - 1.0).abs();
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, begin, end));
            }
        }
        best.map(|(_, begin, end)| (begin, end))
    }

    /// Joints of a frame and of the one after; `None` for the last.
    fn look(&self, frame: usize) -> Option<Look> {
        let places = |frame: usize| {
            let mut model = ModelPose::default();
            forward_kinematics(&self.skeleton, self.poses.get(frame)?, &mut model);
            Some(Joint::ALL.map(|joint| model.position(joint)))
        };
        let (now, next) = (places(frame)?, places(frame + 1)?);
        Some(Look {
            velocities: core::array::from_fn(|joint| (next[joint] - now[joint]) / self.frame_secs),
            positions: now,
        })
    }

    /// Returns the loop above a point of constant velocity, with the mismatch at its end spread over all frames.
    fn closed(&self, from: usize, to: usize, speed_mps: f32) -> LoopedWalk {
        let (begin, end) = (&self.places[from], &self.places[to]);
        let way = end.position - begin.position;
        let course = if speed_mps > 0.0 {
            way.x.atan2(way.z)
        } else {
            begin.heading
        };
        let start_from_course = from_heading(course);
        let frames = to - from;
        let mut poses: Vec<Pose> = (from..=to)
            .map(|frame| {
                let along = (frame - from) as f32 / frames as f32;
                let place = &self.places[frame];
                let ground = begin.position + along * way;
                let turn = from_heading(wrap_angle(place.heading - course));
                let mut pose = self.poses[frame].clone();
                let offset = start_from_course.conjugate() * (place.position - ground);
                pose.root_position = turn * pose.root_position + offset;
                pose.rotations[Joint::Hips.index()] = turn * pose.rotations[Joint::Hips.index()];
                pose
            })
            .collect();
        let seam_m = match (self.look(from), self.look(to)) {
            (Some(first), Some(last)) => Look::farthest(&first, &last),
            _ => 0.0,
        };
        self.fade(from, to, &mut poses);
        close(&mut poses);
        let walked = self.speed_between(from, to);
        let stretch = if speed_mps > 0.0 {
            walked / speed_mps
        } else {
            1.0
        };
        let stretch = if (stretch - 1.0).abs() <= MOST_STRETCH {
            stretch
        } else {
            1.0
        };
        LoopedWalk {
            frame_secs: self.frame_secs * stretch,
            poses,
            speed_mps: walked / stretch,
            seam_m,
        }
    }

    /// Blends a standing person, towards the end, to their motion before the frame `first`. A blend of two poses on the same feet stands
    /// on them, too.
    fn meet(&mut self, first: usize) {
        let last = self.poses.len() - 1;
        for left in 0..first {
            let share = smooth_step(1.0 - left as f32 / first as f32);
            let before = self.poses[first - left].clone();
            let pose = &mut self.poses[last - left];
            *pose = pose.interpolate(&before, share);
        }
    }

    /// Blends joints that do not bear the body to their motion before the beginning, so that they continue there at the same speed.
    fn fade(&self, from: usize, to: usize, poses: &mut [Pose]) {
        let frames = ((FADE_SECS / self.frame_secs) as usize)
            .min(from)
            .min(to - from);
        for (left, pose) in poses.iter_mut().rev().enumerate().take(frames) {
            let share = smooth_step(1.0 - left as f32 / frames as f32);
            for joint in Joint::ALL
                .into_iter()
                .filter(|joint| !joint.is_of_lower_body())
            {
                let before = self.poses[from - left].rotation(joint);
                let rotation = &mut pose.rotations[joint.index()];
                *rotation = rotation.slerp(before, share);
            }
        }
    }
}

/// Positions and velocities of a frame's joints.
struct Look {
    positions: [Vec3; JOINT_COUNT],
    velocities: [Vec3; JOINT_COUNT],
}

impl Look {
    /// Mean distance of joints, in place and velocity.
    fn apart(a: &Self, b: &Self) -> f32 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for joint in Joint::ALL {
            let index = joint.index();
            let weight = if joint.is_of_lower_body() {
                LEG_WEIGHT
            } else {
                1.0
            };
            sum += weight
                * (a.positions[index].distance(b.positions[index])
                    + VELOCITY_SECS * a.velocities[index].distance(b.velocities[index]));
            weights += weight;
        }
        sum / weights
    }

    fn farthest(a: &Self, b: &Self) -> f32 {
        (0..JOINT_COUNT)
            .map(|joint| a.positions[joint].distance(b.positions[joint]))
            .fold(0.0, f32::max)
    }
}

/// Spreads the mismatch between the last and the first frame over all frames. Standing feet move by millimetres at most.
fn close(poses: &mut [Pose]) {
    let (Some(first), Some(last)) = (poses.first().cloned(), poses.last().cloned()) else {
        return;
    };
    let steps = (poses.len() - 1).max(1) as f32;
    let missing: [Quat; JOINT_COUNT] = core::array::from_fn(|joint| {
        let turn = last.rotations[joint].conjugate() * first.rotations[joint];
        if turn.w < 0.0 { -turn } else { turn }
    });
    for (frame, pose) in poses.iter_mut().enumerate() {
        let share = frame as f32 / steps;
        pose.root_position += share * (first.root_position - last.root_position);
        for (rotation, missing) in pose.rotations.iter_mut().zip(missing) {
            *rotation = (*rotation * Quat::IDENTITY.slerp(missing, share)).normalize();
        }
    }
    // Without rounding errors.
    let last = poses.len() - 1;
    poses[last] = poses[0].clone();
}
