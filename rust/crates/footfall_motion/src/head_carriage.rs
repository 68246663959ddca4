//! True carriage of a person's neck and head, on skeletons that were fitted to markers.
//!
//! A head turns with the band of markers that it wears, and nobody wrote down how the band sat; the neck has no marker, and
//! ends where the fit has the top of the trunk. In the CMU library necks tilt back by 12° and faces look down by 16° in the
//! median of plain walkers, by -5 to 44° person by person, where people whose joints are placed well carry their necks
//! forwards and their faces nearly level. Both errors are the same in all recordings of a person.
//!
//! This module separates the error from the person: the mean of a person's plain walks is the sum of both, and each has a
//! known spread. How a neck and a head *move* is never changed.

use crate::hip_centres::{Origin, WalkingEvidence};
use crate::skeleton_fit::Manner;
use std::fmt::{Display, Formatter, Result};

/// Pitch of neck and head: forwards and downwards, degrees from upright.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeadCarriage {
    /// The line from the bottom of the neck to the head.
    pub neck_deg: f32,
    /// The face.
    pub head_deg: f32,
}

/// Decision about a person's neck and head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadFinding {
    /// Strides of plain walking that it was learned from.
    pub strides: usize,
    /// Mean over them as recorded.
    pub recorded: HeadCarriage,
    /// Turn that takes the error of the fit away.
    pub correction: HeadCarriage,
}

/// A quantity of which people have one share and the fit of a skeleton another, degrees: means and standard deviations.
struct Carriage {
    people: (f32, f32),
    fit: (f32, f32),
}

/// Necks of O3DE's actor and Bandai's two neutral walkers; less that of 8 walkers of the CMU library.
const NECK: Carriage = Carriage {
    people: (5.0, 6.0),
    fit: (-17.0, 4.0),
};
/// Their faces.
const HEAD: Carriage = Carriage {
    people: (5.0, 6.0),
    fit: (12.0, 14.0),
};
/// Standard deviation of necks and faces among all manners of walking (Bandai's acted styles), degrees.
const MANNERS_DEG: f32 = 16.0;

impl Carriage {
    /// The most probable turn that undoes the fit's share of a mean.
    fn correction(&self, mean: f32, manner: Manner) -> f32 {
        let people = match manner {
            Manner::Plain => self.people.1,
            Manner::Unlabelled | Manner::Acted => self.people.1.hypot(MANNERS_DEG),
        };
        let (usual, spread) = self.fit;
        let weight = spread * spread / (spread * spread + people * people);
        -(usual + weight * (mean - self.people.0 - usual))
    }
}

/// Finds the carriage of one person from all recordings of one skeleton. None for a skeleton that nobody fitted to markers, and without
/// strides of walking.
pub fn find_head_carriage(recordings: &[&WalkingEvidence], manner: Manner) -> Option<HeadFinding> {
    let is_fitted = |recording: &&WalkingEvidence| {
        recording.origin == Origin::MarkerFit && !recording.is_own_body
    };
    if !recordings.iter().all(is_fitted) {
        return None;
    }
    let heads: Vec<HeadCarriage> = recordings
        .iter()
        .flat_map(|recording| recording.heads.iter().copied())
        .collect();
    let mean =
        |of: fn(&HeadCarriage) -> f32| heads.iter().map(of).sum::<f32>() / heads.len() as f32;
    (!heads.is_empty()).then(|| {
        let recorded = HeadCarriage {
            neck_deg: mean(|head| head.neck_deg),
            head_deg: mean(|head| head.head_deg),
        };
        HeadFinding {
            strides: heads.len(),
            recorded,
            correction: HeadCarriage {
                neck_deg: NECK.correction(recorded.neck_deg, manner),
                head_deg: HEAD.correction(recorded.head_deg, manner),
            },
        }
    })
}

/// The line begins with "neck".
impl Display for HeadFinding {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        let (was, turn) = (self.recorded, self.correction);
        write!(
            out,
            "neck {:.0} to {:.0}° forwards, face {:.0} to {:.0}° down over {} strides",
            was.neck_deg,
            was.neck_deg + turn.neck_deg,
            was.head_deg,
            was.head_deg + turn.head_deg,
            self.strides
        )
    }
}
