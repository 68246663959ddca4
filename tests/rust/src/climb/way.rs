//! Ground to climb.

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
    /// A ramp of this slope, 3 m long, down where negative.
    Ramp {
        /// Rise by run.
        slope: f32,
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
            Self::Ramp { slope } => z.clamp(0.0, self.length()) * slope,
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

    pub(super) fn length(self) -> f32 {
        match self {
            Self::Level => 6.0,
            Self::Stairs { run, .. } => STEPS * run,
            Self::Ramp { .. } => 3.0,
            Self::Blocks { .. } => 9.0,
        }
    }
}
