//! Cuts the surface along the edges of its coloured regions, so that colours meet in clean lines and not along triangles.

use super::body::{Body, Region};
use super::field::{gradient, project};
use super::surface_nets::{Mesh, neighbours};
use super::weights::{Weights, strongest_four};
use glam::Vec3;
use std::collections::BTreeMap;

/// A skinned mesh whose triangles each lie in one region.
pub(super) struct Painted {
    pub(super) mesh: Mesh,
    pub(super) weights: Vec<Weights>,
    /// The region of each triangle.
    pub(super) regions: Vec<Region>,
}

/// Cuts a mesh along the edges of the body's bands.
pub(super) fn paint(body: &Body, mut mesh: Mesh, mut weights: Vec<Weights>) -> Painted {
    for band in 0..body.bands() {
        cut_along(body, band, &mut mesh, &mut weights);
    }
    let middle = |triangle: &[u32; 3]| {
        triangle
            .map(|vertex| mesh.positions[vertex as usize])
            .iter()
            .sum::<Vec3>()
            / 3.0
    };
    let regions = mesh
        .triangles
        .iter()
        .map(|triangle| body.region(middle(triangle)))
        .collect();
    Painted {
        mesh,
        weights,
        regions,
    }
}

/// Cuts a mesh along the edges of one band.
fn cut_along(body: &Body, band: usize, mesh: &mut Mesh, weights: &mut Vec<Weights>) {
    let field = |point| body.distance(point);
    let inside = |point| body.in_one_band(band, point);
    let side = snap(&field, &inside, mesh);
    let mut cut_of_edge = BTreeMap::new();
    let mut triangles = Vec::new();
    for triangle in std::mem::take(&mut mesh.triangles) {
        let mut cut = |from: u32, to: u32| {
            let (a, b) = (side[from as usize], side[to as usize]);
            if a * b >= 0.0 {
                return None;
            }
            let (from, to) = (from.min(to), from.max(to));
            Some(*cut_of_edge.entry((from, to)).or_insert_with(|| {
                let weight = border(&inside, mesh, from, to);
                let [p, q] = [from, to].map(|vertex| mesh.positions[vertex as usize]);
                let position = project(&field, p.lerp(q, weight), 0.002);
                mesh.positions.push(position);
                mesh.normals
                    .push(gradient(&field, position).normalize_or_zero());
                let [u, v] = [from, to].map(|vertex| weights[vertex as usize]);
                let mixed = std::array::from_fn(|joint| u[joint] + (v[joint] - u[joint]) * weight);
                weights.push(strongest_four(&mixed));
                (mesh.positions.len() - 1) as u32
            }))
        };
        let [a, b, c] = triangle;
        split(triangle, [cut(a, b), cut(b, c), cut(c, a)], &mut triangles);
    }
    mesh.triangles = triangles;
}

/// Moves vertices that are almost on an edge onto it, so that no slivers are cut off. Returns each vertex's side.
fn snap(field: &dyn Fn(Vec3) -> f32, inside: &dyn Fn(Vec3) -> f32, mesh: &mut Mesh) -> Vec<f32> {
    let neighbours = neighbours(mesh.positions.len(), &mesh.triangles);
    let old = mesh.positions.clone();
    old.iter()
        .zip(&neighbours)
        .enumerate()
        .map(|(vertex, (&position, near))| {
            let value = inside(position);
            if value.abs() > 0.05 {
                return value;
            }
            let shortest = near
                .iter()
                .map(|&other| old[other as usize].distance(position))
                .fold(f32::MAX, f32::min);
            if value.abs() > 0.3 * shortest {
                return value;
            }
            let normal = mesh.normals[vertex];
            let slope = gradient(inside, position).reject_from_normalized(normal);
            let moved = position - slope * (value / slope.length_squared().max(0.25));
            mesh.positions[vertex] = project(field, moved, 0.002);
            mesh.normals[vertex] = gradient(field, mesh.positions[vertex]).normalize_or(normal);
            0.0
        })
        .collect()
}

/// Share of a triangle's edge at which the band's border crosses it.
fn border(inside: &dyn Fn(Vec3) -> f32, mesh: &Mesh, from: u32, to: u32) -> f32 {
    let [p, q] = [from, to].map(|vertex| mesh.positions[vertex as usize]);
    let (mut low, mut high) = (0.0, 1.0);
    let starts_inside = inside(p) > 0.0;
    for _ in 0..20 {
        let middle = f32::midpoint(low, high);
        if (inside(p.lerp(q, middle)) > 0.0) == starts_inside {
            low = middle;
        } else {
            high = middle;
        }
    }
    f32::midpoint(low, high)
}

/// Cuts one triangle; `cuts` are new vertices on its edges ab, bc and ca.
fn split([a, b, c]: [u32; 3], cuts: [Option<u32>; 3], into: &mut Vec<[u32; 3]>) {
    match cuts {
        [None, None, None] => into.push([a, b, c]),
        // One edge is cut: the line runs to the opposite vertex.
        [Some(p), None, None] => into.extend([[a, p, c], [p, b, c]]),
        [None, Some(p), None] => into.extend([[a, b, p], [a, p, c]]),
        [None, None, Some(p)] => into.extend([[a, b, p], [p, b, c]]),
        // Two are: a corner comes off.
        [Some(p), Some(q), _] => into.extend([[p, b, q], [a, p, q], [a, q, c]]),
        [Some(p), None, Some(r)] => into.extend([[a, p, r], [p, b, c], [p, c, r]]),
        [None, Some(q), Some(r)] => into.extend([[q, c, r], [a, b, q], [a, q, r]]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_keep_the_outline_and_the_winding() {
        // Corners 0, 1, 2 and the middles of their edges.
        let at = [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [0.5, 0.0],
            [0.5, 0.5],
            [0.0, 0.5],
        ];
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c]: [[f32; 2]; 3] = [a, b, c].map(|vertex| at[vertex as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        };
        for bits in 0..7_u32 {
            let cuts = [0, 1, 2].map(|edge| (bits & (1 << edge) != 0).then_some(3 + edge));
            let mut parts = Vec::new();
            split([0, 1, 2], cuts, &mut parts);
            assert!(
                parts.iter().all(|&part| area(part) > 0.0),
                "{cuts:?}: {parts:?}"
            );
            let total: f32 = parts.iter().map(|&part| area(part)).sum();
            assert!((total - 1.0).abs() < 1e-6, "{cuts:?}");
        }
    }
}
