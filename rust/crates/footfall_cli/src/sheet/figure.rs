//! A body as capsules, seen from any side.

use super::draw::palette::{INK, LEFT, PAPER, RIGHT, Rgb, TRUNK};
use super::draw::{Canvas, lighter};
use footfall_core::{ModelPose, Side, Skeleton};
use footfall_motion::figure::{Limb, Part, limbs, sole_points};
use glam::{Vec2, Vec3};

/// An orthographic camera: where world axes and metres go on the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct View {
    /// World direction that points right on the paper.
    pub(crate) right: Vec3,
    /// World direction that points out of the paper.
    pub(crate) towards: Vec3,
    /// Pixels of a metre.
    pub(crate) scale: f32,
    /// World point that falls on `anchor`.
    pub(crate) origin: Vec3,
    /// Pixels.
    pub(crate) anchor: Vec2,
}

impl View {
    /// From the character's right, so that it walks to the right of the paper.
    pub(crate) fn side(travel: Vec3, scale: f32, origin: Vec3, anchor: Vec2) -> Self {
        Self {
            right: travel,
            towards: travel.cross(Vec3::Y),
            scale,
            origin,
            anchor,
        }
    }

    /// Into the character's face.
    pub(crate) fn front(travel: Vec3, scale: f32, origin: Vec3, anchor: Vec2) -> Self {
        Self {
            right: Vec3::Y.cross(travel),
            towards: travel,
            scale,
            origin,
            anchor,
        }
    }

    /// Pixel that a world point falls on.
    pub(crate) fn project(&self, point: Vec3) -> Vec2 {
        let offset = point - self.origin;
        self.anchor + Vec2::new(offset.dot(self.right), -offset.y) * self.scale
    }
}

const fn color_of(side: Side) -> Rgb {
    match side {
        Side::Left => LEFT,
        Side::Right => RIGHT,
    }
}

fn color(part: Part) -> Rgb {
    match part {
        Part::Trunk => TRUNK,
        Part::Arm(side) => lighter(color_of(side), 0.25),
        Part::Leg(side) => color_of(side),
    }
}

/// Draws one pose.
pub(crate) fn draw_figure(canvas: &mut Canvas, skeleton: &Skeleton, pose: &ModelPose, view: &View) {
    let size = skeleton.mean_leg_length();
    let mut parts = limbs(skeleton, pose);
    let depth = |part: &Limb| (part.ends[0] + part.ends[1]).dot(view.towards);
    parts.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    for part in &parts {
        let ends = part.ends.map(|end| view.project(end));
        let radii = part.radii.map(|radius| (radius * view.scale).max(0.8));
        // A rim of paper keeps limbs that cross apart.
        canvas.limb(ends, radii.map(|radius| radius + 1.0), PAPER, 1.0);
        canvas.limb(ends, radii, color(part.part), 1.0);
    }
    for side in Side::BOTH {
        let points = sole_points(skeleton, pose, side).map(|point| view.project(point));
        canvas.line(&points, (0.012 * size * view.scale).max(1.2), INK);
    }
}
