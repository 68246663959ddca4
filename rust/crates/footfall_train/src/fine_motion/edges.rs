//! Edges that a walk loses on the way from captured steps to generated ones.

use footfall_core::Joint;
use footfall_model::{FEATURE_COUNT, FineMotion};

/// Factors on the detail of a part of the body.
#[derive(Clone, Copy)]
struct Edges {
    /// On what repeats from stride to stride.
    repeated: f64,
    /// On what does not.
    chance: f64,
}

/// Factors for the pelvis. Without them and [`TRUNK`]'s, the energies of third differences of generated pelvises, trunks and heads are 20 to 35 % below those of CMU's neutral
/// walkers: the mean of walkers whose edges fall at different moments is duller than each of them, and hips that are carried over planted feet lose more.
const PELVIS: Edges = Edges {
    repeated: 1.4,
    chance: 1.2,
};
/// Factors for the trunk, the neck and the head.
const TRUNK: Edges = Edges {
    repeated: 1.5,
    chance: 1.15,
};

/// Restores the edges of a walk's pelvis, trunk and head.
pub(crate) fn restore(fine: &mut FineMotion) {
    let tables = fine.walker.iter_mut().chain([&mut fine.shared]).flatten();
    for row in tables.flat_map(|table| table.chunks_exact_mut(FEATURE_COUNT)) {
        scale(row, |edges| edges.repeated);
    }
    for direction in &mut fine.chance.directions {
        scale(direction, |edges| edges.chance);
    }
}

fn scale(row: &mut [f64], factor: impl Fn(Edges) -> f64) {
    for (joint, values) in Joint::ALL.into_iter().zip(row.chunks_exact_mut(3)) {
        let edges = match joint {
            Joint::Hips => PELVIS,
            _ if joint.is_of_arm() || joint.is_of_leg() => continue,
            _ => TRUNK,
        };
        for value in values {
            *value *= factor(edges);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_model::{FINE_POINTS, FINE_TAPS, FineChance};

    #[test]
    fn pelvis_and_trunk_get_edges_and_limbs_stay() {
        let table = || [(); 2].map(|()| vec![1.0; FINE_POINTS * FEATURE_COUNT]);
        let mut fine = FineMotion {
            shared: table(),
            walker: vec![table()],
            chance: FineChance {
                kernels: vec![vec![1.0; FINE_TAPS]],
                directions: vec![vec![1.0; FEATURE_COUNT]],
                walker_strength: vec![0.0],
            },
            scale: vec![1.0; FEATURE_COUNT],
        };
        restore(&mut fine);
        let repeated = fine.walker.iter().chain([&fine.shared]).flatten();
        for row in repeated.flat_map(|table| table.chunks_exact(FEATURE_COUNT)) {
            for (joint, values) in Joint::ALL.into_iter().zip(row.chunks_exact(3)) {
                let is_limb = joint.index() >= Joint::LeftShoulder.index();
                let stronger = values.iter().all(|value| *value > 1.3);
                assert_eq!(stronger, !is_limb, "{joint:?}: {values:?}");
            }
        }
        let direction = &fine.chance.directions[0];
        assert!(direction[..3].iter().all(|value| *value > 1.1));
        let first_limb = 3 * Joint::LeftShoulder.index();
        assert_eq!(
            direction[first_limb..],
            vec![1.0; FEATURE_COUNT - first_limb]
        );
    }
}
