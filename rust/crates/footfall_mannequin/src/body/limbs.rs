//! Arms, hands, legs and shoes.

use super::Body;
use crate::field::{Loft, Shape, Station};
use footfall_core::{Joint, Side, Skeleton};
use glam::{Quat, Vec3};

/// The fingers' phalanges, from the knuckles on: bend from the palm in degrees, length, and half the width and the thickness where each begins and ends, metres.
const PHALANGES: [(f32, f32, [f32; 2], [f32; 2]); 3] = [
    (28.0, 0.042, [0.040, 0.0150], [0.037, 0.0140]),
    (60.0, 0.026, [0.037, 0.0140], [0.034, 0.0130]),
    (85.0, 0.020, [0.034, 0.0130], [0.027, 0.0115]),
];

impl Body {
    pub(super) fn arm(&mut self, at: &impl Fn(Joint) -> Vec3) {
        let (shoulder, elbow, wrist) = (
            at(Joint::LeftUpperArm),
            at(Joint::LeftLowerArm),
            at(Joint::LeftHand),
        );
        // Along +X with the front at +Z, the side is up: +side is +Y … of `along × front` = X × Z = −Y.
        let station = |along: f32, up: f32, down: f32, front: f32, back: f32| Station {
            along,
            extents: [down, up, front, back],
        };
        let upper = elbow.x - shoulder.x;
        let stations = vec![
            station(-0.05, 0.040, 0.058, 0.052, 0.052),
            station(0.0, 0.052, 0.064, 0.058, 0.058),
            station(0.05, 0.056, 0.057, 0.057, 0.056),
            station(0.12, 0.048, 0.047, 0.049, 0.048),
            station(0.19, 0.043, 0.043, 0.044, 0.044),
            station(upper - 0.03, 0.037, 0.037, 0.039, 0.039),
            station(upper, 0.037, 0.036, 0.039, 0.039),
        ];
        self.add(
            0.045,
            Shape::Loft(Loft::new(
                shoulder,
                Vec3::X,
                Vec3::Z,
                [0.02, 0.02],
                stations,
            )),
        );
        let lower = wrist.x - elbow.x;
        let stations = vec![
            station(0.0, 0.036, 0.036, 0.039, 0.038),
            station(0.03, 0.038, 0.038, 0.042, 0.040),
            station(0.075, 0.039, 0.039, 0.044, 0.041),
            station(0.15, 0.031, 0.031, 0.036, 0.034),
            station(lower - 0.02, 0.022, 0.022, 0.029, 0.028),
            station(lower, 0.021, 0.021, 0.028, 0.027),
        ];
        self.add(
            0.02,
            Shape::Loft(Loft::new(elbow, Vec3::X, Vec3::Z, [0.02, 0.012], stations)),
        );
        self.hand(wrist);
    }

    /// A relaxed mitten: palm down, fingers together and curled, thumb to the front.
    fn hand(&mut self, wrist: Vec3) {
        let station = |along: f32, up: f32, down: f32, front: f32, back: f32| Station {
            along,
            extents: [down, up, front, back],
        };
        let palm = vec![
            station(-0.01, 0.018, 0.018, 0.026, 0.026),
            station(0.02, 0.017, 0.018, 0.031, 0.031),
            station(0.06, 0.015, 0.018, 0.041, 0.039),
            station(0.095, 0.014, 0.015, 0.041, 0.040),
        ];
        self.add(
            0.015,
            Shape::Loft(Loft::new(wrist, Vec3::X, Vec3::Z, [0.012, 0.012], palm)),
        );
        let knuckles = wrist + Vec3::new(0.09, 0.0, 0.0);
        let mut joint = knuckles;
        for (degrees, length, from, to) in PHALANGES {
            let along = Quat::from_rotation_z(-f32::to_radians(degrees)) * Vec3::X;
            let row =
                |along: f32, [wide, thick]: [f32; 2]| station(along, thick, thick, wide, wide);
            let stations = vec![row(0.0, from), row(length, to)];
            self.add(
                0.010,
                Shape::Loft(Loft::new(joint, along, Vec3::Z, [0.010, 0.012], stations)),
            );
            joint += along * length;
        }
        let base = wrist + Vec3::new(0.025, -0.006, 0.022);
        let knuckle = wrist + Vec3::new(0.062, -0.012, 0.056);
        let tip = wrist + Vec3::new(0.098, -0.018, 0.066);
        self.add(
            0.02,
            Shape::RoundCone {
                from: base,
                to: knuckle,
                radii: [0.017, 0.0125],
            },
        );
        self.add(
            0.012,
            Shape::RoundCone {
                from: knuckle,
                to: tip,
                radii: [0.0125, 0.0095],
            },
        );
    }

    pub(super) fn leg(&mut self, at: &impl Fn(Joint) -> Vec3) {
        let (hip, knee, ankle) = (
            at(Joint::LeftUpperLeg),
            at(Joint::LeftLowerLeg),
            at(Joint::LeftFoot),
        );
        // Along −Y with the front at +Z, `along × front` is −X: the first extent is the inner side.
        let station = |along: f32, outer: f32, inner: f32, front: f32, back: f32| Station {
            along,
            extents: [inner, outer, front, back],
        };
        let upper = hip.y - knee.y;
        let stations = vec![
            station(-0.02, 0.064, 0.068, 0.078, 0.085),
            station(0.06, 0.074, 0.075, 0.083, 0.087),
            station(0.14, 0.075, 0.073, 0.082, 0.080),
            station(0.24, 0.066, 0.066, 0.074, 0.068),
            station(0.34, 0.056, 0.057, 0.062, 0.056),
            station(upper - 0.03, 0.052, 0.053, 0.058, 0.052),
            station(upper, 0.051, 0.052, 0.058, 0.049),
        ];
        self.add(
            0.045,
            Shape::Loft(Loft::new(hip, Vec3::NEG_Y, Vec3::Z, [0.05, 0.03], stations)),
        );
        let lower = knee.y - ankle.y;
        let stations = vec![
            station(0.0, 0.050, 0.051, 0.056, 0.049),
            station(0.05, 0.051, 0.050, 0.049, 0.056),
            station(0.12, 0.054, 0.051, 0.046, 0.070),
            station(0.19, 0.050, 0.046, 0.043, 0.064),
            station(0.28, 0.038, 0.037, 0.038, 0.043),
            station(lower - 0.05, 0.032, 0.031, 0.035, 0.033),
            station(lower, 0.034, 0.033, 0.036, 0.036),
        ];
        self.add(
            0.025,
            Shape::Loft(Loft::new(
                knee,
                Vec3::NEG_Y,
                Vec3::Z,
                [0.03, 0.02],
                stations,
            )),
        );
    }

    /// A plain shoe: heel, arch, ball and toe box on a flat sole.
    pub(super) fn foot(&mut self, at: &impl Fn(Joint) -> Vec3, skeleton: &Skeleton) {
        let ankle = at(Joint::LeftFoot);
        let toes = at(Joint::LeftToes);
        let shape = skeleton.foot(Side::Left);
        let heel = (ankle + shape.heel).z;
        let tip = (toes + shape.toe_tip).z;
        let base = Vec3::new(ankle.x, 0.022, 0.0);
        // Along +Z with the front up, `along × front` is −X: the first extent is the inner side.
        let station = |along: f32, outer: f32, inner: f32, height: f32| Station {
            along,
            extents: [inner, outer, height, 0.034],
        };
        let stations = vec![
            station(heel + 0.014, 0.028, 0.028, 0.048),
            station(heel + 0.045, 0.036, 0.035, 0.068),
            station(heel + 0.085, 0.038, 0.034, 0.072),
            station(heel + 0.125, 0.042, 0.036, 0.056),
            station(heel + 0.165, 0.049, 0.043, 0.041),
            station(toes.z + 0.015, 0.050, 0.047, 0.033),
            station(tip - 0.035, 0.041, 0.042, 0.028),
            station(tip - 0.012, 0.027, 0.030, 0.022),
        ];
        self.add(
            0.022,
            Shape::Loft(Loft::new(base, Vec3::Z, Vec3::Y, [0.014, 0.012], stations)),
        );
    }
}
