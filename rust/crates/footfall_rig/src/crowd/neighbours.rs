//! Neighbours: a grid over the plane, rebuilt as walkers move.

use glam::{IVec2, Vec2};

/// Distance at which walkers notice others, metres.
pub(super) const SIGHT_M: f32 = 6.0;
/// Side of a cell, metres.
const CELL_M: f32 = 1.5;
/// Approximate number of visible neighbours: in a dense crowd the nearest hide the others.
const MOST_IN_SIGHT: f32 = 48.0;
/// Most neighbours that are considered, where the crowd is denser than around it.
const MOST_LOOKED_AT: usize = 128;
/// Distance within which all neighbours count, whatever their number, metres.
const LEAST_SIGHT_M: f32 = 1.5;

/// Least number of buckets: with few buckets, distant walkers share them.
const LEAST_BUCKETS: usize = 4096;
/// Factor between rows of cells: successive cells of a row are also successive in memory, and nearby rows never share buckets.
const ROW: u32 = 0x9e37_79b1;

/// A person whom walkers avoid: another walker, or a player.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Passerby {
    /// Place in the plane of the crowd, metres: x and z of its space.
    pub place: Vec2,
    /// Velocity there, m/s.
    pub velocity: Vec2,
}

impl Passerby {
    /// A person at no place.
    pub(super) const NOWHERE: Self = Self {
        place: Vec2::NAN,
        velocity: Vec2::ZERO,
    };
}

/// Space for the neighbours of a place.
#[derive(Debug)]
pub(super) struct Sight([Passerby; MOST_LOOKED_AT]);

impl Default for Sight {
    fn default() -> Self {
        Self([Passerby::default(); MOST_LOOKED_AT])
    }
}

/// Walkers in the order of their cells.
#[derive(Debug, Default)]
pub(super) struct Neighbours {
    seen: Vec<Passerby>,
    /// Index in `seen` at which each bucket begins; one more than buckets.
    starts: Vec<u32>,
}

impl Neighbours {
    /// Rebuilds the grid from all finite places. Allocates only if there are more walkers than ever before.
    pub(super) fn rebuild(&mut self, everybody: impl Iterator<Item = Passerby> + Clone) {
        let there = everybody.filter(|seen| seen.place.is_finite());
        let count = there.clone().count();
        let buckets = (2 * count).next_power_of_two().max(LEAST_BUCKETS);
        self.starts.clear();
        self.starts.resize(buckets + 1, 0);
        for seen in there.clone() {
            self.starts[bucket(cell(seen.place), buckets)] += 1;
        }
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
        self.seen.clear();
        self.seen.resize(count, Passerby::default());
        // Each bucket is filled from its end, so that `starts` ends up at its beginning.
        for seen in there {
            let start = &mut self.starts[bucket(cell(seen.place), buckets)];
            *start -= 1;
            self.seen[*start as usize] = seen;
        }
    }

    /// The visible neighbours of a place: the nearest ones, as many as do not hide each other.
    pub(super) fn around<'a>(&self, place: Vec2, found: &'a mut Sight) -> &'a [Passerby] {
        let middle = cell(place);
        let near = rows(middle, 1).flat_map(|row| self.strip(row, 1));
        let near: usize = near.map(<[Passerby]>::len).sum();
        let density = near as f32 / (9.0 * CELL_M * CELL_M);
        let sight = (MOST_IN_SIGHT / (core::f32::consts::PI * density.max(1e-3))).sqrt();
        let sight = sight.clamp(LEAST_SIGHT_M, SIGHT_M);
        let cells = (sight / CELL_M).ceil() as i32;
        let mut count = 0;
        for row in rows(middle, cells) {
            for seen in self.strip(row, cells).into_iter().flatten() {
                // A bucket may hold distant walkers, too.
                if seen.place.distance_squared(place) < sight * sight {
                    let Some(room) = found.0.get_mut(count) else {
                        break;
                    };
                    *room = *seen;
                    count += 1;
                }
            }
        }
        &found.0[..count]
    }

    /// Walkers in the memory of part of a row of cells: in two parts if that wraps around.
    fn strip(&self, middle: IVec2, cells: i32) -> [&[Passerby]; 2] {
        let buckets = self.starts.len().saturating_sub(1);
        if buckets == 0 {
            return [&[]; 2];
        }
        let between = |first: usize, end: usize| {
            &self.seen[self.starts[first] as usize..self.starts[end] as usize]
        };
        let first = bucket(middle - cells * IVec2::X, buckets);
        let end = first + 2 * cells as usize + 1;
        [
            between(first, end.min(buckets)),
            between(0, end.saturating_sub(buckets)),
        ]
    }
}

/// The middle cells of the rows within this distance in rows, the nearest first.
fn rows(middle: IVec2, cells: i32) -> impl Iterator<Item = IVec2> {
    (0..=2 * cells).map(move |row| {
        let off = if row % 2 == 0 {
            row / 2
        } else {
            -(row + 1) / 2
        };
        middle + off * IVec2::Y
    })
}

fn cell(place: Vec2) -> IVec2 {
    (place / CELL_M).floor().as_ivec2()
}

fn bucket(cell: IVec2, buckets: usize) -> usize {
    let row = cell.y.cast_unsigned().wrapping_mul(ROW);
    cell.x.cast_unsigned().wrapping_add(row) as usize & (buckets - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evenly distributed people, by their number on a square metre.
    fn strewn(density: f32) -> Vec<Vec2> {
        (0..4000)
            .map(|index| {
                let radius = (index as f32 / (core::f32::consts::PI * density)).sqrt();
                Vec2::from_angle(index as f32 * 2.4) * radius
            })
            .collect()
    }

    fn neighbours(places: &[Vec2]) -> Neighbours {
        let mut neighbours = Neighbours::default();
        for _ in 0..2 {
            neighbours.rebuild(places.iter().map(|place| Passerby {
                place: *place,
                velocity: Vec2::ZERO,
            }));
        }
        neighbours
    }

    #[test]
    fn everybody_near_is_found_once() {
        let mut places = strewn(0.15);
        places.push(Vec2::NAN);
        let neighbours = neighbours(&places);
        let mut sight = Sight::default();
        places.pop();
        for place in places.iter().step_by(7) {
            let found = neighbours.around(*place, &mut sight);
            let found: Vec<Vec2> = found.iter().map(|seen| seen.place).collect();
            for other in &places {
                let times = found.iter().filter(|found| *found == other).count();
                let near = other.distance(*place) < SIGHT_M;
                assert_eq!(times, usize::from(near), "{other} seen from {place}");
            }
        }
    }

    #[test]
    fn a_denser_crowd_does_not_mean_that_more_are_looked_at() {
        for density in [1.0, 3.0, 6.0, 12.0] {
            let places = strewn(density);
            let neighbours = neighbours(&places);
            let mut sight = Sight::default();
            for place in places[..200].iter().step_by(7) {
                let found = neighbours.around(*place, &mut sight);
                let count = found.len();
                assert!((20..=MOST_LOOKED_AT).contains(&count), "{density}: {count}");
                let nearest = places.iter().filter(|other| other.distance(*place) < 0.5);
                let seen = |other: &Vec2| found.iter().any(|seen| seen.place == *other);
                assert!(nearest.take(4).all(seen), "the nearest count");
            }
        }
    }
}
