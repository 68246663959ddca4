//! Collision avoidance: the direction and the speed with the least cost, among a few.
//!
//! Each candidate costs its detour and its expected encounters, as in Moussaïd, Helbing and Theraulaz, "How simple rules determine
//! pedestrian behavior and crowd disasters", PNAS 2011, if the others keep their velocities.

use super::neighbours::{Passerby, SIGHT_M};
use super::steering::{ARC_SPEED, direction, turn_rate, turning_speed};
use glam::Vec2;

/// Distance and time of an expected encounter within which others are avoided, metres and seconds.
const PERSONAL_M: f32 = 0.9;
const FORESIGHT_SECS: f32 = 8.0;
/// Time for which a walker continues as it goes, seconds: it takes half a step to turn or slow down.
const LAG_SECS: f32 = 0.25;
/// Time that a walker takes to go as it decided, seconds, and the share of its present speed that it has meanwhile.
const TURNING_SECS: f32 = 0.7;
const PRESENT_SHARE: f32 = 0.15;
/// Least cosine of the angle between the direction it faces and another person: those behind are ignored.
const BEHIND: f32 = -0.5;
/// Closer than this two bodies touch, metres.
const BODIES_M: f32 = 0.5;
/// Costs of turning by a radian and of standing, relative to those of touching and of walking into another body. Chosen, as the distances and times above, by how near
/// walkers come in two rows that pass through each other and in a square in which they wander.
const TURNING: f32 = 0.15;
const SLOWING: f32 = 0.4;
const CLOSENESS: f32 = 0.6;
const TOUCHING: f32 = 2.0;
/// Distance after that time below which two are too near, metres, and the cost of being at one place then.
const APART_M: f32 = 0.6;
const TOGETHER: f32 = 6.0;
/// Speed at which those count as approaching who stay where they are, for the choice of the most urgent, m/s.
const PRESENCE_MPS: f32 = 1.5;
/// Number of others that are considered, the most urgent ones.
const MOST_OTHERS: usize = 8;
/// Candidate directions relative to the desired one, radians to the left.
const ASIDES: [f32; 9] = [0.0, -0.2, 0.2, -0.4, 0.4, -0.7, 0.7, -1.0, 1.0];
/// Candidate shares of the desired speed.
const SPEEDS: [f32; 4] = [1.0, 0.75, 0.5, 0.3];

/// A walker with a goal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wayfarer {
    pub(super) place: Vec2,
    /// Direction it faces: 0 along +Z (`y` of the plane), positive to the left, radians.
    pub(super) heading: f32,
    /// Desired direction relative to that, radians to the left.
    pub(super) off: f32,
    /// Preferred speed, m/s.
    pub(super) speed_mps: f32,
    /// Speed now, m/s.
    pub(super) present_mps: f32,
    /// Most that it can step aside to the right and to the left, radians.
    pub(super) room_rad: [f32; 2],
}

/// A detour around others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Detour {
    /// Angle from the desired direction, radians to the left.
    pub(super) aside: f32,
    /// Share of the preferred speed.
    pub(super) speed: f32,
}

impl Wayfarer {
    /// The detour of least cost; `None` if nobody is near.
    pub(super) fn detour<'a>(&self, others: impl Iterator<Item = &'a Passerby>) -> Option<Detour> {
        let facing = direction(self.heading);
        let velocity = direction(self.heading + self.off) * self.speed_mps;
        let mut near = Near::default();
        for other in others {
            let way = other.place - self.place;
            let far = way.length();
            if (1e-3..SIGHT_M).contains(&far) && way.dot(facing) >= BEHIND * far {
                let closing = (velocity - other.velocity).dot(way) / far;
                near.take((closing + PRESENCE_MPS) / far, way, other.velocity);
            }
        }
        if near.len == 0 {
            return None;
        }
        let [right, left] = self.room_rad;
        let mut best = (f32::INFINITY, None);
        for aside in ASIDES
            .into_iter()
            .filter(|aside| (-right..=left).contains(aside))
        {
            // An encounter never makes a detour cheaper.
            if detour_cost(aside, 1.0) >= best.0 {
                continue;
            }
            let off = self.off + aside;
            let wanted = direction(self.heading + off);
            let turning = direction(self.heading + 0.5 * TURNING_SECS * turn_rate(off));
            let slowed = turning_speed(off, ARC_SPEED);
            for speed in SPEEDS {
                let detour = detour_cost(aside, speed);
                if detour >= best.0 {
                    break;
                }
                let pace = speed * self.speed_mps;
                let velocity = wanted * pace;
                let slow = slowed * pace;
                let meanwhile = slow + PRESENT_SHARE * (self.present_mps - slow);
                let course = Course {
                    velocity,
                    ahead: (facing * self.present_mps - velocity) * LAG_SECS,
                    turned: turning * meanwhile * TURNING_SECS,
                };
                let cost = detour + near.cost(&course);
                if cost < best.0 {
                    best = (cost, Some(Detour { aside, speed }));
                }
            }
        }
        best.1
    }
}

/// Motion of a walker after a decision.
struct Course {
    /// Velocity in the end, m/s.
    velocity: Vec2,
    /// Lead over a walker who has had this velocity from the beginning, metres.
    ahead: Vec2,
    /// Displacement in the time that it takes to turn, metres.
    turned: Vec2,
}

/// Cost of a detour; to the right it is slightly less than to the left, so that two who meet face to face agree.
fn detour_cost(aside: f32, speed: f32) -> f32 {
    let turned = if aside > 0.0 { 1.1 * aside } else { aside };
    TURNING * turned * turned + SLOWING * (1.0 - speed)
}

/// Others to be considered: urgency, relative place and velocity, as arrays of components, so that SIMD evaluates all of them at once.
#[derive(Debug, Default)]
struct Near {
    urgency: [f32; MOST_OTHERS],
    way: [[f32; MOST_OTHERS]; 2],
    velocity: [[f32; MOST_OTHERS]; 2],
    len: usize,
}

impl Near {
    /// Adds a person; if the list is full, it replaces the least urgent one.
    fn take(&mut self, urgency: f32, way: Vec2, velocity: Vec2) {
        let index = if self.len < MOST_OTHERS {
            self.len += 1;
            self.len - 1
        } else {
            let all = self.urgency.iter().enumerate();
            let least = all.min_by(|a, b| a.1.total_cmp(b.1));
            let Some((index, _)) = least.filter(|least| *least.1 < urgency) else {
                return;
            };
            index
        };
        self.urgency[index] = urgency;
        for (axis, (way, velocity)) in way
            .to_array()
            .into_iter()
            .zip(velocity.to_array())
            .enumerate()
        {
            self.way[axis][index] = way;
            self.velocity[axis][index] = velocity;
        }
    }

    /// Cost of meeting them on a course.
    fn cost(&self, course: &Course) -> f32 {
        let mut costs = [0.0; MOST_OTHERS];
        for (index, cost) in costs.iter_mut().enumerate() {
            let way = Vec2::new(self.way[0][index], self.way[1][index]);
            let other = Vec2::new(self.velocity[0][index], self.velocity[1][index]);
            let then = way + other * TURNING_SECS - course.turned;
            *cost = meeting_cost(way - course.ahead, course.velocity - other)
                + TOGETHER * (1.0 - then.length() / APART_M).max(0.0);
        }
        costs[..self.len].iter().sum()
    }
}

/// Cost of approaching a person at a relative place with this velocity. Without branches, for SIMD.
#[inline]
fn meeting_cost(way: Vec2, approach: Vec2) -> f32 {
    let secs = way.dot(approach) / approach.length_squared().max(1e-3);
    let secs = secs.clamp(0.0, FORESIGHT_SECS);
    let nearest = (way - approach * secs).length();
    let soon = 1.0 - secs / FORESIGHT_SECS;
    let close = ((PERSONAL_M - nearest) / (PERSONAL_M - BODIES_M)).clamp(0.0, 1.0);
    let touching = (1.0 - nearest / BODIES_M).max(0.0);
    soon * (CLOSENESS * close + TOUCHING * touching)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::PI;

    const AHEAD: Wayfarer = Wayfarer {
        place: Vec2::ZERO,
        heading: 0.0,
        off: 0.0,
        speed_mps: 1.3,
        present_mps: 1.3,
        room_rad: [PI; 2],
    };
    const STRAIGHT_ON: Detour = Detour {
        aside: 0.0,
        speed: 1.0,
    };

    fn somebody(x: f32, z: f32, velocity: Vec2) -> Passerby {
        Passerby {
            place: Vec2::new(x, z),
            velocity,
        }
    }

    /// Least distance of the two when one takes a detour and the other goes on.
    fn nearest(detour: Detour, other: &Passerby) -> f32 {
        let velocity = direction(detour.aside) * (1.3 * detour.speed);
        (0..80)
            .map(|tenth| 0.1 * tenth as f32)
            .map(|secs| (other.place + (other.velocity - velocity) * secs).length())
            .fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn nobody_in_the_way_means_straight_on() {
        assert_eq!(AHEAD.detour([].iter()), None);
        let away = [
            somebody(0.0, -1.5, Vec2::ZERO),
            somebody(3.0, 4.0, Vec2::ZERO),
            somebody(0.2, 3.0, 1.3 * Vec2::Y),
        ];
        assert_eq!(AHEAD.detour(away.iter()), Some(STRAIGHT_ON));
    }

    #[test]
    fn two_who_meet_face_to_face_both_go_to_their_right() {
        let other = somebody(0.0, 5.0, -1.3 * Vec2::Y);
        let detour = AHEAD.detour([other].iter()).unwrap();
        assert!(detour.aside < 0.0, "{detour:?}");
        assert!(nearest(detour, &other) > BODIES_M);
    }

    #[test]
    fn whoever_goes_along_too_near_is_left() {
        for side in [-1.0, 1.0] {
            let other = somebody(0.35 * side, 0.1, 1.3 * Vec2::Y);
            let detour = AHEAD.detour([other].iter()).unwrap();
            let velocity = direction(detour.aside) * (1.3 * detour.speed);
            let then = other.place + (other.velocity - velocity) * TURNING_SECS;
            assert!(then.length() > APART_M, "{detour:?}: {then}");
        }
    }

    #[test]
    fn one_who_stands_or_crosses_is_not_walked_into() {
        let crowd = [
            somebody(0.1, 2.0, Vec2::ZERO),
            somebody(-0.1, 3.0, Vec2::ZERO),
            somebody(3.0, 3.0, Vec2::new(-1.3, 0.0)),
            somebody(-3.0, 3.2, Vec2::new(1.2, 0.0)),
        ];
        for other in crowd {
            assert!(nearest(STRAIGHT_ON, &other) < BODIES_M);
            let detour = AHEAD.detour([other].iter()).unwrap();
            assert!(nearest(detour, &other) > BODIES_M, "{other:?}: {detour:?}");
        }
    }

    #[test]
    fn of_too_many_the_urgent_count() {
        let aside = (0..40).map(|index| somebody(4.0, 0.1 * index as f32, Vec2::ZERO));
        let urgent = somebody(0.0, 1.5, Vec2::ZERO);
        let everybody: Vec<Passerby> = aside.chain([urgent]).collect();
        let detour = AHEAD.detour(everybody.iter()).unwrap();
        assert!(nearest(detour, &urgent) > BODIES_M);
    }

    #[test]
    fn whoever_has_no_room_on_one_side_goes_round_on_the_other_or_waits() {
        let other = somebody(0.0, 5.0, -1.3 * Vec2::Y);
        let in_room = |right: f32, left: f32| {
            let wayfarer = Wayfarer {
                room_rad: [right, left],
                ..AHEAD
            };
            wayfarer.detour([other].iter()).unwrap()
        };
        assert!(in_room(0.0, PI).aside > 0.0);
        assert!((-0.2..0.0).contains(&in_room(0.2, 0.0).aside));
        let between_walls = in_room(0.0, 0.0);
        assert!(
            between_walls.aside == 0.0 && between_walls.speed < 1.0,
            "{between_walls:?}"
        );
    }
}
