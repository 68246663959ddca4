//! Neighbours: a grid over the plane, made anew as people move.

use super::agent::{Passerby, SIGHT_M};
use glam::{IVec2, Vec2};

/// Walkers by the cell that they are in; a cell is as wide as one sees.
#[derive(Debug, Default)]
pub(super) struct Neighbours {
    seen: Vec<Passerby>,
    /// Walkers in the order of their buckets.
    order: Vec<u32>,
    /// Index in `order` at which each bucket begins; one more than buckets.
    starts: Vec<u32>,
}

impl Neighbours {
    /// Takes everybody in. Allocates only when there are more than ever.
    pub(super) fn rebuild(&mut self, everybody: impl Iterator<Item = Passerby>) {
        self.seen.clear();
        self.seen.extend(everybody);
        let buckets = self.seen.len().next_power_of_two().max(16);
        self.starts.clear();
        self.starts.resize(buckets + 1, 0);
        for seen in &self.seen {
            self.starts[bucket(cell(seen.place), buckets) + 1] += 1;
        }
        for index in 0..buckets {
            self.starts[index + 1] += self.starts[index];
        }
        self.order.clear();
        self.order.resize(self.seen.len(), 0);
        // Filled from the back, so that `starts` ends where it began.
        for (index, seen) in self.seen.iter().enumerate().rev() {
            let end = &mut self.starts[bucket(cell(seen.place), buckets) + 1];
            *end -= 1;
            self.order[*end as usize] = index as u32;
        }
        self.starts.rotate_left(1);
        self.starts[buckets] = self.seen.len() as u32;
    }

    /// Everybody in the cells around a place, and by chance a few from elsewhere.
    pub(super) fn around(&self, place: Vec2) -> impl Iterator<Item = &Passerby> {
        let buckets = self.starts.len().saturating_sub(1).max(1);
        let middle = cell(place);
        (-1..=1)
            .flat_map(move |x| (-1..=1).map(move |y| bucket(middle + IVec2::new(x, y), buckets)))
            .flat_map(|bucket| {
                let from = self.starts.get(bucket).copied().unwrap_or(0) as usize;
                let to = self.starts.get(bucket + 1).copied().unwrap_or(0) as usize;
                self.order[from..to.max(from)].iter()
            })
            .map(|index| &self.seen[*index as usize])
    }
}

fn cell(place: Vec2) -> IVec2 {
    (place / SIGHT_M).floor().as_ivec2()
}

fn bucket(cell: IVec2, buckets: usize) -> usize {
    // Two large primes, as is usual for grids that are hashed.
    let hash = cell.x.wrapping_mul(73_856_093) ^ cell.y.wrapping_mul(19_349_663);
    hash.cast_unsigned() as usize & (buckets - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everybody_near_is_found() {
        let places: Vec<Vec2> = (0..500)
            .map(|index| {
                let angle = index as f32 * 2.4;
                Vec2::from_angle(angle) * (index as f32).sqrt() * 1.5
            })
            .collect();
        let mut neighbours = Neighbours::default();
        for _ in 0..2 {
            neighbours.rebuild(places.iter().map(|place| Passerby {
                place: *place,
                velocity: Vec2::ZERO,
            }));
        }
        for place in &places {
            let found: Vec<Vec2> = neighbours.around(*place).map(|seen| seen.place).collect();
            for other in &places {
                if other.distance(*place) < SIGHT_M {
                    assert!(found.contains(other), "{other} is near {place}");
                }
            }
        }
    }
}
