//! Saved state of a crowd.

use super::MOST_AGENTS;
use super::agent::Agent;
use super::goal::Goal;
use super::roster::{Roster, SavedRoster};
use serde::{Deserialize, Serialize};

/// Headers of the versions; the first version had no names.
const HEADER: &[u8; 8] = b"footcrw2";
const HEADER_1: &[u8; 8] = b"footcrw1";

/// Reasons why bytes are not a saved crowd.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CrowdStateError {
    /// The header is unknown.
    #[error("these are not the bytes of a crowd, or those of another version of Footfall")]
    NotACrowd,
    /// The content is damaged or incomplete.
    #[error("the bytes are damaged ({0})")]
    Damaged(String),
    /// The crowd is larger than the limit.
    #[error("it has more than {MOST_AGENTS} walkers")]
    TooMany,
}

/// Saved state of a walker.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedAgent {
    pub(super) seed: u64,
    pub(super) phase: f32,
    pub(super) place: [f32; 3],
    pub(super) heading: f32,
    pub(super) speed_mps: f32,
    pub(super) size: f32,
    pub(super) tint: [f32; 4],
    pub(super) target: Option<[f32; 2]>,
    pub(super) turn_rate: f32,
    pub(super) progress_m: f32,
    pub(super) aside_m: f32,
    pub(super) weights: Vec<f32>,
}

/// A saved crowd whose content was checked.
#[derive(Debug, PartialEq)]
pub struct SavedCrowd {
    /// Number of walkers so far.
    pub(super) made: u64,
    /// `None` for a crowd that was saved before walkers had names.
    pub(super) roster: Option<Roster>,
    /// In the order in which they came.
    pub(super) agents: Vec<SavedAgent>,
    /// True for walkers of the node's `count`.
    pub(super) counted: Vec<bool>,
}

/// The layout of the second version.
type Content = (u64, SavedRoster, Vec<SavedAgent>, Vec<bool>);

/// Writes all walkers; `agents` are in the roster's order.
pub(super) fn write<'a>(
    made: u64,
    roster: &Roster,
    agents: impl Iterator<Item = &'a Agent> + Clone,
) -> Vec<u8> {
    let content: Content = (
        made,
        roster.saved(),
        agents.clone().map(SavedAgent::of).collect(),
        agents.map(|agent| agent.counted).collect(),
    );
    let mut bytes = HEADER.to_vec();
    // Plain numbers can always be written.
    bytes.extend(postcard::to_stdvec(&content).unwrap_or_default());
    bytes
}

impl SavedCrowd {
    /// Reads a crowd that [`Crowd::save`](super::Crowd::save) wrote, in this version or an older one.
    ///
    /// # Errors
    /// [`CrowdStateError`] if the bytes are not a saved crowd.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CrowdStateError> {
        let damaged = |error: postcard::Error| CrowdStateError::Damaged(error.to_string());
        let saved = if let Some(content) = bytes.strip_prefix(HEADER) {
            let (made, roster, agents, counted): Content =
                postcard::from_bytes(content).map_err(damaged)?;
            let roster = Roster::restored(&roster)
                .filter(|roster| roster.order().len() == agents.len())
                .ok_or_else(|| {
                    CrowdStateError::Damaged("its walkers and their names do not agree".into())
                })?;
            Self {
                made,
                roster: Some(roster),
                agents,
                counted,
            }
        } else if let Some(content) = bytes.strip_prefix(HEADER_1) {
            let agents: Vec<SavedAgent> = postcard::from_bytes(content).map_err(damaged)?;
            Self {
                made: agents.len() as u64,
                roster: None,
                counted: vec![true; agents.len()],
                agents,
            }
        } else {
            return Err(CrowdStateError::NotACrowd);
        };
        if saved.agents.len() > MOST_AGENTS as usize {
            return Err(CrowdStateError::TooMany);
        }
        if saved.agents.iter().all(SavedAgent::is_sound) {
            Ok(saved)
        } else {
            Err(CrowdStateError::Damaged("a number is not finite".into()))
        }
    }
}

impl SavedAgent {
    fn of(agent: &Agent) -> Self {
        let (target, turn_rate) = match agent.goal {
            Goal::Place(place) => (Some(place.to_array()), 0.0),
            Goal::Turn(rate) => (None, rate),
            // A state keeps no destination without a route: it stands until it is sent again.
            Goal::Awaited(_) => (Some(agent.level().to_array()), 0.0),
        };
        Self {
            seed: agent.seed,
            phase: agent.phase(),
            place: agent.place.to_array(),
            heading: agent.heading,
            speed_mps: agent.speed_mps,
            size: agent.size,
            tint: agent.tint,
            target,
            turn_rate,
            progress_m: agent.progress_m,
            aside_m: agent.aside_m,
            weights: agent.mixture.weights(),
        }
    }

    fn is_sound(&self) -> bool {
        let numbers = [
            self.phase,
            self.heading,
            self.speed_mps,
            self.size,
            self.turn_rate,
            self.progress_m,
            self.aside_m,
        ];
        let target = self.target.iter().flatten();
        let mut all = numbers
            .iter()
            .chain(&self.place)
            .chain(target)
            .chain(&self.weights);
        all.all(|number| number.is_finite()) && (0.05..20.0).contains(&self.size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn bytes_that_are_no_crowd_are_refused() {
        let read = SavedCrowd::from_bytes;
        for strange in [b"".as_slice(), b"footcrw9"] {
            assert_eq!(read(strange), Err(CrowdStateError::NotACrowd));
        }
        assert!(read(b"footcrw1\xff\xff\xff\xff").is_err());
        assert!(read(b"footcrw2\xff\xff\xff\xff").is_err());
        let empty = read(&write(3, &Roster::default(), core::iter::empty())).unwrap();
        assert_eq!(empty.made, 3);
        assert_eq!(empty.roster, Some(Roster::default()));
    }

    #[test]
    fn names_are_kept_and_bytes_of_the_first_version_are_read() {
        let mut roster = Roster::default();
        let agents: Vec<Agent> = (0..3_u16)
            .map(|index| {
                roster.enter();
                let mut agent = Agent::new(u64::from(index), Vec3::X, f32::from(index), 7);
                agent.counted = index == 1;
                agent
            })
            .collect();
        roster.leave(&[1]);
        let there = roster.order().iter().map(|place| &agents[*place as usize]);
        let read = SavedCrowd::from_bytes;
        let saved = read(&write(3, &roster, there)).unwrap();
        assert_eq!(saved.roster, Some(roster));
        assert_eq!(saved.agents.len(), 2);
        assert!((saved.agents[1].heading - 2.0).abs() < 1e-6);
        assert_eq!(saved.counted, [false, false]);

        let mut old = HEADER_1.to_vec();
        old.extend(postcard::to_stdvec(&saved.agents).unwrap());
        let read = read(&old).unwrap();
        assert_eq!((read.roster, read.agents.len()), (None, 2));
    }
}
