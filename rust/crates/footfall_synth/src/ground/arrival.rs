//! The body at the end of a step, as its foot lands.

use crate::footstep::Footstep;
use footfall_core::GroundTransform;
use footfall_core::rotation::from_heading;
use footfall_ik::placement::{Frame, Landing};
use glam::Vec3;

/// Place of the body at a landing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Arrival {
    pub(crate) hips: Vec3,
    pub(crate) ankles: [Vec3; 2],
}

/// Returns the landing of the next footstep and the body's place at it, relative to the character.
pub(crate) fn landings(
    next: Option<(Footstep, f32)>,
    from: &GroundTransform,
    arrival: &Arrival,
) -> [Option<Landing>; 2] {
    let mut landings = [None; 2];
    if let Some((footstep, secs)) = next {
        let back = from_heading(-from.heading);
        let seen = |place: Vec3| back * (place - from.position);
        landings[footstep.side.index()] = Some(Landing {
            flat: Frame {
                position: footstep.position,
                rotation: from_heading(footstep.heading),
            },
            secs,
            hips: seen(arrival.hips),
            ankles: arrival.ankles.map(seen),
        });
    }
    landings
}
