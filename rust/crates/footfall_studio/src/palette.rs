//! Colours, the same as in contact sheets; colour-blind people can distinguish them.

use eframe::egui::Color32;
use footfall_core::Side;

pub(crate) const LEFT: Color32 = Color32::from_rgb(230, 110, 20);
pub(crate) const RIGHT: Color32 = Color32::from_rgb(20, 130, 200);
pub(crate) const PLAYHEAD: Color32 = Color32::from_rgb(240, 200, 60);
pub(crate) const BAD: Color32 = Color32::from_rgb(225, 85, 75);
pub(crate) const GOOD: Color32 = Color32::from_rgb(80, 175, 110);

/// x, y and z.
pub(crate) const AXES: [Color32; 3] = [
    Color32::from_rgb(220, 80, 70),
    Color32::from_rgb(110, 185, 80),
    Color32::from_rgb(80, 130, 230),
];

/// Lines of a plot, in order (Okabe and Ito).
pub(crate) const SERIES: [Color32; 8] = [
    Color32::from_rgb(230, 110, 20),
    Color32::from_rgb(20, 130, 200),
    Color32::from_rgb(0, 158, 115),
    Color32::from_rgb(204, 121, 167),
    Color32::from_rgb(240, 200, 60),
    Color32::from_rgb(86, 180, 233),
    Color32::from_rgb(160, 110, 220),
    Color32::from_rgb(150, 150, 150),
];

pub(crate) const fn side(side: Side) -> Color32 {
    match side {
        Side::Left => LEFT,
        Side::Right => RIGHT,
    }
}

pub(crate) const fn trunk(dark: bool) -> Color32 {
    if dark {
        Color32::from_rgb(176, 182, 194)
    } else {
        Color32::from_rgb(104, 110, 122)
    }
}

pub(crate) const fn backdrop(dark: bool) -> Color32 {
    if dark {
        Color32::from_rgb(24, 26, 31)
    } else {
        Color32::from_rgb(238, 240, 243)
    }
}

pub(crate) const fn grid(dark: bool) -> Color32 {
    if dark {
        Color32::from_rgb(58, 62, 72)
    } else {
        Color32::from_rgb(200, 204, 212)
    }
}
