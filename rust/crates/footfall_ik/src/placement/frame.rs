//! A place with axes.

use footfall_core::GroundTransform;
use footfall_core::rotation::from_heading;
use glam::{Quat, Vec3};

/// A place with axes, without scale: `parent_from_frame`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Position of its origin, metres.
    pub position: Vec3,
    /// Rotation of its axes.
    pub rotation: Quat,
}

impl Frame {
    /// The parent's own origin and axes.
    pub const IDENTITY: Self = Self {
        position: Vec3::ZERO,
        rotation: Quat::IDENTITY,
    };

    /// A point of this frame, in the parent.
    pub fn point(&self, point: Vec3) -> Vec3 {
        self.position + self.rotation * point
    }

    /// A frame inside this one, in the parent.
    #[must_use]
    pub fn child(&self, child: &Self) -> Self {
        Self {
            position: self.point(child.position),
            rotation: (self.rotation * child.rotation).normalize(),
        }
    }

    /// A frame of the parent, as it is seen from this one.
    #[must_use]
    pub fn local(&self, other: &Self) -> Self {
        let back = self.rotation.conjugate();
        Self {
            position: back * (other.position - self.position),
            rotation: (back * other.rotation).normalize(),
        }
    }

    /// A point of the parent, as it is seen from this frame.
    pub fn local_point(&self, point: Vec3) -> Vec3 {
        self.rotation.conjugate() * (point - self.position)
    }

    /// The third axis.
    pub fn forward(&self) -> Vec3 {
        self.rotation * Vec3::Z
    }

    /// The second axis.
    pub fn up(&self) -> Vec3 {
        self.rotation * Vec3::Y
    }
}

/// A place on level ground: upright axes that point where the heading does.
impl From<GroundTransform> for Frame {
    fn from(place: GroundTransform) -> Self {
        Self {
            position: place.position,
            rotation: from_heading(place.heading),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn local_undoes_child() {
        let frame = Frame {
            position: Vec3::new(1.0, 2.0, 3.0),
            rotation: Quat::from_rotation_y(0.7) * Quat::from_rotation_x(0.2),
        };
        let child = Frame {
            position: Vec3::new(-0.4, 0.5, 0.1),
            rotation: Quat::from_rotation_z(0.3),
        };
        let back = frame.local(&frame.child(&child));
        assert!(back.position.distance(child.position) < 1e-6);
        assert!(back.rotation.angle_between(child.rotation) < 1e-3);
        let point = frame.local_point(frame.point(child.position));
        assert!(point.distance(child.position) < 1e-6);
    }

    #[test]
    fn a_place_on_the_ground_stands_upright_and_points_where_it_heads() {
        let place = GroundTransform {
            position: Vec3::new(1.0, 0.2, -3.0),
            heading: 0.4,
        };
        let frame = Frame::from(place);
        assert_eq!(frame.position, place.position);
        // Positive headings are to the left, which is +X of a body that faces +Z.
        let forward = Vec3::new(0.4_f32.sin(), 0.0, 0.4_f32.cos());
        assert!(frame.forward().distance(forward) < 1e-6);
        assert!(frame.up().distance(Vec3::Y) < 1e-6);
    }
}
