//! Level of detail of a walker: distant walkers need fewer poses.

/// Level of detail of a walker.
///
/// The trajectory is the same. With less detail, fewer of its frames are placed on the ground, and the others are
/// interpolated. Feet then slip slightly between frames, which is visible only close by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// Every frame of the model.
    #[default]
    Full,
    /// Every second.
    Half,
    /// Every fourth.
    Quarter,
}

/// Heights on screen, pixels, from which a body needs a detail. Standing feet slip by up to 0.5 cm/s at half and 2 cm/s at quarter detail: below these heights
/// by half a pixel a second.
const LEAST_PIXELS: [(Detail, f32); 2] = [(Detail::Full, 150.0), (Detail::Half, 40.0)];

/// Share of such a height down to which a body keeps its detail.
const KEPT_SHARE: f32 = 0.8;

/// Minimum number of planted frames of a step.
const LEAST_GROUND_FRAMES: usize = 4;

/// Maximum number of planted frames of a step, for which every walker has room; longer steps, which are slow, get coarser detail.
pub(crate) const MOST_GROUND_FRAMES: usize = 64;

impl Detail {
    /// All, finest first.
    pub const ALL: [Self; 3] = [Self::Full, Self::Half, Self::Quarter];

    /// Returns the detail that suffices for a standing body of a height on screen in pixels.
    ///
    /// `self` is the present detail: it is kept down to 0.8 of the height from which it is chosen (150 for full and 40 for half), so that bodies between two details do not
    /// change with each frame.
    #[must_use]
    pub fn for_height(self, pixels: f32) -> Self {
        let suffices = |&(detail, least): &(Self, f32)| {
            let is_kept = self as u8 <= detail as u8;
            pixels >= if is_kept { KEPT_SHARE * least } else { least }
        };
        LEAST_PIXELS
            .into_iter()
            .find(suffices)
            .map_or(Self::Quarter, |(detail, _)| detail)
    }

    /// Returns the frames of the model from one planted frame to the next.
    pub(crate) const fn stride(self) -> usize {
        1 << self as usize
    }

    /// Returns this detail, or a coarser one if a step of this many frames would need more room than [`ground_room`](Self::ground_room).
    pub(crate) fn holding(self, frames: usize) -> Self {
        let holds =
            |detail: &Self| detail.whole_frames(frames) <= MOST_GROUND_FRAMES * detail.stride();
        let mut coarser = Self::ALL.into_iter().skip(self as usize);
        coarser.find(holds).unwrap_or(Self::Quarter)
    }

    /// Returns the maximum number of planted frames of a step, given the frames of the longest step.
    pub(crate) fn ground_room(longest: usize) -> usize {
        longest
            .div_ceil(Self::Quarter.stride())
            .max(MOST_GROUND_FRAMES)
    }

    /// Returns the number of frames rounded up so that a step ends with a planted frame.
    pub(crate) fn whole_frames(self, frames: usize) -> usize {
        let stride = self.stride();
        frames
            .next_multiple_of(stride)
            .max(LEAST_GROUND_FRAMES * stride)
    }
}

#[cfg(test)]
mod tests {
    use super::{Detail, KEPT_SHARE, LEAST_PIXELS};

    #[test]
    fn detail_follows_the_height_and_does_not_flicker() {
        for (detail, least) in LEAST_PIXELS {
            let between = f32::midpoint(KEPT_SHARE, 1.0) * least;
            let less = detail.for_height(0.9 * KEPT_SHARE * least);
            assert_eq!(less.for_height(least), detail);
            assert_eq!(detail.for_height(between), detail);
            assert_eq!(less.stride(), 2 * detail.stride());
            assert_eq!(less.for_height(between), less);
        }
        for present in Detail::ALL {
            assert_eq!(present.for_height(0.0), Detail::Quarter);
            assert_eq!(present.for_height(f32::INFINITY), Detail::Full);
        }
    }
}
