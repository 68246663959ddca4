//! Stand-ins: a few tubes around a body in the colours of its character, for walkers of a few pixels.
//!
//! [`StandIn::new`] measures a character's surface in the T-pose. Each part of the body (trunk, head, arms, legs, feet) becomes a tube of four sides whose
//! rings have the place, the mean width and the colours of the surface there. The rings move with the joints of the body, so that a
//! stand-in walks in the same steps as the mesh that it stands for.

mod section;
mod tubes;

use footfall_core::{JOINT_COUNT, Joint};
use glam::Vec3;
use section::Corner;
use tubes::{Shape, Station};

/// Corners of a ring.
const SIDES: usize = 4;

/// Triangle of a character's surface in the T-pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Places in the T-pose, metres, +Y up, facing +Z.
    pub corners: [Vec3; 3],
    /// Joint that moves it most.
    pub joint: Joint,
    /// Mean colour: red, green and blue, linear.
    pub colour: Vec3,
}

impl Facet {
    fn middle(&self) -> Vec3 {
        self.corners.iter().sum::<Vec3>() / 3.0
    }

    /// Area, square metres.
    pub fn area(&self) -> f32 {
        let [a, b, c] = self.corners;
        0.5 * (b - a).cross(c - a).length()
    }
}

/// Vertex of a stand-in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandInVertex {
    /// Place in the T-pose, metres.
    pub place: Vec3,
    /// Normal, of length 1.
    pub normal: Vec3,
    /// Joints that move it, half each.
    pub joints: [Joint; 2],
    /// Red, green and blue, linear.
    pub colour: Vec3,
}

/// Mesh of about 150 triangles in place of a character's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StandIn {
    /// Vertices.
    pub vertices: Vec<StandInVertex>,
    /// Indices of vertices, three a triangle, clockwise as seen from outside.
    pub indices: Vec<u32>,
}

impl StandIn {
    /// Makes the stand-in of a surface on a body whose joints are at these places in the T-pose. Parts of the body without a surface get none; a stand-in
    /// of nothing is empty.
    pub fn new(facets: &[Facet], rest: &[Vec3; JOINT_COUNT]) -> Self {
        let mut made = Self::default();
        for shape in tubes::tubes() {
            let of_it = facets
                .iter()
                .filter(|facet| shape.facets.contains(&facet.joint));
            let of_it: Vec<Facet> = of_it.copied().collect();
            if let Some(rings) = section::rings(&of_it, &shape, rest) {
                made.add(&rings, &shape, &of_it);
            }
        }
        made
    }

    /// Height of its highest vertex, metres.
    pub fn height_m(&self) -> f32 {
        let heights = self.vertices.iter().map(|vertex| vertex.place.y);
        heights.fold(0.0, f32::max)
    }

    fn add(&mut self, rings: &[[Corner; SIDES]], shape: &Shape, facets: &[Facet]) {
        let first = self.vertices.len();
        for (corners, (_, joints)) in rings.iter().zip(&shape.rings) {
            let vertices = corners.map(|corner| StandInVertex {
                place: corner.place,
                normal: corner.normal,
                joints: *joints,
                colour: Vec3::ONE,
            });
            self.vertices.extend(vertices);
        }
        paint(&mut self.vertices[first..], facets);
        let corner = |ring: usize, side: usize| (first + ring * SIDES + side % SIDES) as u32;
        for ring in 1..rings.len() {
            for side in 0..SIDES {
                let [a, b] = [side, side + 1].map(|side| corner(ring - 1, side));
                let [c, d] = [side, side + 1].map(|side| corner(ring, side));
                self.indices.extend_from_slice(&[a, c, b, b, c, d]);
            }
        }
        // A tube that begins at a joint begins inside another one, as a leg ends in a foot.
        if matches!(shape.rings[0].0, Station::Begin) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|side| corner(0, side));
            self.indices.extend_from_slice(&[a, b, c, a, c, d]);
        }
        if !shape.ends_inside {
            let [a, b, c, d] = [0, 1, 2, 3].map(|side| corner(rings.len() - 1, side));
            self.indices.extend_from_slice(&[a, c, b, a, d, c]);
        }
    }
}

/// Gives each vertex the mean colour of the surface to which it is the nearest, or of all of it.
fn paint(vertices: &mut [StandInVertex], facets: &[Facet]) {
    let mut sums = vec![(Vec3::ZERO, 0.0); vertices.len()];
    let mut whole = (Vec3::ZERO, 1e-9);
    for facet in facets {
        let (middle, area) = (facet.middle(), facet.area());
        let far = |vertex: &StandInVertex| vertex.place.distance_squared(middle);
        let nearest =
            (0..vertices.len()).min_by(|a, b| far(&vertices[*a]).total_cmp(&far(&vertices[*b])));
        for sum in [&mut sums[nearest.unwrap_or(0)], &mut whole] {
            sum.0 += area * facet.colour;
            sum.1 += area;
        }
    }
    for (vertex, (colour, area)) in vertices.iter_mut().zip(sums) {
        let (colour, area) = if area > 0.0 { (colour, area) } else { whole };
        vertex.colour = colour / area;
    }
}

#[cfg(test)]
mod tests;
