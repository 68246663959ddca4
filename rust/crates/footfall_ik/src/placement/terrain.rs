//! Ground queries.

use crate::placement::frame::Frame;
use glam::Vec3;

/// Identity of one thing to stand on. 0 is the world itself, which never moves.
pub type SupportId = u64;

/// A point of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Position in the world, metres.
    pub position: Vec3,
    /// The unit normal of the ground there.
    pub normal: Vec3,
    /// Support that it belongs to.
    pub support: SupportId,
}

/// The ground of a scene, however it is found: by casting rays, from a height map, from a formula.
///
/// A closure that answers [`cast`](Self::cast) is ground on which nothing moves.
pub trait Terrain {
    /// The first ground on the way from `from` along `way`, both of the world in metres; `None` when there is none. Ground in which
    /// `from` itself lies is not met.
    fn cast(&mut self, from: Vec3, way: Vec3) -> Option<Ground>;

    /// Returns the place of a support in the world now: `world_from_support`. `None` when it is gone.
    fn support(&mut self, support: SupportId) -> Option<Frame>;
}

impl<F: FnMut(Vec3, Vec3) -> Option<Ground>> Terrain for F {
    fn cast(&mut self, from: Vec3, way: Vec3) -> Option<Ground> {
        self(from, way)
    }

    fn support(&mut self, _support: SupportId) -> Option<Frame> {
        Some(Frame::IDENTITY)
    }
}

/// Rise of ground with this normal along a way seen from above, metres; at most twice as far as that way goes.
pub(super) fn rise_along(normal: Vec3, way: Vec3) -> f32 {
    -(normal.x * way.x + normal.z * way.z) / normal.y.max(0.5)
}
