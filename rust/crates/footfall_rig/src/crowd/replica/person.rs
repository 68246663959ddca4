//! Format in which a walker is introduced: its identity, its looks and its current step.

use super::step::{STEP_BYTES, StepUpdate};
use crate::crowd::agent::Agent;
use crate::crowd::mixtures::StyleMixture;
use footfall_core::hash::fnv1a;
use footfall_synth::CrowdWalker;
use serde::{Deserialize, Serialize};

/// Units of sizes, speeds and tints.
const SIZE_UNITS: f32 = 4096.0;
const SPEED_UNITS: f32 = 1000.0;
const TINT_UNITS: f32 = 4096.0;

/// Sizes of walkers.
const SIZES: core::ops::Range<f32> = 0.05..16.0;

/// Styles of one walker.
const MOST_STYLES: usize = 64;

/// A walker for its introduction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Person {
    name: u32,
    pub(super) seed: u64,
    /// Position of its random numbers in the current step.
    pub(super) chance_position: u64,
    size: u16,
    speed: u16,
    tint: [u16; 4],
    mixture: Vec<i8>,
    step: [u8; STEP_BYTES],
}

fn quantized(number: f32, units: f32) -> u16 {
    (number * units).round() as u16
}

impl Person {
    /// The walker of this name, with its packed step.
    pub(super) fn of(name: i32, agent: &Agent, step: [u8; STEP_BYTES]) -> Self {
        let walker = agent.walker.as_ref();
        Self {
            name: name.cast_unsigned(),
            seed: agent.seed,
            chance_position: walker.map_or(0, CrowdWalker::chance_position),
            size: quantized(agent.size, SIZE_UNITS),
            speed: quantized(agent.speed_mps, SPEED_UNITS),
            tint: agent.tint.map(|part| quantized(part, TINT_UNITS)),
            mixture: agent.mixture.parts().to_vec(),
            step,
        }
    }

    /// A hash of the walker's identity and looks.
    pub(super) fn look(agent: &Agent) -> u64 {
        let numbers = agent.tint.iter().chain([&agent.size]);
        let numbers = numbers.flat_map(|number| number.to_bits().to_le_bytes());
        let seed = agent.seed.to_le_bytes();
        let parts = agent
            .mixture
            .parts()
            .iter()
            .map(|part| part.cast_unsigned());
        fnv1a(seed.into_iter().chain(numbers).chain(parts))
    }

    /// Its name and current step, if they are valid.
    pub(super) fn checked(&self) -> Option<(i32, StepUpdate)> {
        let name = i32::try_from(self.name).ok()?;
        let step = StepUpdate::unpack(&self.step);
        let sensible = SIZES.contains(&self.size())
            && self.mixture.len() <= MOST_STYLES
            && (step.row, step.turn) == StepUpdate::row_and_turn(name);
        sensible.then_some((name, step))
    }

    fn size(&self) -> f32 {
        f32::from(self.size) / SIZE_UNITS
    }

    /// Weights of its styles, for this many styles.
    pub(super) fn mixture(&self, styles: usize) -> StyleMixture {
        StyleMixture::of_parts(&self.mixture[..self.mixture.len().min(styles)])
    }

    /// Gives a walker these looks.
    pub(super) fn dress(&self, agent: &mut Agent) {
        agent.size = self.size();
        agent.speed_mps = f32::from(self.speed) / SPEED_UNITS;
        agent.tint = self.tint.map(|part| f32::from(part) / TINT_UNITS);
    }
}
