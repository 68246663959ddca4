//! Behaviours: ways of using the feet.

/// A way of getting about, or of staying.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Behaviour {
    /// On both feet, without going anywhere.
    Stand,
    /// A foot stands at any time; forwards, backwards or along a curve.
    Walk,
    /// From one foot to the other through the air.
    Run,
    /// With both feet through the air.
    Jump,
    /// From one foot to the same foot through the air.
    Hop,
    /// A foot stands at any time; sideways.
    Sidestep,
}

impl Behaviour {
    /// Every behaviour.
    pub const ALL: [Self; 6] = [
        Self::Stand,
        Self::Walk,
        Self::Run,
        Self::Jump,
        Self::Hop,
        Self::Sidestep,
    ];

    /// Position in [`Behaviour::ALL`].
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The name in files, reports and signals, for example `walk`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stand => "stand",
            Self::Walk => "walk",
            Self::Run => "run",
            Self::Jump => "jump",
            Self::Hop => "hop",
            Self::Sidestep => "sidestep",
        }
    }
}
