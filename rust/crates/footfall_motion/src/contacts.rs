//! When the heel and the toes of each foot bear on the ground, and the gait events that follow.
//!
//! A point of the sole comes into contact when it is low and has come to rest, and leaves it when it is high or fast, with
//! hysteresis. Heights are above the level at which the point itself rests in the clip; speeds are shares of the speed of a
//! swinging foot in the clip, so that a runner's sliding stance and an old man's slow swing are told apart.
//!
//! **Definition.** An initial contact is the first frame in which any part of the foot bears on the ground, a terminal contact
//! the last. Published kinematic detectors differ from each other by 20 to 50 ms; the limits here were chosen to lie between
//! them. Mean delay and spread of ours against two of them (negative: ours is earlier), milliseconds, on public recordings:
//!
//! | recordings | event | Zeni et al. 2008 (farthest ahead of and behind the hips) | O'Connor et al. 2007 (vertical speed of the foot) |
//! | --- | --- | --- | --- |
//! | CMU neutral walks, 120 fps | initial | +16 ± 9, F1 0.99 at ±50 ms | -29 ± 13 |
//! | | terminal | 0 ± 20, F1 0.99 | -3 ± 27 |
//! | Bandai neutral walks, 30 fps | initial | +25 ± 15, F1 0.99 | -20 ± 17, F1 0.98 |
//! | | terminal | 0 ± 10, F1 1.00 | +9 ± 16, F1 0.99 |
//! | Bandai styled walks, 30 fps | initial | +19 ± 18, F1 0.98 | -17 ± 18 |
//! | | terminal | -1 ± 13, F1 1.00 | +3 ± 22, F1 0.96 |
//! | CMU runs, 120 fps | initial | +48 ± 11 | -2 ± 42 |
//! | | terminal | -81 ± 21 | -48 ± 30 |
//!
//! Neither reference is made for runs: there a foot reaches farthest ahead before it lands and farthest behind after it
//! lifts. Against the time for which the body falls freely (centre of mass below -0.5 g), landings of CMU runs are 17 ms
//! early to 8 ms late and lifts 40 ms late, part of which is the push that is weaker than half the body's weight.

mod hysteresis;
mod signals;

use footfall_core::{Clip, EventKind, FrameSpan, GaitEvent, Side};
use hysteresis::{Gate, close_gaps, drop_short, gate};
use signals::FootSignals;

/// Limits of the detector. Heights are above the level at which the point itself rests in this clip.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactConfig {
    /// Frames before this one are no motion and have no contact.
    pub first_frame: usize,
    /// A point comes into contact below this height, metres.
    pub height_on_m: f32,
    /// The heel leaves it above this one.
    pub heel_off_m: f32,
    /// The toes leave it above this one.
    pub toe_off_m: f32,
    /// A point comes into contact below this speed, as a share of the speed of a swinging foot in this clip.
    pub speed_on: f32,
    /// The heel leaves it above this share.
    pub heel_speed_off: f32,
    /// The toes leave it above this share: they slide while they push off.
    pub toe_speed_off: f32,
    /// A contact lasts at least this long, seconds.
    pub least_contact_secs: f64,
    /// A shorter break within a contact does not count, seconds.
    pub least_gap_secs: f64,
}

impl ContactConfig {
    /// The limits that were measured to agree best with published detectors, for a clip whose motion starts at `first_frame`.
    pub const fn from_frame(first_frame: usize) -> Self {
        Self {
            first_frame,
            height_on_m: 0.035,
            heel_off_m: 0.04,
            toe_off_m: 0.05,
            speed_on: 0.15,
            heel_speed_off: 0.2,
            toe_speed_off: 0.27,
            least_contact_secs: 0.08,
            least_gap_secs: 0.06,
        }
    }
}

/// Contact of one foot, frame by frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FootContacts {
    /// Whether the heel bears on the ground.
    pub heel: Vec<bool>,
    /// Whether the ball of the foot or the toes bear on the ground.
    pub toe: Vec<bool>,
    /// Runs of frames in which any part of the foot bears on the ground, in order.
    pub stances: Vec<FrameSpan>,
}

/// Contacts of both feet with the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Contacts {
    /// Frames per second of the clip.
    pub frame_rate_hz: f64,
    /// How many frames the clip has.
    pub frames: usize,
    /// First frame of the motion proper.
    pub first_frame: usize,
    /// Left, then right.
    pub feet: [FootContacts; 2],
}

impl Contacts {
    /// One foot.
    pub fn foot(&self, side: Side) -> &FootContacts {
        &self.feet[side.index()]
    }

    /// The same clip with these stances of the left and of the right foot instead, in order and apart. Which part of the foot
    /// bears stays as it was where a stance was; where there is a new one, the whole foot does.
    #[must_use]
    pub fn with_stances(&self, stances: [Vec<FrameSpan>; 2]) -> Self {
        let mut corrected = self.clone();
        for (foot, stances) in corrected.feet.iter_mut().zip(stances) {
            let mut stands = vec![false; self.frames];
            for span in &stances {
                let last = span.last.min(self.frames.saturating_sub(1));
                stands[span.first.min(last)..=last].fill(true);
            }
            for (frame, bears) in stands.into_iter().enumerate() {
                let known = foot.heel[frame] || foot.toe[frame];
                foot.heel[frame] = bears && (foot.heel[frame] || !known);
                foot.toe[frame] = bears && (foot.toe[frame] || !known);
            }
            foot.stances = stances;
        }
        corrected
    }

    /// Whether any part of a foot bears on the ground in a frame.
    pub fn bears(&self, side: Side, frame: usize) -> bool {
        let foot = self.foot(side);
        let flag = |flags: &[bool]| flags.get(frame).copied().unwrap_or(false);
        flag(&foot.heel) || flag(&foot.toe)
    }

    /// Initial and terminal contacts in the order of their frames.
    ///
    /// A stance that already lasts when the motion begins has no initial contact, one that lasts to its end no terminal one.
    pub fn events(&self) -> Vec<GaitEvent> {
        let mut events = Vec::new();
        for side in Side::BOTH {
            for stance in &self.foot(side).stances {
                let ends = [
                    (stance.first, EventKind::InitialContact, self.first_frame),
                    (stance.last, EventKind::TerminalContact, self.frames - 1),
                ];
                for (frame, kind, edge) in ends {
                    if frame != edge {
                        events.push(GaitEvent { frame, side, kind });
                    }
                }
            }
        }
        events.sort_by_key(|event| (event.frame, event.kind, event.side));
        events
    }
}

/// Detects contacts from height and speed of heel, ball and toe tip. Frame numbers are the clip's.
pub fn detect_contacts(clip: &Clip, config: &ContactConfig) -> Contacts {
    let frames = clip.poses.len();
    let first_frame = config.first_frame.min(frames.saturating_sub(1));
    let signals = Side::BOTH.map(|side| FootSignals::of(clip, side, first_frame));
    // Both feet swing alike, and in a short clip one of them may not swing at all.
    let swing_speed = signals
        .iter()
        .map(|foot| foot.swing_speed)
        .fold(0.0, f32::max)
        .max(signals::LEAST_SWING_SPEED);
    let feet = signals.map(|foot| contacts_of(&foot, swing_speed, clip.frame_rate_hz, config));
    Contacts {
        frame_rate_hz: clip.frame_rate_hz,
        frames,
        first_frame,
        feet: feet.map(|(heel, toe)| {
            let pad = |flags: Vec<bool>| {
                let mut all = vec![false; first_frame];
                all.extend(flags);
                all
            };
            let (heel, toe) = (pad(heel), pad(toe));
            let any: Vec<bool> = heel
                .iter()
                .zip(&toe)
                .map(|(heel, toe)| *heel || *toe)
                .collect();
            FootContacts {
                heel,
                toe,
                stances: FrameSpan::runs(&any),
            }
        }),
    }
}

fn contacts_of(
    foot: &FootSignals,
    swing_speed: f32,
    frame_rate_hz: f64,
    config: &ContactConfig,
) -> (Vec<bool>, Vec<bool>) {
    let frames_of = |secs: f64| (secs * frame_rate_hz).round() as usize;
    let gate_with = |height_off: f32, speed_off: f32| Gate {
        height_on: config.height_on_m,
        height_off: height_off.max(config.height_on_m),
        speed_on: config.speed_on * swing_speed,
        speed_off: speed_off.max(config.speed_on) * swing_speed,
    };
    let heel_gate = gate_with(config.heel_off_m, config.heel_speed_off);
    let toe_gate = gate_with(config.toe_off_m, config.toe_speed_off);
    let mut heel = gate(&foot.heel, &heel_gate);
    let mut toe = gate(&foot.toe, &toe_gate);
    for flags in [&mut heel, &mut toe] {
        close_gaps(flags, frames_of(config.least_gap_secs));
    }
    // What counts as a contact is the foot's, not the point's: a heel may touch for a moment before the ball does.
    let mut any: Vec<bool> = heel
        .iter()
        .zip(&toe)
        .map(|(heel, toe)| *heel || *toe)
        .collect();
    let gaps = any.clone();
    close_gaps(&mut any, frames_of(config.least_gap_secs));
    for frame in 0..any.len() {
        // In a closed gap the lower part bears.
        if any[frame] && !gaps[frame] {
            if foot.heel.height[frame] < foot.toe.height[frame] {
                heel[frame] = true;
            } else {
                toe[frame] = true;
            }
        }
    }
    drop_short(&mut any, frames_of(config.least_contact_secs));
    for frame in 0..any.len() {
        heel[frame] &= any[frame];
        toe[frame] &= any[frame];
    }
    (heel, toe)
}
