//! A body as capsules, seen from any side.

use super::draw::palette::{INK, LEFT, PAPER, RIGHT, Rgb, TRUNK};
use super::draw::{Canvas, lighter};
use footfall_core::{Joint, ModelPose, Side, Skeleton};
use glam::{Vec2, Vec3};

/// Half-widths of the limbs on a body whose leg is one metre long, metres: proximal end, distal end.
const THIGH: [f32; 2] = [0.085, 0.055];
const SHANK: [f32; 2] = [0.055, 0.036];
const ARM: [f32; 2] = [0.048, 0.036];
const FOREARM: [f32; 2] = [0.036, 0.026];
const HAND: f32 = 0.036;
const FOOT: [f32; 2] = [0.034, 0.022];
const TRUNK_HALF_WIDTHS: [f32; 2] = [0.095, 0.115];

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

    /// Where a world point falls.
    pub(crate) fn project(&self, point: Vec3) -> Vec2 {
        let offset = point - self.origin;
        self.anchor + Vec2::new(offset.dot(self.right), -offset.y) * self.scale
    }
}

struct Part {
    ends: [Vec3; 2],
    radii: [f32; 2],
    color: Rgb,
}

/// Draws one pose.
pub(crate) fn draw_figure(canvas: &mut Canvas, skeleton: &Skeleton, pose: &ModelPose, view: &View) {
    let size = skeleton.mean_leg_length();
    let mut parts = body_parts(skeleton, pose, size);
    let depth = |part: &Part| (part.ends[0] + part.ends[1]).dot(view.towards);
    parts.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    for part in &parts {
        let ends = part.ends.map(|end| view.project(end));
        let radii = part
            .radii
            .map(|radius| (radius * size * view.scale).max(0.8));
        // A rim of paper keeps limbs that cross apart.
        canvas.limb(ends, radii.map(|radius| radius + 1.0), PAPER, 1.0);
        canvas.limb(ends, radii, part.color, 1.0);
    }
    for side in Side::BOTH {
        let points = sole_points(skeleton, pose, side).map(|point| view.project(point));
        canvas.line(&points, (0.012 * size * view.scale).max(1.2), INK);
    }
}

/// Heel, ball and toe tip of one foot in model space.
pub(crate) fn sole_points(skeleton: &Skeleton, pose: &ModelPose, side: Side) -> [Vec3; 3] {
    let foot = skeleton.foot(side);
    [
        pose.point(side.foot(), foot.heel),
        pose.point(side.toes(), foot.ball),
        pose.point(side.toes(), foot.toe_tip),
    ]
}

fn body_parts(skeleton: &Skeleton, pose: &ModelPose, size: f32) -> Vec<Part> {
    let at = |joint: Joint| pose.position(joint);
    let mut parts = Vec::with_capacity(24);
    let mut limb = |ends: [Vec3; 2], radii: [f32; 2], color: Rgb| {
        parts.push(Part { ends, radii, color });
    };
    let head_top = pose.point(Joint::Head, skeleton.head_top);
    let head_length = at(Joint::Head).distance(head_top);
    let head_radius = (0.55 * head_length / size).clamp(0.05, 0.16);
    let head_centre = at(Joint::Head).lerp(head_top, 0.5);
    let nose = head_centre + pose.rotation(Joint::Head) * Vec3::Z * (head_radius * size);
    let waist = at(Joint::Hips).lerp(at(Joint::Spine), 0.5);
    limb([waist, at(Joint::UpperChest)], TRUNK_HALF_WIDTHS, TRUNK);
    limb(
        [at(Joint::LeftUpperLeg), at(Joint::RightUpperLeg)],
        [0.08, 0.08],
        TRUNK,
    );
    limb(
        [at(Joint::LeftUpperArm), at(Joint::RightUpperArm)],
        [0.052, 0.052],
        TRUNK,
    );
    limb([at(Joint::Neck), at(Joint::Head)], [0.045, 0.045], TRUNK);
    limb([head_centre, nose], [head_radius, 0.022], TRUNK);
    for side in Side::BOTH {
        let (color, shoulder) = match side {
            Side::Left => (LEFT, Joint::LeftShoulder),
            Side::Right => (RIGHT, Joint::RightShoulder),
        };
        let arm = |n: usize| Joint::ALL[shoulder.index() + n];
        let soft = lighter(color, 0.25);
        limb([at(arm(1)), at(arm(2))], ARM, soft);
        limb([at(arm(2)), at(arm(3))], FOREARM, soft);
        // The hand has no joint beyond it: it goes on a little along the hand's own arm axis.
        let palm = at(arm(3)) + pose.rotation(arm(3)) * Vec3::X * (side.sign() * 0.08 * size);
        limb([at(arm(3)), palm], [0.8 * HAND, HAND], soft);
        limb([at(side.upper_leg()), at(side.lower_leg())], THIGH, color);
        limb([at(side.lower_leg()), at(side.foot())], SHANK, color);
        let raise = Vec3::Y * (FOOT[1] * size);
        let [heel, ball, tip] = sole_points(skeleton, pose, side);
        let foot_up = pose.rotation(side.foot()) * raise;
        let toes_up = pose.rotation(side.toes()) * raise;
        limb([at(side.foot()), heel + foot_up], FOOT, color);
        limb([at(side.foot()), ball + toes_up], FOOT, color);
        limb([heel + foot_up, ball + toes_up], [FOOT[1]; 2], color);
        limb([ball + toes_up, tip + toes_up], [FOOT[1]; 2], color);
    }
    parts
}
