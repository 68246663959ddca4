//! Shapes as distance fields: negative inside, near the surface close to the distance in metres.

use glam::{Mat3, Vec3};

/// Extents of a lofted shape at one place of its axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Station {
    /// Place along the axis, metres from its origin.
    pub(super) along: f32,
    /// Half extents across: +side, −side, +front, −front, metres.
    pub(super) extents: [f32; 4],
}

/// A smooth tube around an axis, with elliptic quarters that may differ in size and rounded ends.
#[derive(Clone, Debug)]
pub(super) struct Loft {
    origin: Vec3,
    /// `model_from_loft` axes: side, along, front.
    axes: Mat3,
    stations: Vec<Station>,
    /// Lengths of the rounded ends beyond the first and the last station.
    caps: [f32; 2],
}

impl Loft {
    /// `along` and `front` are unit vectors at right angles; stations ascend.
    pub(super) fn new(
        origin: Vec3,
        along: Vec3,
        front: Vec3,
        caps: [f32; 2],
        stations: Vec<Station>,
    ) -> Self {
        Self {
            origin,
            axes: Mat3::from_cols(along.cross(front), along, front),
            stations,
            caps,
        }
    }

    fn distance(&self, point: Vec3) -> f32 {
        let local = self.axes.transpose() * (point - self.origin);
        let (first, last) = (
            self.stations[0].along,
            self.stations[self.stations.len() - 1].along,
        );
        let clamped = local.y.clamp(first, last);
        let beyond = local.y - clamped;
        let extents = self.extents_at(clamped);
        let side = if local.x >= 0.0 {
            extents[0]
        } else {
            extents[1]
        };
        let front = if local.z >= 0.0 {
            extents[2]
        } else {
            extents[3]
        };
        let cap = if beyond >= 0.0 {
            self.caps[1]
        } else {
            self.caps[0]
        };
        ellipsoid(
            Vec3::new(local.x, beyond, local.z),
            Vec3::new(side, cap, front),
        )
    }

    /// Extents between stations, by Catmull-Rom splines so that the outline has no corners.
    fn extents_at(&self, along: f32) -> [f32; 4] {
        let stations = &self.stations;
        let next = stations
            .partition_point(|station| station.along <= along)
            .clamp(1, stations.len() - 1);
        let (from, to) = (&stations[next - 1], &stations[next]);
        let before = &stations[next.saturating_sub(2)];
        let after = &stations[(next + 1).min(stations.len() - 1)];
        let span = to.along - from.along;
        let t = ((along - from.along) / span).clamp(0.0, 1.0);
        let slope = |a: &Station, b: &Station, index: usize| {
            let run = b.along - a.along;
            if run > 0.0 {
                (b.extents[index] - a.extents[index]) / run * span
            } else {
                0.0
            }
        };
        std::array::from_fn(|index| {
            let (a, b) = (from.extents[index], to.extents[index]);
            let (ma, mb) = (slope(before, to, index), slope(from, after, index));
            let (t2, t3) = (t * t, t * t * t);
            a * (2.0 * t3 - 3.0 * t2 + 1.0)
                + ma * (t3 - 2.0 * t2 + t)
                + b * (3.0 * t2 - 2.0 * t3)
                + mb * (t3 - t2)
        })
    }
}

/// A first-order bound of the distance to an ellipsoid at the origin.
fn ellipsoid(point: Vec3, radii: Vec3) -> f32 {
    let scaled = (point / radii).length();
    let gradient = (point / (radii * radii)).length();
    if gradient < 1e-6 {
        -radii.min_element()
    } else {
        scaled * (scaled - 1.0) / gradient
    }
}

/// One solid.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// A tube along a line.
    Loft(Loft),
    /// An ellipsoid: centre and radii along the model's axes.
    Ellipsoid(Vec3, Vec3),
    /// A ball that is swept along a line while its radius changes.
    RoundCone {
        from: Vec3,
        to: Vec3,
        radii: [f32; 2],
    },
}

impl Shape {
    pub(super) fn distance(&self, point: Vec3) -> f32 {
        match self {
            Self::Loft(loft) => loft.distance(point),
            Self::Ellipsoid(centre, radii) => ellipsoid(point - *centre, *radii),
            Self::RoundCone { from, to, radii } => {
                let axis = *to - *from;
                let along = ((point - *from).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
                point.distance(*from + axis * along) - radii[0].lerp(radii[1], along)
            }
        }
    }
}

trait Lerp {
    fn lerp(self, other: Self, weight: Self) -> Self;
}

impl Lerp for f32 {
    fn lerp(self, other: Self, weight: Self) -> Self {
        self + (other - self) * weight
    }
}

/// Union of two solids, rounded where they meet over about `radius`.
pub(super) fn smooth_union(a: f32, b: f32, radius: f32) -> f32 {
    let near = (radius - (a - b).abs()).max(0.0) / radius;
    a.min(b) - near * near * radius * 0.25
}

/// Distance to the shape that is in `a` but not in `b`, rounded where they meet.
pub(super) fn smooth_difference(a: f32, b: f32, radius: f32) -> f32 {
    -smooth_union(-a, b, radius)
}

/// 0 up to `from`, 1 from `to` on, smooth between.
pub(super) fn smoothstep(from: f32, to: f32, value: f32) -> f32 {
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Outward direction and steepness of a field.
pub(super) fn gradient(field: &dyn Fn(Vec3) -> f32, point: Vec3) -> Vec3 {
    const STEP: f32 = 1e-3;
    let along =
        |axis: Vec3| (field(point + axis * STEP) - field(point - axis * STEP)) / (2.0 * STEP);
    Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z))
}

/// Moves a point that is near the surface onto it.
pub(super) fn project(field: &dyn Fn(Vec3) -> f32, mut point: Vec3, reach: f32) -> Vec3 {
    for _ in 0..4 {
        let slope = gradient(field, point);
        let steepness = slope.length_squared().max(0.05);
        point -= (slope * (field(point) / steepness)).clamp_length_max(reach);
    }
    point
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tube() -> Loft {
        let station = |along: f32, r: f32| Station {
            along,
            extents: [r; 4],
        };
        Loft::new(
            Vec3::ZERO,
            Vec3::Y,
            Vec3::Z,
            [0.1, 0.2],
            vec![station(0.0, 0.1), station(0.5, 0.2), station(1.0, 0.2)],
        )
    }

    #[test]
    fn a_loft_passes_through_its_stations_and_caps() {
        let tube = tube();
        for on_surface in [
            Vec3::new(0.1, 0.0, 0.0),
            Vec3::new(0.0, 0.5, -0.2),
            Vec3::new(-0.2, 1.0, 0.0),
            Vec3::new(0.0, -0.1, 0.0),
            Vec3::new(0.0, 1.2, 0.0),
        ] {
            assert!(
                tube.distance(on_surface).abs() < 1e-5,
                "{on_surface}: {}",
                tube.distance(on_surface)
            );
        }
        assert!(tube.distance(Vec3::new(0.0, 0.5, 0.0)) < -0.1);
        assert!(tube.distance(Vec3::new(0.5, 0.5, 0.0)) > 0.2);
    }

    #[test]
    fn projection_lands_on_the_surface() {
        let tube = tube();
        let field = |point: Vec3| tube.distance(point);
        let landed = project(&field, Vec3::new(0.23, 0.4, 0.02), 0.1);
        assert!(field(landed).abs() < 1e-4, "{}", field(landed));
    }

    #[test]
    fn a_smooth_union_only_adds() {
        assert!(smooth_union(0.1, 0.1, 0.1) < 0.1);
        assert!((smooth_union(0.1, 0.5, 0.1) - 0.1).abs() < 1e-7);
        assert!(smooth_difference(-0.2, -0.1, 0.05) >= 0.1 - 1e-6);
    }
}
