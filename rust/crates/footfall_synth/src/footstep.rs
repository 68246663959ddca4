//! Footsteps, the reported initial contacts.

use footfall_core::{GroundTransform, Side};
use footfall_ik::{Plant, RockerFoot};
use glam::Vec3;

/// An initial contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footstep {
    /// The foot.
    pub side: Side,
    /// The ground under the ankle, in the space where the walk began, metres.
    pub position: Vec3,
    /// Heading of the foot in that space, radians.
    pub heading: f32,
}

impl Footstep {
    /// Makes the footstep of a plant, relative to a place of the same space.
    pub(crate) fn seen_from(from: &GroundTransform, side: Side, plant: &Plant) -> Self {
        let place = from.local(&GroundTransform {
            position: RockerFoot::footprint(plant),
            heading: plant.heading,
        });
        Self {
            side,
            position: place.position,
            heading: place.heading,
        }
    }
}
