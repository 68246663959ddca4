//! Tiers of a crowd's walkers: by distance, with largest counts, and with hysteresis.

use glam::Vec3;

/// Ways of drawing a walker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Tier {
    /// A whole character scene with a skeleton.
    Full,
    /// An instance with a new pose in every frame.
    Near,
    /// An instance with a new pose every few frames and with repeated steps.
    #[default]
    Far,
}

/// Borders between tiers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Most walkers in the full and in the near tier.
    pub counts: [usize; 2],
    /// Distances from the camera where they end, metres.
    pub distances_m: [f32; 2],
}

/// Factor on the distance up to which a walker keeps a better tier.
const KEEP: f32 = 1.1;

/// Chooses tiers.
#[derive(Debug, Default)]
pub(super) struct Chooser {
    /// Effective distance, and index.
    order: Vec<(f32, u32)>,
}

impl Chooser {
    /// Chooses the tiers from the walkers' places, `None` for those that are not made. A walker in a better tier counts as nearer.
    pub(super) fn choose(
        &mut self,
        camera: Vec3,
        limits: &Limits,
        places: impl Iterator<Item = Option<Vec3>>,
        tiers: &mut [Tier],
    ) {
        self.order.clear();
        let reach = limits.distances_m[1].max(limits.distances_m[0]) * KEEP;
        for ((index, place), tier) in places.enumerate().zip(tiers.iter_mut()) {
            let far = place.map_or(f32::INFINITY, |place| place.distance(camera));
            let counts = if *tier == Tier::Far { far } else { far / KEEP };
            if counts < reach {
                self.order.push((counts, index as u32));
            } else {
                *tier = Tier::Far;
            }
        }
        let most = (limits.counts[0] + limits.counts[1]).min(self.order.len());
        if most > 0 && most < self.order.len() {
            self.order
                .select_nth_unstable_by(most - 1, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
        self.order[..most].sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut left = limits.counts;
        for (rank, (far, index)) in self.order.iter().enumerate() {
            let tier = &mut tiers[*index as usize];
            let keeps = |own: Tier| if *tier <= own { KEEP } else { 1.0 };
            // For walkers in a better tier than far, the distance was divided already.
            let real = if *tier == Tier::Far { *far } else { far * KEEP };
            *tier = if rank >= most {
                Tier::Far
            } else if left[0] > 0 && real < limits.distances_m[0] * keeps(Tier::Full) {
                left[0] -= 1;
                Tier::Full
            } else if left[1] > 0 && real < limits.distances_m[1] * keeps(Tier::Near) {
                left[1] -= 1;
                Tier::Near
            } else {
                Tier::Far
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        counts: [3, 5],
        distances_m: [5.0, 20.0],
    };

    fn line(count: usize) -> impl Iterator<Item = Option<Vec3>> + Clone {
        (0..count).map(|index| Some(Vec3::X * (index as f32 + 0.5)))
    }

    #[test]
    fn the_nearest_get_the_most_and_counts_are_kept() {
        let mut tiers = vec![Tier::default(); 50];
        Chooser::default().choose(Vec3::ZERO, &LIMITS, line(50), &mut tiers);
        assert!(tiers[..3].iter().all(|tier| *tier == Tier::Full));
        assert!(tiers[3..8].iter().all(|tier| *tier == Tier::Near));
        assert!(tiers[8..].iter().all(|tier| *tier == Tier::Far));
        let none = Limits {
            counts: [0, 0],
            ..LIMITS
        };
        Chooser::default().choose(Vec3::ZERO, &none, line(50), &mut tiers);
        assert!(tiers.iter().all(|tier| *tier == Tier::Far));
    }

    #[test]
    fn who_is_at_a_border_does_not_flicker() {
        let limits = Limits {
            counts: [10, 10],
            distances_m: [5.0, 20.0],
        };
        let mut tiers = [Tier::Far];
        let mut chooser = Chooser::default();
        let mut changes = 0;
        for frame in 0..100 {
            let wobble = 0.2 * (frame as f32).sin();
            let before = tiers;
            chooser.choose(
                Vec3::ZERO,
                &limits,
                [Some(Vec3::X * (4.9 + wobble))].into_iter(),
                &mut tiers,
            );
            changes += usize::from(before != tiers);
        }
        assert!(changes <= 2, "{changes} changes");
        chooser.choose(
            Vec3::ZERO,
            &limits,
            [Some(Vec3::X * 5.6)].into_iter(),
            &mut tiers,
        );
        assert_eq!(tiers, [Tier::Near]);
    }
}
