//! The floor: a grid of metres, shadows, and where feet stand.

use super::camera::Projection;
use super::view::Footprint;
use crate::palette;
use eframe::egui::epaint::{Mesh, PathShape, Vertex, WHITE_UV};
use eframe::egui::{Color32, Painter, Shape, Stroke};
use footfall_core::Side;
use glam::Vec3;

/// Reach of the grid, metres.
const REACH_M: i32 = 7;

/// Half the width of a footprint, metres.
const SOLE_M: f32 = 0.042;

pub(super) fn grid(painter: &Painter, projection: &Projection, around: Vec3, ink: Color32) {
    let (x, z) = (around.x.round(), around.z.round());
    let reach = REACH_M as f32;
    for step in -REACH_M..=REACH_M {
        let offset = step as f32;
        let fade = 1.0 - (offset / (reach + 1.0)).powi(2);
        let stroke = Stroke::new(1.0, ink.gamma_multiply(fade));
        let along_x = [
            Vec3::new(x - reach, 0.0, z + offset),
            Vec3::new(x + reach, 0.0, z + offset),
        ];
        let along_z = [
            Vec3::new(x + offset, 0.0, z - reach),
            Vec3::new(x + offset, 0.0, z + reach),
        ];
        for ends in [along_x, along_z] {
            if let Some(line) = projection.line(ends) {
                painter.line_segment(line, stroke);
            }
        }
    }
}

/// A soft disc under a body.
pub(super) fn shadow(painter: &Painter, projection: &Projection, under: Vec3, strength: f32) {
    const CORNERS: u32 = 24;
    const RADIUS_M: f32 = 0.42;
    let mut mesh = Mesh::default();
    let vertex = |place: Vec3, color: Color32| Vertex {
        pos: projection.project(place).0,
        uv: WHITE_UV,
        color,
    };
    let centre = under.with_y(0.0);
    mesh.vertices.push(vertex(
        centre,
        Color32::from_black_alpha((110.0 * strength) as u8),
    ));
    for corner in 0..CORNERS {
        let angle = corner as f32 / CORNERS as f32 * core::f32::consts::TAU;
        let rim = centre + Vec3::new(angle.cos(), 0.0, angle.sin()) * RADIUS_M;
        mesh.vertices.push(vertex(rim, Color32::TRANSPARENT));
        mesh.indices
            .extend([0, corner + 1, (corner + 1) % CORNERS + 1]);
    }
    painter.add(Shape::mesh(mesh));
}

/// The outline of a sole; filled while the foot stands.
pub(super) fn footprint(painter: &Painter, projection: &Projection, print: &Footprint) {
    let color = match print.side {
        Side::Left => palette::LEFT,
        Side::Right => palette::RIGHT,
    };
    let [heel, ball, tip] = print.sole.map(|point| point.with_y(0.0));
    let ahead = (tip - heel).normalize_or(Vec3::Z);
    let across = Vec3::Y.cross(ahead) * SOLE_M;
    let outline = [
        heel - ahead * 0.02,
        heel - across * 0.75,
        ball - across,
        tip - across * 0.5,
        tip + ahead * 0.015,
        tip + across * 0.5,
        ball + across,
        heel + across * 0.75,
    ];
    let points: Vec<_> = outline
        .iter()
        .map(|point| projection.project(*point))
        .collect();
    if points
        .iter()
        .any(|(_, depth)| *depth < super::camera::NEAR_M)
    {
        return;
    }
    let fill = if print.stands {
        color.gamma_multiply(0.75)
    } else {
        color.gamma_multiply(0.16)
    };
    painter.add(Shape::Path(PathShape::convex_polygon(
        points.into_iter().map(|(point, _)| point).collect(),
        fill,
        Stroke::new(1.0, color.gamma_multiply(0.7)),
    )));
}
