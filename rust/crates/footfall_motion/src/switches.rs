//! Ground contacts from joint angles alone: when the legs change roles.
//!
//! Gait alternates between two systems, which switch when a foot lands (*Gait as a switching dynamical system*, section 2). The
//! projection residual of hip and knee angles ([`footfall_prob::switching`]) rises around each switch, but in captured motion it is
//! too noisy to be read: noise, muffled impacts and the lift of the other foot, a tenth of a second later, blur it. What hip and
//! knee angles say more plainly is where the legs are:
//!
//! 1. Hip and knee angles put the ankles somewhere below the hips. Every half cycle of one ankle ahead of the other holds one switch, onto the leg
//!    that was lifted in it: the leg ahead, or in backward walks the leg behind.
//! 2. The ankle reaches farthest ahead of its hip, and about then the landing knee is straightest. Which of the two comes first depends on the
//!    person; halfway between them differs little from person to person, and the foot lands [a few milliseconds](SwitchConfig) later.
//! 3. A leg that is lifted without a half cycle, to put the feet together or to turn on the spot, lands when the ankles no longer move against each
//!    other.
//!
//! No height, speed or ground is looked at. Each step is found by itself, so steps need not repeat. What the residual would add is
//! measured by `footfall evaluate contacts --corpus INDEX --ablate`; [`Landing`] has the choices.
//!
//! Against the kinematic initial contacts ([`crate::contacts`]), within 33 ms, on public recordings, hip joints corrected (bias and spread of ours
//! less the kinematic time, milliseconds; of people each by itself, the worst):
//!
//! | recordings | events | F1 | worst person | bias | spread | half cycles alone | with the residual instead of the legs | with both |
//! | --- | --- | --- | --- | --- | --- | --- | --- | --- |
//! | CMU and Bandai neutral walks, 120 and 30 fps | 411 | 1.00 | 1.00 | +4 | 13 | 0.43, worst 0.00 | 0.75, worst 0.00 | 0.98, worst 0.62 |
//! | Bandai styled walks, 30 fps | 1367 | 0.99 | 0.96 | +11 | 18 | 0.71, worst 0.44 | 0.90, worst 0.48 | 0.95, worst 0.89 |
//! | CMU and Bandai runs, styled ones too | 817 | 0.99 | 0.98 | -2 | 19 | 0.96, worst 0.46 | 0.93, worst 0.08 | 0.99, worst 0.85 |
//! | Bandai walks backwards, 30 fps | 207 | 0.86 | | 0 | 21 | | | |
//! | O3DE takes with stops, turns, jumps and crouches, 60 fps | 2391 | 0.89 | | +7 | 13 | 0.80 | 0.83 | 0.89 |
//!
//! Of the O3DE takes those of walks and their stops and turns have 0.87 to 0.96, runs with pivots 0.82, crouched walks 0.69, turns on the spot 0.48.
//!
//! Limits: hops and jumps are beyond it, dances too, and a foot that shifts by a hand's breadth in a turn is often missed.

mod angles;
mod beside;
mod legs;
mod residual;

use crate::steps::{LONGEST_STEP_SECS, SHORTEST_STEP_SECS, Step, Walk};
use angles::LegAngles;
use footfall_core::{Clip, EventKind, FrameSpan, GaitEvent, Side};
use footfall_prob::ProbError;
use residual::Residual;

/// Frames per second at which angles are looked at, those of the paper.
pub const ANGLE_RATE_HZ: f64 = 60.0;

/// Reach of the search for the residual from where the ankles are farthest apart, frames at [`ANGLE_RATE_HZ`].
const RESIDUAL_REACH: f64 = 12.0;

/// Rule that places a switch within the half cycle that holds it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Landing {
    /// Nothing: the ankles are farthest apart.
    HalfCycle,
    /// The projection residual, averaged over the clip's steps, is greatest.
    Residual,
    /// Place of the ankle by hip and knee.
    #[default]
    Legs,
    /// The residual is greatest within a frame of where the legs say.
    LegsAndResidual,
}

impl Landing {
    /// All of them, from the least to the most.
    pub const ALL: [Self; 4] = [
        Self::HalfCycle,
        Self::Residual,
        Self::Legs,
        Self::LegsAndResidual,
    ];

    /// A name for tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HalfCycle => "half cycles",
            Self::Residual => "half cycles, residual",
            Self::Legs => "half cycles, legs",
            Self::LegsAndResidual => "half cycles, legs, residual",
        }
    }
}

/// Rule and limits of the detector. Times were chosen on all people of the CMU, Bandai and O3DE recordings, each counting once;
/// `footfall evaluate contacts --leave-one-out` chooses the first two anew without each of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwitchConfig {
    /// Rule that places a switch.
    pub landing: Landing,
    /// Time by which a leg lands ahead after the moment halfway between its ankle farthest ahead and its knee straightest, seconds, when
    /// the knee bent by 60° in the swing.
    pub landing_secs: f64,
    /// Time by which it lands later for each radian that the knee bent more, seconds: faster shanks are stretched earlier.
    pub bend_secs_per_rad: f64,
    /// Time by which a leg lands behind before its ankle is farthest behind, seconds: toes first.
    pub behind_secs: f64,
}

impl Default for SwitchConfig {
    fn default() -> Self {
        Self {
            landing: Landing::default(),
            landing_secs: 0.006,
            bend_secs_per_rad: 0.012,
            behind_secs: 0.027,
        }
    }
}

impl SwitchConfig {
    /// The same limits with a rule of one's own choice.
    pub fn by(landing: Landing) -> Self {
        Self {
            landing,
            ..Self::default()
        }
    }
}

/// A change of roles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switch {
    /// Frame of the clip.
    pub frame: usize,
    /// The leg that lands and carries the body from here on.
    pub side: Side,
}

impl Switch {
    /// The initial contact that it stands for.
    pub const fn event(self) -> GaitEvent {
        GaitEvent {
            frame: self.frame,
            side: self.side,
            kind: EventKind::InitialContact,
        }
    }
}

/// Finds the switches of a clip from its frame `first_frame` on. A clip that is too short, or without a walk, has none.
///
/// # Errors
/// [`ProbError::NotFinite`] when a pose is not finite.
pub fn detect_switches(clip: &Clip, first_frame: usize) -> Result<Vec<Switch>, ProbError> {
    detect_switches_by(clip, first_frame, &SwitchConfig::default())
}

/// The same with limits of one's own choice.
///
/// # Errors
/// As [`detect_switches`].
pub fn detect_switches_by(
    clip: &Clip,
    first_frame: usize,
    config: &SwitchConfig,
) -> Result<Vec<Switch>, ProbError> {
    check_finite_legs(clip, first_frame)?;
    let angles = LegAngles::of(clip, first_frame);
    let residual = match config.landing {
        Landing::HalfCycle | Landing::Legs => None,
        Landing::Residual | Landing::LegsAndResidual => Residual::of(&angles)?,
    };
    Ok(place(clip, first_frame, &angles, residual.as_ref(), config))
}

/// The switches, and the residual to be shown beside them; none of it for a clip that is too short.
///
/// # Errors
/// As [`detect_switches`].
pub fn analyse_switches(
    clip: &Clip,
    first_frame: usize,
) -> Result<(Vec<Switch>, Option<SwitchResidual>), ProbError> {
    check_finite_legs(clip, first_frame)?;
    let angles = LegAngles::of(clip, first_frame);
    let residual = Residual::of(&angles)?;
    let switches = place(clip, first_frame, &angles, None, &SwitchConfig::default());
    let shown = residual.map(|residual| SwitchResidual {
        first_secs: first_frame as f64 / clip.frame_rate_hz + residual.first as f64 / ANGLE_RATE_HZ,
        rate_hz: ANGLE_RATE_HZ,
        legs: residual.legs,
    });
    Ok((switches, shown))
}

/// The switches of all swings, each in the first frame of the clip that shows it.
fn place(
    clip: &Clip,
    first_frame: usize,
    angles: &LegAngles,
    residual: Option<&Residual>,
    config: &SwitchConfig,
) -> Vec<Switch> {
    let (by_legs, reach) = match config.landing {
        Landing::HalfCycle => (false, 0.0),
        Landing::Residual => (false, RESIDUAL_REACH),
        Landing::Legs => (true, 0.0),
        Landing::LegsAndResidual => (true, 1.0),
    };
    let moments: Vec<(f64, Side)> = legs::landings(angles, config)
        .into_iter()
        .map(|landed| {
            let frame = if by_legs {
                landed.by_legs
            } else {
                landed.half_cycle
            };
            (frame, landed.side)
        })
        .collect();
    let shift = residual.map_or(0.0, |residual| residual.peak(&moments, reach));
    let last = clip.poses.len().saturating_sub(1);
    let mut switches: Vec<Switch> = moments
        .into_iter()
        .map(|(frame, side)| {
            let secs = (frame + shift).max(0.0) / ANGLE_RATE_HZ;
            let frame = first_frame + (secs * clip.frame_rate_hz).ceil() as usize;
            Switch { frame, side }
        })
        .filter(|switch| switch.frame <= last)
        .collect();
    switches.sort_by_key(|switch| switch.frame);
    switches
}

fn check_finite_legs(clip: &Clip, first_frame: usize) -> Result<(), ProbError> {
    let legs = Side::BOTH.map(|side| [side.upper_leg(), side.lower_leg()]);
    for (frame, pose) in clip.poses.iter().enumerate().skip(first_frame) {
        for rotation in legs
            .as_flattened()
            .iter()
            .map(|joint| pose.rotation(*joint))
        {
            if !rotation.is_finite() {
                return Err(ProbError::NotFinite {
                    what: "leg rotations, by frame",
                    index: frame,
                    value: f64::NAN,
                });
            }
        }
    }
    Ok(())
}

/// The projection residual, which peaks where one system hands over to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct SwitchResidual {
    /// Time in the clip of the first value, seconds.
    pub first_secs: f64,
    /// Values a second.
    pub rate_hz: f64,
    /// For the left and the right leg, over the clip's median.
    pub legs: [Vec<f64>; 2],
}

/// The frames in which each foot certainly bears on the ground: from its switch until the last one of the other foot before its own next. When it
/// leaves the ground after that is not determined by switches.
pub fn stances(switches: &[Switch], frames: usize) -> [Vec<FrameSpan>; 2] {
    let mut stances = [Vec::new(), Vec::new()];
    for (index, switch) in switches.iter().enumerate() {
        let later = &switches[index + 1..];
        let others = later.iter().take_while(|next| next.side != switch.side);
        let last = if later.is_empty() {
            frames.saturating_sub(1)
        } else {
            others.last().map_or(switch.frame, |next| next.frame)
        };
        stances[switch.side.index()].push(FrameSpan {
            first: switch.frame,
            last: last.max(switch.frame),
        });
    }
    stances
}

/// The steps between switches, as walks; steps shorter than 0.15 s or longer than 1.5 s break a walk. Which steps begin and end a
/// walk, and when feet leave the ground, is not determined by switches.
pub fn walks(switches: &[Switch], frame_rate_hz: f64) -> Vec<Walk> {
    let mut walks: Vec<Walk> = Vec::new();
    let mut last_end = None;
    for pair in switches.windows(2) {
        let (side, first, end) = (pair[0].side, pair[0].frame, pair[1].frame);
        let secs = end.saturating_sub(first) as f64 / frame_rate_hz;
        if side == pair[1].side || !(SHORTEST_STEP_SECS..=LONGEST_STEP_SECS).contains(&secs) {
            continue;
        }
        let step = Step::inside(side, first, end);
        match walks.last_mut() {
            Some(walk) if last_end == Some(first) => walk.steps.push(step),
            _ => walks.push(Walk { steps: vec![step] }),
        }
        last_end = Some(end);
    }
    walks
}
