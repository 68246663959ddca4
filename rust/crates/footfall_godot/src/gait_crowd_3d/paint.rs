//! Colour of a character's surface: its material's colour, its texture and the colours of its vertices together.

use glam::Vec3;
use godot::classes::image::Format;
use godot::classes::{ShaderMaterial, Texture2D};
use godot::prelude::*;

/// Texels of a texture's longer side that are kept: means over triangles need no more.
const TEXELS: i32 = 128;

/// Colour of a surface.
pub(super) struct Paint {
    albedo: Vec3,
    texture: Option<Texels>,
    /// True where the renderer takes the colours of vertices as sRGB.
    in_srgb: bool,
}

/// A texture in eight bits a colour.
struct Texels {
    bytes: PackedByteArray,
    width: usize,
    height: usize,
}

impl Paint {
    /// Reads what a material of the crowd shows.
    pub(super) fn of(material: Option<&Gd<ShaderMaterial>>, in_srgb: bool) -> Self {
        let parameter = |name: &str| {
            material.map_or_else(Variant::nil, |material| material.get_shader_parameter(name))
        };
        let albedo = parameter("albedo").try_to::<Color>();
        let texture = parameter("albedo_texture").try_to::<Gd<Texture2D>>();
        Self {
            albedo: albedo.map_or(Vec3::ONE, light),
            texture: texture.ok().and_then(|texture| Texels::of(&texture)),
            in_srgb,
        }
    }

    /// Mean linear colour of a triangle from what its corners have.
    pub(super) fn of_triangle(
        &self,
        uvs: [Option<Vector2>; 3],
        colours: [Option<Color>; 3],
    ) -> Vec3 {
        let own = colours.map(|colour| match colour {
            Some(colour) if self.in_srgb => light(colour),
            Some(colour) => Vec3::new(colour.r, colour.g, colour.b),
            None => Vec3::ONE,
        });
        let painted = match (&self.texture, uvs) {
            (Some(texture), [Some(a), Some(b), Some(c)]) => texture.mean([a, b, c]),
            _ => Vec3::ONE,
        };
        self.albedo * painted * own.iter().sum::<Vec3>() / 3.0
    }
}

impl Texels {
    /// Reads a texture; `None` where the engine does not hand it out.
    fn of(texture: &Gd<Texture2D>) -> Option<Self> {
        let mut image = texture.get_image()?;
        if image.is_empty() {
            return None;
        }
        if image.is_compressed() && image.decompress() != godot::global::Error::OK {
            return None;
        }
        image.convert(Format::RGB8);
        while image.get_width().max(image.get_height()) > TEXELS
            && image.get_width().min(image.get_height()) > 1
        {
            image.shrink_x2();
        }
        image.clear_mipmaps();
        Some(Self {
            bytes: image.get_data(),
            width: usize::try_from(image.get_width()).ok()?,
            height: usize::try_from(image.get_height()).ok()?,
        })
    }

    /// Mean linear colour of a triangle of the texture.
    fn mean(&self, corners: [Vector2; 3]) -> Vec3 {
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let places = [middle]
            .into_iter()
            .chain(corners.map(|corner| corner.lerp(middle, 0.5)));
        places.map(|place| self.at(place)).sum::<Vec3>() / 4.0
    }

    fn at(&self, uv: Vector2) -> Vec3 {
        let texel = |part: f32, size: usize| {
            ((part.rem_euclid(1.0) * size as f32) as usize).min(size.saturating_sub(1))
        };
        let first = 3 * (texel(uv.y, self.height) * self.width + texel(uv.x, self.width));
        let part = |index: usize| self.bytes.get(first + index).unwrap_or(255);
        light(Color::from_rgba8(part(0), part(1), part(2), 255))
    }
}

fn light(colour: Color) -> Vec3 {
    let linear = colour.srgb_to_linear();
    Vec3::new(linear.r, linear.g, linear.b)
}
