//! Errors of a person's skeleton that are the same in all recordings: places of the hip joints and carriage of the head.

use crate::head_carriage::{HeadFinding, find_head_carriage};
use crate::hip_centres::{HipFinding, HipVerdict, find_hip_centres};
use crate::walking_evidence::{Manner, WalkingEvidence};
use std::fmt::{self, Display, Formatter};

/// Findings about a person's skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitFinding {
    /// The hip joints.
    pub hip_centres: HipFinding,
    /// Neck and head; absent where nothing is known about them.
    pub head: Option<HeadFinding>,
}

impl FitFinding {
    /// A verdict about all joints that needs no evidence.
    pub const fn without_evidence(verdict: HipVerdict) -> Self {
        Self {
            hip_centres: HipFinding::without_evidence(verdict),
            head: None,
        }
    }

    /// Returns true when a recording stays as it is.
    pub const fn is_as_recorded(&self) -> bool {
        self.hip_centres.verdict.correction().is_none() && self.head.is_none()
    }
}

/// One line about the hip joints, and one about the head where anything is known about it.
impl Display for FitFinding {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        write!(out, "Hip joints {}", self.hip_centres)?;
        match &self.head {
            Some(head) => write!(out, "\nHead: {head}"),
            None => Ok(()),
        }
    }
}

/// Finds what is wrong with a skeleton from all recordings of one person on it.
pub fn find_fit(recordings: &[&WalkingEvidence], manner: Manner) -> FitFinding {
    FitFinding {
        hip_centres: find_hip_centres(recordings),
        head: find_head_carriage(recordings, manner),
    }
}
