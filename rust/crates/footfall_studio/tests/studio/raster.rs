//! egui's triangles in software, the same on every machine.

use eframe::egui::epaint::{ImageData, Mesh, Primitive, Vertex};
use eframe::egui::{Color32, Context, FullOutput, Rect, TextureId, TexturesDelta};
use egui_kittest::TestRenderer;
use image::{Rgba, RgbaImage};
use std::collections::HashMap;

/// Colour of a cleared window in the dark theme.
const CLEAR: Rgba<u8> = Rgba([24, 26, 31, 255]);

#[derive(Default)]
pub(crate) struct Raster {
    textures: HashMap<TextureId, Texture>,
}

struct Texture {
    size: [usize; 2],
    pixels: Vec<Color32>,
}

impl TestRenderer for Raster {
    fn handle_delta(&mut self, delta: &TexturesDelta) {
        for (id, delta) in &delta.set {
            let ImageData::Color(image) = &delta.image;
            let [width, height] = image.size;
            match delta.pos {
                None => {
                    let pixels = image.pixels.clone();
                    self.textures.insert(
                        *id,
                        Texture {
                            size: image.size,
                            pixels,
                        },
                    );
                }
                Some([left, top]) => {
                    let texture = self.textures.get_mut(id).expect("a part of a texture");
                    for y in 0..height {
                        let to = (top + y) * texture.size[0] + left;
                        texture.pixels[to..to + width]
                            .copy_from_slice(&image.pixels[y * width..(y + 1) * width]);
                    }
                }
            }
        }
        for id in &delta.free {
            self.textures.remove(id);
        }
    }

    fn render(&mut self, ctx: &Context, output: &FullOutput) -> Result<RgbaImage, String> {
        let size = ctx.content_rect().size() * ctx.pixels_per_point();
        let mut image = RgbaImage::from_pixel(size.x as u32, size.y as u32, CLEAR);
        for clipped in ctx.tessellate(output.shapes.clone(), ctx.pixels_per_point()) {
            if let Primitive::Mesh(mesh) = &clipped.primitive {
                let texture = self
                    .textures
                    .get(&mesh.texture_id)
                    .ok_or("a mesh without its texture")?;
                let clip = clipped.clip_rect * ctx.pixels_per_point();
                paint(&mut image, mesh, texture, clip, ctx.pixels_per_point());
            }
        }
        Ok(image)
    }
}

fn paint(image: &mut RgbaImage, mesh: &Mesh, texture: &Texture, clip: Rect, scale: f32) {
    for corners in mesh.indices.chunks_exact(3) {
        let mut corners = [0, 1, 2].map(|n| mesh.vertices[corners[n] as usize]);
        let at = |v: &Vertex| [v.pos.x * scale, v.pos.y * scale];
        let area = cross(at(&corners[0]), at(&corners[1]), at(&corners[2]));
        if area == 0.0 || !area.is_finite() {
            continue;
        }
        if area < 0.0 {
            corners.swap(1, 2);
        }
        triangle(image, &corners, texture, clip, scale);
    }
}

/// Twice the area that three points enclose; positive clockwise in the window.
fn cross(a: [f32; 2], b: [f32; 2], c: [f32; 2]) -> f32 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn triangle(
    image: &mut RgbaImage,
    corners: &[Vertex; 3],
    texture: &Texture,
    clip: Rect,
    scale: f32,
) {
    let points = corners.map(|v| [v.pos.x * scale, v.pos.y * scale]);
    let area = cross(points[0], points[1], points[2]);
    let range = |axis: usize, low: f32, high: f32, end: u32| {
        let least = points.iter().map(|p| p[axis]).fold(f32::MAX, f32::min);
        let most = points.iter().map(|p| p[axis]).fold(f32::MIN, f32::max);
        let first = least.max(low).floor().max(0.0) as u32;
        first..(most.min(high).ceil().max(0.0) as u32).min(end)
    };
    // A pixel on an edge that two triangles share belongs to one of them: the one that it is left of or above.
    let edges = [(1, 2), (2, 0), (0, 1)].map(|(from, to)| {
        let (dx, dy) = (
            points[to][0] - points[from][0],
            points[to][1] - points[from][1],
        );
        (from, to, dy < 0.0 || (dy == 0.0 && dx > 0.0))
    });
    for y in range(1, clip.min.y, clip.max.y, image.height()) {
        'pixel: for x in range(0, clip.min.x, clip.max.x, image.width()) {
            let centre = [x as f32 + 0.5, y as f32 + 0.5];
            let is_clipped = centre[0] < clip.min.x
                || centre[0] >= clip.max.x
                || centre[1] < clip.min.y
                || centre[1] >= clip.max.y;
            if is_clipped {
                continue;
            }
            let mut weights = [0.0; 3];
            for (weight, (from, to, owns_edge)) in weights.iter_mut().zip(edges) {
                let inside = cross(points[from], points[to], centre);
                if inside < 0.0 || (inside == 0.0 && !owns_edge) {
                    continue 'pixel;
                }
                *weight = inside / area;
            }
            let mixed = |value: fn(&Vertex) -> f32| -> f32 {
                (0..3).map(|n| weights[n] * value(&corners[n])).sum()
            };
            let texel = texture.at(mixed(|v| v.uv.x), mixed(|v| v.uv.y));
            let color = [
                mixed(|v| f32::from(v.color.r())),
                mixed(|v| f32::from(v.color.g())),
                mixed(|v| f32::from(v.color.b())),
                mixed(|v| f32::from(v.color.a())),
            ];
            let texel = texel.to_array().map(|t| f32::from(t) / 255.0);
            let pixel = image.get_pixel_mut(x, y);
            let opacity = color[3] * texel[3] / 255.0;
            for channel in 0..3 {
                let above = color[channel] * texel[channel];
                let below = f32::from(pixel.0[channel]) * (1.0 - opacity);
                pixel.0[channel] = (above + below).round().clamp(0.0, 255.0) as u8;
            }
        }
    }
}

impl Texture {
    fn at(&self, u: f32, v: f32) -> Color32 {
        let place = |at: f32, size: usize| ((at * size as f32) as usize).min(size - 1);
        self.pixels[place(v, self.size[1]) * self.size[0] + place(u, self.size[0])]
    }
}
