//! Ground contact: spans of frames and the events at their ends.

use crate::joint::Side;

/// A run of frames, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSpan {
    /// First frame of the run.
    pub first: usize,
    /// Last frame of the run.
    pub last: usize,
}

impl FrameSpan {
    /// The runs of frames in which something holds.
    pub fn runs(holds: &[bool]) -> Vec<Self> {
        let mut runs: Vec<Self> = Vec::new();
        for (frame, _) in holds.iter().enumerate().filter(|(_, holds)| **holds) {
            match runs.last_mut() {
                Some(run) if run.last + 1 == frame => run.last = frame,
                _ => runs.push(Self {
                    first: frame,
                    last: frame,
                }),
            }
        }
        runs
    }

    /// Returns true when a frame lies in the run.
    pub const fn contains(self, frame: usize) -> bool {
        frame >= self.first && frame <= self.last
    }

    /// Number of frames in the run.
    pub const fn frames(self) -> usize {
        self.last - self.first + 1
    }
}

/// The two ends of a stance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EventKind {
    /// The first frame in which any part of the foot bears on the ground.
    InitialContact,
    /// The last frame in which any part of the foot bears on the ground.
    TerminalContact,
}

impl EventKind {
    /// `initial_contact` or `terminal_contact`, as in the files that we write.
    pub const fn name(self) -> &'static str {
        match self {
            Self::InitialContact => "initial_contact",
            Self::TerminalContact => "terminal_contact",
        }
    }
}

/// A gait event of one foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GaitEvent {
    /// Frame of the clip.
    pub frame: usize,
    /// The foot.
    pub side: Side,
    /// End of the stance that it is.
    pub kind: EventKind,
}
