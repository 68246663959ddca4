//! Polygons from a distance field: naive surface nets (Gibson 1998) on a grid whose lines need not be evenly spaced.

use super::field::{gradient, project};
use glam::Vec3;
use std::collections::BTreeMap;

/// Triangles on the surface of a solid, seen from outside counter-clockwise.
#[derive(Clone, Debug, Default)]
pub(super) struct Mesh {
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Coordinates of the grid's planes along each axis, ascending.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub(super) lines: [Vec<f32>; 3],
}

impl Grid {
    fn size(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.lines[axis].len())
    }

    fn point(&self, at: [usize; 3]) -> Vec3 {
        Vec3::new(
            self.lines[0][at[0]],
            self.lines[1][at[1]],
            self.lines[2][at[2]],
        )
    }

    fn index(&self, at: [usize; 3]) -> usize {
        let size = self.size();
        (at[2] * size[1] + at[1]) * size[0] + at[0]
    }

    /// Every node, or every cell when `short` is 1.
    fn places(&self, short: usize) -> impl Iterator<Item = [usize; 3]> + use<> {
        let size = self.size().map(|lines| lines - short);
        (0..size[2])
            .flat_map(move |z| (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y, z])))
    }
}

/// The surface of `field` where the grid sees it. Vertices lie on the surface and are spread evenly along it.
pub(super) fn polygonise(field: &dyn Fn(Vec3) -> f32, grid: &Grid) -> Mesh {
    let values: Vec<f32> = grid.places(0).map(|at| field(grid.point(at))).collect();
    let mut mesh = Mesh::default();
    let mut vertex_of_cell = BTreeMap::new();
    for cell in grid.places(1) {
        if let Some(position) = vertex_in_cell(grid, &values, cell) {
            vertex_of_cell.insert(grid.index(cell), mesh.positions.len() as u32);
            mesh.positions.push(position);
        }
    }
    for at in grid.places(0) {
        for axis in 0..3 {
            quad_across_edge(grid, &values, &vertex_of_cell, (at, axis), &mut mesh);
        }
    }
    relax(field, &mut mesh);
    mesh.normals = mesh
        .positions
        .iter()
        .map(|&position| gradient(field, position).normalize_or(Vec3::Y))
        .collect();
    mesh
}

/// The mean of the places where the surface crosses the cell's edges.
fn vertex_in_cell(grid: &Grid, values: &[f32], cell: [usize; 3]) -> Option<Vec3> {
    let corner = |bits: usize| [0, 1, 2].map(|axis| cell[axis] + ((bits >> axis) & 1));
    let (mut sum, mut crossings) = (Vec3::ZERO, 0);
    for bits in 0..8 {
        for axis in 0..3 {
            if bits & (1 << axis) != 0 {
                continue;
            }
            let (from, to) = (corner(bits), corner(bits | (1 << axis)));
            let (a, b) = (values[grid.index(from)], values[grid.index(to)]);
            if (a < 0.0) != (b < 0.0) {
                sum += grid.point(from).lerp(grid.point(to), a / (a - b));
                crossings += 1;
            }
        }
    }
    (crossings > 0).then(|| sum / crossings as f32)
}

/// Two triangles across an edge that the surface crosses, between the four cells around it.
fn quad_across_edge(
    grid: &Grid,
    values: &[f32],
    vertex_of_cell: &BTreeMap<usize, u32>,
    (at, axis): ([usize; 3], usize),
    mesh: &mut Mesh,
) {
    let size = grid.size();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    if at[axis] + 1 >= size[axis]
        || at[u] == 0
        || at[v] == 0
        || at[u] + 1 >= size[u]
        || at[v] + 1 >= size[v]
    {
        return;
    }
    let mut next = at;
    next[axis] += 1;
    let (inside, next_inside) = (values[grid.index(at)] < 0.0, values[grid.index(next)] < 0.0);
    if inside == next_inside {
        return;
    }
    let around = [(1, 1), (0, 1), (0, 0), (1, 0)].map(|(du, dv)| {
        let mut cell = at;
        cell[u] -= du;
        cell[v] -= dv;
        vertex_of_cell.get(&grid.index(cell)).copied()
    });
    let [Some(a), Some(b), Some(c), Some(d)] = around else {
        return;
    };
    let (b, d) = if inside { (b, d) } else { (d, b) };
    let at = |vertex: u32| mesh.positions[vertex as usize];
    // The shorter diagonal follows the surface better.
    if at(a).distance_squared(at(c)) <= at(b).distance_squared(at(d)) {
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
    } else {
        mesh.triangles.extend([[a, b, d], [b, c, d]]);
    }
}

/// For each vertex, those that share an edge with it.
pub(super) fn neighbours(vertices: usize, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut neighbours = vec![Vec::new(); vertices];
    for triangle in triangles {
        for corner in 0..3 {
            let (from, to) = (triangle[corner], triangle[(corner + 1) % 3]);
            neighbours[from as usize].push(to);
            neighbours[to as usize].push(from);
        }
    }
    for list in &mut neighbours {
        list.sort_unstable();
        list.dedup();
    }
    neighbours
}

/// Evens the triangles out: towards the neighbours' mean, then back onto the surface.
fn relax(field: &dyn Fn(Vec3) -> f32, mesh: &mut Mesh) {
    let neighbours = neighbours(mesh.positions.len(), &mesh.triangles);
    for _ in 0..4 {
        let old = mesh.positions.clone();
        for (position, near) in mesh.positions.iter_mut().zip(&neighbours) {
            let mean = near.iter().map(|&other| old[other as usize]).sum::<Vec3>()
                / near.len().max(1) as f32;
            let reach = mean.distance(*position).max(0.005);
            *position = project(field, position.lerp(mean, 0.5), reach);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball() -> Mesh {
        let line: Vec<f32> = (0..=24).map(|n| -0.6 + 0.05 * n as f32).collect();
        polygonise(
            &|point| point.length() - 0.5,
            &Grid {
                lines: [line.clone(), line.clone(), line],
            },
        )
    }

    #[test]
    fn a_ball_is_closed_round_and_seen_from_outside() {
        let mesh = ball();
        let mut edges = BTreeMap::new();
        let mut volume = 0.0;
        for triangle in &mesh.triangles {
            for corner in 0..3 {
                *edges
                    .entry((triangle[corner], triangle[(corner + 1) % 3]))
                    .or_insert(0) += 1;
            }
            let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
            volume += a.dot(b.cross(c)) / 6.0;
        }
        assert!(
            edges
                .iter()
                .all(|(&(from, to), &count)| count == 1 && edges.get(&(to, from)) == Some(&1))
        );
        let exact = 4.0 / 3.0 * std::f32::consts::PI * 0.125;
        assert!((volume / exact - 1.0).abs() < 0.03, "{volume} for {exact}");
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            assert!((position.length() - 0.5).abs() < 1e-3);
            assert!(normal.dot(*position) > 0.499);
        }
    }
}
