//! Walkers who are so small on screen that a stand-in shows them.

use crate::convert;
use crate::screen_size::ScreenScale;
use footfall_rig::crowd::{Crowd, Eyesight};
use godot::classes::{Camera3D, Node3D};
use godot::prelude::*;
use rayon::prelude::*;

/// Rows that one thread looks through at a time.
const ROWS: usize = 4096;

/// Flags of small walkers.
#[derive(Default)]
pub(super) struct Sizes {
    small: Vec<bool>,
}

impl Sizes {
    /// Chooses the small walkers anew; without a view there are none.
    pub(super) fn look(&mut self, walkers: &Crowd, view: Option<&Eyesight>) {
        let drawn = walkers.drawn();
        self.small.resize(drawn.len(), false);
        let Some(view) = view else {
            self.small.fill(false);
            return;
        };
        let small = self.small.par_chunks_mut(ROWS);
        small
            .zip(drawn.par_chunks(ROWS))
            .for_each(|(small, drawn)| {
                for (small, drawn) in small.iter_mut().zip(drawn) {
                    *small = view.is_small(drawn.places[1], drawn.size, *small);
                }
            });
    }

    /// For each row, whether a stand-in shows it.
    pub(super) fn small(&self) -> &[bool] {
        &self.small
    }
}

/// View of a camera on a crowd whose character has this height; `None` if stand-ins are off.
pub(super) fn eyesight(
    camera: &Gd<Camera3D>,
    host: &Gd<Node3D>,
    height_m: f32,
    smallest_px: f32,
) -> Option<Eyesight> {
    let scale = ScreenScale::of(camera).filter(|_| smallest_px > 0.0)?;
    Some(Eyesight {
        place: convert::vec3(host.to_local(camera.get_global_position())),
        metre_px: scale.metre_px,
        is_parallel: scale.is_parallel,
        height_m,
        smallest_px,
    })
}
