//! Input of placement: settings, and each frame of the animation.

use crate::placement::contact::ContactThresholds;
use crate::placement::frame::Frame;
use crate::placement::landings::Landing;

/// Settings of foot placement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacementConfig {
    /// Ground that is farther above the animation's floor and the higher sole, or farther below the floor and the lower one, is out of
    /// reach, metres.
    pub max_step_m: f32,
    /// Feet are tilted against the animation by this much at most, radians.
    pub max_tilt: f32,
    /// Time in which the pelvis goes half of its way up or down, seconds.
    pub pelvis_half_life_secs: f32,
    /// Largest motion of the pelvis against the animation's floor, metres.
    pub max_pelvis_m: f32,
    /// A foot that the animation drags this far from where it is locked is put anew, metres.
    pub max_drift_m: f32,
    /// A foot that the animation turns this far from where it is locked is put anew, radians.
    pub max_twist: f32,
    /// True when a foot that would stand across an edge is put ahead of it, behind it or beside it.
    pub adjust_footholds: bool,
    /// Thresholds of contact, for animations without known contacts.
    pub contact: ContactThresholds,
}

impl Default for PlacementConfig {
    fn default() -> Self {
        Self {
            max_step_m: 0.5,
            max_tilt: 0.6,
            pelvis_half_life_secs: 0.08,
            max_pelvis_m: 0.6,
            max_drift_m: 0.2,
            max_twist: 0.6,
            adjust_footholds: true,
            contact: ContactThresholds::default(),
        }
    }
}

/// One frame of the animation.
#[derive(Clone, Copy, Debug)]
pub struct PlacementInput {
    /// `world_from_floor`: the flat floor that the animation moves over. +Y is up, against gravity.
    pub world_from_floor: Frame,
    /// Feet that stand, where the animation knows; `None` to find them from height and speed.
    pub contacts: Option<[bool; 2]>,
    /// Next landings of the left and the right foot, where the animation knows.
    pub landings: [Option<Landing>; 2],
    /// True when the character is in the air: feet are left to the animation.
    pub airborne: bool,
}
