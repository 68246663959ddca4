//! The ground along a step.

use crate::placement::terrain::Terrain;
use glam::Vec3;

/// Number of places at which the ground is queried, and their distance, metres.
const SAMPLES: usize = 48;
const SPACING_M: f32 = 0.05;

/// Heights of the ground along a line, found by following it: ground must connect to the ground before it. So a staircase of any
/// height belongs to it, and the floor below it does not.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    start: Vec3,
    pub(super) along: Vec3,
    up: Vec3,
    heights: [Option<f32>; SAMPLES],
}

impl Profile {
    /// Follows the ground from a point along a level unit vector, for a length in metres. Ground that rises or falls by more than
    /// `max_step_m` at once is a wall or an abyss.
    pub(super) fn trace(
        terrain: &mut impl Terrain,
        [start, along, up]: [Vec3; 3],
        length_m: f32,
        max_step_m: f32,
    ) -> Self {
        let mut profile = Self {
            start,
            along,
            up,
            heights: [None; SAMPLES],
        };
        let mut height = start.dot(up);
        let count = ((length_m / SPACING_M).ceil() as usize + 1).min(SAMPLES);
        for index in 0..count {
            let from = profile.at(index as f32 * SPACING_M, height + max_step_m);
            let ground = terrain.cast(from, up * (-2.0 * max_step_m));
            profile.heights[index] = ground.map(|ground| ground.position.dot(up));
            height = profile.heights[index].unwrap_or(height);
        }
        profile
    }

    /// The place at a distance along the line, at a height.
    pub(super) fn at(&self, along_m: f32, height: f32) -> Vec3 {
        let place = self.start + self.along * along_m;
        place + self.up * (height - place.dot(self.up))
    }

    /// Height of the ground at a distance; `None` without ground, and beyond the end.
    pub(super) fn height(&self, along_m: f32) -> Option<f32> {
        let index = (along_m / SPACING_M).round().max(0.0) as usize;
        *self.heights.get(index)?
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::frame::Frame;
    use crate::placement::terrain::{Ground, SupportId};

    /// A staircase of thin treads over a floor: 20 by 29 cm.
    struct Open;

    impl Terrain for Open {
        fn cast(&mut self, from: Vec3, way: Vec3) -> Option<Ground> {
            let tread = 0.2 * ((from.z / 0.29).floor() + 1.0).clamp(0.0, 9.0);
            [tread, 0.0]
                .into_iter()
                .find(|height| (from.y + way.y..=from.y).contains(height))
                .map(|height| Ground {
                    position: Vec3::new(from.x, height, from.z),
                    normal: Vec3::Y,
                    support: 0,
                })
        }

        fn support(&mut self, _: SupportId) -> Option<Frame> {
            Some(Frame::IDENTITY)
        }
    }

    #[test]
    fn a_staircase_is_followed_up_and_the_floor_below_it_is_not() {
        let axes = [Vec3::new(0.0, 0.0, -0.3), Vec3::Z, Vec3::Y];
        let profile = Profile::trace(&mut Open, axes, 2.0, 0.4);
        let height = |along_m: f32| profile.height(along_m).unwrap_or(f32::NAN);
        assert!(height(0.1).abs() < 1e-6);
        assert!((height(0.45) - 0.2).abs() < 1e-6);
        assert!((height(1.35) - 0.8).abs() < 1e-6);
        assert!(profile.height(2.6).is_none());
        // Steps that are too high are a wall.
        let profile = Profile::trace(&mut Open, axes, 2.0, 0.15);
        assert!(
            height(0.1).abs() < 1e-6 && profile.height(1.35).is_none_or(|height| height == 0.0)
        );
    }
}
