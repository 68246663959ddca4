//! Bouts of one gait within recordings, and their speed, cadence and flight.

use footfall_core::Clip;
use footfall_motion::steps::{Step, Walk, running_parts};

/// A gait that is judged by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gait {
    /// Steps without flight.
    #[default]
    Walk,
    /// Steps that end in flight, at least two in a row at an even speed and nearly straight.
    Run,
}

impl Gait {
    /// Name in tables and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Run => "run",
        }
    }

    /// Parts of a clip's walks in this gait.
    pub fn parts(self, clip: &Clip, walks: &[Walk]) -> Vec<Walk> {
        match self {
            Self::Walk => walking_parts(walks),
            Self::Run => running_parts(clip, walks),
        }
    }
}

/// Parts of walks in which one foot or the other always bears.
fn walking_parts(walks: &[Walk]) -> Vec<Walk> {
    let parts = walks
        .iter()
        .flat_map(|walk| walk.steps.split(|step| step.take_off.is_some()));
    parts
        .filter(|steps| !steps.is_empty())
        .map(|steps| Walk {
            steps: steps.to_vec(),
        })
        .collect()
}

/// Steps in a row in one gait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bout {
    /// Number of steps.
    pub steps: usize,
    /// Mean speed of the hips over the ground, m/s.
    pub speed_mps: f64,
    /// Steps a second.
    pub cadence_hz: f64,
    /// Share of the time in which the hips fall freely, from the last frame of support to the next initial contact.
    pub flight_share: f64,
}

impl Bout {
    /// Measures of a part; `None` without a step within the clip.
    pub fn of(clip: &Clip, part: &Walk) -> Option<Self> {
        let (first, last) = (part.steps.first()?, part.steps.last()?);
        let end = last.end.min(clip.poses.len().checked_sub(1)?);
        let frames = end.checked_sub(first.first).filter(|frames| *frames > 0)?;
        let way = clip.poses[end].root_position - clip.poses[first.first].root_position;
        let secs = frames as f64 / clip.frame_rate_hz;
        let flight: usize = part.steps.iter().map(flight_frames).sum();
        Some(Self {
            steps: part.steps.len(),
            speed_mps: f64::from(way.with_y(0.0).length()) / secs,
            cadence_hz: part.steps.len() as f64 / secs,
            flight_share: flight as f64 / frames as f64,
        })
    }
}

fn flight_frames(step: &Step) -> usize {
    step.take_off
        .map_or(0, |frame| step.end.saturating_sub(frame + 1))
}

/// Greatest difference in speed of bouts that are compared, m/s.
const ALIKE_MPS: f64 = 0.25;
/// Captured bouts fewer than this span no range.
const LEAST_BOUTS: usize = 3;

/// Shares of generated bouts within the range of the captured bouts of about the same speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WithinRange {
    /// Generated bouts with at least three captured ones within 0.25 m/s.
    pub bouts: usize,
    /// Share of these whose cadence lies between the least and the greatest captured.
    pub cadence: f64,
    /// Share of these whose flight does.
    pub flight: f64,
}

impl WithinRange {
    /// Compares bouts.
    pub fn of(captured: &[Bout], generated: &[Bout]) -> Self {
        let mut within = Self::default();
        for made in generated {
            let alike = || {
                let near = |bout: &&Bout| (bout.speed_mps - made.speed_mps).abs() <= ALIKE_MPS;
                captured.iter().filter(near)
            };
            if alike().count() < LEAST_BOUTS {
                continue;
            }
            let holds = |of: fn(&Bout) -> f64| {
                let below = alike().any(|bout| of(bout) <= of(made));
                let above = alike().any(|bout| of(bout) >= of(made));
                f64::from(u8::from(below && above))
            };
            within.bouts += 1;
            within.cadence += holds(|bout| bout.cadence_hz);
            within.flight += holds(|bout| bout.flight_share);
        }
        let count = within.bouts.max(1) as f64;
        (within.cadence, within.flight) = (within.cadence / count, within.flight / count);
        within
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Pose, Side, Skeleton};

    fn step(first: usize, end: usize, take_off: Option<usize>) -> Step {
        Step {
            take_off,
            ..Step::inside(Side::Left, first, end)
        }
    }

    /// Hips at 3 m/s for two seconds at 60 frames a second.
    fn clip() -> Clip {
        let poses = (0..=120).map(|frame| {
            let mut pose = Pose::rest(&Skeleton::standard());
            pose.root_position.z = 3.0 * frame as f32 / 60.0;
            pose
        });
        Clip {
            skeleton: Skeleton::standard(),
            frame_rate_hz: 60.0,
            poses: poses.collect(),
        }
    }

    #[test]
    fn a_walk_is_cut_where_it_flies() {
        let (flying, bearing) = (Some(39), None);
        let walks = [Walk {
            steps: vec![
                step(0, 20, bearing),
                step(20, 44, flying),
                step(44, 64, bearing),
                step(64, 84, bearing),
            ],
        }];
        let parts = Gait::Walk.parts(&clip(), &walks);
        let lengths: Vec<usize> = parts.iter().map(|part| part.steps.len()).collect();
        assert_eq!(lengths, [1, 2]);
    }

    #[test]
    fn a_bout_is_measured_by_its_frames() {
        let part = Walk {
            steps: vec![step(10, 30, Some(24)), step(30, 50, Some(44))],
        };
        let bout = Bout::of(&clip(), &part).unwrap();
        assert!((bout.speed_mps - 3.0).abs() < 1e-4, "{bout:?}");
        assert!((bout.cadence_hz - 3.0).abs() < 1e-9, "{bout:?}");
        assert!((bout.flight_share - 0.25).abs() < 1e-9, "{bout:?}");
        assert_eq!(Bout::of(&clip(), &Walk::default()), None);
    }

    #[test]
    fn what_lies_outside_is_found_and_what_has_no_like_is_left_out() {
        let bout = |speed_mps, cadence_hz, flight_share| Bout {
            steps: 2,
            speed_mps,
            cadence_hz,
            flight_share,
        };
        let captured = [
            bout(3.0, 2.6, 0.2),
            bout(3.1, 2.8, 0.3),
            bout(2.9, 2.7, 0.25),
        ];
        let generated = [
            bout(3.0, 2.7, 0.1),
            bout(3.0, 2.65, 0.28),
            bout(4.0, 9.0, 0.9),
        ];
        let within = WithinRange::of(&captured, &generated);
        assert_eq!(within.bouts, 2);
        assert!((within.cadence - 1.0).abs() < 1e-9);
        assert!((within.flight - 0.5).abs() < 1e-9);
    }
}
