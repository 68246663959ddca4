//! Where on the ground a sole can lie.

use crate::placement::frame::Frame;
use crate::placement::terrain::{Ground, SupportId, Terrain};
use crate::rocker::RockerFoot;
use glam::{Quat, Vec3};

/// A flat sole is on the ground as long as none of its points is farther from it than this, metres.
const FLAT_M: f32 = 0.008;

/// What is looked at reaches so much beyond heel and toes: a sole whose very edge is over the edge of a step stands badly.
const MARGIN_M: f32 = 0.005;

/// Heel and toes keep so far from ground that is higher, where they can, metres: the foot comes from above.
const CLEAR_M: f32 = 0.05;
/// Ground that is higher by less is stepped over.
const HIGHER_M: f32 = 0.03;

/// A sole follows heel and toes rather than the ground under its ball by so much at most, radians.
const MAX_BRIDGE: f32 = 0.3;

/// A foot that would stand across an edge is put so much farther ahead or back, in the order of trial, metres.
const SHIFTS_M: [f32; 17] = [
    0.0, 0.02, -0.02, 0.04, -0.04, 0.06, -0.06, 0.08, -0.08, 0.1, -0.1, 0.12, -0.12, 0.14, -0.14,
    0.16, -0.16,
];

/// A place for a sole, on something that may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Foothold {
    /// Whether the heel sticks out over an edge.
    pub(crate) heel_hangs: bool,
    support: SupportId,
    support_from_sole: Frame,
}

impl Foothold {
    /// Where the sole is in the world now: the origin lies on the ground under the ankle of a flat foot, +Y is the ground's normal
    /// and +Z points to the toes. `None` when what it stands on is gone.
    pub(crate) fn world_from_sole(&self, terrain: &mut impl Terrain) -> Option<Frame> {
        let support = terrain.support(self.support)?;
        Some(support.child(&self.support_from_sole))
    }

    /// What it stands on.
    pub(crate) fn support(&self) -> SupportId {
        self.support
    }
}

/// What a place costs: a metre of shift, higher ground close by, and a heel or toes that stick out over an edge. A sole that is borne
/// by less costs more than any of them.
pub(crate) const SHIFT_COST: f32 = 1.0;
const TIGHT_COST: f32 = 0.08;
const OVERHANG_COST: f32 = 0.3;

/// A sole on the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lie {
    /// In the world.
    pub(crate) sole: Frame,
    support: SupportId,
    /// How far from the ground its farthest point is, and its ball with the nearer end, metres.
    gap: f32,
    borne_gap: f32,
    heel_hangs: bool,
}

impl Lie {
    pub(crate) fn foothold(&self, terrain: &mut impl Terrain) -> Option<Foothold> {
        Some(Foothold {
            heel_hangs: self.heel_hangs,
            support: self.support,
            support_from_sole: terrain.support(self.support)?.local(&self.sole),
        })
    }
}

/// What limits a foothold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search {
    /// The direction against gravity, of the world.
    pub(crate) up: Vec3,
    /// How far above the animation's floor ground is looked for, and how far below it, metres.
    pub(crate) above_m: f32,
    pub(crate) below_m: f32,
    /// A sole is tilted by this much at most, radians.
    pub(crate) max_tilt: f32,
    /// Whether the sole may move ahead or back, out of the way of an edge.
    pub(crate) may_shift: bool,
}

impl Search {
    /// The ground above or below a point.
    pub(crate) fn cast(&self, terrain: &mut impl Terrain, at: Vec3) -> Option<Ground> {
        let way = self.up * (self.above_m + self.below_m);
        terrain.cast(at + self.up * self.above_m, -way)
    }

    /// The best place for a sole that the animation puts at `world_from_flat`; `None` where there is no ground.
    pub(crate) fn find(
        &self,
        terrain: &mut impl Terrain,
        world_from_flat: &Frame,
        foot: &RockerFoot,
    ) -> Option<Foothold> {
        let forward = world_from_flat.forward();
        let shifts = if self.may_shift {
            &SHIFTS_M[..]
        } else {
            &SHIFTS_M[..1]
        };
        let mut best: Option<(f32, Lie)> = None;
        for shift in shifts {
            // No farther one is better.
            if best.is_some_and(|(least, ..)| least <= SHIFT_COST * shift.abs()) {
                break;
            }
            let flat = Frame {
                position: world_from_flat.position + forward * *shift,
                ..*world_from_flat
            };
            let Some((lie, cost)) = self.judge(terrain, &flat, foot) else {
                continue;
            };
            let cost = cost + SHIFT_COST * shift.abs();
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, lie));
            }
        }
        best?.1.foothold(terrain)
    }

    /// How a sole lies in this place and what that costs, beyond the way to it; `None` where there is no ground.
    pub(crate) fn judge(
        &self,
        terrain: &mut impl Terrain,
        flat: &Frame,
        foot: &RockerFoot,
    ) -> Option<(Lie, f32)> {
        let lie = self.lay(terrain, flat, foot)?;
        let cost = if lie.borne_gap > FLAT_M {
            1.0 + lie.gap
        } else if lie.gap > FLAT_M {
            OVERHANG_COST
        } else if self.is_tight(terrain, &lie.sole, foot) {
            TIGHT_COST
        } else {
            0.0
        };
        Some((lie, cost))
    }

    /// Whether higher ground stands close behind the heel or before the toes of a sole.
    fn is_tight(&self, terrain: &mut impl Terrain, sole: &Frame, foot: &RockerFoot) -> bool {
        let [heel, _, tip] = foot.sole_points();
        [heel - Vec3::Z * CLEAR_M, tip + Vec3::Z * CLEAR_M]
            .into_iter()
            .any(|point| {
                let ground = self.cast(terrain, sole.point(point));
                ground.is_some_and(|ground| sole.local_point(ground.position).y > HIGHER_M)
            })
    }

    /// A sole laid on the ground here.
    fn lay(&self, terrain: &mut impl Terrain, flat: &Frame, foot: &RockerFoot) -> Option<Lie> {
        let [heel, ball, tip] = foot.sole_points();
        let margin = Vec3::Z * MARGIN_M;
        let [heel, ball, tip] =
            [heel - margin, ball, tip + margin].map(|point| self.cast(terrain, flat.point(point)));
        let ball = ball.or(heel).or(tip)?;
        let across = ball.normal;
        let along_ground = match (heel, tip) {
            (Some(heel), Some(tip)) => (tip.position - heel.position).normalize_or(flat.forward()),
            _ => flat.forward(),
        };
        let on_plane = |normal: Vec3| {
            let normal = self.limited(normal);
            let rotation = laid(normal, flat.forward());
            // The plane goes through the highest point of the ground under the sole.
            let rise = [heel, Some(ball), tip]
                .into_iter()
                .flatten()
                .map(|ground| (ground.position - ball.position).dot(normal))
                .fold(f32::NEG_INFINITY, f32::max);
            let [heel_gap, ball_gap, tip_gap] = [heel, Some(ball), tip].map(|ground| {
                ground.map_or(self.above_m, |ground| {
                    rise - (ground.position - ball.position).dot(normal)
                })
            });
            let on_plane = ball.position + normal * rise - flat.position;
            let height = on_plane.dot(normal) / self.up.dot(normal);
            let sole = Frame {
                position: flat.position + self.up * height,
                rotation,
            };
            Lie {
                sole,
                support: ball.support,
                gap: heel_gap.max(ball_gap).max(tip_gap),
                borne_gap: ball_gap.max(heel_gap.min(tip_gap)),
                heel_hangs: heel_gap > FLAT_M,
            }
        };
        let by_normal = on_plane(across);
        // Over a crest or through a dip the line from heel to toes lies better than the normal under the ball.
        let by_line =
            on_plane((across - along_ground * across.dot(along_ground)).normalize_or(across));
        // Nor does a sole lie from edge to edge of a staircase.
        let bridges = by_line.sole.up().angle_between(self.limited(across)) > MAX_BRIDGE;
        Some(if bridges || by_normal.gap <= by_line.gap.max(FLAT_M) {
            by_normal
        } else {
            by_line
        })
    }

    /// A normal that is not tilted too far.
    fn limited(&self, normal: Vec3) -> Vec3 {
        let angle = self.up.angle_between(normal);
        if angle <= self.max_tilt {
            return normal;
        }
        let tilt = Quat::from_rotation_arc(self.up, normal);
        Quat::IDENTITY.slerp(tilt, self.max_tilt / angle) * self.up
    }
}

/// The axes of a sole on a plane with this normal, pointing as near to `forward` as the plane lets it.
fn laid(normal: Vec3, forward: Vec3) -> Quat {
    let along =
        (forward - normal * normal.dot(forward)).normalize_or(normal.any_orthonormal_vector());
    Quat::from_mat3(&glam::Mat3::from_cols(normal.cross(along), normal, along))
}
