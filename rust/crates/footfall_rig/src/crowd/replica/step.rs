//! Format of a walker's step in a message.
//!
//! | bytes | content | unit |
//! | --- | --- | --- |
//! | 0–2 | row (17 bits), and the count of earlier walkers in it (7 bits) | |
//! | 3–4 | number of the step: even ones begin with the left foot's contact | |
//! | 5 | time since it began | 1/128 s |
//! | 6–7 | speed (12 bits); rests, runs, stops | 2 mm/s |
//! | 8 | turning | 1/36 rad/s |
//! | 9–11, 12–14 | place where it leads, or the walker rests: x and z | mm |
//! | 15–16 | height of the ground there | 2 cm |
//! | 17–18 | the walker's heading there | 2π/65536 |

use core::f32::consts::TAU;
use footfall_synth::{Controls, GaitChoice, GroundTransform};
use glam::Vec3;

/// Length of a step.
pub const STEP_BYTES: usize = 19;

const ROW_BITS: u32 = 17;
const TURNS: u32 = 1 << 7;

const RESTS: u16 = 1 << 12;
const RUNS: u16 = 1 << 13;
const STOPS: u16 = 1 << 14;
const MOST_SPEED: f32 = 4095.0;

const AGE_UNITS: f32 = 128.0;
const SPEED_UNITS: f32 = 500.0;
const TURN_UNITS: f32 = 36.0;
const PLACE_UNITS: f32 = 1000.0;
const HEIGHT_UNITS: f32 = 50.0;
const HEADING_UNITS: f32 = 65_536.0 / TAU;

/// Range of places, in their units.
const MOST_PLACE: f32 = 8_388_607.0;
const MOST_HEIGHT: f32 = 32_767.0;

/// Lowest speed of a moving walker, m/s; less would be standing. Lowest turn rate of a moving walker, rad/s.
const LEAST_MPS: f32 = 0.1;
const TURNS_RADPS: f32 = 0.05;

/// A step that a walker takes, or the place where it rests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StepUpdate {
    pub(super) row: u32,
    /// Count of earlier walkers in the row, as far as it is sent.
    pub(super) turn: u8,
    pub(super) number: u16,
    pub(super) age_secs: f32,
    /// Controls of the step, with its gait.
    pub(super) controls: Controls,
    pub(super) rests: bool,
    /// Place of the landing foot, or of the resting walker, with the walker's heading there, in the crowd's space.
    pub(super) aim: GroundTransform,
}

impl StepUpdate {
    /// Row and turn of a name.
    pub(super) const fn row_and_turn(name: i32) -> (u32, u8) {
        let name = name.cast_unsigned();
        let turn = (name >> ROW_BITS) % TURNS;
        (name % (1 << ROW_BITS), turn as u8)
    }

    /// Packs the step; `None` if its place is out of range: 8.3 km from the origin, or 655 m above or below it.
    pub(super) fn pack(&self) -> Option<[u8; STEP_BYTES]> {
        let place = self.aim.position;
        let [x, z] = [place.x, place.z].map(|part| (PLACE_UNITS * part).round());
        let height = (HEIGHT_UNITS * place.y).round();
        // NaN is within no range.
        let fits = x.abs() <= MOST_PLACE && z.abs() <= MOST_PLACE && height.abs() <= MOST_HEIGHT;
        if !fits || !self.aim.heading.is_finite() {
            return None;
        }
        let flag = |set: bool, bit: u16| if set { bit } else { 0 };
        let Controls {
            speed_mps,
            turn_rate_radps,
            gait,
            ..
        } = self.controls;
        let speed = (SPEED_UNITS * speed_mps).round().clamp(0.0, MOST_SPEED) as u16
            | flag(self.rests, RESTS)
            | flag(gait == GaitChoice::Run, RUNS)
            | flag(self.controls.is_standing(), STOPS);
        let heading = (HEADING_UNITS * self.aim.heading.rem_euclid(TAU)).round() as u32 as u16;
        let row = self.row | u32::from(self.turn) << ROW_BITS;
        let mut bytes = [0; STEP_BYTES];
        bytes[..3].copy_from_slice(&row.to_le_bytes()[..3]);
        bytes[3..5].copy_from_slice(&self.number.to_le_bytes());
        bytes[5] = (AGE_UNITS * self.age_secs).round() as u8;
        bytes[6..8].copy_from_slice(&speed.to_le_bytes());
        bytes[8] = ((TURN_UNITS * turn_rate_radps).round() as i8).cast_unsigned();
        bytes[9..12].copy_from_slice(&(x as i32).to_le_bytes()[..3]);
        bytes[12..15].copy_from_slice(&(z as i32).to_le_bytes()[..3]);
        bytes[15..17].copy_from_slice(&(height as i16).to_le_bytes());
        bytes[17..].copy_from_slice(&heading.to_le_bytes());
        Some(bytes)
    }

    /// Unpacks a step. Any bytes give one.
    pub(super) fn unpack(bytes: &[u8; STEP_BYTES]) -> Self {
        let short = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        let place = |at: usize| {
            let number = i32::from_le_bytes([0, bytes[at], bytes[at + 1], bytes[at + 2]]) >> 8;
            number as f32 / PLACE_UNITS
        };
        let row = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], 0]);
        let speed = short(6);
        let has = |bit: u16| speed & bit != 0;
        let stops = has(STOPS);
        let turn_rate_radps = f32::from(bytes[8].cast_signed()) / TURN_UNITS;
        // Rounding must not make a slow walker stand.
        let least = if turn_rate_radps.abs() < TURNS_RADPS {
            LEAST_MPS
        } else {
            0.0
        };
        let speed_mps = (f32::from(speed & 0x0fff) / SPEED_UNITS).max(least);
        Self {
            row: row % (1 << ROW_BITS),
            turn: (row >> ROW_BITS) as u8,
            number: short(3),
            age_secs: f32::from(bytes[5]) / AGE_UNITS,
            controls: Controls {
                speed_mps: if stops { 0.0 } else { speed_mps },
                turn_rate_radps: if stops { 0.0 } else { turn_rate_radps },
                gait: if has(RUNS) {
                    GaitChoice::Run
                } else {
                    GaitChoice::Walk
                },
                ..Controls::STAND
            },
            rests: has(RESTS),
            aim: GroundTransform {
                position: Vec3::new(
                    place(9),
                    f32::from(short(15).cast_signed()) / HEIGHT_UNITS,
                    place(12),
                ),
                heading: f32::from(short(17)) / HEADING_UNITS,
            },
        }
    }
}
