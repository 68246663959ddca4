//! Ground to climb.

use core::f32::consts::{PI, TAU};

/// Kinds of ground to walk over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// Level ground.
    Level,
    /// Six steps up, or down where the rise is negative.
    Stairs {
        /// Height of a step, metres.
        rise: f32,
        /// Depth of a tread, metres.
        run: f32,
    },
    /// A ramp, down where its slope is negative.
    Ramp {
        /// Rise by run.
        slope: f32,
        /// Distance from its foot to its top, over the ground, metres.
        length: f32,
    },
    /// Rounded hills that begin and end level, for 24 m.
    Hills {
        /// Height of the highest above the lowest place, metres.
        height: f32,
        /// Seed of the hills.
        seed: u32,
    },
    /// Blocks of 45 cm, up to this high, for 9 m.
    Blocks {
        /// Height of the highest, metres.
        height: f32,
        /// Seed of the blocks.
        seed: u32,
    },
}

pub(super) const STEPS: f32 = 6.0;
const BLOCK_M: f32 = 0.45;

impl Way {
    /// Height of the ground so far behind the first edge and to the side, metres.
    pub fn height(self, x: f32, z: f32) -> f32 {
        match self {
            Self::Level => 0.0,
            Self::Stairs { rise, run } => ((z / run).floor() + 1.0).clamp(0.0, STEPS) * rise,
            Self::Ramp { slope, length } => z.clamp(0.0, length) * slope,
            Self::Hills { height, seed } => height * hills(x, z / self.length(), seed),
            Self::Blocks { height, seed } => {
                if z < 0.0 || z > self.length() {
                    return 0.0;
                }
                let cell = |value: f32| (value / BLOCK_M).floor() as i32 as u32;
                let mut hash =
                    cell(x).wrapping_mul(0x9E37_79B9) ^ cell(z).wrapping_mul(0x85EB_CA6B);
                hash ^= seed.wrapping_mul(0xC2B2_AE35);
                hash = (hash ^ (hash >> 15)).wrapping_mul(0x2C1B_3C6D);
                hash = (hash ^ (hash >> 12)).wrapping_mul(0x297A_2D39);
                height * ((hash ^ (hash >> 15)) >> 8) as f32 / 16_777_216.0
            }
        }
    }

    /// Distance from the first edge to the last, over the ground, metres.
    pub fn length(self) -> f32 {
        match self {
            Self::Level => 6.0,
            Self::Stairs { run, .. } => STEPS * run,
            Self::Ramp { length, .. } => length,
            Self::Hills { .. } => 24.0,
            Self::Blocks { .. } => 9.0,
        }
    }
}

/// Heights of waves that cross each other, 0 to 1, at a part of the way.
fn hills(x: f32, part: f32, seed: u32) -> f32 {
    let part = part.clamp(0.0, 1.0);
    let waves: f32 = [1.0, 2.3, 3.7]
        .into_iter()
        .zip(1_u32..)
        .map(|(waves, turn)| {
            let phase =
                (seed.wrapping_mul(turn).wrapping_mul(0x9E37_79B9) >> 8) as f32 / 16_777_216.0;
            (TAU * (waves * part + phase + 0.02 * waves * x)).sin() / waves
        })
        .sum();
    // Level at both ends.
    (PI * part).sin().powi(2) * (0.5 + 0.27 * waves)
}
