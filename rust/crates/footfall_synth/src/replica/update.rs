//! Updates: a walker's progress as it is sent over a network.
//!
//! | bytes | content | unit |
//! | --- | --- | --- |
//! | 0 | format (upper half); rests, runs, stops, brakes | |
//! | 1–2 | tag of the walker's identity | |
//! | 3–4 | the sender's time, which wraps after 262 s | 4 ms |
//! | 5–6 | number of the step: even ones begin with the left foot's contact | |
//! | 7 | share of the step that had passed when it was last planned | 1/255 |
//! | 8 | time since then | frame of the model |
//! | 9–10 | speed | mm/s |
//! | 11 | direction | π/128 |
//! | 12 | turning | 1/36 rad/s |
//! | 13 | rise of a jump | cm |
//! | 14–16, 17–19 | place of the landing foot or the resting walker: x and z | mm |
//! | 20–21 | its height | 4 cm |
//! | 22–23 | the walker's heading there (12 bits), depth of the crouch (4 bits) | π/2048, 1/15 |

use super::ReplicaError;
use crate::controls::{Controls, GaitChoice, TURN_UNITS};
use core::f32::consts::{PI, TAU};
use footfall_core::GroundTransform;
use glam::Vec3;

/// Length of a packed update.
pub const UPDATE_BYTES: usize = 24;

/// Format that this build writes and reads.
pub(super) const FORMAT: u8 = 2;

const RESTS: u8 = 1;
const RUNS: u8 = 2;
const STOPS: u8 = 4;
const BRAKES: u8 = 8;

const PASSED_UNITS: f32 = 255.0;
const PLACE_UNITS: f32 = 1000.0;
const HEIGHT_UNITS: f32 = 25.0;
const SPEED_UNITS: f32 = 1000.0;
const DIRECTION_UNITS: f32 = 128.0 / PI;
const RISE_UNITS: f32 = 100.0;
const HEADING_STEPS: f32 = 4096.0;
const CROUCH_UNITS: f32 = 15.0;

/// Greatest distances from the origin, in units.
const MOST_PLACE: f32 = 8_388_607.0;
const MOST_HEIGHT: f32 = 32_767.0;

/// Slowest speed of a walking walker, m/s; less would be standing.
const LEAST_MPS: f32 = 0.1;

/// Moment of a walk at which a step was planned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Planned {
    /// Number of the step.
    pub(super) number: u16,
    /// Share of the step that had passed, in 255ths.
    pub(super) passed: u8,
}

/// Progress of a walker, as it is sent to others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WalkUpdate {
    pub(super) tag: u16,
    /// The sender's time in ticks.
    pub(super) time: u16,
    pub(super) planned: Planned,
    /// Frames of the model since then; 255 is that many or more.
    pub(super) age_frames: u8,
    /// Controls of the step; the gait is its actual one.
    pub(super) controls: Controls,
    /// True when the walker has stopped and rests.
    pub(super) rests: bool,
    /// True when the step brings the feet together, at the end of a walk, or is one of a run that slows down.
    pub(super) brakes: bool,
    /// Rise of the hips in a jump, metres; 0 is none.
    pub(super) rise_m: f32,
    /// Place of the landing foot or the resting walker, under the walker's heading then, in the shared space.
    pub(super) aim: GroundTransform,
}

impl Planned {
    pub(super) fn of(number: u16, passed: f32) -> Self {
        Self {
            number,
            passed: (PASSED_UNITS * passed).round() as u8,
        }
    }

    /// Returns the share of the step that had passed.
    pub(super) fn share(self) -> f32 {
        f32::from(self.passed) / PASSED_UNITS
    }

    /// Returns true when less of the step has passed than this share, which was rounded.
    pub(super) fn is_after(self, share: f32) -> bool {
        PASSED_UNITS * share < f32::from(self.passed) - 0.5
    }

    /// Returns the number of steps from another number to this one; negative for earlier ones.
    pub(super) const fn steps_from(self, number: u16) -> i16 {
        self.number.wrapping_sub(number).cast_signed()
    }
}

impl WalkUpdate {
    /// Packs it.
    ///
    /// # Errors
    /// [`ReplicaError::OutOfRange`] when the place does not fit.
    pub(super) fn pack(&self) -> Result<[u8; UPDATE_BYTES], ReplicaError> {
        let place = self.aim.position;
        let [x, z] = [place.x, place.z].map(|part| (PLACE_UNITS * part).round());
        let height = (HEIGHT_UNITS * place.y).round();
        // NaN is outside any range.
        let fits = x.abs() <= MOST_PLACE && z.abs() <= MOST_PLACE && height.abs() <= MOST_HEIGHT;
        if !fits || !self.aim.heading.is_finite() {
            return Err(ReplicaError::OutOfRange(place.length()));
        }
        let flag = |set: bool, bit: u8| if set { bit } else { 0 };
        let Controls {
            speed_mps,
            turn_rate_radps,
            direction_rad,
            gait,
            crouch,
        } = self.controls;
        let flags = flag(self.rests, RESTS)
            | flag(gait == GaitChoice::Run, RUNS)
            | flag(self.controls.is_standing(), STOPS)
            | flag(self.brakes, BRAKES);
        let heading = (HEADING_STEPS * self.aim.heading.rem_euclid(TAU) / TAU).round() as u16;
        let crouch = (CROUCH_UNITS * crouch.clamp(0.0, 1.0)).round() as u16;
        let mut bytes = [0; UPDATE_BYTES];
        bytes[0] = FORMAT << 4 | flags;
        bytes[1..3].copy_from_slice(&self.tag.to_le_bytes());
        bytes[3..5].copy_from_slice(&self.time.to_le_bytes());
        bytes[5..7].copy_from_slice(&self.planned.number.to_le_bytes());
        bytes[7] = self.planned.passed;
        bytes[8] = self.age_frames;
        let speed = (SPEED_UNITS * speed_mps).round() as u16;
        bytes[9..11].copy_from_slice(&speed.to_le_bytes());
        // 180° to the left is 180° to the right.
        let direction = (DIRECTION_UNITS * direction_rad).round() as i16;
        bytes[11] = direction as u8;
        bytes[12] = ((TURN_UNITS * turn_rate_radps).round() as i8).cast_unsigned();
        bytes[13] = (RISE_UNITS * self.rise_m).round() as u8;
        bytes[14..17].copy_from_slice(&(x as i32).to_le_bytes()[..3]);
        bytes[17..20].copy_from_slice(&(z as i32).to_le_bytes()[..3]);
        bytes[20..22].copy_from_slice(&(height as i16).to_le_bytes());
        bytes[22..].copy_from_slice(&((heading & 0x0fff) | crouch << 12).to_le_bytes());
        Ok(bytes)
    }

    /// Unpacks it.
    ///
    /// # Errors
    /// [`ReplicaError::Length`] or [`ReplicaError::Format`].
    pub(super) fn unpack(bytes: &[u8]) -> Result<Self, ReplicaError> {
        let bytes: &[u8; UPDATE_BYTES] = bytes
            .try_into()
            .map_err(|_other_length| ReplicaError::Length(bytes.len()))?;
        let format = bytes[0] >> 4;
        if format != FORMAT {
            return Err(ReplicaError::Format(format));
        }
        let has = |bit: u8| bytes[0] & bit != 0;
        let short = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        let place = |at: usize| {
            let number = i32::from_le_bytes([0, bytes[at], bytes[at + 1], bytes[at + 2]]) >> 8;
            number as f32 / PLACE_UNITS
        };
        let speed_mps = f32::from(short(9)) / SPEED_UNITS;
        let turn_rate_radps = f32::from(bytes[12].cast_signed()) / TURN_UNITS;
        let stops = has(STOPS);
        let turns = !Controls {
            turn_rate_radps,
            ..Controls::STAND
        }
        .is_standing();
        let least = if turns { 0.0 } else { LEAST_MPS };
        let last = short(22);
        Ok(Self {
            tag: short(1),
            time: short(3),
            planned: Planned {
                number: short(5),
                passed: bytes[7],
            },
            age_frames: bytes[8],
            controls: Controls {
                speed_mps: if stops { 0.0 } else { speed_mps.max(least) },
                turn_rate_radps: if stops { 0.0 } else { turn_rate_radps },
                direction_rad: f32::from(bytes[11].cast_signed()) / DIRECTION_UNITS,
                gait: if has(RUNS) {
                    GaitChoice::Run
                } else {
                    GaitChoice::Walk
                },
                crouch: f32::from(last >> 12) / CROUCH_UNITS,
            },
            rests: has(RESTS),
            brakes: has(BRAKES),
            rise_m: f32::from(bytes[13]) / RISE_UNITS,
            aim: GroundTransform {
                position: Vec3::new(
                    place(14),
                    f32::from(short(20).cast_signed()) / HEIGHT_UNITS,
                    place(17),
                ),
                heading: TAU * f32::from(last & 0x0fff) / HEADING_STEPS,
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn update(place: Vec3, heading: f32) -> WalkUpdate {
        WalkUpdate {
            tag: 0xbeef,
            time: 65_000,
            planned: Planned::of(513, 0.4),
            age_frames: 17,
            controls: Controls {
                speed_mps: 1.234,
                turn_rate_radps: -0.5,
                direction_rad: -1.2,
                gait: GaitChoice::Walk,
                crouch: 0.6,
            },
            rests: false,
            brakes: true,
            rise_m: 0.31,
            aim: GroundTransform {
                position: place,
                heading,
            },
        }
    }

    proptest! {
        #[test]
        fn places_come_through_within_their_units(
            (x, y, z) in (-8000.0_f32..8000.0, -1000.0_f32..1000.0, -8000.0_f32..8000.0),
            heading in -3.0_f32..3.0,
        ) {
            let sent = update(Vec3::new(x, y, z), heading);
            let heard = WalkUpdate::unpack(&sent.pack().unwrap()).unwrap();
            let off = (heard.aim.position - sent.aim.position).abs();
            // Half a millimetre, and what an `f32` can say of 8 km.
            prop_assert!(off.x < 0.002 && off.z < 0.002 && off.y < 0.021, "{off}");
            let turned = footfall_core::rotation::wrap_angle(heard.aim.heading - heading);
            prop_assert!(turned.abs() < 0.0008, "{turned}");
            prop_assert_eq!((heard.planned, heard.rests, heard.brakes), (sent.planned, false, true));
            prop_assert_eq!((heard.tag, heard.time, heard.age_frames), (0xbeef, 65_000, 17));
        }

        #[test]
        fn any_bytes_are_an_update_or_an_error(bytes in proptest::collection::vec(any::<u8>(), 0..40)) {
            if let Ok(update) = WalkUpdate::unpack(&bytes) {
                prop_assert!(update.aim.position.is_finite() && update.controls.speed_mps.is_finite());
                prop_assert_eq!(bytes.len(), UPDATE_BYTES);
            }
        }
    }

    /// A share that was rounded up would have its frame pass unnoticed.
    #[test]
    fn a_step_is_replanned_in_the_frame_in_which_the_sender_did() {
        for frames in 6..65_u16 {
            for frame in 1..frames {
                let share = |frame: u16| f32::from(frame) / f32::from(frames);
                let planned = Planned::of(0, share(frame));
                assert!(!planned.is_after(share(frame)), "{frame} of {frames}");
                assert!(planned.is_after(share(frame - 1)), "{frame} of {frames}");
            }
        }
    }

    #[test]
    fn who_goes_slowly_does_not_stand() {
        for (speed_mps, turn_rate_radps, stands) in [
            (0.1, 0.0, false),
            (0.0, 0.05, false),
            (0.099, 0.049, true),
            (0.1004, -0.01, false),
        ] {
            let mut sent = update(Vec3::ZERO, 0.0);
            sent.controls.speed_mps = speed_mps;
            sent.controls.turn_rate_radps = turn_rate_radps;
            let heard = WalkUpdate::unpack(&sent.pack().unwrap()).unwrap();
            assert_eq!(heard.controls.is_standing(), stands, "{speed_mps} m/s");
        }
    }

    #[test]
    fn places_that_do_not_fit_are_refused() {
        for place in [
            Vec3::X * 9000.0,
            Vec3::Y * 1500.0,
            Vec3::NAN,
            Vec3::Z * f32::NEG_INFINITY,
        ] {
            let refused = update(place, 0.0).pack();
            assert!(
                matches!(refused, Err(ReplicaError::OutOfRange(_))),
                "{place}"
            );
        }
        assert!(update(Vec3::ZERO, f32::NAN).pack().is_err());
    }
}
