//! Contacts of heel and toes with the ground, and the resulting gait events.
//!
//! A point of the sole comes into contact when it is low and has come to rest, and leaves it when it is high or fast, with
//! hysteresis. Heights are above the level at which the point itself rests nearby, for a leg of 0.84 m; speeds are shares of the
//! speed of the swings nearby, which distinguishes a runner's sliding stance from an old man's slow swing, also within one clip.
//!
//! **Definition.** An initial contact is the first frame in which any part of the foot bears on the ground, a terminal contact
//! the last. Published kinematic detectors differ from each other by 20 to 50 ms; the limits here lie between them. Mean delay and
//! spread of ours against Zeni et al. 2008 (farthest ahead of and behind the hips; [`crate::published_events`]) in steady walks
//! straight ahead, milliseconds (positive: ours is later), and F1 within 50 ms of the worst person:
//!
//! | recordings | initial contacts | worst | terminal contacts | worst |
//! | --- | --- | --- | --- | --- |
//! | CMU neutral walks, 120 fps, 7 people and strangers | +10 ± 8 | 0.95 | +5 ± 11 | 0.97 |
//! | Bandai neutral walks, 30 fps, two groups of actors | +18 ± 17 | 0.99 | -3 ± 11 | 0.99 |
//! | Bandai styled walks, 30 fps, the same | +12 ± 17 | 0.96 | -2 ± 13 | 1.00 |
//! | O3DE walks with stops and turns, 60 fps, one actor | +11 ± 11 | 0.99 | -13 ± 9 | 0.99 |
//!
//! The vertical speed of the middle of the foot (O'Connor et al. 2007) gives the initial contacts of the same walks 23 to 37 ms after
//! ours and the terminal ones 16 to 24 ms before.
//!
//! Neither is made for runs: there a foot reaches farthest ahead before it lands and farthest behind after it lifts. Against the time
//! for which the body falls freely (centre of mass below -0.5 g), landings of CMU runs are about 25 ms early to on time and lifts 40 ms
//! late, part of which is the push that is weaker than half the body's weight.
//!
//! **Unknown people.** Feet of people outside the tuning set used to lift 40 to 150 ms early, for three reasons. The speed of a swing and the
//! levels at which soles rest were those of the clip, but a clip of mostly standing has few swings, and soles that
//! lie as they do in standing; both are now local. The toes of a retargeted body that do not bend like the person's slide
//! back while the ball rises, so neither speed alone shows a lift: now both must go forward, or both up.

mod hysteresis;
mod levels;
mod signals;

use footfall_core::{Clip, EventKind, FrameSpan, GaitEvent, Side};
use hysteresis::{Gate, close_gaps, drop_short, gate};
pub(crate) use signals::body_size;
use signals::{FootSignals, swing_speeds};

/// Limits of the detector. Heights are above the level at which the point itself rests within 0.6 s, on a body whose leg is 0.84 m long
/// (in proportion on others); speeds are shares of the speed at which feet swing within half a second.
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
    /// The heel comes into contact below this share of the swing's speed.
    pub heel_speed_on: f32,
    /// The toes come into contact below this share.
    pub toe_speed_on: f32,
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
            heel_speed_on: 0.2,
            toe_speed_on: 0.15,
            heel_speed_off: 0.25,
            toe_speed_off: 0.3,
            least_contact_secs: 0.08,
            least_gap_secs: 0.06,
        }
    }
}

/// Contact of one foot, frame by frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FootContacts {
    /// True for the frames in which the heel bears on the ground.
    pub heel: Vec<bool>,
    /// True for those in which the ball of the foot or the toes do.
    pub toe: Vec<bool>,
    /// Runs of frames in which any part of the foot bears on the ground, in order.
    pub stances: Vec<FrameSpan>,
}

/// Contacts of both feet with the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Contacts {
    /// Frames per second of the clip.
    pub frame_rate_hz: f64,
    /// Number of the clip's frames.
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

    /// Returns true when any part of a foot bears on the ground in a frame.
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
    let size = body_size(clip);
    let heels = signals.each_ref().map(|foot| &foot.heel);
    let swing = swing_speeds(heels, clip.frame_rate_hz as f32, size);
    let feet = signals.map(|foot| contacts_of(&foot, &swing, size, clip.frame_rate_hz, config));
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
    swing_speed: &[f32],
    size: f32,
    frame_rate_hz: f64,
    config: &ContactConfig,
) -> (Vec<bool>, Vec<bool>) {
    let frames_of = |secs: f64| (secs * frame_rate_hz).round() as usize;
    let gate_with = |height_off: f32, speed_on: f32, speed_off: f32| Gate {
        height_on: config.height_on_m * size,
        height_off: height_off.max(config.height_on_m) * size,
        speed_on,
        speed_off: speed_off.max(speed_on),
    };
    let heel_gate = gate_with(
        config.heel_off_m,
        config.heel_speed_on,
        config.heel_speed_off,
    );
    let toe_gate = gate_with(config.toe_off_m, config.toe_speed_on, config.toe_speed_off);
    let mut heel = gate(&foot.heel, swing_speed, &heel_gate);
    let mut toe = gate(&foot.toe, swing_speed, &toe_gate);
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
