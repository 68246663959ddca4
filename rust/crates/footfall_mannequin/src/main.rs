//! `cargo xtask mannequin`: the character of the demo, made from the canonical body.
//!
//! A distance field gives the shape, surface nets its triangles, diffusion its skin weights; glTF binary carries it to Godot
//! in three levels of detail. The same program always writes the same bytes.
#![expect(clippy::print_stderr, reason = "a command line tool talks to its user")]

mod body;
mod field;
mod glb;
mod paint;
mod rest;
mod surface_nets;
mod weights;

use anyhow::{Context as _, Result};
use body::Body;
use footfall_core::Skeleton;
use paint::Painted;
use std::path::PathBuf;
use surface_nets::Grid;

/// Spacing of the grid in metres, level by level.
const SPACINGS_M: [f32; 3] = [0.0155, 0.024, 0.038];

/// Writes the file that is named by the first argument.
fn main() -> Result<()> {
    let file = std::env::args_os().nth(1).map(PathBuf::from);
    let file = file.context("name the file to write, such as mannequin.glb")?;
    let bytes = make()?;
    std::fs::write(&file, &bytes).with_context(|| format!("cannot write {}", file.display()))?;
    eprintln!("{} ({} kB)", file.display(), bytes.len() / 1000);
    Ok(())
}

fn make() -> Result<Vec<u8>> {
    let skeleton = Skeleton::standard();
    let body = Body::new(&skeleton);
    let mut levels = Vec::new();
    for spacing in SPACINGS_M {
        let painted = sculpt(&skeleton, &body, spacing);
        eprintln!(
            "{} vertices, {} triangles",
            painted.mesh.positions.len(),
            painted.mesh.triangles.len()
        );
        levels.push(painted);
    }
    glb::encode(&skeleton, &levels)
}

/// One level of detail.
fn sculpt(skeleton: &Skeleton, body: &Body, spacing: f32) -> Painted {
    let mesh = surface_nets::polygonise(&|point| body.distance(point), &grid(spacing));
    let weights = weights::compute(skeleton, &mesh);
    paint::paint(body, mesh, weights)
}

/// Lines closer together where the shape is finer: the face, the hands, the feet.
fn grid(spacing: f32) -> Grid {
    let fine = |value: f32, from: f32, to: f32, factor: f32| {
        1.0 + (factor - 1.0) * field::smoothstep(0.0, 0.04, (value - from).min(to - value) + 0.02)
    };
    let half: Vec<f32> = lines(0.5 * spacing, 0.94, |x| {
        spacing * fine(x, 0.66, 1.0, 0.75) * fine(x, -1.0, 0.14, 0.85)
    });
    let x = half
        .iter()
        .rev()
        .map(|x| -x)
        .chain(half.iter().copied())
        .collect();
    let y = lines(-0.02, 1.8, |y| {
        spacing * fine(y, -0.1, 0.1, 0.7) * fine(y, 1.54, 1.9, 0.75) * fine(y, 1.38, 1.46, 0.7)
    });
    let z = lines(-0.2, 0.25, |_| spacing * 0.85);
    Grid { lines: [x, y, z] }
}

fn lines(from: f32, to: f32, step: impl Fn(f32) -> f32) -> Vec<f32> {
    let mut lines = vec![from];
    let mut last = from;
    while last < to {
        last += step(last);
        lines.push(last);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use body::Region;
    use footfall_core::{JOINT_COUNT, Joint};
    use glam::Vec3;
    use std::collections::BTreeMap;

    fn coarse() -> Painted {
        let skeleton = Skeleton::standard();
        sculpt(&skeleton, &Body::new(&skeleton), SPACINGS_M[2])
    }

    #[test]
    fn the_skin_is_closed_after_it_was_cut() {
        let painted = coarse();
        let mut edges = BTreeMap::new();
        for triangle in &painted.mesh.triangles {
            for corner in 0..3 {
                *edges
                    .entry((triangle[corner], triangle[(corner + 1) % 3]))
                    .or_insert(0) += 1;
            }
        }
        let open = edges
            .iter()
            .filter(|((from, to), count)| **count != 1 || edges.get(&(*to, *from)) != Some(&1));
        assert_eq!(open.count(), 0);
        for region in [Region::Shell, Region::Joint, Region::Left, Region::Right] {
            assert!(painted.regions.contains(&region), "{region:?}");
        }
    }

    #[test]
    fn every_bone_moves_skin_and_only_near_itself() {
        let painted = coarse();
        let mut moved = [0.0; JOINT_COUNT];
        for (position, weights) in painted.mesh.positions.iter().zip(&painted.weights) {
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
            assert!(weights.iter().filter(|&&weight| weight > 0.0).count() <= 4);
            for joint in Joint::ALL {
                moved[joint.index()] += weights[joint.index()];
                // A leg never pulls the other leg; between them the skin is one, over a cell of this grid.
                if weights[joint.index()] > 0.05 && joint.name().starts_with("Left") {
                    assert!(position.x > -0.045, "{} moves {position}", joint.name());
                }
            }
        }
        for joint in Joint::ALL {
            assert!(moved[joint.index()] > 1.0, "{} moves nothing", joint.name());
        }
    }

    #[test]
    fn a_fine_grid_is_even_and_mirrored() {
        let grid = grid(0.02);
        let [x, y, z] = &grid.lines;
        for lines in [x, y, z] {
            assert!(
                lines
                    .windows(2)
                    .all(|pair| pair[1] > pair[0] && pair[1] - pair[0] < 0.021)
            );
        }
        assert!(
            x.iter()
                .zip(x.iter().rev())
                .all(|(left, right)| (left + right).abs() < 1e-6)
        );
        let reach = Vec3::new(x[x.len() - 1], y[y.len() - 1], z[z.len() - 1]);
        assert!(reach.cmpgt(Vec3::new(0.9, 1.78, 0.22)).all());
    }
}
