//! Legs of a recording, solved anew between corrected hip joints and the ankles that stay where they were.

use super::rest::rest_rotations;
use super::source::{SourceFrame, SourceMotion};
use crate::hip_centres::HipCorrection;
use footfall_core::rotation::shortest_arc;
use footfall_core::{Joint, Side};
use glam::Vec3;

/// Weight of the knee's own mean axis beside the plane of a leg whose segments have length one: where the leg is nearly
/// straight it has no plane.
const AXIS_WEIGHT: f32 = 0.05;
/// A leg is never stretched beyond this share of its length, so that its knee keeps a side to bend to.
const MOST_STRETCHED: f32 = 0.9995;
/// A leg comes up to that over this share of its length: a knee that is nearly straight turns by degrees for a millimetre.
const SOFTNESS: f32 = 0.0012;

/// Moves the hip joints and solves the legs in every frame.
pub(super) fn correct_legs(source: &mut SourceMotion, correction: &HipCorrection) {
    let pelvis = rest_rotations(source)[Joint::Hips.index()].inverse();
    let knee_axes = Side::BOTH.map(|side| knee_axis(source, side));
    let unit = source.leg_length;
    for frame in &mut source.frames {
        let world_from_pelvis = frame.rotation(Joint::Hips) * pelvis;
        for side in Side::BOTH {
            let hip = frame.position(side.upper_leg())
                + world_from_pelvis * correction.offset(side) * unit;
            solve_leg(
                frame,
                side,
                hip,
                correction.leg_factor,
                knee_axes[side.index()],
            );
        }
    }
    source.leg_factor = correction.leg_factor;
}

/// Mean axis of a knee in the thigh's own space: the direction about which a positive turn bends it.
fn knee_axis(source: &SourceMotion, side: Side) -> Vec3 {
    let axis = |frame: &SourceFrame| {
        let across = frame
            .direction(side.upper_leg())
            .cross(frame.direction(side.lower_leg()));
        frame.rotation(side.upper_leg()).inverse() * across
    };
    source.sampled().map(axis).sum::<Vec3>().normalize_or_zero()
}

fn solve_leg(frame: &mut SourceFrame, side: Side, hip: Vec3, factor: f32, knee_axis: Vec3) {
    let (upper, lower) = (side.upper_leg(), side.lower_leg());
    let [thigh, shank] = [upper, lower].map(|joint| frame.segment(joint) * factor);
    let ankle = frame.tails[lower.index()];
    let axis = thigh.normalize_or_zero().cross(shank.normalize_or_zero())
        + frame.rotation(upper) * knee_axis * AXIS_WEIGHT;
    let line = ankle - hip;
    let [thigh_m, shank_m] = [thigh.length(), shank.length()];
    let reach = reach_of(line.length(), thigh_m + shank_m).max((thigh_m - shank_m).abs());
    let (Some(down), true) = (line.try_normalize(), thigh_m * shank_m > 0.0) else {
        return;
    };
    let along = (thigh_m * thigh_m + reach * reach - shank_m * shank_m) / (2.0 * reach.max(1e-9));
    let aside = (thigh_m * thigh_m - along * along).max(0.0).sqrt();
    // The axis is thigh times shank, so the knee lies across line and axis.
    let knee = hip + down * along + down.cross(axis).normalize_or_zero() * aside;
    for (joint, from, to, old) in [
        (upper, hip, knee, thigh),
        (lower, knee, hip + down * reach, shank),
    ] {
        let turn = shortest_arc(old.normalize_or_zero(), (to - from).normalize_or_zero());
        frame.rotations[joint.index()] = (turn * frame.rotation(joint)).normalize();
        frame.positions[joint.index()] = from;
        frame.tails[joint.index()] = to;
    }
}

/// Reach of a leg of this length for an ankle at a distance.
fn reach_of(distance: f32, length: f32) -> f32 {
    let softness = SOFTNESS * length;
    let left = (MOST_STRETCHED * length - distance) / softness;
    // Far from the limit the exponential overflows, and there is nothing to soften.
    if left > 20.0 {
        return distance;
    }
    MOST_STRETCHED * length - softness * left.exp().ln_1p()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leg_reaches_its_ankle_and_never_straightens_all_the_way() {
        assert!((reach_of(0.7, 0.9) - 0.7).abs() < f32::EPSILON);
        let reach: Vec<f32> = (0..200)
            .map(|n| reach_of(0.88 + 1.5e-4 * n as f32, 0.9))
            .collect();
        assert!(reach.windows(2).all(|pair| pair[1] >= pair[0]));
        assert!(reach.iter().all(|reach| *reach < 0.9));
        assert!((reach_of(0.895, 0.9) - 0.895).abs() < 1e-4);
    }
}
