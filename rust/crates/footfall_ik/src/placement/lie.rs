//! Lie of a sole on the ground in one place.

use crate::placement::foothold::{FLAT_M, Search};
use crate::placement::frame::Frame;
use crate::placement::terrain::{SupportId, Terrain};
use crate::rocker::RockerFoot;
use glam::{Quat, Vec3};

/// Distance by which the search reaches beyond heel and toes: a sole whose very edge is over the edge of a step stands badly.
const MARGIN_M: f32 = 0.005;

/// Clearance of heel and toes from higher ground, if possible, metres: the foot comes from above.
const CLEAR_M: f32 = 0.05;
/// Ground that is higher by less is stepped over.
const HIGHER_M: f32 = 0.03;

/// Greatest angle by which a sole follows heel and toes rather than the ground under its ball, radians.
const MAX_BRIDGE: f32 = 0.3;

/// Height above a sole, metres, from which on ground beside it is a wall.
const WALL_M: f32 = 0.25;

/// A sole on the ground.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lie {
    /// In the world.
    pub(crate) sole: Frame,
    pub(super) support: SupportId,
    /// Distance from the ground to its farthest point, and to its ball with the nearer end, metres.
    pub(super) gap: f32,
    pub(super) borne_gap: f32,
    pub(super) heel_hangs: bool,
    /// Largest height of the ground beside it above the sole, metres, and the number of points of its rim without ground.
    pub(super) rim_cut: f32,
    pub(super) rim_hangs: usize,
}

impl Lie {
    /// Returns true when it lies on the ground in its whole breadth.
    pub(super) fn rim_rests(&self) -> bool {
        self.rim_cut <= FLAT_M && self.rim_hangs == 0
    }
}

impl Search {
    /// Looks at the ground under the rim of a sole, and raises it onto what would cut into it. Returns false, with the sole where it was, as soon
    /// as it is `too_dear`.
    pub(super) fn widen(
        &self,
        terrain: &mut impl Terrain,
        lie: &mut Lie,
        foot: &RockerFoot,
        too_dear: impl Fn(&Lie) -> bool,
    ) -> bool {
        let mut raise = 0.0_f32;
        for point in foot.sole_rim().as_flattened() {
            let ground = self.cast(terrain, lie.sole.point(*point));
            let height = ground.map_or(-self.below_m, |ground| {
                lie.sole.local_point(ground.position).y
            });
            lie.rim_cut = lie.rim_cut.max(height);
            lie.rim_hangs += usize::from(height < -FLAT_M);
            if height < WALL_M {
                raise = raise.max(height);
            }
            if too_dear(lie) {
                return false;
            }
        }
        if raise > FLAT_M {
            lie.sole.position += lie.sole.up() * raise;
            lie.gap += raise;
            lie.borne_gap += raise;
        }
        true
    }

    /// Returns true when higher ground stands close behind the heel or before the toes of a sole.
    pub(super) fn is_tight(
        &self,
        terrain: &mut impl Terrain,
        sole: &Frame,
        foot: &RockerFoot,
    ) -> bool {
        let [heel, _, tip] = foot.sole_points();
        [heel - Vec3::Z * CLEAR_M, tip + Vec3::Z * CLEAR_M]
            .into_iter()
            .any(|point| {
                let ground = self.cast(terrain, sole.point(point));
                ground.is_some_and(|ground| sole.local_point(ground.position).y > HIGHER_M)
            })
    }

    /// A sole laid on the ground here.
    pub(super) fn lay(
        &self,
        terrain: &mut impl Terrain,
        flat: &Frame,
        foot: &RockerFoot,
    ) -> Option<Lie> {
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
                rim_cut: 0.0,
                rim_hangs: 0,
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
