//! Size on screen: pixels that a metre takes at a place in view of the current camera.

use godot::classes::{Node3D, Viewport};
use godot::prelude::*;

/// Distance from the camera at which sizes are taken at least, metres.
const NEAREST_M: f32 = 0.05;

/// Pixels of the node's viewport that a metre takes at a place, in global space, or `None` without a camera.
///
/// The place need not be in view: what matters is its distance from the camera.
pub(crate) fn pixels_per_metre(node: &Gd<Node3D>, place: Vector3) -> Option<f32> {
    let viewport = node.get_viewport()?;
    let camera = viewport.get_camera_3d()?;
    let projection = camera.get_camera_projection();
    // A perspective divides by the depth, an orthogonal view by one.
    let divides = projection.cols[3].w == 0.0;
    let depth = if divides {
        camera
            .get_global_position()
            .distance_to(place)
            .max(NEAREST_M)
    } else {
        1.0
    };
    Some(0.5 * height(&viewport) * projection.cols[1].y.abs() / depth)
}

fn height(viewport: &Gd<Viewport>) -> f32 {
    viewport.get_visible_rect().size.y
}
