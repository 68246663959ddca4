//! Places of walkers for drawing.

use glam::Vec3;

/// Places of a walker for drawing: before its latest motion, and after it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Drawn {
    /// The two places.
    pub places: [Vec3; 2],
    /// Its headings there. The second is within half a turn of the first.
    pub headings: [f32; 2],
    /// Time between them, seconds.
    pub secs: f32,
    /// Its height against that of the character.
    pub size: f32,
    /// Its tint: red, green, blue and opacity.
    pub tint: [f32; 4],
}

impl Drawn {
    /// Interpolated place and heading: `share` 0 is the first place, 1 the second.
    pub fn at(&self, share: f32) -> (Vec3, f32) {
        let [from, to] = self.headings;
        (
            self.places[0].lerp(self.places[1], share),
            from + share * (to - from),
        )
    }
}
