//! Travel of a character, for callers once a frame of the physics, once a drawn frame, or when it happens.

use godot::classes::skeleton_3d::ModifierCallbackModeProcess;
use godot::classes::{Engine, Skeleton3D};
use godot::prelude::*;

/// Travel by two clocks, so that each counts every frame's share of it exactly once.
#[derive(Debug, Default)]
pub(crate) struct RootMotion {
    physics: Tally,
    process: Tally,
    last: Transform3D,
}

/// Travel in the latest frame of a clock that saw any.
#[derive(Debug, Default)]
struct Tally {
    frame: u64,
    sum: Transform3D,
    /// True when it was asked for in that very frame.
    told: bool,
}

/// The frame that it is, by both clocks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Now {
    physics: u64,
    process: u64,
    in_physics: bool,
}

/// When a skeleton moves within a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Moves {
    /// At the end of every frame of the physics.
    InPhysics,
    /// At the end of every frame that is drawn.
    InProcess,
    /// When the game advances it.
    ByHand,
}

impl Now {
    pub(crate) fn of(engine: &Gd<Engine>) -> Self {
        Self {
            physics: engine.get_physics_frames(),
            process: engine.get_process_frames(),
            in_physics: engine.is_in_physics_frame(),
        }
    }
}

impl Moves {
    pub(crate) fn of(skeleton: &Gd<Skeleton3D>) -> Self {
        let mode = skeleton.get_modifier_callback_mode_process();
        if mode == ModifierCallbackModeProcess::PHYSICS {
            Self::InPhysics
        } else if mode == ModifierCallbackModeProcess::MANUAL {
            Self::ByHand
        } else {
            Self::InProcess
        }
    }
}

impl RootMotion {
    /// A character travelled, in its own axes.
    pub(crate) fn add(&mut self, delta: Transform3D, now: Now) {
        self.last = delta;
        self.physics.add(delta, now.physics);
        self.process.add(delta, now.process);
    }

    /// Travel since the frame before, by the clock of the caller. In the frame that a skeleton has just moved in, that
    /// frame's.
    pub(crate) fn tell(&mut self, moves: Moves, now: Now) -> Transform3D {
        let (tally, frame) = if now.in_physics {
            (&mut self.physics, now.physics)
        } else {
            (&mut self.process, now.process)
        };
        if tally.frame == frame {
            tally.told = true;
            return if moves == Moves::ByHand {
                self.last
            } else {
                tally.sum
            };
        }
        // Physics comes before the drawn frame: what moved with it was told in its own frame.
        let before_it = moves == Moves::InPhysics && !now.in_physics;
        let told = moves == Moves::ByHand && tally.told;
        if tally.frame + 1 == frame && !before_it && !told {
            tally.sum
        } else {
            Transform3D::IDENTITY
        }
    }
}

impl Tally {
    fn add(&mut self, delta: Transform3D, frame: u64) {
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
    use godot::builtin::math::ApproxEq as _;
    use std::f32::consts::FRAC_PI_2;

    /// A metre forwards and a quarter turn.
    fn delta() -> Transform3D {
        let turn = Basis::from_axis_angle(Vector3::UP, FRAC_PI_2);
        Transform3D::new(turn, Vector3::new(0.0, 0.0, 1.0))
    }

    fn now(physics: u64, process: u64, in_physics: bool) -> Now {
        Now {
            physics,
            process,
            in_physics,
        }
    }

    /// Frames of two seconds at these rates. Returns the travel that both clocks counted, in deltas.
    fn told(moves: Moves, physics_hz: u64, drawn_hz: u64) -> [usize; 3] {
        let mut motion = RootMotion::default();
        let step = Transform3D::new(Basis::IDENTITY, Vector3::new(0.0, 0.0, 1.0));
        let count = |way: Transform3D| way.origin.z.round() as usize;
        let (mut physics, mut sums) = (0, [0; 3]);
        for process in 0..2 * drawn_hz {
            while physics * drawn_hz < process * physics_hz {
                physics += 1;
                sums[0] += count(motion.tell(moves, now(physics, process, true)));
                if moves == Moves::InPhysics {
                    motion.add(step, now(physics, process, true));
                    sums[2] += 1;
                }
            }
            sums[1] += count(motion.tell(moves, now(physics, process, false)));
            if moves == Moves::InProcess {
                motion.add(step, now(physics, process, false));
                sums[2] += 1;
            }
        }
        sums
    }

    #[test]
    fn both_clocks_are_told_all_of_it_at_any_rates() {
        for moves in [Moves::InProcess, Moves::InPhysics] {
            for (physics_hz, drawn_hz) in [(60, 30), (60, 60), (60, 120), (30, 144), (120, 50)] {
                let [physics, process, moved] = told(moves, physics_hz, drawn_hz);
                // What moved last is told in the frame to come: up to five drawn frames for one of the physics.
                assert!(
                    physics <= moved && physics + 5 >= moved,
                    "{moves:?} {physics_hz} {drawn_hz}: {physics} of {moved}"
                );
                assert!(
                    process <= moved && process + 3 >= moved,
                    "{moves:?} {physics_hz} {drawn_hz}: {process} of {moved}"
                );
            }
        }
    }

    #[test]
    fn ways_are_joined_with_their_turns() {
        let mut motion = RootMotion::default();
        motion.add(delta(), now(7, 1, false));
        motion.add(delta(), now(7, 2, false));
        let way = motion.tell(Moves::InProcess, now(8, 3, true));
        assert!(way.approx_eq(&(delta() * delta())));
        assert!(way.origin.approx_eq(&Vector3::new(1.0, 0.0, 1.0)));
    }

    #[test]
    fn twice_in_a_frame_is_the_same_and_later_is_nothing() {
        let mut motion = RootMotion::default();
        motion.add(delta(), now(7, 1, false));
        for _ in 0..2 {
            let way = motion.tell(Moves::InProcess, now(8, 2, true));
            assert!(way.approx_eq(&delta()));
        }
        let later = motion.tell(Moves::InProcess, now(9, 2, true));
        assert_eq!(later, Transform3D::IDENTITY);
    }

    #[test]
    fn by_hand_it_is_the_last_advance() {
        let mut motion = RootMotion::default();
        let still = Transform3D::IDENTITY;
        motion.add(delta(), now(7, 1, false));
        motion.add(delta(), now(7, 1, false));
        assert!(
            motion
                .tell(Moves::ByHand, now(7, 1, false))
                .approx_eq(&delta())
        );
        // Told in its own frame already.
        assert_eq!(motion.tell(Moves::ByHand, now(7, 2, false)), still);
        motion.add(still, now(7, 2, false));
        assert_eq!(motion.tell(Moves::ByHand, now(7, 2, false)), still);
    }
}
