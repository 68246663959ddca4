//! Explicit-duration forward-backward, as the trainer runs it.

use anyhow::{Context as _, Result};
use footfall_prob::duration::{DurationDist, GaussianDuration};
use footfall_prob::hsmm::{Boundary, ChainState, hsmm_forward_backward};
use std::hint::black_box;

/// Eight steps of five states each, 60 frames a step.
const FRAMES: usize = 480;
const SEGMENTS: usize = 40;
const EMISSIONS: usize = 10;
const LONGEST_STATE: usize = 60;

/// A walk-like problem with its inputs ready.
pub(super) struct ForwardBackward {
    log_emissions: Vec<f64>,
    chain: Vec<ChainState>,
    durations: [DurationDist; 1],
}

impl ForwardBackward {
    pub(super) fn new() -> Result<Self> {
        let duration = GaussianDuration {
            mean: 12.0,
            variance: 9.0,
        };
        Ok(Self {
            // Emissions favour the right state, with a wobble that never repeats.
            log_emissions: (0..FRAMES * EMISSIONS)
                .map(|index| {
                    let (frame, emission) = (index / EMISSIONS, index % EMISSIONS);
                    let right = (frame / 12) % EMISSIONS == emission;
                    200.0 * (index as f64 * 2.414).sin() + if right { 0.0 } else { -150.0 }
                })
                .collect(),
            chain: (0..SEGMENTS)
                .map(|segment| ChainState {
                    emission: segment % EMISSIONS,
                    duration: 0,
                })
                .collect(),
            durations: [duration
                .discretise(LONGEST_STATE)
                .context("the benchmark's durations")?],
        })
    }

    pub(super) fn frames(&self) -> usize {
        self.log_emissions.len() / EMISSIONS
    }

    pub(super) fn segments(&self) -> usize {
        self.chain.len()
    }

    pub(super) fn run(&mut self) -> Result<()> {
        let posterior = hsmm_forward_backward(
            black_box(&self.log_emissions),
            EMISSIONS,
            &self.chain,
            &self.durations,
            Boundary::default(),
        )
        .context("the benchmark's walk cannot be explained")?;
        black_box(posterior);
        Ok(())
    }
}
