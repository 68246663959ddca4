//! Position of a step in its walk (Tilmanne et al. 2012, section 5.2.1).

/// Position of a step in its walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StepPosition {
    /// The first after standing.
    First,
    /// The second after standing.
    Second,
    /// Any that is none of the others, and all of a walk whose start or end is not seen.
    #[default]
    Inside,
    /// The last but one before standing.
    LastButOne,
    /// The last before standing.
    Last,
}

impl StepPosition {
    /// All five, in the order of a walk.
    pub const ALL: [Self; 5] = [
        Self::First,
        Self::Second,
        Self::Inside,
        Self::LastButOne,
        Self::Last,
    ];

    /// Index in [`ALL`](Self::ALL).
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Its name in files and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Second => "second",
            Self::Inside => "inside",
            Self::LastButOne => "last_but_one",
            Self::Last => "last",
        }
    }
}
