//! A recording as it is judged.

use super::stride_features::{Stride, strides};
use footfall_core::Clip;
use footfall_motion::recording::Recording;
use footfall_motion::steps::Walk;

/// A recording of a style with its strides.
pub(super) struct Take {
    pub(super) style: usize,
    pub(super) motion: Moving,
    /// Place among the recordings of its style.
    pub(super) number: usize,
    pub(super) strides: Vec<Stride>,
}

/// The motion proper of a recording: an artificial T-pose at its front would count as a jerk.
pub(super) struct Moving {
    clip: Clip,
    /// In frames of the clip.
    walks: Vec<Walk>,
}

impl Moving {
    pub(super) fn of(recording: &Recording) -> Self {
        let (clip, first) = (recording.clip(), recording.first_frame());
        let mut walks = recording.walks.clone();
        for step in walks.iter_mut().flat_map(|walk| &mut walk.steps) {
            let shift = |frame: usize| frame.saturating_sub(first);
            (step.first, step.end) = (shift(step.first), shift(step.end));
            step.other_terminal = step.other_terminal.map(shift);
            step.heel_rise = step.heel_rise.map(shift);
            step.take_off = step.take_off.map(shift);
        }
        Self {
            clip: Clip {
                poses: clip.poses.get(first..).unwrap_or_default().to_vec(),
                ..clip.clone()
            },
            walks,
        }
    }

    pub(super) fn strides(&self) -> Vec<Stride> {
        strides(&self.clip, &self.walks)
    }

    /// Each walk as a clip of its own: the frames before, between and after are no gait.
    pub(super) fn walking(&self) -> Vec<Clip> {
        let span = |walk: &Walk| Some((walk.steps.first()?.first, walk.steps.last()?.end));
        self.walks
            .iter()
            .filter_map(|walk| {
                let (first, end) = span(walk)?;
                let end = end.min(self.clip.poses.len());
                Some(Clip {
                    poses: self.clip.poses.get(first..end)?.to_vec(),
                    ..self.clip.clone()
                })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Pose, Side, Skeleton};
    use footfall_motion::retarget::Retargeted;
    use footfall_motion::steps::Step;

    #[test]
    fn leading_frames_are_cut_off_and_steps_move_along() {
        let skeleton = Skeleton::standard();
        let pose = |frame: u8| {
            let mut pose = Pose::rest(&skeleton);
            pose.root_position.z = f32::from(frame);
            pose
        };
        let mut whole = Recording::detected(Retargeted::canonical(Clip {
            poses: (0..100).map(pose).collect(),
            frame_rate_hz: 30.0,
            skeleton,
        }));
        let step = |first, end| Step {
            other_terminal: Some(first + 3),
            ..Step::inside(Side::Left, first, end)
        };
        whole.walks = vec![Walk {
            steps: vec![step(48, 72)],
        }];
        whole.retargeted.first_frame = 5;
        let moving = Moving::of(&whole);
        assert_eq!(moving.clip.poses[0], whole.clip().poses[5]);
        let moved = &moving.walks[0].steps[0];
        assert_eq!(
            (moved.first, moved.end, moved.other_terminal),
            (43, 67, Some(46))
        );
        assert_eq!(moving.walking()[0].poses.len(), 24);
    }
}
