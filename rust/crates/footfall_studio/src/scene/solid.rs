//! Tapered capsules and boxes as shaded triangles.

use super::camera::{NEAR_M, Projection};
use eframe::egui::epaint::{Mesh, Vertex, WHITE_UV};
use eframe::egui::{Color32, Shape};
use footfall_motion::figure::Limb;
use glam::{Quat, Vec3};

/// Corners around a limb.
const AROUND: usize = 10;

/// Rings of each rounded end.
const CAP: usize = 3;

/// Direction of the light, and how much there is without.
const LIGHT: Vec3 = Vec3::new(0.45, 0.8, 0.4);
const AMBIENT: f32 = 0.42;

struct Triangle {
    corners: [u32; 3],
    depth: f32,
}

/// Triangles on their way to the window.
#[derive(Default)]
pub(super) struct Solids {
    vertices: Vec<Vertex>,
    depths: Vec<f32>,
    /// Depth by which the triangles that come now are sorted.
    depth: f32,
    triangles: Vec<Triangle>,
}

impl Solids {
    /// Adds a tapered capsule, sorted as if it were `nearer_m` nearer than it is.
    ///
    /// Solids are sorted as wholes: each is convex and hides its own far side, and where two of them meet, one lies cleanly over the
    /// other. Single triangles would show through each other in patches.
    pub(super) fn capsule(
        &mut self,
        projection: &Projection,
        limb: &Limb,
        color: Color32,
        nearer_m: f32,
    ) {
        let Limb { ends, radii, .. } = *limb;
        let middle = ends[0].midpoint(ends[1]);
        self.depth = projection.project(middle).1 - nearer_m;
        let along = (ends[1] - ends[0]).normalize_or(Vec3::Y);
        let side = along.any_orthonormal_vector();
        let turn = along.cross(side);
        let first = self.vertices.len() as u32;
        let rings = 2 * (CAP + 1);
        for ring in 0..rings {
            let end = usize::from(ring > CAP);
            // From the pole of one end over both rims to the pole of the other.
            let step = (ring - end) as f32 / CAP as f32;
            let angle = (step.min(2.0) - 1.0) * core::f32::consts::FRAC_PI_2;
            for corner in 0..AROUND {
                let around = corner as f32 / AROUND as f32 * core::f32::consts::TAU;
                let out = side * around.cos() + turn * around.sin();
                let normal = out * angle.cos() + along * angle.sin();
                self.vertex(projection, ends[end] + normal * radii[end], normal, color);
            }
        }
        for ring in 0..rings as u32 - 1 {
            for corner in 0..AROUND as u32 {
                let next = (corner + 1) % AROUND as u32;
                let at = |ring: u32, corner: u32| first + ring * AROUND as u32 + corner;
                let quad = [
                    at(ring, corner),
                    at(ring, next),
                    at(ring + 1, next),
                    at(ring + 1, corner),
                ];
                self.triangle([quad[0], quad[1], quad[2]]);
                self.triangle([quad[0], quad[2], quad[3]]);
            }
        }
    }

    /// Adds a box.
    pub(super) fn cuboid(
        &mut self,
        projection: &Projection,
        centre: Vec3,
        rotation: Quat,
        half: Vec3,
        colors: [Color32; 3],
    ) {
        self.depth = projection.project(centre).1;
        for (axis, color) in colors.into_iter().enumerate() {
            for sign in [-1.0, 1.0] {
                let mut normal = Vec3::ZERO;
                normal[axis] = sign;
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let first = self.vertices.len() as u32;
                for (a, b) in [(-1.0, -1.0), (sign, -sign), (1.0, 1.0), (-sign, sign)] {
                    let mut corner = normal;
                    corner[u] = a;
                    corner[v] = b;
                    let place = centre + rotation * (corner * half);
                    self.vertex(projection, place, rotation * normal, color);
                }
                self.triangle([first, first + 1, first + 2]);
                self.triangle([first, first + 2, first + 3]);
            }
        }
    }

    fn vertex(&mut self, projection: &Projection, place: Vec3, normal: Vec3, color: Color32) {
        let (pos, depth) = projection.project(place);
        let light = normal.dot(LIGHT.normalize()).max(0.0);
        // A little light from the camera keeps what faces it readable.
        let towards = normal.dot(-projection.forward).max(0.0);
        let shade = (AMBIENT + 0.45 * light + 0.22 * towards).min(1.1);
        self.vertices.push(Vertex {
            pos,
            uv: WHITE_UV,
            color: shaded(color, shade),
        });
        self.depths.push(depth);
    }

    /// Adds a triangle unless it is turned away or too near.
    fn triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|corner| self.vertices[corner as usize].pos);
        let depths = corners.map(|corner| self.depths[corner as usize]);
        let area = (b - a).x * (c - a).y - (b - a).y * (c - a).x;
        if area >= 0.0 || depths.iter().any(|depth| *depth < NEAR_M) {
            return;
        }
        self.triangles.push(Triangle {
            corners,
            depth: self.depth,
        });
    }

    /// Everything, the farthest first.
    pub(super) fn into_shape(mut self) -> Shape {
        self.triangles.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        Shape::mesh(Mesh {
            indices: self.triangles.iter().flat_map(|t| t.corners).collect(),
            vertices: self.vertices,
            ..Mesh::default()
        })
    }
}

fn shaded(color: Color32, shade: f32) -> Color32 {
    // The channels are multiplied by the opacity already and stay below it.
    let channel = |value: u8| (f32::from(value) * shade).min(f32::from(color.a())) as u8;
    Color32::from_rgba_premultiplied(
        channel(color.r()),
        channel(color.g()),
        channel(color.b()),
        color.a(),
    )
}
