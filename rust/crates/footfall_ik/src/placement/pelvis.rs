//! How high the pelvis is carried over uneven ground.

use glam::Vec3;

/// A critically damped follower of a height.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Follower {
    pub(crate) value: f32,
    velocity: f32,
}

impl Follower {
    /// Comes closer to `target` for a time; `half_life_secs` is how long half of the way takes, about.
    pub(crate) fn follow(&mut self, target: f32, half_life_secs: f32, dt_secs: f32) {
        // A critically damped spring passes half of the way after 1.68 / omega.
        let omega = 1.68 / half_life_secs.max(1e-3);
        let offset = self.value - target;
        let momentum = self.velocity + omega * offset;
        let decay = (-omega * dt_secs).exp();
        self.value = target + (offset + momentum * dt_secs) * decay;
        self.velocity = (self.velocity - omega * momentum * dt_secs) * decay;
    }

    /// Is at `value` at once, at rest.
    pub(crate) fn jump(&mut self, value: f32) {
        *self = Self {
            value,
            velocity: 0.0,
        };
    }

    /// Is no higher than `limit`.
    pub(crate) fn hold_below(&mut self, limit: f32) {
        if self.value > limit {
            self.value = limit;
            self.velocity = self.velocity.min(0.0);
        }
    }
}

/// Height of a plane under a place, for planes that are not upright.
pub(crate) fn plane_height(on_plane: Vec3, normal: Vec3, place: Vec3) -> f32 {
    let run = Vec3::new(place.x - on_plane.x, 0.0, place.z - on_plane.z).clamp_length_max(0.6);
    on_plane.y - normal.dot(run) / normal.y.max(0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_follower_arrives_without_overshooting() {
        let mut follower = Follower::default();
        let mut before = 0.0;
        for frame in 0..120 {
            follower.follow(1.0, 0.1, 1.0 / 60.0);
            assert!(follower.value >= before && follower.value <= 1.0);
            before = follower.value;
            if frame == 5 {
                assert!((follower.value - 0.5).abs() < 0.02, "{}", follower.value);
            }
        }
        assert!(follower.value > 0.999);
    }

    #[test]
    fn a_plane_is_followed_up_and_down() {
        let normal = Vec3::new(0.0, 1.0, -0.5).normalize();
        let ahead = plane_height(Vec3::Y, normal, Vec3::Z * 0.5);
        assert!((ahead - 1.25).abs() < 1e-6);
    }
}
