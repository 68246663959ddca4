//! Sizes on screen of what a camera sees.

use godot::classes::Camera3D;
use godot::prelude::*;

/// Distance from the camera at which sizes are taken at least, metres.
const NEAREST_M: f32 = 0.05;

/// Scale of a camera's picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScreenScale {
    /// Height of a metre, pixels: at a distance of one metre, or at any distance where the view is parallel.
    pub(crate) metre_px: f32,
    /// True where nothing shrinks with the distance.
    pub(crate) is_parallel: bool,
}

impl ScreenScale {
    /// Scale of a camera's picture; `None` for a camera without a viewport.
    pub(crate) fn of(camera: &Gd<Camera3D>) -> Option<Self> {
        let viewport = camera.get_viewport()?;
        // Pixels of what is rendered: a window that stretches counts its size in units of the interface.
        let height_px =
            viewport.get_visible_rect().size.y * viewport.get_final_transform().b.length();
        let projection = camera.get_camera_projection();
        Some(Self {
            metre_px: 0.5 * height_px * projection.cols[1].y,
            is_parallel: projection.cols[3].w > 0.5,
        })
    }

    /// Height of a metre at a distance from the camera, pixels, in view or not.
    pub(crate) fn metre_at(self, distance_m: f32) -> f32 {
        if self.is_parallel {
            self.metre_px
        } else {
            self.metre_px / distance_m.max(NEAREST_M)
        }
    }
}
