//! Looks about: when the gaze jumps, how far, and what the body does with it.

use super::{Offsets, Person, RATE_HZ, Stretch, mirrored};
use crate::averages::upper_median;
use footfall_imu::filter::low_pass;
use footfall_model::{LOOK_DIRECTIONS, Looks, SWAY_COUNT};
use glam::Vec3;
use nalgebra::{DMatrix, DVector};

/// Faster turns of the head are noise, hertz.
const CUT_OFF_HZ: f64 = 1.5;

/// A jump is faster than this somewhere, and lasts while it is faster than the other, rad/s; smaller ones than this are sway, radians.
const JUMP_RADPS: f64 = 0.26;
const STILL_RADPS: f64 = 0.07;
const LEAST_JUMP: f64 = 0.12;

/// Of looks without any jump: those who never look need a length for one, seconds.
const USUAL_SHIFT_SECS: f64 = 1.2;

/// Regularisation of the regression for people who hardly look around, rad².
const LEAST_ENERGY: f64 = 1e-6;

/// A jump of the gaze between two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Jump {
    from: usize,
    to: usize,
}

/// Removes looks from all offsets, and returns them.
pub(super) fn take_out(people: &[Person], offsets: &mut [Vec<Offsets>]) -> Looks {
    let paths: Vec<Vec<Vec<[f64; 2]>>> = people
        .iter()
        .map(|person| person.stretches.iter().map(path).collect())
        .collect();
    let directions = regress(people, &paths, offsets);
    for (paths, offsets) in paths.iter().zip(offsets) {
        for (path, rows) in paths.iter().zip(offsets) {
            for (gaze, row) in path.iter().zip(rows) {
                for (direction, gaze) in directions.iter().zip(gaze) {
                    for (value, slope) in row.iter_mut().zip(direction) {
                        *value -= slope * gaze;
                    }
                }
            }
        }
    }
    let spread = spread(people, &paths);
    let directions = directions.iter().zip(spread);
    let (rate_hz, shift_secs) = rhythm(people);
    Looks {
        rate_hz,
        shift_secs,
        directions: directions
            .map(|(row, spread)| row.iter().map(|value| spread * value).collect())
            .collect(),
    }
}

/// Jumps of the gaze to the side.
fn jumps(stretch: &Stretch) -> Vec<Jump> {
    let yaw: Vec<f64> = smooth(&stretch.gaze).iter().map(|gaze| gaze[0]).collect();
    let speed: Vec<f64> = yaw
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) * RATE_HZ)
        .collect();
    let mut jumps: Vec<Jump> = Vec::new();
    let mut frame = 0;
    while frame < speed.len() {
        if speed[frame].abs() < JUMP_RADPS {
            frame += 1;
            continue;
        }
        let moves = |other: &usize| speed[*other] * speed[frame].signum() > STILL_RADPS;
        let from = (0..frame).rev().take_while(moves).last().unwrap_or(frame);
        let to = (frame..speed.len())
            .take_while(moves)
            .last()
            .unwrap_or(frame)
            + 1;
        if (yaw[to] - yaw[from]).abs() > LEAST_JUMP {
            jumps.push(Jump { from, to });
        }
        frame = to + 1;
    }
    jumps
}

fn smooth(gaze: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let values: Vec<Vec3> = gaze
        .iter()
        .map(|[yaw, down]| Vec3::new(*yaw as f32, *down as f32, 0.0))
        .collect();
    let smoothed = low_pass(&values, RATE_HZ, CUT_OFF_HZ);
    let narrow = smoothed.into_iter();
    narrow.map(|v| [f64::from(v.x), f64::from(v.y)]).collect()
}

/// Returns the path of a gaze that rests between its jumps, and goes along a smooth step in them.
fn path(stretch: &Stretch) -> Vec<[f64; 2]> {
    let jumps = jumps(stretch);
    let frames = stretch.frames();
    let begins = core::iter::once(0).chain(jumps.iter().map(|jump| jump.to));
    let ends = jumps.iter().map(|jump| jump.from).chain([frames - 1]);
    let rests: Vec<[f64; 2]> = begins
        .zip(ends)
        .map(|(begin, end)| {
            let rows = &stretch.gaze[begin..=end.max(begin)];
            core::array::from_fn(|axis| {
                rows.iter().map(|row| row[axis]).sum::<f64>() / rows.len() as f64
            })
        })
        .collect();
    let mut path = vec![rests[0]; frames];
    for (jump, pair) in jumps.iter().zip(rests.windows(2)) {
        for (frame, gaze) in path.iter_mut().enumerate().skip(jump.from) {
            let part = (frame - jump.from) as f64 / (jump.to - jump.from) as f64;
            let part = part.min(1.0);
            let share = part * part * (3.0 - 2.0 * part);
            *gaze = core::array::from_fn(|axis| {
                pair[0][axis] + share * (pair[1][axis] - pair[0][axis])
            });
        }
    }
    path
}

/// Motion of the body, a radian of gaze, by a regression within stretches.
fn regress(
    people: &[Person],
    paths: &[Vec<Vec<[f64; 2]>>],
    offsets: &[Vec<Offsets>],
) -> Vec<Vec<f64>> {
    let mut energy = DMatrix::<f64>::identity(LOOK_DIRECTIONS, LOOK_DIRECTIONS) * LEAST_ENERGY;
    let mut together = DMatrix::<f64>::zeros(LOOK_DIRECTIONS, SWAY_COUNT);
    for ((person, paths), offsets) in people.iter().zip(paths).zip(offsets) {
        let frames: usize = person.stretches.iter().map(Stretch::frames).sum();
        let weight = person.weight / frames as f64;
        for (path, rows) in paths.iter().zip(offsets) {
            let mean_gaze: [f64; 2] = mean(path);
            let mean_row: [f64; SWAY_COUNT] = mean(rows);
            for (gaze, row) in path.iter().zip(rows) {
                let gaze =
                    DVector::from_fn(LOOK_DIRECTIONS, |axis, _| gaze[axis] - mean_gaze[axis]);
                let row: [f64; SWAY_COUNT] = core::array::from_fn(|n| row[n] - mean_row[n]);
                // The mirrored body looks to the other side.
                let other = DVector::from_vec(vec![-gaze[0], gaze[1]]);
                for (gaze, row) in [(&gaze, row), (&other, mirrored(&row))] {
                    energy += weight * gaze * gaze.transpose();
                    together += weight * gaze * DVector::from_row_slice(&row).transpose();
                }
            }
        }
    }
    let slopes = energy.try_inverse().map_or_else(
        || DMatrix::zeros(LOOK_DIRECTIONS, SWAY_COUNT),
        |inverse| inverse * together,
    );
    let rows = slopes.row_iter();
    rows.map(|row| row.iter().copied().collect()).collect()
}

fn mean<const N: usize>(rows: &[[f64; N]]) -> [f64; N] {
    core::array::from_fn(|n| rows.iter().map(|row| row[n]).sum::<f64>() / rows.len().max(1) as f64)
}

/// Standard deviation of where the gaze rests, about each person's own mean, radians to the side and down: the mean of those who look about.
fn spread(people: &[Person], paths: &[Vec<Vec<[f64; 2]>>]) -> [f64; LOOK_DIRECTIONS] {
    let (mut sums, mut total) = ([0.0; LOOK_DIRECTIONS], 0.0);
    for (person, paths) in people.iter().zip(paths) {
        if person
            .stretches
            .iter()
            .all(|stretch| jumps(stretch).is_empty())
        {
            continue;
        }
        let all: Vec<[f64; 2]> = paths.concat();
        let mean = mean(&all);
        total += person.weight;
        for (axis, sum) in sums.iter_mut().enumerate() {
            let squares = all.iter().map(|gaze| (gaze[axis] - mean[axis]).powi(2));
            *sum += person.weight * (squares.sum::<f64>() / all.len() as f64).sqrt();
        }
    }
    sums.map(|sum| sum / f64::max(total, f64::MIN_POSITIVE))
}

/// Jumps a second of the mean person, and how long one lasts.
fn rhythm(people: &[Person]) -> (f64, f64) {
    let (mut rate, mut total) = (0.0, 0.0);
    let mut lengths = Vec::new();
    for person in people {
        let found: Vec<Jump> = person.stretches.iter().flat_map(jumps).collect();
        let frames: usize = person.stretches.iter().map(Stretch::frames).sum();
        rate += person.weight * found.len() as f64 * RATE_HZ / frames as f64;
        total += person.weight;
        lengths.extend(
            found
                .iter()
                .map(|jump| (jump.to - jump.from) as f64 / RATE_HZ),
        );
    }
    (
        rate / total,
        upper_median(lengths).unwrap_or(USUAL_SHIFT_SECS),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_model::FEATURE_COUNT;

    /// Looks between two places every four seconds, with a slow sway of half a degree on top.
    fn looking(frames: usize) -> Stretch {
        let gaze = (0..frames).map(|frame| {
            let secs = frame as f64 / RATE_HZ;
            let part = ((secs % 4.0) / 1.0).min(1.0);
            let share = part * part * (3.0 - 2.0 * part);
            let up = ((secs / 4.0) as usize).is_multiple_of(2);
            let yaw = if up { 0.6 * share } else { 0.6 * (1.0 - share) };
            [yaw + 0.009 * (0.7 * secs).sin(), 0.1]
        });
        Stretch {
            begin_secs: 0.0,
            features: vec![vec![0.0; FEATURE_COUNT]; frames],
            hips: vec![[0.0; 2]; frames],
            head: vec![[0.0; 2]; frames],
            gaze: gaze.collect(),
            turned_out: 0.0,
        }
    }

    #[test]
    fn looks_are_found_and_taken_out() {
        let frames = (80.0 * RATE_HZ) as usize;
        let person = Person {
            name: "one".to_owned(),
            stretches: vec![looking(frames)],
            weight: 1.0,
        };
        // The trunk follows by a quarter, and something else goes on at the same time.
        let rows: Offsets = person.stretches[0]
            .gaze
            .iter()
            .enumerate()
            .map(|(frame, gaze)| {
                let mut row = [0.0; SWAY_COUNT];
                row[4] = 0.25 * gaze[0];
                row[40] = 0.02 * (1.3 * frame as f64 / RATE_HZ).sin();
                row
            })
            .collect();
        let mut offsets = vec![vec![rows]];
        let looks = take_out(&[person], &mut offsets);
        assert!((looks.rate_hz - 0.25).abs() < 0.02, "{}", looks.rate_hz);
        assert!(
            (0.6..1.3).contains(&looks.shift_secs),
            "{}",
            looks.shift_secs
        );
        let [yaw, _] = [&looks.directions[0], &looks.directions[1]];
        assert!((yaw[4] - 0.25 * 0.27).abs() < 0.02, "{}", yaw[4]);
        // What is left are the sway and half a degree.
        let left = offsets[0][0]
            .iter()
            .map(|row| row[4].abs())
            .fold(0.0, f64::max);
        assert!(left < 0.1, "{left}");
        let kept = offsets[0][0]
            .iter()
            .map(|row| row[40].abs())
            .fold(0.0, f64::max);
        assert!((kept - 0.02).abs() < 5e-3, "{kept}");
    }
}
