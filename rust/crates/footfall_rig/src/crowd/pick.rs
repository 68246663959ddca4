//! Walkers by their places: along a ray, and near a point.

use super::Crowd;
use super::agent::Agent;
use glam::Vec3;

/// Half the width of a walker as a share of its height, and that height over the one of its highest joint.
const RADIUS: f32 = 0.16;
const SKULL: f32 = 1.12;

impl Crowd {
    /// The row of the walker whose body a line from one point to another meets first. Bodies count as capsules.
    pub fn first_met(&self, from: Vec3, to: Vec3) -> Option<usize> {
        if !(from.is_finite() && to.is_finite()) {
            return None;
        }
        let height = SKULL * self.height_m;
        let met = self.there().filter_map(|(place, agent)| {
            let height = height * agent.size;
            let share = share_to_capsule(from, to, agent.place, height, RADIUS * height)?;
            Some((share, place))
        });
        met.min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, place)| place)
    }

    /// The row of the walker that is nearest to a point, within a distance.
    pub fn nearest(&self, point: Vec3, reach_m: f32) -> Option<usize> {
        let far = self.there();
        let far = far.map(|(place, agent)| (agent.place.distance_squared(point), place));
        let (far, place) = far.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (far <= reach_m * reach_m).then_some(place)
    }

    fn there(&self) -> impl Iterator<Item = (usize, &Agent)> {
        let places = self.roster.order().iter().map(|place| *place as usize);
        places.map(|place| (place, &self.agents[place]))
    }
}

/// Share of the line between two points at which it meets an upright capsule; `None` if it misses.
fn share_to_capsule(from: Vec3, to: Vec3, foot: Vec3, height: f32, radius: f32) -> Option<f32> {
    let low = foot + Vec3::Y * radius;
    let high = foot + Vec3::Y * (height - radius).max(radius);
    let axis = high - low;
    let way = to - from;
    // The middle part, then the two ends: each where a square of the distance falls to that of the radius.
    let flat = |v: Vec3| v * Vec3::new(1.0, 0.0, 1.0);
    let side = enter(flat(way), flat(from - low), radius)
        .filter(|share| (0.0..=axis.y).contains(&(from + way * *share - low).y));
    let ends = [low, high].map(|end| enter(way, from - end, radius));
    let shares = ends.into_iter().chain([side]).flatten();
    shares.min_by(f32::total_cmp)
}

/// The share of a line at which it comes within `radius` of the origin; 0 if it begins there.
fn enter(way: Vec3, from: Vec3, radius: f32) -> Option<f32> {
    let excess = from.length_squared() - radius * radius;
    if excess <= 0.0 {
        return Some(0.0);
    }
    let (square, half) = (way.length_squared(), way.dot(from));
    let root = half * half - square * excess;
    if root < 0.0 || half >= 0.0 || square <= 0.0 {
        return None;
    }
    let share = (-half - root.sqrt()) / square;
    (share <= 1.0).then_some(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meets(from: [f32; 3], to: [f32; 3]) -> Option<f32> {
        share_to_capsule(from.into(), to.into(), Vec3::new(0.0, 0.0, 5.0), 1.8, 0.25)
    }

    #[test]
    fn a_ray_meets_the_side_the_top_and_not_what_is_beside() {
        let side = meets([0.0, 1.0, 0.0], [0.0, 1.0, 10.0]).unwrap();
        assert!((side - 0.475).abs() < 1e-5, "{side}");
        let top = meets([0.0, 10.0, 5.0], [0.0, 0.0, 5.0]).unwrap();
        assert!((top - 0.82).abs() < 1e-5, "{top}");
        assert_eq!(meets([0.3, 1.0, 0.0], [0.3, 1.0, 10.0]), None);
        assert_eq!(meets([0.0, 1.9, 0.0], [0.0, 1.9, 10.0]), None);
        assert_eq!(meets([0.0, 1.0, 0.0], [0.0, 1.0, 4.0]), None, "too short");
        assert_eq!(
            meets([0.0, 1.0, 10.0], [0.0, 1.0, 20.0]),
            None,
            "away from it"
        );
        assert_eq!(
            meets([0.0, 1.0, 5.0], [0.0, 1.0, 9.0]),
            Some(0.0),
            "from inside"
        );
        // Obliquely past the head.
        assert_eq!(meets([0.24, 1.79, 0.0], [0.24, 1.79, 10.0]), None);
        assert!(meets([0.1, 1.7, 0.0], [0.1, 1.7, 10.0]).is_some());
    }
}
