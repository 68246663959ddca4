//! A crowd as bytes.

use super::agent::{Agent, Goal};
use serde::{Deserialize, Serialize};

/// Says what the bytes are, and which version of it.
const HEADER: &[u8; 8] = b"footcrw1";

/// What is kept of a walker.
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

/// Writes everybody.
pub(super) fn write(agents: &[Agent]) -> Vec<u8> {
    let saved: Vec<SavedAgent> = agents.iter().map(SavedAgent::of).collect();
    let mut bytes = HEADER.to_vec();
    // Plain numbers always can be written.
    bytes.extend(postcard::to_stdvec(&saved).unwrap_or_default());
    bytes
}

/// Reads everybody.
///
/// # Errors
/// What is wrong with the bytes, for the user.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<SavedAgent>, String> {
    let content = bytes
        .strip_prefix(HEADER)
        .ok_or("these are not the bytes of a crowd, or those of another version of Footfall")?;
    let saved: Vec<SavedAgent> = postcard::from_bytes(content)
        .map_err(|error| format!("the bytes are damaged ({error})"))?;
    if saved.iter().all(SavedAgent::is_sound) {
        Ok(saved)
    } else {
        Err("the bytes are damaged: a number is not finite".to_owned())
    }
}

impl SavedAgent {
    fn of(agent: &Agent) -> Self {
        let (target, turn_rate) = match agent.goal {
            Goal::Place(place) => (Some(place.to_array()), 0.0),
            Goal::Turn(rate) => (None, rate),
        };
        Self {
            seed: agent.seed,
            phase: agent.walker.phase(),
            place: agent.place.to_array(),
            heading: agent.heading,
            speed_mps: agent.speed_mps,
            size: agent.size,
            tint: agent.tint,
            target,
            turn_rate,
            progress_m: agent.progress_m,
            aside_m: agent.aside_m,
            weights: agent.weights.clone(),
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

    #[test]
    fn bytes_that_are_no_crowd_are_refused() {
        assert!(read(b"").is_err());
        assert!(read(b"footcrw9").is_err());
        assert!(read(b"footcrw1\xff\xff\xff\xff").is_err());
        assert_eq!(read(&write(&[])).unwrap(), Vec::new());
    }
}
