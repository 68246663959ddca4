//! Decay of the offset between two motions, from its initial speed.

use glam::Vec3;

/// An offset with a velocity that decays to zero.
///
/// A quintic polynomial: place and velocity are continuous at the beginning, place, velocity and acceleration at the end, and the
/// acceleration at the beginning is that of the new motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Fading {
    offset: Vec3,
    /// Change of the offset per second.
    velocity: Vec3,
    secs: f32,
    age_secs: f32,
}

impl Fading {
    pub(super) const fn new(offset: Vec3, velocity: Vec3, secs: f32) -> Self {
        Self {
            offset,
            velocity,
            secs,
            age_secs: 0.0,
        }
    }

    pub(super) fn advance(&mut self, dt_secs: f32) {
        self.age_secs = (self.age_secs + dt_secs).min(self.secs);
    }

    /// Share of its time that has passed, 0 to 1.
    pub(super) fn share(&self) -> f32 {
        if self.secs > 0.0 {
            self.age_secs / self.secs
        } else {
            1.0
        }
    }

    pub(super) fn is_over(&self) -> bool {
        self.age_secs >= self.secs
    }

    /// The current offset.
    pub(super) fn left(&self) -> Vec3 {
        let s = self.share();
        if s >= 1.0 {
            return Vec3::ZERO;
        }
        let s3 = s * s * s;
        let of_offset = 1.0 + s3 * (-10.0 + s * (15.0 - 6.0 * s));
        let of_velocity = s + s3 * (-6.0 + s * (8.0 - 3.0 * s));
        self.offset * of_offset + self.velocity * (self.secs * of_velocity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_begins_as_it_was_and_ends_at_rest() {
        const STEP: f32 = 1e-3;
        let (offset, velocity) = (Vec3::new(0.2, -0.1, 0.05), Vec3::new(-1.0, 0.5, 2.0));
        let mut fading = Fading::new(offset, velocity, 0.4);
        assert_eq!(fading.left(), offset);
        fading.advance(STEP);
        assert!(((fading.left() - offset) / STEP).distance(velocity) < 0.01);
        let mut before = fading.left();
        while !fading.is_over() {
            before = fading.left();
            fading.advance(STEP);
        }
        assert!(before.length() / STEP < 0.01, "it comes to rest: {before}");
        assert_eq!(fading.left(), Vec3::ZERO);
    }

    #[test]
    fn without_time_nothing_is_left() {
        assert_eq!(Fading::new(Vec3::X, Vec3::Y, 0.0).left(), Vec3::ZERO);
    }
}
