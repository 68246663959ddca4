//! A stride in two hundred numbers, the same for every body, rate and direction of travel.
//!
//! A stride is two steps, so every joint is seen through a whole cycle and it hardly matters where the cycle begins. For
//! each joint but the toes (which capture measures badly and planting moves) and each component of its exponential map: the
//! mean (posture), the standard deviation and the range (swing). Beside them speed, cadence, stride and step width, and
//! height, bob and sway of the hips.

use crate::dataset::smooth_headings;
use footfall_core::rotation::{from_heading, log_map, log_map_near};
use footfall_core::{Clip, Joint, ModelPose, Side, StepPosition};
use footfall_motion::steps::{Step, Walk};
use glam::Vec3;

/// Samples of a time-normalised step.
pub const PHASES: usize = 20;
/// Least standard deviation of a feature (radians, metres, metres per second, hertz): a third of a degree or half a centimetre is
/// invisible, and a joint that capture holds still would otherwise dominate the comparison.
pub const LEAST_SPREAD: f64 = 0.005;
/// Angles per frame: three components of each joint.
const ANGLES: usize = 3 * Joint::ALL.len();

/// A stride and what the measures need of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Stride {
    /// The foot that its first step stands on.
    pub side: Side,
    /// First frame of the clip.
    pub first: usize,
    /// The frame after its last.
    pub end: usize,
    /// See [`feature_names`].
    pub features: Vec<f64>,
    /// Joint angles of the first step, time-normalised: phases × joints × 3, radians.
    pub step_angles: Vec<f64>,
    /// Variance of each joint's angles over the stride, summed over the three components, rad².
    pub joint_variances: Vec<f64>,
}

/// Joints whose swing is part of the features.
fn judged_joints() -> impl Iterator<Item = Joint> {
    Joint::ALL
        .into_iter()
        .filter(|joint| !matches!(joint, Joint::LeftToes | Joint::RightToes))
}

/// Names of the features in their order.
pub fn feature_names() -> Vec<String> {
    let mut names = Vec::new();
    for joint in judged_joints() {
        for axis in ["x", "y", "z"] {
            for kind in ["mean", "deviation", "range"] {
                names.push(format!("{} {axis} {kind}", joint.name()));
            }
        }
    }
    let others = [
        "speed_mps",
        "cadence_hz",
        "stride_m",
        "step_width_m",
        "hips_height_m",
        "hips_bob_m",
        "hips_sway_m",
    ];
    names.extend(others.map(str::to_owned));
    names
}

/// The strides of a clip's walks: every step with the one that follows, without steps out of and into standing.
pub fn strides(clip: &Clip, walks: &[Walk]) -> Vec<Stride> {
    let motion = Motion::of(clip);
    let is_under_way =
        |step: &Step| !matches!(step.position, StepPosition::First | StepPosition::Last);
    let pairs = walks.iter().flat_map(|walk| walk.steps.windows(2));
    pairs
        .filter(|pair| pair.iter().all(is_under_way) && pair[1].end <= clip.poses.len())
        .map(|pair| motion.stride(&pair[0], &pair[1]))
        .collect()
}

/// A clip in the terms that features are made of.
struct Motion {
    frame_rate_hz: f64,
    /// Frames × [`ANGLES`]: exponential maps, continuous over time; of the hips without their heading.
    angles: Vec<f64>,
    frames: Vec<ModelPose>,
    headings: Vec<f64>,
}

impl Motion {
    fn of(clip: &Clip) -> Self {
        let headings = smooth_headings(clip);
        let mut angles: Vec<f64> = Vec::with_capacity(clip.poses.len() * ANGLES);
        let mut frames = Vec::with_capacity(clip.poses.len());
        let mut previous: Option<Vec<Vec3>> = None;
        for (pose, heading) in clip.poses.iter().zip(&headings) {
            let now: Vec<Vec3> = Joint::ALL
                .into_iter()
                .map(|joint| {
                    let rotation = match joint {
                        Joint::Hips => from_heading(-*heading as f32) * pose.rotation(joint),
                        _ => pose.rotation(joint),
                    };
                    previous.as_ref().map_or_else(
                        || log_map(rotation),
                        |before| log_map_near(rotation, before[joint.index()]),
                    )
                })
                .collect();
            angles.extend(now.iter().flat_map(Vec3::to_array).map(f64::from));
            previous = Some(now);
            let model = ModelPose::of(&clip.skeleton, pose);
            frames.push(model);
        }
        Self {
            frame_rate_hz: clip.frame_rate_hz,
            angles,
            frames,
            headings,
        }
    }

    fn angle(&self, frame: usize, component: usize) -> f64 {
        let frame = frame.min(self.frames.len() - 1);
        self.angles[frame * ANGLES + component]
    }

    fn ankle(&self, side: Side, frame: usize) -> Vec3 {
        self.frames[frame.min(self.frames.len() - 1)]
            .position(side.foot())
            .with_y(0.0)
    }

    fn stride(&self, first: &Step, second: &Step) -> Stride {
        let frames = first.first..second.end;
        let series = |component: usize| frames.clone().map(move |at| self.angle(at, component));
        let mut features = Vec::new();
        let mut joint_variances = vec![0.0; Joint::ALL.len()];
        for joint in Joint::ALL {
            for axis in 0..3 {
                let swing = Summary::of(series(3 * joint.index() + axis));
                joint_variances[joint.index()] += swing.deviation * swing.deviation;
            }
        }
        for joint in judged_joints() {
            for axis in 0..3 {
                let swing = Summary::of(series(3 * joint.index() + axis));
                features.extend([swing.mean, swing.deviation, swing.range]);
            }
        }
        features.extend(self.travel_features(first, second));
        Stride {
            side: first.side,
            first: first.first,
            end: second.end,
            features,
            step_angles: self.normalised(first),
            joint_variances,
        }
    }

    fn travel_features(&self, first: &Step, second: &Step) -> [f64; 7] {
        let (begin, end) = (first.first, second.end.min(self.frames.len() - 1));
        let secs = (second.end - begin) as f64 / self.frame_rate_hz;
        let hips = |frame: usize| self.frames[frame].position(Joint::Hips);
        let travel = hips(end) - hips(begin);
        let stride_m = f64::from(travel.x.hypot(travel.z));
        let heights = Summary::of((begin..end).map(|frame| f64::from(hips(frame).y)));
        // Sway is across the line on which the hips travel, or across the heading of one who stays in place.
        let middle = self.headings[usize::midpoint(begin, end)] as f32;
        let forward = if stride_m > 0.1 {
            travel.with_y(0.0).normalize()
        } else {
            from_heading(middle) * Vec3::Z
        };
        let left = Vec3::Y.cross(forward);
        let sway = Summary::of((begin..end).map(|frame| f64::from(hips(frame).dot(left))));
        // Width: how far the middle landing lies from the line through the landings of the other foot.
        let other = self.ankle(second.side, second.first);
        let line = self.ankle(first.side, second.end) - self.ankle(first.side, first.first);
        let across = if line.length() > 0.1 {
            Vec3::Y.cross(line.normalize())
        } else {
            left
        };
        let width = (other - self.ankle(first.side, first.first))
            .dot(across)
            .abs();
        [
            stride_m / secs,
            2.0 / secs,
            stride_m,
            f64::from(width),
            heights.mean,
            heights.range,
            sway.range,
        ]
    }

    /// A step's angles at [`PHASES`] equally spaced moments.
    fn normalised(&self, step: &Step) -> Vec<f64> {
        let length = step.frames() as f64;
        let mut samples = Vec::with_capacity(PHASES * ANGLES);
        for phase in 0..PHASES {
            let position = step.first as f64 + length * phase as f64 / PHASES as f64;
            let (frame, share) = (position.floor() as usize, position.fract());
            samples.extend((0..ANGLES).map(|component| {
                let (from, to) = (
                    self.angle(frame, component),
                    self.angle(frame + 1, component),
                );
                from + share * (to - from)
            }));
        }
        samples
    }
}

struct Summary {
    mean: f64,
    deviation: f64,
    range: f64,
}

impl Summary {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let count = values.clone().count().max(1) as f64;
        let mean = values.clone().sum::<f64>() / count;
        let variance = values
            .clone()
            .map(|value| (value - mean).powi(2))
            .sum::<f64>()
            / count;
        let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        Self {
            mean,
            deviation: variance.sqrt(),
            range: (high - low).max(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::rotation::{exp_map, from_heading};
    use footfall_core::{Pose, Skeleton};

    const RATE: f64 = 60.0;
    const STEP_FRAMES: usize = 30;

    /// Hips at 1.2 m/s that bob 4 cm and sway, a knee that swings by 0.5 ± 0.3 rad, turned as a whole.
    fn walk(heading: f32, steps: usize) -> (Clip, Vec<Walk>) {
        let skeleton = Skeleton::standard();
        let turned = from_heading(heading);
        let poses = (0..=steps * STEP_FRAMES)
            .map(|frame| {
                let time = frame as f32 / RATE as f32;
                let cycle = core::f32::consts::TAU * time;
                let mut pose = Pose::rest(&skeleton);
                let place = Vec3::new(
                    0.03 * cycle.cos(),
                    0.9 + 0.02 * (2.0 * cycle).cos(),
                    1.2 * time,
                );
                pose.root_position = turned * place;
                pose.rotations[Joint::Hips.index()] = turned;
                pose.rotations[Joint::LeftLowerLeg.index()] =
                    exp_map(Vec3::X * (0.5 + 0.3 * cycle.sin()));
                pose
            })
            .collect();
        let clip = Clip {
            skeleton,
            frame_rate_hz: RATE,
            poses,
        };
        let steps = (0..steps)
            .map(|index| {
                Step::inside(
                    Side::BOTH[index % 2],
                    index * STEP_FRAMES,
                    (index + 1) * STEP_FRAMES,
                )
            })
            .collect();
        (clip, vec![Walk { steps }])
    }

    fn feature(stride: &Stride, name: &str) -> f64 {
        let index = feature_names().iter().position(|known| known == name);
        stride.features[index.unwrap()]
    }

    #[test]
    fn features_of_a_known_walk() {
        let (clip, walks) = walk(0.0, 6);
        let strides = strides(&clip, &walks);
        assert_eq!(strides.len(), 5);
        assert_eq!(strides[0].features.len(), feature_names().len());
        let expected = [
            ("LeftLowerLeg x mean", 0.5),
            ("LeftLowerLeg x deviation", 0.3 / 2_f64.sqrt()),
            ("LeftLowerLeg x range", 0.6),
            ("RightLowerLeg x range", 0.0),
            ("speed_mps", 1.2),
            ("cadence_hz", 2.0),
            ("stride_m", 1.2),
            // The feet sway along: 18 cm and twice 3 cm.
            ("step_width_m", 0.24),
            ("hips_height_m", 0.9),
            ("hips_bob_m", 0.04),
            ("hips_sway_m", 0.06),
        ];
        for (name, value) in expected {
            let found = feature(&strides[1], name);
            assert!(
                (found - value).abs() < 2e-3,
                "{name}: {found} is not {value}"
            );
        }
        let knee = strides[1].joint_variances[Joint::LeftLowerLeg.index()];
        assert!((knee - 0.045).abs() < 1e-3, "{knee}");
        let quarter = strides[0].step_angles[10 * ANGLES + 3 * Joint::LeftLowerLeg.index()];
        assert!((quarter - 0.8).abs() < 1e-3, "{quarter}");
    }

    #[test]
    fn neither_direction_nor_rate_matters() {
        let (clip, walks) = walk(0.0, 6);
        let (turned, _) = walk(2.0, 6);
        let coarse = clip.resampled(30.0);
        let mut half = walks.clone();
        for step in &mut half[0].steps {
            step.first /= 2;
            step.end /= 2;
        }
        let reference = strides(&clip, &walks);
        for other in [strides(&turned, &walks), strides(&coarse, &half)] {
            for (a, b) in reference.iter().zip(&other) {
                for (name, (a, b)) in feature_names()
                    .iter()
                    .zip(a.features.iter().zip(&b.features))
                {
                    assert!((a - b).abs() < 8e-3, "{name}: {a} and {b}");
                }
            }
        }
    }

    #[test]
    fn steps_out_of_and_into_standing_are_left_out() {
        let (clip, mut walks) = walk(0.0, 6);
        walks[0].steps[0].position = StepPosition::First;
        walks[0].steps[5].position = StepPosition::Last;
        assert_eq!(strides(&clip, &walks).len(), 3);
    }
}
