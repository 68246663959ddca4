//! Places on the ground.

use crate::rotation::{from_heading, wrap_angle};
use glam::Vec3;

/// A place on the ground with a heading: `start_from_character` and the like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroundTransform {
    /// Position with y = 0, metres.
    pub position: Vec3,
    /// Heading in radians, positive to the left.
    pub heading: f32,
}

impl GroundTransform {
    /// Returns the place that is seen from here as `place`, in the space that this one is in.
    #[must_use]
    pub fn global(&self, place: &Self) -> Self {
        Self {
            position: self.position + from_heading(self.heading) * place.position,
            heading: wrap_angle(self.heading + place.heading),
        }
    }

    /// Returns a place of the space that this one is in, as it is seen from here.
    #[must_use]
    #[inline]
    pub fn local(&self, place: &Self) -> Self {
        Self {
            position: from_heading(-self.heading) * (place.position - self.position),
            heading: wrap_angle(place.heading - self.heading),
        }
    }
}
