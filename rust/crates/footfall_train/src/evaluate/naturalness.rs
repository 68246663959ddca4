//! Naturalness by what can be measured on a clip alone: feet that slip, feet that skate, jerk.

mod slip;

pub use slip::{Slips, contact_slips, slips};

use footfall_core::{Clip, Joint, ModelPose, Side, forward_kinematics};
use glam::Vec3;

/// Rate of the skating ratio, frames per second, as its authors have it.
const SKATING_RATE_HZ: f64 = 20.0;
const SKATING_HEIGHT_M: f32 = 0.05;
const SKATING_SPEED_MPS: f32 = 0.5;
/// Frames over which the speed is averaged.
const SKATING_WINDOW: usize = 5;
/// Rate at which jerk is measured, frames per second: a third difference grows with the rate.
const JERK_RATE_HZ: f64 = 30.0;

/// Positions of all joints in every frame, model space, metres.
pub(super) fn joint_positions(clip: &Clip) -> Vec<ModelPose> {
    clip.poses
        .iter()
        .map(|pose| {
            let mut model = ModelPose::default();
            forward_kinematics(&clip.skeleton, pose, &mut model);
            model
        })
        .collect()
}

/// Share of the frames in which a foot skates (Karunratanakul et al. 2023, guided motion diffusion): at 20 fps, a toe joint
/// under 5 cm in two adjacent frames whose horizontal speed is over 0.5 m/s, both at once and averaged over five frames.
///
/// People score about 0.07, for a swinging toe passes under 5 cm. `None` for a clip of less than two frames at that rate.
pub fn skating_ratio(clip: &Clip) -> Option<f64> {
    let frames = joint_positions(&clip.resampled(SKATING_RATE_HZ));
    let count = frames.len().checked_sub(1).filter(|count| *count > 0)?;
    let mut skates = vec![false; count];
    for side in Side::BOTH {
        let toes: Vec<Vec3> = frames
            .iter()
            .map(|frame| frame.position(side.toes()))
            .collect();
        let speeds: Vec<f32> = toes
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).with_y(0.0).length() * SKATING_RATE_HZ as f32)
            .collect();
        for frame in 0..count {
            // As in the reference implementation, what lies beyond the ends counts as speed 0.
            let half = SKATING_WINDOW / 2;
            let around = &speeds[frame.saturating_sub(half)..(frame + half + 1).min(count)];
            let average = around.iter().sum::<f32>() / SKATING_WINDOW as f32;
            let is_low = toes[frame].y < SKATING_HEIGHT_M && toes[frame + 1].y < SKATING_HEIGHT_M;
            skates[frame] |=
                is_low && speeds[frame] > SKATING_SPEED_MPS && average > SKATING_SPEED_MPS;
        }
    }
    Some(skates.iter().filter(|skates| **skates).count() as f64 / count as f64)
}

/// Root mean square of the jerk (third derivative of the position) over all joints and frames at 30 fps, m/s³.
///
/// `None` for a clip of less than four frames at that rate.
pub fn jerk(clip: &Clip) -> Option<f64> {
    let frames = joint_positions(&clip.resampled(JERK_RATE_HZ));
    let (mut sum, mut count) = (0.0, 0_usize);
    for at in frames.windows(4) {
        for joint in Joint::ALL {
            let place = |frame: usize| at[frame].position(joint).as_dvec3();
            let third = place(3) - 3.0 * place(2) + 3.0 * place(1) - place(0);
            sum += (third * JERK_RATE_HZ.powi(3)).length_squared();
            count += 1;
        }
    }
    (count > 0).then(|| (sum / count as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Pose, Skeleton};

    /// The T-pose with its toes at 2 cm, moved by a path of time in seconds.
    fn moved(secs: f64, rate: f64, path: impl Fn(f64) -> Vec3) -> Clip {
        let skeleton = Skeleton::standard();
        let poses = (0..=(secs * rate).round() as usize)
            .map(|frame| {
                let mut pose = Pose::rest(&skeleton);
                pose.root_position += path(frame as f64 / rate);
                pose
            })
            .collect();
        Clip {
            skeleton,
            frame_rate_hz: rate,
            poses,
        }
    }

    #[test]
    fn a_sliding_figure_skates_and_a_standing_one_does_not() {
        let slide = |speed: f64| moved(2.0, 60.0, move |time| Vec3::Z * (speed * time) as f32);
        // Two frames at each end average over the emptiness beyond, at 0.6 of the speed.
        assert_eq!(skating_ratio(&slide(1.0)), Some(1.0));
        assert_eq!(skating_ratio(&slide(0.7)), Some(38.0 / 40.0));
        assert_eq!(skating_ratio(&slide(0.4)), Some(0.0));
        let flying = moved(2.0, 60.0, |time| Vec3::new(0.0, 0.1, time as f32));
        assert_eq!(skating_ratio(&flying), Some(0.0));
        assert_eq!(skating_ratio(&moved(0.0, 60.0, |_| Vec3::ZERO)), None);
    }

    #[test]
    fn jerk_of_a_cubic_is_its_third_derivative_at_any_rate() {
        for rate in [30.0, 60.0, 120.0] {
            let clip = moved(1.0, rate, |time| Vec3::X * (0.5 * time.powi(3)) as f32);
            let found = jerk(&clip).unwrap();
            assert!((found - 3.0).abs() < 0.05, "{rate} fps: {found}");
        }
        let straight = moved(1.0, 30.0, |time| Vec3::Z * time as f32);
        assert!(jerk(&straight).unwrap() < 0.05);
        assert_eq!(jerk(&moved(0.05, 30.0, |_| Vec3::ZERO)), None);
    }
}
