//! Anti-aliased shapes and text on one picture. Pixels, y down.

use ab_glyph::{Font as _, FontRef, GlyphId, PxScale, ScaleFont as _};
use anyhow::{Context as _, Result};
use glam::Vec2;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, StrokeDash,
    Transform,
};

/// Colours of the sheet; left and right stay apart for colour-blind readers too.
pub(crate) mod palette {
    /// Red, green, blue.
    pub(crate) type Rgb = [u8; 3];
    pub(crate) const PAPER: Rgb = [255, 255, 255];
    pub(crate) const INK: Rgb = [34, 38, 46];
    pub(crate) const GREY: Rgb = [112, 118, 128];
    pub(crate) const GRID: Rgb = [224, 227, 232];
    pub(crate) const SHADE: Rgb = [243, 245, 248];
    pub(crate) const FLOOR: Rgb = [168, 174, 184];
    pub(crate) const LEFT: Rgb = [213, 94, 0];
    pub(crate) const RIGHT: Rgb = [0, 114, 178];
    pub(crate) const TRUNK: Rgb = [70, 76, 88];
}
use palette::Rgb;

/// Alignment of text to its anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    /// Starts at the anchor.
    Left,
    /// Centred on the anchor.
    Centre,
    /// Ends at the anchor.
    Right,
}

/// A picture in the making.
pub(crate) struct Canvas {
    pixmap: Pixmap,
    font: FontRef<'static>,
}

impl Canvas {
    /// A white picture.
    pub(crate) fn new(width: u32, height: u32) -> Result<Self> {
        let mut pixmap = Pixmap::new(width, height)
            .with_context(|| format!("a picture of {width} x {height} pixels is too large; draw fewer clips or lower --width"))?;
        pixmap.fill(Color::WHITE);
        let font = FontRef::try_from_slice(epaint_default_fonts::HACK_REGULAR)
            .context("the embedded font does not load")?;
        Ok(Self { pixmap, font })
    }

    /// The picture as 8-bit RGB rows.
    pub(crate) fn into_rgb(self) -> (u32, u32, Vec<u8>) {
        let (width, height) = (self.pixmap.width(), self.pixmap.height());
        let rgb = self
            .pixmap
            .data()
            .chunks_exact(4)
            .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
            .collect();
        (width, height, rgb)
    }

    /// A filled rectangle from its corner and size.
    pub(crate) fn rectangle(&mut self, corner: Vec2, size: Vec2, color: Rgb) {
        if let Some(rect) = Rect::from_xywh(corner.x, corner.y, size.x.max(0.1), size.y.max(0.1)) {
            self.fill(&PathBuilder::from_rect(rect), color, 1.0);
        }
    }

    /// A disc.
    pub(crate) fn disc(&mut self, centre: Vec2, radius: f32, color: Rgb, opacity: f32) {
        if let Some(path) = PathBuilder::from_circle(centre.x, centre.y, radius) {
            self.fill(&path, color, opacity);
        }
    }

    /// A line through points.
    pub(crate) fn line(&mut self, points: &[Vec2], width: f32, color: Rgb) {
        self.stroke(points, width, color, None);
    }

    /// A broken line through points; `dash` is the length of a dash and of a gap.
    pub(crate) fn dashed(&mut self, points: &[Vec2], width: f32, color: Rgb, dash: f32) {
        self.stroke(points, width, color, StrokeDash::new(vec![dash, dash], 0.0));
    }

    /// A limb: two discs of different radius and their common hull.
    pub(crate) fn limb(&mut self, ends: [Vec2; 2], radii: [f32; 2], color: Rgb, opacity: f32) {
        let [a, b] = ends;
        let axis = b - a;
        let length = axis.length();
        let mut path = PathBuilder::new();
        if length > (radii[0] - radii[1]).abs() + 1e-3 {
            // The common tangents touch both discs at the same angle from the axis.
            let along = axis / length;
            let cosine = (radii[0] - radii[1]) / length;
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let normal = |sign: f32| along * cosine + along.perp() * (sign * sine);
            let corners = [
                a + normal(1.0) * radii[0],
                b + normal(1.0) * radii[1],
                b + normal(-1.0) * radii[1],
                a + normal(-1.0) * radii[0],
            ];
            path.move_to(corners[0].x, corners[0].y);
            for corner in &corners[1..] {
                path.line_to(corner.x, corner.y);
            }
            path.close();
            if let Some(hull) = path.finish() {
                self.fill(&hull, color, opacity);
            }
        }
        self.disc(a, radii[0], color, opacity);
        self.disc(b, radii[1], color, opacity);
    }

    /// Text on a baseline; `size` is the height of a line in pixels.
    pub(crate) fn text(&mut self, anchor: Vec2, text: &str, size: f32, color: Rgb, align: Align) {
        let width = self.text_width(text, size);
        let mut pen = Vec2::new(
            match align {
                Align::Left => anchor.x,
                Align::Centre => anchor.x - 0.5 * width,
                Align::Right => anchor.x - width,
            }
            .round(),
            anchor.y.round(),
        );
        let font = self.font.clone();
        let scaled = font.as_scaled(PxScale::from(size));
        let mut previous: Option<GlyphId> = None;
        for character in text.chars() {
            let id = font.glyph_id(character);
            if let Some(previous) = previous {
                pen.x += scaled.kern(previous, id);
            }
            let glyph = id.with_scale_and_position(size, ab_glyph::point(pen.x, pen.y));
            if let Some(outline) = font.outline_glyph(glyph) {
                let bounds = outline.px_bounds();
                outline.draw(|x, y, coverage| {
                    self.blend(
                        bounds.min.x as i64 + i64::from(x),
                        bounds.min.y as i64 + i64::from(y),
                        color,
                        coverage,
                    );
                });
            }
            pen.x += scaled.h_advance(id);
            previous = Some(id);
        }
    }

    /// Width of a text, in pixels.
    pub(crate) fn text_width(&self, text: &str, size: f32) -> f32 {
        let scaled = self.font.as_scaled(PxScale::from(size));
        text.chars()
            .map(|character| scaled.h_advance(self.font.glyph_id(character)))
            .sum()
    }

    fn blend(&mut self, x: i64, y: i64, color: Rgb, coverage: f32) {
        let (width, height) = (
            i64::from(self.pixmap.width()),
            i64::from(self.pixmap.height()),
        );
        if x < 0 || y < 0 || x >= width || y >= height {
            return;
        }
        let start = ((y * width + x) * 4) as usize;
        for (channel, value) in color.iter().enumerate() {
            let below = f32::from(self.pixmap.data()[start + channel]);
            let mixed = below + (f32::from(*value) - below) * coverage.clamp(0.0, 1.0);
            self.pixmap.data_mut()[start + channel] = mixed.round() as u8;
        }
    }

    fn fill(&mut self, path: &Path, color: Rgb, opacity: f32) {
        self.pixmap.fill_path(
            path,
            &paint(color, opacity),
            FillRule::Winding,
            Transform::identity(),
            None,
        );
    }

    fn stroke(&mut self, points: &[Vec2], width: f32, color: Rgb, dash: Option<StrokeDash>) {
        let mut path = PathBuilder::new();
        for (index, point) in points.iter().enumerate() {
            if index == 0 {
                path.move_to(point.x, point.y);
            } else {
                path.line_to(point.x, point.y);
            }
        }
        let Some(path) = path.finish() else {
            return;
        };
        let stroke = Stroke {
            width,
            line_cap: if dash.is_some() {
                LineCap::Butt
            } else {
                LineCap::Round
            },
            line_join: LineJoin::Round,
            dash,
            ..Stroke::default()
        };
        self.pixmap.stroke_path(
            &path,
            &paint(color, 1.0),
            &stroke,
            Transform::identity(),
            None,
        );
    }
}

fn paint(color: Rgb, opacity: f32) -> Paint<'static> {
    let mut paint = Paint {
        anti_alias: true,
        ..Paint::default()
    };
    let [red, green, blue] = color;
    paint.set_color_rgba8(red, green, blue, (opacity.clamp(0.0, 1.0) * 255.0) as u8);
    paint
}

/// Mixes a colour towards white; 0 keeps it, 1 is white.
pub(crate) fn lighter(color: Rgb, amount: f32) -> Rgb {
    color.map(|channel| (f32::from(channel) + (255.0 - f32::from(channel)) * amount) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_and_text_leave_ink_where_they_should() {
        let mut canvas = Canvas::new(100, 50).unwrap();
        canvas.limb(
            [Vec2::new(20.0, 10.0), Vec2::new(20.0, 40.0)],
            [6.0, 3.0],
            palette::LEFT,
            1.0,
        );
        canvas.text(
            Vec2::new(95.0, 30.0),
            "12 °",
            14.0,
            palette::INK,
            Align::Right,
        );
        let (width, height, rgb) = canvas.into_rgb();
        assert_eq!((width, height, rgb.len()), (100, 50, 15000));
        let pixel = |x: usize, y: usize| [0, 1, 2].map(|c| rgb[(y * 100 + x) * 3 + c]);
        assert_eq!(pixel(20, 25), palette::LEFT);
        assert_eq!(pixel(24, 11), palette::LEFT);
        assert_eq!(pixel(25, 40), palette::PAPER, "the limb tapers");
        assert!((60..95).any(|x| (15..32).any(|y| pixel(x, y)[0] < 100)));
        assert!((96..100).all(|x| pixel(x, 25) == palette::PAPER));
    }
}
