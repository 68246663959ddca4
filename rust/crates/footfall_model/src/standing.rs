//! Standing as people stand: a posture, and how it lives.
//!
//! Motion is a sum of seeded noises of octaves (Perlin 1985), each a stationary Gaussian process with a covariance of its own, of looks that jump
//! and hold, and of breathing. Everything is an offset of the posture: a rotation of each joint after its own, and the hips' way over feet that stay.

use crate::check::{ModelError, check_finite, check_len, check_positive};
use crate::layout::{FEATURE_COUNT, feature_offset, mirror};
use footfall_core::rotation::{exp_map, log_map};
use footfall_core::{Joint, Side};
use glam::{Quat, Vec3};

/// Numbers of an offset: a rotation vector for each joint, in the joint's own frame, in the order of the [features](crate::layout); then the
/// hips' way to the left and forwards, in leg lengths. Legs are 0: they follow from the feet.
pub const SWAY_COUNT: usize = FEATURE_COUNT + 2;

/// Octaves of a model at most.
pub const MAX_SWAY_OCTAVES: usize = 8;

/// Directions of an octave at most.
pub const MAX_SWAY_DIRECTIONS: usize = 8;

/// Directions in which people look: to the side, and up or down.
pub const LOOK_DIRECTIONS: usize = 2;

/// Standing.
#[derive(Clone, Debug, PartialEq)]
pub struct StandingModel {
    /// Features ([`FEATURE_COUNT`]) of the upright posture, the same left and right, with ankles straight below the hip joints.
    pub posture: Vec<f64>,
    /// Distance of the hips of a person who stands at ease ahead of that, leg lengths.
    pub hips_ahead: f64,
    /// Weight on one leg for long. All people have as much of it.
    pub stance: SwayOctave,
    /// Sway and shifts of weight, slowest first.
    pub octaves: Vec<SwayOctave>,
    /// Their looks.
    pub looks: Looks,
    /// Breathing.
    pub breath: Breath,
    /// Standard deviation, between people, of the logarithm of how far they sway and look about.
    pub strength_spread: f64,
}

/// Noise with one correlation time.
#[derive(Clone, Debug, PartialEq)]
pub struct SwayOctave {
    /// Time between the knots of its curves, seconds: cubic B-splines with independent normal weights.
    pub knot_secs: f64,
    /// Directions of [`SWAY_COUNT`] numbers, each as long as the standard deviation along it.
    pub directions: Vec<Vec<f64>>,
}

/// Looks about: the gaze jumps to a place and stays there.
#[derive(Clone, Debug, PartialEq)]
pub struct Looks {
    /// Jumps a second; 0 for never.
    pub rate_hz: f64,
    /// Duration of a jump.
    pub shift_secs: f64,
    /// Motion of the body with a look to the side and with one down ([`SWAY_COUNT`] numbers each), by the standard deviation of where
    /// it rests.
    pub directions: Vec<Vec<f64>>,
}

/// Quiet breathing.
#[derive(Clone, Debug, PartialEq)]
pub struct Breath {
    /// Breaths a second.
    pub rate_hz: f64,
    /// Motion of the body from the middle of a breath to its top ([`SWAY_COUNT`] numbers).
    pub direction: Vec<f64>,
}

impl StandingModel {
    /// Checks every shape and value.
    pub(crate) fn check(&self) -> Result<(), ModelError> {
        check_len("standing posture", &self.posture, FEATURE_COUNT)?;
        check_finite("standing posture", &self.posture)?;
        check_finite("standing posture", &[self.hips_ahead])?;
        check_count("octaves of standing", self.octaves.len(), MAX_SWAY_OCTAVES)?;
        for octave in self.octaves.iter().chain([&self.stance]) {
            check_positive("octave of standing", &[octave.knot_secs])?;
            check_count(
                "directions of standing",
                octave.directions.len(),
                MAX_SWAY_DIRECTIONS,
            )?;
        }
        let looks = &self.looks;
        if looks.directions.len() != LOOK_DIRECTIONS {
            return Err(shape("looks", LOOK_DIRECTIONS, looks.directions.len()));
        }
        check_positive("looks", &[looks.shift_secs, 1.0 + looks.rate_hz])?;
        check_positive("breath", &[self.breath.rate_hz])?;
        check_finite("spread of standing", &[self.strength_spread])?;
        let octaves = self.octaves.iter().chain([&self.stance]);
        let octaves = octaves.flat_map(|octave| &octave.directions);
        let all = octaves.chain(&looks.directions);
        for direction in all.chain([&self.breath.direction]) {
            check_len("direction of standing", direction, SWAY_COUNT)?;
            check_finite("direction of standing", direction)?;
        }
        Ok(())
    }

    /// Takes over what a walk changes in the posture of another: both are features, means over whole strides. Legs go on standing as
    /// they do.
    pub(crate) fn restyle(&mut self, base: &[f64], styled: &[f64]) {
        let mut change: Vec<f64> = styled
            .iter()
            .zip(base)
            .map(|(to, from)| to - from)
            .collect();
        let mut mirrored = change.clone();
        mirror(&mut mirrored);
        for (change, mirrored) in change.iter_mut().zip(mirrored) {
            *change = 0.5 * (*change + mirrored);
        }
        let hips_before = self.rotation(Joint::Hips);
        for joint in Joint::ALL
            .into_iter()
            .filter(|joint| *joint < Joint::LeftUpperLeg)
        {
            let offset = feature_offset(joint);
            let values = self.posture[offset..].iter_mut().zip(&change[offset..]);
            for (value, change) in values.take(3) {
                *value += change;
            }
        }
        let turned = self.rotation(Joint::Hips).inverse() * hips_before;
        for side in Side::BOTH {
            let thigh = turned * self.rotation(side.upper_leg());
            let vector = log_map(thigh).as_dvec3().to_array();
            self.posture[feature_offset(side.upper_leg())..][..3].copy_from_slice(&vector);
        }
    }

    fn rotation(&self, joint: Joint) -> Quat {
        let vector = &self.posture[feature_offset(joint)..];
        exp_map(Vec3::new(
            vector[0] as f32,
            vector[1] as f32,
            vector[2] as f32,
        ))
    }
}

fn check_count(part: &str, found: usize, most: usize) -> Result<(), ModelError> {
    if found > most {
        return Err(shape(part, most, found));
    }
    Ok(())
}

fn shape(part: &str, expected: usize, found: usize) -> ModelError {
    ModelError::Shape {
        part: part.to_owned(),
        expected,
        found,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn upright() -> StandingModel {
        let mut posture = vec![0.0; FEATURE_COUNT];
        posture[feature_offset(Joint::Hips)] = 0.1;
        posture[feature_offset(Joint::LeftUpperLeg)] = -0.15;
        posture[feature_offset(Joint::RightUpperLeg)] = -0.15;
        StandingModel {
            posture,
            hips_ahead: 0.05,
            stance: SwayOctave {
                knot_secs: 24.0,
                directions: Vec::new(),
            },
            octaves: Vec::new(),
            looks: Looks {
                rate_hz: 0.1,
                shift_secs: 1.0,
                directions: vec![vec![0.0; SWAY_COUNT]; LOOK_DIRECTIONS],
            },
            breath: Breath {
                rate_hz: 0.25,
                direction: vec![0.0; SWAY_COUNT],
            },
            strength_spread: 0.3,
        }
    }

    #[test]
    fn a_style_changes_the_posture_and_legs_stand_as_before() {
        let mut standing = upright();
        let thigh = |s: &StandingModel| s.rotation(Joint::Hips) * s.rotation(Joint::LeftUpperLeg);
        let before = thigh(&standing);
        let base = vec![0.0; FEATURE_COUNT];
        let mut styled = base.clone();
        // A walk that bows and holds one arm out: arms change alike, by half of it.
        styled[feature_offset(Joint::Hips)] = 0.3;
        styled[feature_offset(Joint::Chest)] = 0.2;
        styled[feature_offset(Joint::LeftUpperArm) + 2] = 0.4;
        styled[feature_offset(Joint::LeftLowerLeg)] = 0.5;
        standing.restyle(&base, &styled);
        assert!((standing.posture[feature_offset(Joint::Chest)] - 0.2).abs() < 1e-12);
        assert!((standing.posture[feature_offset(Joint::LeftUpperArm) + 2] - 0.2).abs() < 1e-12);
        assert!((standing.posture[feature_offset(Joint::RightUpperArm) + 2] + 0.2).abs() < 1e-12);
        assert!(standing.posture[feature_offset(Joint::LeftLowerLeg)].abs() < 1e-12);
        assert!(thigh(&standing).angle_between(before) < 1e-3);
    }

    #[test]
    fn what_has_another_shape_is_refused() {
        let refused = |change: &dyn Fn(&mut StandingModel)| {
            let mut standing = upright();
            change(&mut standing);
            standing.check().unwrap_err().to_string()
        };
        assert!(upright().check().is_ok());
        assert!(refused(&|s| s.posture.truncate(3)).contains("standing posture"));
        assert!(refused(&|s| s.looks.directions.clear()).contains("looks"));
        assert!(refused(&|s| s.breath.direction[0] = f64::NAN).contains("direction"));
        assert!(refused(&|s| s.breath.rate_hz = 0.0).contains("breath"));
        let octave = SwayOctave {
            knot_secs: 0.0,
            directions: Vec::new(),
        };
        assert!(refused(&|s| s.octaves.push(octave.clone())).contains("octave"));
    }
}
