use super::*;
use footfall_core::{ModelPose, Pose, Skeleton};

const RADIUS_M: f32 = 0.05;

fn rest() -> [Vec3; JOINT_COUNT] {
    let body = Skeleton::standard();
    ModelPose::of(&body, &Pose::rest(&body)).positions
}

/// A cylinder of many sides from a place to another.
fn cylinder(from: Vec3, to: Vec3, joint: Joint, colour: Vec3) -> Vec<Facet> {
    const MANY: usize = 24;
    let axis = (to - from).normalize();
    let side = axis.any_orthonormal_vector() * RADIUS_M;
    let around = |index: usize| {
        let angle = index as f32 * core::f32::consts::TAU / MANY as f32;
        glam::Quat::from_axis_angle(axis, angle) * side
    };
    (0..MANY)
        .flat_map(|index| {
            let (a, b) = (around(index), around(index + 1));
            [[from + a, from + b, to + a], [from + b, to + b, to + a]]
        })
        .map(|corners| Facet {
            corners,
            joint,
            colour,
        })
        .collect()
}

/// A cylinder along every bone, red on the left of the body and blue elsewhere.
fn figure(rest: &[Vec3; JOINT_COUNT]) -> Vec<Facet> {
    let mut facets = Vec::new();
    for joint in Joint::ALL {
        let place = rest[joint.index()];
        let below = Joint::ALL.into_iter().find(|below| {
            below.parent() == Some(joint)
                && *below != Joint::LeftUpperLeg
                && *below != Joint::LeftShoulder
        });
        let end = below.map_or_else(
            || match joint {
                Joint::Head => place + 0.2 * Vec3::Y,
                Joint::LeftHand => place + 0.15 * Vec3::X,
                Joint::RightHand => place - 0.15 * Vec3::X,
                _ => place + 0.08 * Vec3::Z,
            },
            |below| rest[below.index()],
        );
        let is_left = joint.name().starts_with("Left");
        let colour = if is_left { Vec3::X } else { Vec3::Z };
        facets.extend(cylinder(place, end, joint, colour));
    }
    facets
}

/// Volume inside a mesh whose triangles are clockwise as seen from outside.
fn volume(made: &StandIn) -> f32 {
    let place = |index: u32| made.vertices[index as usize].place;
    let triangles = made.indices.chunks_exact(3);
    triangles
        .map(|corners| {
            let [a, b, c] = [corners[0], corners[1], corners[2]].map(place);
            -a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

#[test]
fn a_body_becomes_a_hundred_triangles_that_look_outwards() {
    let rest = rest();
    let made = StandIn::new(&figure(&rest), &rest);
    let triangles = made.indices.len() / 3;
    assert!((60..=160).contains(&triangles), "{triangles} triangles");
    assert!(volume(&made) > 0.01, "{} m3 inside", volume(&made));
    let top = rest[Joint::Head.index()].y + 0.2;
    assert!((made.height_m() - top).abs() < 1e-3, "{}", made.height_m());
    for vertex in &made.vertices {
        assert!((vertex.normal.length() - 1.0).abs() < 1e-4);
    }
}

#[test]
fn a_tube_looks_as_wide_as_what_it_stands_for() {
    let rest = rest();
    let [hip, knee] = [Joint::LeftUpperLeg, Joint::LeftLowerLeg].map(|joint| rest[joint.index()]);
    let foot = rest[Joint::LeftFoot.index()];
    let mut facets = cylinder(hip, knee, Joint::LeftUpperLeg, Vec3::ONE);
    facets.extend(cylinder(knee, foot, Joint::LeftLowerLeg, Vec3::ONE));
    let made = StandIn::new(&facets, &rest);
    let middle = &made.vertices[SIDES..2 * SIDES];
    let side = |index: usize| {
        middle[index]
            .place
            .distance(middle[(index + 1) % SIDES].place)
    };
    let outline: f32 = (0..SIDES).map(side).sum();
    let round = core::f32::consts::TAU * RADIUS_M * section::FULLER;
    assert!(
        (outline / round - 1.0).abs() < 0.03,
        "{outline} for {round}"
    );
    let knee = middle.iter().map(|vertex| vertex.place).sum::<Vec3>() / SIDES as f32;
    assert!(knee.distance(rest[Joint::LeftLowerLeg.index()]) < 0.02);
    assert_eq!(middle[0].joints, [Joint::LeftUpperLeg, Joint::LeftLowerLeg]);
}

#[test]
fn parts_keep_their_colours_and_their_sides() {
    let rest = rest();
    let made = StandIn::new(&figure(&rest), &rest);
    let arms = made.vertices.iter().filter(|vertex| {
        let joint = vertex.joints[1].name();
        joint.ends_with("Arm") || joint.ends_with("Hand")
    });
    let mut sides = [0, 0];
    for vertex in arms {
        let is_left = vertex.place.x > 0.0;
        sides[usize::from(is_left)] += 1;
        assert_eq!(is_left, vertex.joints[1].name().starts_with("Left"));
        let colour = if is_left { Vec3::X } else { Vec3::Z };
        assert!(vertex.colour.distance(colour) < 1e-4, "{vertex:?}");
    }
    assert_eq!(sides[0], sides[1]);
}

#[test]
fn what_is_not_there_has_no_tube() {
    let rest = rest();
    assert_eq!(StandIn::new(&[], &rest), StandIn::default());
    let mut facets = figure(&rest);
    facets.retain(|facet| facet.joint != Joint::Head && facet.joint != Joint::Neck);
    let made = StandIn::new(&facets, &rest);
    assert!(!made.indices.is_empty());
    assert!(
        made.vertices
            .iter()
            .all(|vertex| vertex.joints[1] != Joint::Head)
    );
    let flat = Facet {
        corners: [Vec3::ZERO; 3],
        joint: Joint::Head,
        colour: Vec3::ONE,
    };
    assert_eq!(StandIn::new(&[flat], &rest), StandIn::default());
    let nowhere = [Vec3::NAN; JOINT_COUNT];
    let made = StandIn::new(&figure(&rest), &nowhere);
    assert_eq!(made, StandIn::default());
}
