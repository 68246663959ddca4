//! The tubes of a body: the part of the surface that each encloses, and its rings.

use footfall_core::Joint;
use footfall_core::Joint::{
    Chest, Head, Hips, LeftFoot, LeftHand, LeftLowerArm, LeftLowerLeg, LeftShoulder, LeftToes,
    LeftUpperArm, LeftUpperLeg, Neck, RightShoulder, Spine, UpperChest,
};

/// A tube around part of a body.
#[derive(Clone)]
pub(super) struct Shape {
    /// Joints whose surface it encloses.
    pub(super) facets: Vec<Joint>,
    /// Its axis: from the first joint to the second.
    pub(super) axis: [Joint; 2],
    /// True where the axis is level, as that of a foot.
    pub(super) is_level: bool,
    /// True where it ends inside another tube.
    pub(super) ends_inside: bool,
    /// Rings along the axis: their places, and the two joints that move each, half each.
    pub(super) rings: Vec<(Station, [Joint; 2])>,
}

/// Place of a ring along its axis.
#[derive(Clone, Copy)]
pub(super) enum Station {
    /// Beginning of the surface.
    Begin,
    /// At a joint.
    At(Joint),
    /// At a share of the way from a joint to the surface's end.
    Beyond(Joint, f32),
    /// End of the surface.
    End,
}

use Station::{At, Begin, Beyond, End};

/// Trunk, head, arms, legs and feet.
pub(super) fn tubes() -> Vec<Shape> {
    let trunk = Shape {
        facets: vec![Hips, Spine, Chest, UpperChest, LeftShoulder, RightShoulder],
        axis: [Hips, Neck],
        is_level: false,
        ends_inside: false,
        rings: vec![
            (Begin, [Hips; 2]),
            (At(LeftUpperLeg), [Hips; 2]),
            (At(Spine), [Hips, Spine]),
            (At(UpperChest), [Chest, UpperChest]),
            (Beyond(LeftUpperArm, 0.3), [UpperChest; 2]),
        ],
    };
    let head = Shape {
        facets: vec![Neck, Head],
        axis: [Neck, Head],
        is_level: false,
        ends_inside: false,
        rings: vec![
            (At(Neck), [UpperChest, Neck]),
            (Beyond(Head, 0.1), [Head; 2]),
            (Beyond(Head, 0.5), [Head; 2]),
            (End, [Head; 2]),
        ],
    };
    let arm = Shape {
        facets: vec![LeftUpperArm, LeftLowerArm, LeftHand],
        axis: [LeftUpperArm, LeftHand],
        is_level: false,
        ends_inside: false,
        rings: vec![
            (At(LeftUpperArm), [LeftShoulder, LeftUpperArm]),
            (At(LeftLowerArm), [LeftUpperArm, LeftLowerArm]),
            (End, [LeftHand; 2]),
        ],
    };
    let leg = Shape {
        facets: vec![LeftUpperLeg, LeftLowerLeg],
        axis: [LeftUpperLeg, LeftFoot],
        is_level: false,
        ends_inside: true,
        rings: vec![
            // Above this a thigh is cut off askew.
            (Beyond(LeftUpperLeg, 0.1), [LeftUpperLeg; 2]),
            (At(LeftLowerLeg), [LeftUpperLeg, LeftLowerLeg]),
            (End, [LeftLowerLeg; 2]),
        ],
    };
    let foot = Shape {
        facets: vec![LeftFoot, LeftToes],
        axis: [LeftFoot, LeftToes],
        is_level: true,
        ends_inside: false,
        rings: vec![(Begin, [LeftFoot; 2]), (End, [LeftToes; 2])],
    };
    let both = [arm, leg, foot]
        .into_iter()
        .flat_map(|left| [left.mirrored(), left]);
    [trunk, head].into_iter().chain(both).collect()
}

impl Shape {
    /// The same on the other side of the body.
    fn mirrored(&self) -> Self {
        let mut made = self.clone();
        let joints = made.facets.iter_mut().chain(&mut made.axis);
        let of_rings = made.rings.iter_mut().flat_map(|(_, joints)| joints);
        for joint in joints.chain(of_rings) {
            *joint = joint.mirrored();
        }
        for (station, _) in &mut made.rings {
            if let At(joint) | Beyond(joint, _) = station {
                *joint = joint.mirrored();
            }
        }
        made
    }
}
