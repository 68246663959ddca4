//! Detail of a walk: chosen by the user, or by the character's size on screen.

use super::GaitGenerator3D;
use super::session::WalkSession;
use crate::screen_size::ScreenScale;
use footfall_synth::Detail;
use godot::prelude::*;

/// Share of a walk's frames that are computed.
#[derive(GodotConvert, Var, Export, Default, Clone, Copy, Debug)]
#[godot(via = i64)]
pub(crate) enum GaitDetail {
    #[default]
    Full = 0,
    Half = 1,
    Quarter = 2,
    Auto = 3,
}

/// Time between two looks at the screen, seconds. Steps, with which detail changes, take longer.
const LOOK_SECS: f64 = 0.25;

/// Height of a standing body over that of its hips.
const BODY_OVER_HIPS: f32 = 1.8;

/// Detail by size on screen.
#[derive(Debug, Default)]
pub(super) struct AutoDetail {
    chosen: Detail,
    /// Until the next look.
    wait_secs: f64,
}

impl GaitGenerator3D {
    /// Looks at the screen from time to time, and returns the detail of the next step.
    pub(super) fn choose_detail(&mut self, session: &WalkSession, delta_secs: f64) -> Detail {
        let auto = &mut self.auto_detail;
        auto.wait_secs -= delta_secs;
        if matches!(self.detail, GaitDetail::Auto) && auto.wait_secs <= 0.0 {
            auto.wait_secs = LOOK_SECS;
            let character = session.traveller.character();
            let metre = character
                .get_viewport()
                .and_then(|viewport| viewport.get_camera_3d())
                .and_then(|camera| {
                    let away = camera.get_global_position() - character.get_global_position();
                    Some(ScreenScale::of(&camera)?.metre_at(away.length()))
                });
            // Without a camera, as on a server, scripts may still read the poses.
            let pixels = metre.map_or(f32::INFINITY, |metre| {
                metre * BODY_OVER_HIPS * session.hip_height()
            });
            auto.chosen = auto.chosen.for_height(pixels);
        }
        match self.detail {
            GaitDetail::Full => Detail::Full,
            GaitDetail::Half => Detail::Half,
            GaitDetail::Quarter => Detail::Quarter,
            GaitDetail::Auto => self.auto_detail.chosen,
        }
    }

    /// The detail that is set, or the choice of Auto.
    pub(super) const fn current_detail(&self) -> GaitDetail {
        match (self.detail, self.auto_detail.chosen) {
            (GaitDetail::Auto, Detail::Full) => GaitDetail::Full,
            (GaitDetail::Auto, Detail::Half) => GaitDetail::Half,
            (GaitDetail::Auto, Detail::Quarter) => GaitDetail::Quarter,
            (detail, _) => detail,
        }
    }
}
