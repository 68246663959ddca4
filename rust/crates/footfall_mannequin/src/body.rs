//! The mannequin's shape: lofted limbs and trunk, an ellipsoid head, hands and shoes, over the canonical body.
//!
//! Only the left half (+X) is described; the field mirrors it. Sizes follow an adult of average build and 1.77 m.

mod limbs;

use super::field::{Loft, Shape, Station, smooth_difference, smooth_union, smoothstep};
use footfall_core::{Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use glam::Vec3;

/// The parts of the surface that differ in colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Region {
    /// The light shells.
    Shell,
    /// Dark: joints, hands, face.
    Joint,
    /// Shoe and cuff of the left side.
    Left,
    /// Shoe and cuff of the right side.
    Right,
}

/// A stretch of a limb with its own colour, set in a little.
struct Band {
    /// A point in the middle, the direction along the limb and half the length.
    middle: Vec3,
    along: Vec3,
    half_length: f32,
    /// Distance from the middle within which it counts, so that it stays on its limb.
    reach: f32,
    accent: bool,
}

/// The solid of which the mannequin is made.
pub(super) struct Body {
    /// Shapes of the left half and over what length each melts into those before.
    parts: Vec<(Shape, f32)>,
    hollows: Vec<(Shape, f32)>,
    bands: Vec<Band>,
}

/// Further away than any part of the body, metres.
const FAR_M: f32 = 100.0;
/// Depth of a band below the shells, metres.
const INSET_M: f32 = 0.003;

impl Body {
    /// The body over a skeleton's T-pose.
    pub(super) fn new(skeleton: &Skeleton) -> Self {
        let mut model = ModelPose::default();
        forward_kinematics(skeleton, &Pose::rest(skeleton), &mut model);
        let at = |joint: Joint| model.position(joint);
        let mut body = Self {
            parts: Vec::new(),
            hollows: Vec::new(),
            bands: Vec::new(),
        };
        body.trunk(&at);
        body.head(&at);
        body.arm(&at);
        body.leg(&at);
        body.foot(&at, skeleton);
        body.add_bands(&at);
        body
    }

    /// Signed distance to the surface.
    pub(super) fn distance(&self, point: Vec3) -> f32 {
        let half = Vec3::new(point.x.abs(), point.y, point.z);
        let solid = self.parts.iter().fold(FAR_M, |solid, (shape, blend)| {
            smooth_union(solid, shape.distance(half), *blend)
        });
        let hollowed = self.hollows.iter().fold(solid, |solid, (shape, blend)| {
            smooth_difference(solid, shape.distance(half), *blend)
        });
        let inset = hollowed + INSET_M * smoothstep(-0.002, 0.014, self.in_band(half));
        // Soles are flat.
        smooth_difference(inset, half.y, 0.012)
    }

    /// Number of bands.
    pub(super) fn bands(&self) -> usize {
        self.bands.len()
    }

    /// Above zero in one band: the distance to its nearer edge, metres.
    pub(super) fn in_one_band(&self, band: usize, point: Vec3) -> f32 {
        self.bands[band].inside(Vec3::new(point.x.abs(), point.y, point.z))
    }

    /// Above zero in any band.
    fn in_band(&self, point: Vec3) -> f32 {
        let half = Vec3::new(point.x.abs(), point.y, point.z);
        self.bands
            .iter()
            .map(|band| band.inside(half))
            .fold(f32::MIN, f32::max)
    }

    /// The region of a point on the surface.
    pub(super) fn region(&self, point: Vec3) -> Region {
        let half = Vec3::new(point.x.abs(), point.y, point.z);
        let strongest = self
            .bands
            .iter()
            .max_by(|a, b| a.inside(half).total_cmp(&b.inside(half)));
        match strongest {
            Some(band) if band.inside(half) > 0.0 => match (band.accent, point.x > 0.0) {
                (false, _) => Region::Joint,
                (true, true) => Region::Left,
                (true, false) => Region::Right,
            },
            _ => Region::Shell,
        }
    }

    fn add(&mut self, blend: f32, shape: Shape) {
        self.parts.push((shape, blend));
    }

    fn trunk(&mut self, at: &impl Fn(Joint) -> Vec3) {
        let floor = at(Joint::Hips);
        let station = |height: f32, side: f32, front: f32, back: f32| Station {
            along: height - 0.985,
            extents: [side, side, front, back],
        };
        let stations = vec![
            station(0.880, 0.050, 0.050, 0.055),
            station(0.915, 0.110, 0.078, 0.090),
            station(0.955, 0.146, 0.094, 0.112),
            station(1.005, 0.154, 0.099, 0.110),
            station(1.075, 0.142, 0.096, 0.088),
            station(1.135, 0.131, 0.094, 0.080),
            station(1.200, 0.136, 0.099, 0.086),
            station(1.290, 0.153, 0.108, 0.100),
            station(1.360, 0.164, 0.110, 0.108),
            station(1.415, 0.160, 0.099, 0.106),
            station(1.455, 0.130, 0.076, 0.090),
            station(1.490, 0.080, 0.052, 0.070),
        ];
        self.add(
            0.01,
            Shape::Loft(Loft::new(floor, Vec3::Y, Vec3::Z, [0.02, 0.03], stations)),
        );
        // Chest muscles and shoulder blades: hints only.
        self.add(
            0.05,
            Shape::Ellipsoid(
                Vec3::new(0.078, 1.372, 0.066),
                Vec3::new(0.078, 0.060, 0.038),
            ),
        );
        self.add(
            0.05,
            Shape::Ellipsoid(
                Vec3::new(0.075, 1.375, -0.075),
                Vec3::new(0.06, 0.08, 0.038),
            ),
        );
        // Buttocks.
        self.add(
            0.04,
            Shape::Ellipsoid(
                Vec3::new(0.078, 0.93, -0.050),
                Vec3::new(0.076, 0.085, 0.070),
            ),
        );
        // From the neck down to the shoulders.
        let neck = at(Joint::Neck);
        self.add(
            0.06,
            Shape::RoundCone {
                from: neck + Vec3::new(0.025, 0.0, -0.018),
                to: at(Joint::LeftUpperArm) + Vec3::new(-0.02, 0.022, -0.008),
                radii: [0.042, 0.046],
            },
        );
    }

    fn head(&mut self, at: &impl Fn(Joint) -> Vec3) {
        let head = at(Joint::Head);
        let neck = at(Joint::Neck);
        self.add(
            0.03,
            Shape::RoundCone {
                from: neck + Vec3::new(0.0, -0.02, -0.012),
                to: head + Vec3::new(0.0, 0.03, 0.004),
                radii: [0.060, 0.053],
            },
        );
        let part = |x: f32, y: f32, z: f32| head + Vec3::new(x, y, z);
        // Cranium, face and jaw.
        self.add(
            0.018,
            Shape::Ellipsoid(part(0.0, 0.088, -0.006), Vec3::new(0.077, 0.098, 0.096)),
        );
        self.add(
            0.03,
            Shape::Ellipsoid(part(0.0, 0.040, 0.030), Vec3::new(0.060, 0.075, 0.066)),
        );
        self.add(
            0.025,
            Shape::Ellipsoid(part(0.0, -0.020, 0.064), Vec3::new(0.030, 0.020, 0.024)),
        );
        self.add(
            0.03,
            Shape::Ellipsoid(part(0.0, 0.008, 0.066), Vec3::new(0.032, 0.030, 0.028)),
        );
        // A nose and shallow hollows for the eyes: enough to see where it looks.
        self.add(
            0.03,
            Shape::RoundCone {
                from: part(0.0, 0.078, 0.084),
                to: part(0.0, 0.036, 0.097),
                radii: [0.008, 0.0125],
            },
        );
        self.hollows.push((
            Shape::Ellipsoid(part(0.034, 0.064, 0.108), Vec3::new(0.026, 0.019, 0.024)),
            0.035,
        ));
    }

    fn add_bands(&mut self, at: &impl Fn(Joint) -> Vec3) {
        let mut band = |middle: Vec3, along: Vec3, half_length: f32, reach: f32, accent: bool| {
            self.bands.push(Band {
                middle,
                along,
                half_length,
                reach,
                accent,
            });
        };
        let (elbow, wrist) = (at(Joint::LeftLowerArm), at(Joint::LeftHand));
        let (knee, ankle) = (at(Joint::LeftLowerLeg), at(Joint::LeftFoot));
        band(elbow, Vec3::X, 0.026, 0.12, false);
        band(wrist + Vec3::X * 0.1, Vec3::X, 0.11, 0.25, false);
        band(wrist - Vec3::X * 0.032, Vec3::X, 0.022, 0.12, true);
        band(knee, Vec3::Y, 0.034, 0.15, false);
        band(
            at(Joint::Neck) + Vec3::new(0.0, 0.042, -0.01),
            Vec3::new(0.0, 0.94, 0.34).normalize(),
            0.023,
            0.09,
            false,
        );
        band(Vec3::new(0.0, 1.118, 0.0), Vec3::Y, 0.024, 0.25, false);
        // The shoe, from just above the ankle down, and the toe hinge within it.
        band(Vec3::new(ankle.x, 0.0, 0.06), Vec3::Y, 0.1, 0.3, true);
    }
}

impl Band {
    fn inside(&self, point: Vec3) -> f32 {
        let from_middle = point - self.middle;
        let edge = self.half_length - from_middle.dot(self.along).abs();
        edge.min(self.reach - from_middle.length())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_joint_lies_inside_and_soles_are_flat() {
        let skeleton = Skeleton::standard();
        let body = Body::new(&skeleton);
        let mut model = ModelPose::default();
        forward_kinematics(&skeleton, &Pose::rest(&skeleton), &mut model);
        for joint in Joint::ALL {
            assert!(
                body.distance(model.position(joint)) < 0.0,
                "{} is outside",
                joint.name()
            );
        }
        assert!(body.distance(Vec3::new(0.09, -0.002, 0.05)) > 0.0);
        assert!(body.distance(Vec3::new(0.09, 0.008, 0.12)) < 0.0);
        let top = model.position(Joint::Head) + skeleton.head_top;
        assert!(body.distance(top).abs() < 0.01, "{}", body.distance(top));
    }

    #[test]
    fn sides_differ_in_colour_only() {
        let body = Body::new(&Skeleton::standard());
        let (left, right) = (Vec3::new(0.09, 0.03, 0.1), Vec3::new(-0.09, 0.03, 0.1));
        assert_eq!(
            (body.region(left), body.region(right)),
            (Region::Left, Region::Right)
        );
        assert!((body.distance(left) - body.distance(right)).abs() < 1e-7);
        assert_eq!(body.region(Vec3::new(0.0, 1.3, 0.1)), Region::Shell);
    }
}
