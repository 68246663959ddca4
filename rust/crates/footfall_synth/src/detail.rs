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

/// Frames of a step that are put on the ground at least.
const LEAST_GROUND_FRAMES: usize = 4;

/// The same at most, as far as coarser detail keeps to it: every walker has room for so many. Longer steps are slow ones, between whose
/// frames little moves.
pub(crate) const MOST_GROUND_FRAMES: usize = 64;

impl Detail {
    /// All, finest first.
    pub const ALL: [Self; 3] = [Self::Full, Self::Half, Self::Quarter];

    /// Frames of the model from one that is put on the ground to the next.
    pub(crate) const fn stride(self) -> usize {
        1 << self as usize
    }

    /// This detail, or as much less that a step of so many frames needs no more room than [`ground_room`](Self::ground_room).
    pub(crate) fn holding(self, frames: usize) -> Self {
        let holds =
            |detail: &Self| detail.whole_frames(frames) <= MOST_GROUND_FRAMES * detail.stride();
        let mut coarser = Self::ALL.into_iter().skip(self as usize);
        coarser.find(holds).unwrap_or(Self::Quarter)
    }

    /// Frames that are put on the ground of any step, when the longest has so many.
    pub(crate) fn ground_room(longest: usize) -> usize {
        longest
            .div_ceil(Self::Quarter.stride())
            .max(MOST_GROUND_FRAMES)
    }

    /// So many frames of the model or a few more: a step ends with a frame that is put on the ground.
    pub(crate) fn whole_frames(self, frames: usize) -> usize {
        let stride = self.stride();
        frames
            .next_multiple_of(stride)
            .max(LEAST_GROUND_FRAMES * stride)
    }
}
