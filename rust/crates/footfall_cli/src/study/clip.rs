//! Recordings as participants see them.

use footfall_core::rotation::from_heading;
use footfall_core::{Clip, Joint, ModelPose, Side};
use footfall_motion::recording::Recording;
use footfall_motion::steps::{Step, Walk};
use glam::{Quat, Vec3};

/// Frames per second of the page.
pub(super) const RATE_HZ: f64 = 30.0;
/// Points of the figure: the joints, the top of the head, and heel and toe tip of each foot.
pub(super) const POINTS: usize = Joint::ALL.len() + 5;
/// Index of the top of the head among the points; heel and toe tip of the left and of the right foot follow.
pub(super) const HEAD_TOP: usize = Joint::ALL.len();
/// Fewer steps show no style.
const LEAST_STEPS: usize = 3;

/// Steps of one walk.
#[derive(Clone, Debug)]
pub(crate) struct Excerpt<'a> {
    /// Style that it shows or is meant to show.
    pub(crate) style: &'a str,
    /// Name of the recording in the answers.
    pub(crate) name: String,
    clip: &'a Clip,
    steps: &'a [Step],
}

/// One excerpt of each recording that has enough steps: of its longest walk, beginning with a left step, `seconds` long at
/// most.
pub(crate) fn excerpts<'a>(
    recordings: impl Iterator<Item = (&'a Recording, String)>,
    seconds: f64,
) -> Vec<Excerpt<'a>> {
    recordings
        .filter_map(|(recording, name)| {
            let clip = recording.clip();
            let walk = recording.walks.iter().max_by_key(|walk| walk.steps.len())?;
            let steps = opening(walk, clip, (seconds * clip.frame_rate_hz) as usize);
            (steps.len() >= LEAST_STEPS).then_some(Excerpt {
                style: recording.style(),
                name,
                clip,
                steps,
            })
        })
        .collect()
}

fn opening<'a>(walk: &'a Walk, clip: &Clip, frames: usize) -> &'a [Step] {
    let from = walk
        .steps
        .iter()
        .position(|step| step.side == Side::Left)
        .unwrap_or(0);
    let steps = &walk.steps[from..];
    let first = steps.first().map_or(0, |step| step.first);
    let fits = |step: &&Step| step.end - first <= frames && step.end < clip.poses.len();
    &steps[..steps.iter().take_while(fits).count()]
}

impl Excerpt<'_> {
    /// Number of its steps.
    pub(crate) fn steps(&self) -> usize {
        self.steps.len()
    }

    /// Positions of [`POINTS`] points in every frame at [`RATE_HZ`], millimetres, of the first `steps` steps. The figure starts
    /// above the origin and travels along +Z.
    pub(super) fn millimetres(&self, steps: usize) -> Vec<i16> {
        let shown = &self.steps[..steps.min(self.steps.len())];
        let (Some(first), Some(last)) = (shown.first(), shown.last()) else {
            return Vec::new();
        };
        let poses = self.clip.poses[first.first..=last.end].to_vec();
        let clip = Clip {
            poses,
            ..self.clip.clone()
        }
        .resampled(RATE_HZ);
        let places: Vec<Vec<Vec3>> = clip
            .poses
            .iter()
            .map(|pose| {
                let model = ModelPose::of(&clip.skeleton, pose);
                points(&clip, &model)
            })
            .collect();
        let (Some(start), Some(end)) = (places.first(), places.last()) else {
            return Vec::new();
        };
        let (origin, turn) = (start[0].with_y(0.0), towards_z(end[0] - start[0]));
        places
            .iter()
            .flatten()
            .flat_map(|place| (turn * (*place - origin) * 1000.0).to_array())
            .map(|value| {
                value
                    .round()
                    .clamp(f32::from(i16::MIN), f32::from(i16::MAX)) as i16
            })
            .collect()
    }
}

/// The turn about the vertical that makes a travel go along +Z; none for one who stays in place.
fn towards_z(travel: Vec3) -> Quat {
    if travel.with_y(0.0).length() > 0.3 {
        from_heading(-travel.x.atan2(travel.z))
    } else {
        Quat::IDENTITY
    }
}

fn points(clip: &Clip, model: &ModelPose) -> Vec<Vec3> {
    let mut points = model.positions.to_vec();
    points.push(model.point(Joint::Head, clip.skeleton.head_top));
    for side in Side::BOTH {
        let shape = clip.skeleton.foot(side);
        points.push(model.point(side.foot(), shape.heel));
        points.push(model.point(side.toes(), shape.toe_tip));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Pose, Skeleton};
    use footfall_motion::retarget::Retargeted;

    fn recording(steps: usize) -> Recording {
        let skeleton = Skeleton::standard();
        let poses = (0..=steps * 20)
            .map(|frame| {
                let mut pose = Pose::rest(&skeleton);
                // Along -X, turned to face it.
                pose.root_position += Vec3::new(5.0 - 0.02 * frame as f32, 0.0, 2.0);
                pose.rotations[0] = from_heading(-core::f32::consts::FRAC_PI_2);
                pose
            })
            .collect();
        let steps = (0..steps)
            .map(|index| Step::inside(Side::BOTH[(index + 1) % 2], 20 * index, 20 * (index + 1)));
        let clip = Clip {
            skeleton,
            frame_rate_hz: 60.0,
            poses,
        };
        let mut recording = Recording::detected(Retargeted::canonical(clip));
        recording.row.set("style", "sad");
        recording.walks = vec![Walk {
            steps: steps.collect(),
        }];
        recording
    }

    #[test]
    fn figures_start_at_the_origin_and_travel_forward() {
        let recording = recording(8);
        let excerpts = excerpts([(&recording, "one".to_owned())].into_iter(), 1.5);
        let excerpt = &excerpts[0];
        assert_eq!(
            excerpt.steps(),
            4,
            "from the first left step, as many as fit"
        );
        let millimetres = excerpt.millimetres(3);
        let frames: Vec<&[i16]> = millimetres.chunks_exact(3 * POINTS).collect();
        assert_eq!(frames.len(), 31);
        assert_eq!(frames[0][..3], [0, 985, 0]);
        assert!(
            (frames[30][2] - 1200).abs() <= 1 && frames[30][0].abs() <= 1,
            "{:?}",
            &frames[30][..3]
        );
        // The left ankle is to the left of one who walks along +Z, the toes ahead.
        let point = |index: usize| &frames[0][3 * index..3 * index + 3];
        assert!(point(Joint::LeftFoot.index())[0] > 50);
        assert!(point(HEAD_TOP + 2)[2] > point(HEAD_TOP + 1)[2] + 100);
        assert!(point(HEAD_TOP)[1] > 1700);
    }

    #[test]
    fn short_recordings_are_left_out() {
        let short = recording(3);
        assert!(excerpts([(&short, String::new())].into_iter(), 9.0).is_empty());
    }
}
