//! Skin weights: each vertex starts on the bone that it is nearest to, then the weights diffuse along the surface.
//!
//! Diffusion along the surface, unlike blending by distance in space, never leaks from one thigh to the other or from the
//! arm to the ribs. How far it goes differs by joint: a hip bends over more skin than a wrist.

use super::surface_nets::{Mesh, neighbours};
use footfall_core::{JOINT_COUNT, Joint, ModelPose, Pose, Side, Skeleton, forward_kinematics};
use glam::Vec3;

/// The share of each joint in moving a vertex; sums to 1.
pub(super) type Weights = [f32; JOINT_COUNT];

/// A round stretch of the body that a joint moves.
struct Territory {
    joint: Joint,
    from: Vec3,
    to: Vec3,
    radius: f32,
}

/// Width over which the weights of neighbouring joints blend: standard deviation along the skin, metres.
fn spread(joint: Joint) -> f32 {
    match joint {
        Joint::Spine | Joint::Chest | Joint::UpperChest => 0.045,
        Joint::Neck | Joint::Head => 0.022,
        Joint::LeftShoulder | Joint::RightShoulder => 0.04,
        Joint::LeftUpperArm | Joint::RightUpperArm => 0.034,
        Joint::LeftLowerArm | Joint::RightLowerArm => 0.02,
        Joint::LeftHand | Joint::RightHand => 0.012,
        Joint::Hips | Joint::LeftUpperLeg | Joint::RightUpperLeg => 0.036,
        Joint::LeftLowerLeg | Joint::RightLowerLeg => 0.027,
        Joint::LeftFoot | Joint::RightFoot => 0.018,
        Joint::LeftToes | Joint::RightToes => 0.014,
    }
}

fn territories(skeleton: &Skeleton, model: &ModelPose) -> Vec<Territory> {
    let at = |joint: Joint| model.position(joint);
    let mut all = Vec::new();
    let mut add = |joint: Joint, from: Vec3, to: Vec3, radius: f32| {
        all.push(Territory {
            joint,
            from,
            to,
            radius,
        });
    };
    let up = |metres: f32| Vec3::Y * metres;
    let hips = at(Joint::Hips) - up(0.015);
    add(
        Joint::Hips,
        hips - Vec3::X * 0.07,
        hips + Vec3::X * 0.07,
        0.11,
    );
    add(
        Joint::Spine,
        at(Joint::Spine) + up(0.02),
        at(Joint::Chest),
        0.13,
    );
    add(Joint::Chest, at(Joint::Chest), at(Joint::UpperChest), 0.13);
    add(
        Joint::UpperChest,
        at(Joint::UpperChest),
        at(Joint::Neck) - up(0.085),
        0.13,
    );
    let head = at(Joint::Head);
    add(Joint::Neck, at(Joint::Neck), head, 0.08);
    add(
        Joint::Head,
        head + up(0.02),
        head + skeleton.head_top - up(0.07),
        0.09,
    );
    // The jaw, which hangs in front of the neck.
    let front = Vec3::Z;
    add(
        Joint::Head,
        head + up(0.015) + front * 0.04,
        head - up(0.01) + front * 0.06,
        0.06,
    );
    for side in Side::BOTH {
        let outward = Vec3::X * side.sign();
        let arm = |n: usize| {
            let shoulder = if side == Side::Left {
                Joint::LeftShoulder
            } else {
                Joint::RightShoulder
            };
            Joint::ALL[shoulder.index() + n]
        };
        add(arm(0), at(arm(0)) + outward * 0.05, at(arm(1)), 0.05);
        add(arm(1), at(arm(1)), at(arm(2)), 0.05);
        add(arm(2), at(arm(2)), at(arm(3)), 0.05);
        add(arm(3), at(arm(3)), at(arm(3)) + outward * 0.18, 0.05);
        let (hip, knee, ankle, toes) =
            (side.upper_leg(), side.lower_leg(), side.foot(), side.toes());
        add(hip, at(hip) - up(0.025), at(knee), 0.075);
        add(knee, at(knee), at(ankle), 0.075);
        let foot = skeleton.foot(side);
        let sole = at(toes) + foot.ball;
        add(
            ankle,
            at(ankle) - up(0.02),
            sole.with_z(at(toes).z - 0.03),
            0.075,
        );
        add(
            ankle,
            at(ankle) - up(0.02),
            at(ankle) + foot.heel * 0.8,
            0.075,
        );
        add(
            toes,
            at(toes) + Vec3::Z * 0.03,
            at(toes) + foot.toe_tip,
            0.075,
        );
    }
    all
}

/// Weights of each vertex of a mesh in the T-pose.
pub(super) fn compute(skeleton: &Skeleton, mesh: &Mesh) -> Vec<Weights> {
    let mut model = ModelPose::default();
    forward_kinematics(skeleton, &Pose::rest(skeleton), &mut model);
    let territories = territories(skeleton, &model);
    let mut weights: Vec<Weights> = mesh
        .positions
        .iter()
        .map(|&position| {
            let mut weights = [0.0; JOINT_COUNT];
            weights[owner(&territories, position).index()] = 1.0;
            weights
        })
        .collect();
    let neighbours = neighbours(mesh.positions.len(), &mesh.triangles);
    let spreads: Vec<f32> = mesh
        .positions
        .iter()
        .map(|&position| spread_at(&model, position))
        .collect();
    diffuse(mesh, &neighbours, &spreads, &mut weights);
    weights.iter().map(strongest_four).collect()
}

fn owner(territories: &[Territory], point: Vec3) -> Joint {
    let distance = |one: &Territory| {
        let axis = one.to - one.from;
        let along =
            ((point - one.from).dot(axis) / axis.length_squared().max(1e-9)).clamp(0.0, 1.0);
        point.distance(one.from + axis * along) - one.radius
    };
    let nearest = territories
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.map_or(Joint::Hips, |territory| territory.joint)
}

/// The spread of the joints around, the nearer the more.
fn spread_at(model: &ModelPose, point: Vec3) -> f32 {
    let (mut sum, mut total) = (0.0, 0.0);
    for joint in Joint::ALL {
        let nearness = 1.0 / (model.position(joint).distance_squared(point).powi(2) + 1e-6);
        sum += nearness * spread(joint);
        total += nearness;
    }
    sum / total
}

/// Explicit diffusion; per pass a vertex moves towards its neighbours' mean by what its spread and edge length ask for.
fn diffuse(mesh: &Mesh, neighbours: &[Vec<u32>], spreads: &[f32], weights: &mut Vec<Weights>) {
    let edge_squared = |vertex: usize| {
        let near = &neighbours[vertex];
        let position = mesh.positions[vertex];
        let sum: f32 = near
            .iter()
            .map(|&other| mesh.positions[other as usize].distance_squared(position))
            .sum();
        sum / near.len().max(1) as f32
    };
    // One pass at rate r adds r·e²/2 to the variance per direction.
    let needed: Vec<f32> = (0..weights.len())
        .map(|v| 2.0 * spreads[v].powi(2) / edge_squared(v).max(1e-8))
        .collect();
    let largest = needed.iter().copied().fold(0.0, f32::max);
    let passes = (largest / 0.6).ceil().max(1.0);
    for _ in 0..passes as usize {
        let old = weights.clone();
        for (vertex, mine) in weights.iter_mut().enumerate() {
            let near = &neighbours[vertex];
            let rate = needed[vertex] / passes / near.len().max(1) as f32;
            for &other in near {
                for joint in 0..JOINT_COUNT {
                    mine[joint] += rate * (old[other as usize][joint] - old[vertex][joint]);
                }
            }
        }
    }
}

/// Keeps the four largest weights, drops traces, and scales to a sum of 1.
pub(super) fn strongest_four(weights: &Weights) -> Weights {
    let mut order: Vec<usize> = (0..JOINT_COUNT).collect();
    order.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]));
    let mut kept = [0.0; JOINT_COUNT];
    for &joint in order.iter().take(4).filter(|&&joint| weights[joint] > 0.01) {
        kept[joint] = weights[joint];
    }
    let sum: f32 = kept.iter().sum();
    kept.map(|weight| weight / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_weights_remain_and_sum_to_one() {
        let mut weights = [0.0; JOINT_COUNT];
        for (joint, weight) in [
            (0, 0.3),
            (3, 0.25),
            (5, 0.2),
            (7, 0.15),
            (9, 0.095),
            (11, 0.005),
        ] {
            weights[joint] = weight;
        }
        let kept = strongest_four(&weights);
        assert_eq!(kept.iter().filter(|&&weight| weight > 0.0).count(), 4);
        assert!((kept.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        assert!(kept[9] == 0.0 && kept[0] > kept[3]);
    }

    #[test]
    fn middles_of_limbs_belong_to_their_bones() {
        let skeleton = Skeleton::standard();
        let mut model = ModelPose::default();
        forward_kinematics(&skeleton, &Pose::rest(&skeleton), &mut model);
        let territories = territories(&skeleton, &model);
        for (joint, child) in [
            (Joint::LeftUpperArm, Joint::LeftLowerArm),
            (Joint::RightLowerArm, Joint::RightHand),
            (Joint::LeftUpperLeg, Joint::LeftLowerLeg),
            (Joint::RightLowerLeg, Joint::RightFoot),
            (Joint::Chest, Joint::UpperChest),
        ] {
            let middle = model.position(joint).midpoint(model.position(child));
            assert_eq!(owner(&territories, middle + Vec3::Z * 0.05), joint);
        }
    }
}
