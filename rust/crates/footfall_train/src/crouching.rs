//! Crouching, as a part of a gait model.

use crate::beside::{Arms, Upright, symmetric};
use footfall_core::{Clip, Joint};
use footfall_model::layout::feature_offset;
use footfall_model::{BESIDE_COUNT, CrouchModel, FEATURE_COUNT, StandingModel};

/// Least height of upright hips, and greatest height of crouching hips, as shares of their height
/// in the T-pose.
const UPRIGHT_SHARE: f32 = 0.95;
const CROUCHED_SHARE: f32 = 0.9;

/// The deepest crouch is that of this quantile of crouched frames, and so is the fastest.
const QUANTILE: f64 = 0.9;

/// Time over which the hips give the speed, seconds.
const SPEED_SECS: f64 = 1.0;

/// Less is no crouch to learn from, seconds; nor are fewer upright ones to compare with.
const LEAST_SECS: f64 = 3.0;
const LEAST_UPRIGHT_SECS: f64 = 0.5;

/// Crouching as learned, and the amount of data behind it.
#[derive(Clone, Debug)]
pub struct LearnedCrouching {
    /// The section of a model.
    pub model: CrouchModel,
    /// For how many seconds people crouch.
    pub secs: f64,
}

/// Sums over the frames of a crouching person.
#[derive(Default)]
struct Sums {
    /// Of each number of a posture times how low it is, and of that alone and squared.
    by_depth: Vec<f64>,
    depth: f64,
    squared: f64,
    depths: Vec<f64>,
    speeds: Vec<f64>,
    secs: f64,
}

/// Learns how people crouch; each clip comes with its leading frames to leave out, and shows a person both upright and low. `None` if no clip
/// has some seconds of crouching.
///
/// The hips go as far ahead as they go down: a regression through the upright posture, for people crouch in between as well. Trunk, head and arms have their posture in any crouch, so
/// theirs is a mean, in which deeper crouches count for more. The trunk is compared with the same person's upright one. Arms are compared with those of `standing`,
/// from which the model crouches, if it has learned to stand.
/// They stay different left and right: people hold one hand before the other, and even ones would meet.
pub fn learn(
    clips: &[(&Clip, usize)],
    standing: Option<&StandingModel>,
) -> Option<LearnedCrouching> {
    let arms = standing.map(Arms::of);
    let mut sums = Sums {
        by_depth: vec![0.0; BESIDE_COUNT],
        ..Sums::default()
    };
    for (clip, skip) in clips {
        sums.add(clip, *skip, arms.as_ref());
    }
    if sums.secs < LEAST_SECS {
        return None;
    }
    let depth = quantile(&mut sums.depths);
    let mut beside: Vec<f64> = sums.by_depth.iter().map(|sum| sum / sums.depth).collect();
    beside[FEATURE_COUNT + 1] = depth * sums.by_depth[FEATURE_COUNT + 1] / sums.squared;
    beside[FEATURE_COUNT] = -depth;
    let even = symmetric(&beside);
    for joint in Joint::ALL {
        let at = feature_offset(joint)..feature_offset(joint) + 3;
        if joint.is_of_leg() {
            beside[at].fill(0.0);
        } else if !joint.is_of_arm() {
            beside[at.clone()].copy_from_slice(&even[at]);
        }
    }
    Some(LearnedCrouching {
        model: CrouchModel {
            beside,
            fastest: quantile(&mut sums.speeds).max(f64::MIN_POSITIVE),
        },
        secs: sums.secs,
    })
}

impl Sums {
    /// Adds a clip; `arms` are those from which the model crouches, if they are not the person's own.
    fn add(&mut self, clip: &Clip, skip: usize, arms: Option<&Arms>) {
        let rate = clip.frame_rate_hz;
        let (leg, height) = (clip.skeleton.mean_leg_length(), clip.skeleton.hip_height());
        let poses = clip.poses.get(skip..).unwrap_or_default();
        let upright: Vec<Upright> = poses
            .iter()
            .filter(|pose| pose.root_position.y > UPRIGHT_SHARE * height)
            .map(|pose| Upright::new(&clip.skeleton, pose))
            .collect();
        if (upright.len() as f64) < LEAST_UPRIGHT_SECS * rate {
            return;
        }
        let Some(mut standing) = Upright::mean(&upright) else {
            return;
        };
        if let Some(arms) = arms {
            standing.carry_arms(arms, 1.0);
        }
        let reach = (0.5 * SPEED_SECS * rate) as usize;
        for (index, pose) in poses.iter().enumerate() {
            if pose.root_position.y > CROUCHED_SHARE * height {
                continue;
            }
            let row = Upright::new(&clip.skeleton, pose).beside(&standing, leg);
            let depth = -row[FEATURE_COUNT];
            for (sum, value) in self.by_depth.iter_mut().zip(&row) {
                *sum += depth * value;
            }
            self.depth += depth;
            self.squared += depth * depth;
            self.depths.push(depth);
            self.secs += 1.0 / rate;
            let [from, to] = [
                index.saturating_sub(reach),
                (index + reach).min(poses.len() - 1),
            ];
            let way = poses[to].root_position - poses[from].root_position;
            let secs = (to - from).max(1) as f64 / rate;
            self.speeds
                .push(f64::from(way.with_y(0.0).length() / leg) / secs);
        }
    }
}

fn quantile(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let index = (QUANTILE * values.len().saturating_sub(1) as f64) as usize;
    values.get(index).copied().unwrap_or_default()
}
