//! The camera.

use eframe::egui::{Pos2, Rect};
use glam::Vec3;

/// Nearest depth that is painted, metres.
pub(crate) const NEAR_M: f32 = 0.15;

/// Height of the picture over its distance: a lens of about 40°.
const FOCAL: f32 = 1.4;

/// A camera that looks at a point from around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Orbit {
    /// Angle about the vertical, radians: 0 looks into the face of a body at zero heading.
    pub(crate) yaw: f32,
    /// Angle above the horizon, radians.
    pub(crate) pitch: f32,
    /// Metres.
    pub(crate) distance: f32,
    /// Point that it looks at.
    pub(crate) target: Vec3,
}

impl Default for Orbit {
    fn default() -> Self {
        Self {
            yaw: -0.9,
            pitch: 0.22,
            distance: 3.7,
            target: Vec3::new(0.0, 0.9, 0.0),
        }
    }
}

impl Orbit {
    /// Turns it by a drag of the pointer, points.
    pub(crate) fn turn(&mut self, x: f32, y: f32) {
        self.yaw -= 0.008 * x;
        self.pitch = (self.pitch + 0.008 * y).clamp(-0.2, 1.5);
    }

    /// Comes nearer (above 1) or goes away.
    pub(crate) fn zoom(&mut self, factor: f32) {
        self.distance = (self.distance / factor.max(1e-3)).clamp(0.8, 40.0);
    }

    /// Returns the projection into a rectangle of the window.
    pub(crate) fn projection(&self, rect: Rect) -> Projection {
        let level = Vec3::new(self.yaw.sin(), 0.0, self.yaw.cos());
        let away = level * self.pitch.cos() + Vec3::Y * self.pitch.sin();
        let forward = -away;
        let right = forward.cross(Vec3::Y).normalize_or(Vec3::X);
        Projection {
            eye: self.target + away * self.distance,
            right,
            up: right.cross(forward),
            forward,
            focal: FOCAL * rect.height(),
            centre: rect.center(),
        }
    }
}

/// World to window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    pub(crate) eye: Vec3,
    right: Vec3,
    up: Vec3,
    pub(crate) forward: Vec3,
    focal: f32,
    centre: Pos2,
}

impl Projection {
    /// Place in the window and depth; what lies behind the camera is put at its nearest plane.
    pub(crate) fn project(&self, point: Vec3) -> (Pos2, f32) {
        let offset = point - self.eye;
        let depth = offset.dot(self.forward);
        let scale = self.focal / depth.max(NEAR_M);
        let x = self.centre.x + offset.dot(self.right) * scale;
        let y = self.centre.y - offset.dot(self.up) * scale;
        (Pos2::new(x, y), depth)
    }

    /// A line clipped at the nearest plane; `None` when all of it is behind.
    pub(crate) fn line(&self, ends: [Vec3; 2]) -> Option<[Pos2; 2]> {
        let depth = ends.map(|end| (end - self.eye).dot(self.forward));
        if depth[0] < NEAR_M && depth[1] < NEAR_M {
            return None;
        }
        let clipped = |from: usize, to: usize| {
            if depth[from] >= NEAR_M {
                return ends[from];
            }
            let share = (NEAR_M - depth[from]) / (depth[to] - depth[from]);
            ends[from].lerp(ends[to], share)
        };
        Some([self.project(clipped(0, 1)).0, self.project(clipped(1, 0)).0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{pos2, vec2};

    #[test]
    fn what_is_looked_at_falls_in_the_middle_and_up_is_up() {
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(400.0, 300.0));
        let orbit = Orbit::default();
        let projection = orbit.projection(rect);
        let (middle, depth) = projection.project(orbit.target);
        assert!(middle.distance(rect.center()) < 1e-3);
        assert!((depth - orbit.distance).abs() < 1e-4);
        let (above, _) = projection.project(orbit.target + Vec3::Y * 0.5);
        assert!(above.y < middle.y - 10.0 && (above.x - middle.x).abs() < 1e-2);
    }

    #[test]
    fn a_body_that_faces_the_camera_has_its_left_on_the_right() {
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 300.0));
        let orbit = Orbit {
            yaw: 0.0,
            ..Orbit::default()
        };
        // A character faces +Z and its left is +X.
        let left = orbit.projection(rect).project(orbit.target + Vec3::X).0;
        assert!(left.x > rect.center().x);
    }

    #[test]
    fn a_line_through_the_eye_is_cut() {
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 300.0));
        let orbit = Orbit::default();
        let projection = orbit.projection(rect);
        let behind = projection.eye - projection.forward * 3.0;
        assert!(projection.line([behind, orbit.target]).is_some());
        assert!(projection.line([behind, behind + Vec3::X]).is_none());
    }
}
