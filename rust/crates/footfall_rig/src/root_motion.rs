//! Travel of a character for callers per physics frame, per drawn frame, or as it happens.

use core::ops::Mul;

/// Travel by two clocks: each counts every frame's travel exactly once.
///
/// `T` is an engine's transform: its default is the identity, and a product applies the right one first.
#[derive(Debug, Default)]
pub struct RootMotion<T> {
    physics: Tally<T>,
    process: Tally<T>,
    last: T,
}

/// Travel in the latest frame of a clock with any.
#[derive(Debug, Default)]
struct Tally<T> {
    frame: u64,
    sum: T,
    /// True when it was read in that very frame.
    is_read: bool,
}

/// Number of the current frame by both clocks.
#[derive(Clone, Copy, Debug)]
pub struct FrameClock {
    /// Number of the physics' frame.
    pub physics: u64,
    /// Number of the drawn frame.
    pub process: u64,
    /// True during the physics frame.
    pub in_physics: bool,
}

/// Time within a frame at which a skeleton moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Advance {
    /// At the end of every frame of the physics.
    InPhysics,
    /// At the end of every frame that is drawn.
    InProcess,
    /// When the game advances it.
    ByHand,
}

impl<T: Copy + Default + Mul<Output = T>> RootMotion<T> {
    /// Adds travel, in the character's own axes.
    pub fn add(&mut self, delta: T, now: FrameClock) {
        self.last = delta;
        self.physics.add(delta, now.physics);
        self.process.add(delta, now.process);
    }

    /// Returns the travel since the previous frame by the caller's clock; in the frame in which a skeleton has just moved, that frame's travel.
    #[must_use]
    pub fn since_last_frame(&mut self, advance: Advance, now: FrameClock) -> T {
        let (tally, frame) = if now.in_physics {
            (&mut self.physics, now.physics)
        } else {
            (&mut self.process, now.process)
        };
        if tally.frame == frame {
            tally.is_read = true;
            return if advance == Advance::ByHand {
                self.last
            } else {
                tally.sum
            };
        }
        // Physics comes before the drawn frame: what moved with it was read in its own frame.
        let before_it = advance == Advance::InPhysics && !now.in_physics;
        let is_read = advance == Advance::ByHand && tally.is_read;
        if tally.frame + 1 == frame && !before_it && !is_read {
            tally.sum
        } else {
            T::default()
        }
    }
}

impl<T: Copy + Default + Mul<Output = T>> Tally<T> {
    fn add(&mut self, delta: T, frame: u64) {
        if self.frame != frame {
            *self = Self {
                frame,
                ..Self::default()
            };
        }
        // The second way begins where the first one ended, turned as it has turned.
        self.sum = self.sum * delta;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;
    use glam::{Affine3A, Quat, Vec3, Vec3A};

    /// A metre forwards and a quarter turn.
    fn delta() -> Affine3A {
        Affine3A::from_rotation_translation(Quat::from_rotation_y(FRAC_PI_2), Vec3::Z)
    }

    fn now(physics: u64, process: u64, in_physics: bool) -> FrameClock {
        FrameClock {
            physics,
            process,
            in_physics,
        }
    }

    /// Frames of two seconds at these rates. Returns the travel that both clocks counted, in deltas.
    fn read(advance: Advance, physics_hz: u64, drawn_hz: u64) -> [usize; 3] {
        let mut motion = RootMotion::default();
        let step = Affine3A::from_translation(Vec3::Z);
        let count = |way: Affine3A| way.translation.z.round() as usize;
        let (mut physics, mut sums) = (0, [0; 3]);
        for process in 0..2 * drawn_hz {
            while physics * drawn_hz < process * physics_hz {
                physics += 1;
                sums[0] += count(motion.since_last_frame(advance, now(physics, process, true)));
                if advance == Advance::InPhysics {
                    motion.add(step, now(physics, process, true));
                    sums[2] += 1;
                }
            }
            sums[1] += count(motion.since_last_frame(advance, now(physics, process, false)));
            if advance == Advance::InProcess {
                motion.add(step, now(physics, process, false));
                sums[2] += 1;
            }
        }
        sums
    }

    #[test]
    fn both_clocks_are_told_all_of_it_at_any_rates() {
        for advance in [Advance::InProcess, Advance::InPhysics] {
            for (physics_hz, drawn_hz) in [(60, 30), (60, 60), (60, 120), (30, 144), (120, 50)] {
                let [physics, process, moved] = read(advance, physics_hz, drawn_hz);
                // The last motion is returned in the next frame: up to five drawn frames for one of the physics.
                assert!(
                    physics <= moved && physics + 5 >= moved,
                    "{advance:?} {physics_hz} {drawn_hz}: {physics} of {moved}"
                );
                assert!(
                    process <= moved && process + 3 >= moved,
                    "{advance:?} {physics_hz} {drawn_hz}: {process} of {moved}"
                );
            }
        }
    }

    #[test]
    fn ways_are_joined_with_their_turns() {
        let mut motion = RootMotion::default();
        motion.add(delta(), now(7, 1, false));
        motion.add(delta(), now(7, 2, false));
        let way = motion.since_last_frame(Advance::InProcess, now(8, 3, true));
        assert!(way.abs_diff_eq(delta() * delta(), 1e-6));
        assert!(way.translation.abs_diff_eq(Vec3A::new(1.0, 0.0, 1.0), 1e-6));
    }

    #[test]
    fn twice_in_a_frame_is_the_same_and_later_is_nothing() {
        let mut motion = RootMotion::default();
        motion.add(delta(), now(7, 1, false));
        for _ in 0..2 {
            let way = motion.since_last_frame(Advance::InProcess, now(8, 2, true));
            assert!(way.abs_diff_eq(delta(), 1e-6));
        }
        let later = motion.since_last_frame(Advance::InProcess, now(9, 2, true));
        assert_eq!(later, Affine3A::IDENTITY);
    }

    #[test]
    fn by_hand_it_is_the_last_advance() {
        let mut motion = RootMotion::default();
        let still = Affine3A::IDENTITY;
        motion.add(delta(), now(7, 1, false));
        motion.add(delta(), now(7, 1, false));
        assert!(
            motion
                .since_last_frame(Advance::ByHand, now(7, 1, false))
                .abs_diff_eq(delta(), 1e-6)
        );
        // Returned in its own frame already.
        assert_eq!(
            motion.since_last_frame(Advance::ByHand, now(7, 2, false)),
            still
        );
        motion.add(still, now(7, 2, false));
        assert_eq!(
            motion.since_last_frame(Advance::ByHand, now(7, 2, false)),
            still
        );
    }
}
