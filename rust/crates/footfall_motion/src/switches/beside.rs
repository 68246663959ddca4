//! Landings of legs that swing beside the other: feet that are put together, turns on the spot.
//!
//! Ankles on the ground do not move against each other, whichever way the body goes.

use super::legs::{Landed, Legs};
use footfall_core::Side;

/// Lift of the ankle of a leg that swings beside the other, on the canonical body, metres.
const LEAST_RISE_M: f64 = 0.05;

/// Most frames of such a swing before its highest moment, and after it.
const RISE_REACH: usize = 12;
const REST_REACH: usize = 36;

/// An ankle has come to rest against the other at this share of the swing's speed, and at this speed on the canonical body, m/s.
const REST_SHARE: f64 = 0.3;
const REST_MPS: f64 = 0.25;

/// Least number of frames between landings of one foot.
const LEAST_APART: f64 = 15.0;

/// Adds the landings of swings that end neither ahead nor behind.
pub(super) fn add_to(landings: &mut Vec<Landed>, legs: &Legs) {
    let of_half_cycles = landings.clone();
    for side in Side::BOTH {
        let lands = |landings: &[Landed], first: f64, last: f64| {
            let mut own = landings.iter().filter(|landed| landed.side == side);
            own.any(|landed| (first..=last).contains(&landed.by_legs))
        };
        let tops = tops(legs, side);
        for (n, &top) in tops.iter().enumerate() {
            let next = tops.get(n + 1).copied().unwrap_or(usize::MAX);
            let end = (top + REST_REACH).min(next).min(legs.lift.len() - 1);
            let from = top.saturating_sub(RISE_REACH) as f64;
            if lands(&of_half_cycles, from, end as f64) {
                continue;
            }
            let Some(frame) = rest(legs, top, end) else {
                continue;
            };
            if !lands(landings, frame - LEAST_APART, frame + LEAST_APART) {
                landings.push(Landed {
                    side,
                    half_cycle: frame,
                    by_legs: frame,
                });
            }
        }
    }
}

/// The frames in which an ankle is highest above the other, each at the top of a bump.
fn tops(legs: &Legs, side: Side) -> Vec<usize> {
    let height = |frame: usize| (f64::from(side.sign()) * legs.lift[frame]).max(0.0);
    let mut tops = Vec::new();
    let (mut low, mut top) = (f64::INFINITY, None);
    for frame in 0..legs.lift.len() {
        match top {
            None => {
                low = low.min(height(frame));
                if height(frame) - low >= LEAST_RISE_M * legs.size {
                    top = Some(frame);
                }
            }
            Some(highest) if height(frame) > height(highest) => top = Some(frame),
            // Half of the way down the bump is over.
            Some(highest) if height(highest) - height(frame) >= 0.5 * (height(highest) - low) => {
                tops.push(highest);
                (low, top) = (height(frame), None);
            }
            Some(_) => {}
        }
    }
    tops
}

/// First moment after a top in which the ankles have come to rest against each other.
fn rest(legs: &Legs, top: usize, end: usize) -> Option<f64> {
    let speed = &legs.speed;
    let swing = top.saturating_sub(RISE_REACH / 2)..=end;
    let fastest = swing.max_by(|a, b| speed[*a].total_cmp(&speed[*b]))?;
    let limit = (REST_SHARE * speed[fastest]).max(REST_MPS * legs.size);
    let rest = (fastest.max(top)..=end).find(|frame| speed[*frame] < limit)?;
    let before = speed[rest.checked_sub(1)?];
    Some(if before > limit {
        (rest - 1) as f64 + (before - limit) / (before - speed[rest])
    } else {
        rest as f64
    })
}
