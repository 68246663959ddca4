//! Height of walkers on screen, and the choice of those small enough for a stand-in.

use glam::Vec3;

/// Factor on the height up to which a walker keeps its stand-in.
const KEEP: f32 = 1.15;

/// View of a camera, in the space of the crowd.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eyesight {
    /// Place of the camera.
    pub place: Vec3,
    /// Height on screen of one metre, pixels: at a distance of one metre, or at any distance where the view is [parallel](Self::is_parallel).
    pub metre_px: f32,
    /// True for a parallel projection, in which nothing shrinks with the distance.
    pub is_parallel: bool,
    /// Height of a walker of size 1, metres.
    pub height_m: f32,
    /// Height on screen below which a stand-in shows a walker, pixels.
    pub smallest_px: f32,
}

impl Eyesight {
    /// Returns whether a stand-in shows a walker of this size at this place; `was` is the choice of the last frame. The height on screen is that
    /// in the middle of the picture, so that it does not change as the camera turns.
    pub fn is_small(&self, place: Vec3, size: f32, was: bool) -> bool {
        let far = if self.is_parallel {
            1.0
        } else {
            place.distance(self.place)
        };
        let limit = if was {
            self.smallest_px * KEEP
        } else {
            self.smallest_px
        };
        size * self.height_m * self.metre_px < limit * far
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A walker of 1.8 m is 18 pixels high at 100 m.
    const VIEW: Eyesight = Eyesight {
        place: Vec3::new(0.0, 1.7, 0.0),
        metre_px: 1000.0,
        is_parallel: false,
        height_m: 1.8,
        smallest_px: 18.0,
    };

    #[test]
    fn small_is_who_has_few_pixels() {
        let at = |far: f32| VIEW.place + far * Vec3::Z;
        assert!(!VIEW.is_small(at(99.0), 1.0, false));
        assert!(VIEW.is_small(at(101.0), 1.0, false));
        assert!(VIEW.is_small(at(99.0), 0.9, false));
        assert!(!VIEW.is_small(VIEW.place, 1.0, false));
        let parallel = Eyesight {
            is_parallel: true,
            metre_px: 9.0,
            ..VIEW
        };
        assert!(parallel.is_small(at(1.0), 1.0, false));
        assert!(!parallel.is_small(at(1e6), 1.2, false));
        let off = Eyesight {
            smallest_px: 0.0,
            ..VIEW
        };
        assert!(!off.is_small(at(1e9), 1.0, true));
        assert!(!off.is_small(Vec3::NAN, 1.0, false));
    }

    #[test]
    fn who_is_at_the_border_does_not_flicker() {
        let mut is_small = false;
        let mut changes = 0;
        for frame in 0..100 {
            let far = 100.0 + 5.0 * (frame as f32).sin();
            let before = is_small;
            is_small = VIEW.is_small(VIEW.place + far * Vec3::Z, 1.0, is_small);
            changes += u32::from(is_small != before);
        }
        assert_eq!(changes, 1);
        assert!(!VIEW.is_small(VIEW.place + 80.0 * Vec3::Z, 1.0, true));
    }
}
