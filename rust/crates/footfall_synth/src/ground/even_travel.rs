//! Even travel: the hips speed up and slow down once per step as people's do, independent of errors in the angles of the standing leg.
//!
//! The path above the standing foot follows from independently generated angles, and every error of an angle becomes a surge of
//! the whole body: the hips were fastest before a foot landed, whereas people's are fastest soon after. Therefore a forward step gets the speed profile of captured hips,
//! a step in another direction keeps at most the captured amplitude at the step's frequency, and the legs are then solved to the feet.

use super::course::Course;
use super::frame::PlantedFrame;
use super::planter::Planter;
use super::speed_change::{steady, urge};
use crate::plan::StepTiming;
use core::f32::consts::TAU;
use footfall_core::ease::smooth_step;
use glam::{Vec2, Vec3};

/// Greatest amplitudes of the first harmonics of a step's frequency in the hips' speed, as shares of its mean:
/// captured walks have 0.13 and 0.05. Higher harmonics are surge.
const MOST: [f32; 2] = [0.15, 0.06];

/// The same harmonics in a walk forwards, cosine and sine from the landing on: means of CMU's neutral walkers, all eight of whom are fastest 50 to 110 ms after a
/// landing, as the leg behind pushes off, and slowest in the middle of the stance.
const FORWARDS: [Vec2; 2] = [Vec2::new(0.117, 0.055), Vec2::new(0.011, 0.034)];

/// Blend from the harmonics of the generated legs to those. With 1 legs would stretch too fast before a change of speed.
const PEOPLE_S: f32 = 0.35;

/// Weight of a change of speed, and displacement of the step's end in metres, from which a step is not part of a steady walk.
const UNSTEADY: f32 = 0.25;
const DISPLACED_M: f32 = 0.05;

/// Time constant of the transition from the previous step's speed, seconds.
const PASSING_SECS: f32 = 0.15;

/// Travel in a step, as a share of the leg's length, from which evening sets in, and from which it is complete.
const EVENED: [f32; 2] = [0.1, 0.5];

impl Planter {
    /// Evens the travel of the hips within a step; its ends stay.
    pub(super) fn even(&self, timing: &StepTiming, course: Course, out: &mut [PlantedFrame]) {
        let change = course.change;
        let frames = timing.frames as f32;
        let begin = out[0].pose.root_position;
        let way = (out[timing.frames].pose.root_position - begin) * Vec3::new(1.0, 0.0, 1.0);
        let length = way.length();
        let share = length / self.leg_lengths[timing.leading.index()];
        let even = smooth_step((share - EVENED[0]) / (EVENED[1] - EVENED[0]));
        let weight = even.max(change.weight_over(share));
        if weight <= 0.0 {
            return;
        }
        let along = way / length;
        let pace = length / frames;
        // Lead of the hips over travel at constant speed.
        let ahead = |hips: Vec3, frame: usize| along.dot(hips - begin) - pace * frame as f32;

        let people = self.people_s(timing, course);
        let mut waves = [Wave::default(); MOST.len()];
        for (index, (wave, most)) in waves.iter_mut().zip(MOST).enumerate() {
            let Some(turned) = turn_in_frame(index + 1, timing.frames) else {
                continue;
            };
            let turn = Vec2::from_angle(turned);
            let mut angle = Vec2::X;
            let mut sum = Vec2::ZERO;
            for (frame, planted) in out[..timing.frames].iter().enumerate() {
                sum += angle * ahead(planted.pose.root_position, frame);
                angle = turn.rotate(angle);
            }
            wave.turn = turn;
            // Displacement by a speed of one mean.
            let unit = pace / turned;
            let generated = (sum * (2.0 / frames)).clamp_length_max(most * unit);
            let captured = FORWARDS[index].perp() * unit;
            // A change of speed looks like a surge but is not one.
            wave.amplitude = generated.lerp(captured, people) * (1.0 - change.weight);
        }
        let begins_at = waves
            .iter()
            .fold(pace, |speed, wave| speed + wave.first_speed());
        let news = self.state.hips_velocity.map_or(0.0, |velocity| {
            along.dot(velocity) * self.frame_secs - begins_at
        });
        let mut ends = change.speed_mps * self.frame_secs - pace;
        if !timing.rests {
            ends = 0.5 * (ends + steady(news, ends));
        }
        let decay = -self.frame_secs / PASSING_SECS;
        let left = (frames * decay).exp();
        let mut angles = [Vec2::X; MOST.len()];
        for (frame, planted) in out[..=timing.frames].iter_mut().enumerate() {
            let time = frame as f32;
            let settled = news * time * ((time * decay).exp() - left);
            let urged = frames * urge(news, ends, time / frames);
            let mut evened = settled + change.weight * (urged - settled);
            for (wave, angle) in waves.iter().zip(&mut angles) {
                evened += wave.amplitude.dot(*angle - Vec2::X);
                *angle = wave.turn.rotate(*angle);
            }
            let hips = &mut planted.pose.root_position;
            *hips += along * (weight * (evened - ahead(*hips, frame)));
        }
    }

    /// Returns the share of captured harmonics in a step: 0 in a run, in a step that ends standing, backwards and to the side.
    fn people_s(&self, timing: &StepTiming, course: Course) -> f32 {
        if timing.take_off.is_some() || timing.airborne || timing.rests {
            return 0.0;
        }
        let unsteady =
            course.change.weight / UNSTEADY + course.displacement.way.length() / DISPLACED_M;
        PEOPLE_S * (1.0 - unsteady).max(0.0) * self.state.strafe.uprightness()
    }
}

/// Returns the turn of a harmonic of the step's frequency from a frame to the next, radians; `None` where the frames are too few to show it, as in the rest of a step that is
/// planned anew.
fn turn_in_frame(harmonic: usize, frames: usize) -> Option<f32> {
    (2 * harmonic < frames).then(|| TAU * harmonic as f32 / frames as f32)
}

/// One harmonic of the travel.
#[derive(Clone, Copy, Default)]
struct Wave {
    /// The turn from a frame to the next, as a unit vector.
    turn: Vec2,
    /// Amplitudes of cosine and sine, metres.
    amplitude: Vec2,
}

impl Wave {
    /// Its speed in the first frame, metres a frame.
    fn first_speed(&self) -> f32 {
        self.amplitude.y * self.turn.to_angle()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    #[test]
    fn harmonics_turn_by_less_than_half_a_turn_in_a_frame_or_are_left_out() {
        for harmonic in 1..=MOST.len() {
            for frames in 1..60 {
                let shown = turn_in_frame(harmonic, frames);
                assert_eq!(shown.is_some(), frames > 2 * harmonic);
                // Beyond half a turn an angle is taken for one in the other direction, and a limit on the amplitude turns negative.
                assert!(shown.is_none_or(|turn| turn > 0.0 && turn < PI), "{frames}");
            }
        }
    }
}
