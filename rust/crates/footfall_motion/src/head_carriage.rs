//! True carriage of a person's neck and head, on skeletons that were fitted to markers.
//!
//! A head turns with the band of markers that it wears, and nobody wrote down how the band sat; the neck has no marker, and
//! ends where the fit has the top of the trunk. In the CMU library necks tilt back by 12° and faces look down by 16° in the
//! median of plain walkers, by -5 to 44° person by person, where people whose joints are placed well carry their necks
//! forwards and their faces nearly level. Both errors are the same in all recordings of a person.
//!
//! This module separates the error from the person: the mean of a person's plain walks is the sum of both, and each has a
//! known spread. How a neck and a head *move* is never changed.

use crate::walking_evidence::{HeadCarriage, Manner, WalkingEvidence};
use glam::{Quat, Vec3};
use std::array;
use std::fmt::{Display, Formatter, Result};

/// Decision about a person's neck and head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadFinding {
    /// Strides of plain walking that it was learned from.
    pub strides: usize,
    /// Mean over them as recorded.
    pub recorded: HeadCarriage,
    /// The same without the error of the fit.
    pub corrected: HeadCarriage,
}

/// Angles of which people have one share and the fit of a skeleton another, degrees: means and standard deviations.
struct Attitude {
    people: (Vec3, Vec3),
    fit: (Vec3, Vec3),
}

/// Necks of O3DE's actor and Bandai's two neutral walkers; what 13 walkers of the CMU library have beyond that.
const NECK: Attitude = Attitude {
    people: (Vec3::new(5.0, 0.0, 0.0), Vec3::new(6.0, 3.0, 3.0)),
    fit: (Vec3::new(-17.0, 0.0, 0.0), Vec3::new(4.0, 3.0, 9.0)),
};
/// Their heads.
const HEAD: Attitude = Attitude {
    people: (Vec3::new(5.0, 0.0, 0.0), Vec3::new(6.0, 3.0, 3.0)),
    fit: (Vec3::new(12.0, 0.0, 0.0), Vec3::new(14.0, 9.0, 4.0)),
};
/// Standard deviation of necks and faces, up and down, among all manners of walking (Bandai's acted styles), degrees.
const MANNERS_DEG: f32 = 16.0;

impl Attitude {
    /// The most probable attitude of the person where the mean of a person's walks is `recorded`.
    fn of_person(&self, recorded: Vec3, manner: Manner) -> Vec3 {
        let [usual, usual_fit] = [self.people.0, self.fit.0].map(|each| each.to_array());
        let [people, fit] = [self.people.1, self.fit.1].map(|each| each.to_array());
        let recorded = recorded.to_array();
        Vec3::from_array(array::from_fn(|axis| {
            let manners = if axis == 0 && manner != Manner::Plain {
                MANNERS_DEG
            } else {
                0.0
            };
            let variance = people[axis].powi(2) + manners.powi(2);
            let share = variance / (variance + fit[axis].powi(2));
            usual[axis] + share * (recorded[axis] - usual[axis] - usual_fit[axis])
        }))
    }
}

/// Finds the carriage of one person from all recordings of one skeleton. None without evidence of it.
pub fn find_head_carriage(recordings: &[&WalkingEvidence], manner: Manner) -> Option<HeadFinding> {
    let heads: Vec<HeadCarriage> = recordings
        .iter()
        .flat_map(|recording| recording.heads.iter().copied())
        .collect();
    let mean =
        |of: fn(&HeadCarriage) -> Vec3| heads.iter().map(of).sum::<Vec3>() / heads.len() as f32;
    (!heads.is_empty()).then(|| {
        let recorded = HeadCarriage {
            neck: mean(|carriage| carriage.neck),
            head: mean(|carriage| carriage.head),
        };
        HeadFinding {
            strides: heads.len(),
            recorded,
            corrected: HeadCarriage {
                neck: NECK.of_person(recorded.neck, manner),
                head: HEAD.of_person(recorded.head, manner),
            },
        }
    })
}

impl HeadFinding {
    /// Turns of neck and head, each in its own axes, that take the error away.
    pub(crate) fn turns(&self) -> [Quat; 2] {
        let [recorded, corrected] = [&self.recorded, &self.corrected].map(HeadCarriage::rotations);
        array::from_fn(|joint| recorded[joint].inverse() * corrected[joint])
    }
}

/// The line begins with "neck"; angles are forwards or down, to the left, and towards the right shoulder.
impl Display for HeadFinding {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        let angles = |degrees: Vec3| {
            // Adding zero takes the sign from what rounds to none.
            let [x, y, z] = (degrees.round() + Vec3::ZERO).to_array();
            format!("{x:.0}/{y:.0}/{z:.0}°")
        };
        let (was, now) = (self.recorded, self.corrected);
        write!(
            out,
            "neck {} to {}, face {} to {} (down/left/tilted right) over {} strides",
            angles(was.neck),
            angles(now.neck),
            angles(was.head),
            angles(now.head),
            self.strides
        )
    }
}
