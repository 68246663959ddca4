//! Rings of a tube, measured by cutting the surface across the tube's axis.

use super::tubes::{Shape, Station};
use super::{Facet, SIDES};
use footfall_core::{JOINT_COUNT, Joint};
use glam::{Mat3, Vec2, Vec3};

/// Directions in which a section's width is measured.
const DIRECTIONS: usize = 8;
/// Places at which the surface is cut for a ring, in shares of the distance to the next ring: the surface between two rings counts as much as at them.
const CUTS: [f32; 5] = [-0.45, -0.2, 0.0, 0.2, 0.45];
/// Factor on the width of rings. A tube is thinner than the surface where it bends, and where the surface bulges between two rings: without the factor, the
/// mannequin's stand-in covers 94 % of its pixels.
pub(super) const FULLER: f32 = 1.06;
/// A tube shorter than this has no direction, metres.
const SHORTEST_M: f32 = 1e-3;

/// Corner of a ring: its place, and the normal of the surface there.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub(super) place: Vec3,
    pub(super) normal: Vec3,
}

/// Rings around a surface, with the corners of each counter-clockwise about the axis.
pub(super) fn rings(
    facets: &[Facet],
    shape: &Shape,
    rest: &[Vec3; JOINT_COUNT],
) -> Option<Vec<[Corner; SIDES]>> {
    let place = |joint: Joint| rest[joint.index()];
    let [from, to] = shape.axis.map(place);
    let mut axis = to - from;
    if shape.is_level {
        axis.y = 0.0;
    }
    let axis = axis
        .try_normalize()
        .filter(|_| axis.length() > SHORTEST_M)?;
    // Across it forwards and sideways, or upwards and sideways for a foot.
    let ahead = if shape.is_level { Vec3::Y } else { Vec3::Z };
    let ahead = ahead.reject_from_normalized(axis).try_normalize()?;
    let across = Across {
        from,
        to_local: Mat3::from_cols(ahead.cross(axis), ahead, axis).transpose(),
    };
    let along = |place: Vec3| (place - from).dot(axis);
    let corners = facets.iter().flat_map(|facet| facet.corners);
    let (begin, end) = corners.fold((f32::MAX, f32::MIN), |(least, most), corner| {
        (least.min(along(corner)), most.max(along(corner)))
    });
    if end - begin < SHORTEST_M {
        return None;
    }
    let stations: Vec<f32> = shape
        .rings
        .iter()
        .map(|(station, _)| match *station {
            Station::Begin => begin,
            Station::At(joint) => along(place(joint)).clamp(begin, end),
            Station::Beyond(joint, share) => {
                let base = along(place(joint)).clamp(begin, end);
                base + share * (end - base)
            }
            Station::End => end,
        })
        .collect();
    let sections = (0..stations.len()).map(|index| {
        let at = stations[index];
        let before = at - stations[index.saturating_sub(1)];
        let after = stations[(index + 1).min(stations.len() - 1)] - at;
        let cuts = CUTS.map(|share| at + share * if share < 0.0 { before } else { after });
        Section::mean(cuts.iter().filter_map(|cut| across.cut(facets, *cut)))
    });
    let sections: Vec<Option<Section>> = sections.collect();
    // Without a surface at its place, the ring has the size of the others.
    let whole = Section::mean(sections.iter().flatten().copied())?;
    let last = stations.len() - 1;
    let rings = sections.iter().zip(&stations).enumerate();
    Some(
        rings
            .map(|(index, (section, at))| {
                let outwards = if index == 0 {
                    -1.0
                } else if index == last {
                    1.0
                } else {
                    0.0
                };
                across.ring(&section.unwrap_or(whole), *at, outwards)
            })
            .collect(),
    )
}

/// A tube's axis.
struct Across {
    from: Vec3,
    /// Turns the axis to +Z.
    to_local: Mat3,
}

/// Middle and half sides of a section.
#[derive(Clone, Copy)]
struct Section {
    middle: Vec2,
    half: Vec2,
}

impl Across {
    /// The section of the surface at this distance along the axis; `None` if it is empty.
    fn cut(&self, facets: &[Facet], at: f32) -> Option<Section> {
        let mut reach = [(f32::MAX, f32::MIN); DIRECTIONS];
        let directions: [Vec2; DIRECTIONS] = core::array::from_fn(|index| {
            Vec2::from_angle(index as f32 * core::f32::consts::PI / DIRECTIONS as f32)
        });
        for facet in facets {
            let corners = facet
                .corners
                .map(|corner| self.to_local * (corner - self.from));
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let (a, b) = (corners[a], corners[b]);
                if (a.z < at) == (b.z < at) {
                    continue;
                }
                let point = a.lerp(b, (at - a.z) / (b.z - a.z)).truncate();
                for (reach, direction) in reach.iter_mut().zip(directions) {
                    let far = point.dot(direction);
                    *reach = (reach.0.min(far), reach.1.max(far));
                }
            }
        }
        let (wide, deep) = (reach[0], reach[DIRECTIONS / 2]);
        if wide.0 > wide.1 {
            return None;
        }
        let half = 0.5 * Vec2::new(wide.1 - wide.0, deep.1 - deep.0);
        // A rectangle looks as wide as the section, in the mean from all sides (Cauchy: the mean width of a convex shape is its outline
        // by pi).
        let widths = reach.map(|(least, most)| most - least);
        let mean = widths.iter().sum::<f32>() / DIRECTIONS as f32;
        let of_rectangle = 4.0 * (half.x + half.y) / core::f32::consts::PI;
        let scale = (mean / of_rectangle.max(1e-6)).min(1.0);
        Some(Section {
            middle: 0.5 * Vec2::new(wide.0 + wide.1, deep.0 + deep.1),
            half: scale * half,
        })
    }

    /// The corners of a ring; `along` is the part of their normals along the axis.
    fn ring(&self, section: &Section, at: f32, along: f32) -> [Corner; SIDES] {
        let to_world = self.to_local.transpose();
        let half = FULLER * section.half.max(Vec2::splat(1e-3));
        let signs = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        signs.map(|(wide, deep)| {
            let sign = Vec2::new(wide, deep);
            let local = (section.middle + sign * half).extend(at);
            let outwards = (sign / half).normalize().extend(along);
            Corner {
                place: self.from + to_world * local,
                normal: (to_world * outwards).normalize(),
            }
        })
    }
}

impl Section {
    fn mean(sections: impl Iterator<Item = Self>) -> Option<Self> {
        let (mut middle, mut half, mut count) = (Vec2::ZERO, Vec2::ZERO, 0.0);
        for section in sections {
            middle += section.middle;
            half += section.half;
            count += 1.0;
        }
        (count > 0.0).then(|| Self {
            middle: middle / count,
            half: half / count,
        })
    }
}
