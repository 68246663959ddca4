//! Goals of a walker: a turn, a place, or a route to one.

use super::agent::Agent;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Distance at which a walker has arrived at a place, metres.
pub(super) const ARRIVED_M: f32 = 1.0;

/// Most that a walker turns aside to the right and to the left on unknown ground, radians.
const WIDE: [f32; 2] = [PI; 2];

/// Distance from the place of a ground query within which its result holds, metres.
const KNOWN_M: f32 = 1.5;

/// Goals of a walker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// A turn rate, rad/s.
    Turn(f32),
    /// A place, in the plane of the crowd: x and z of its space.
    Place(Vec2),
    /// A place of the crowd's space to which the game has no route yet: the walker stands.
    Awaited(Vec3),
}

/// Knowledge of the ground on which a walker's route lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Guidance {
    /// The ground is unknown.
    None,
    /// The game found the route around obstacles, and has not queried the ground here.
    Route,
    /// The game has queried the ground here.
    Ground(Ground),
}

/// Ground around a walker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ground {
    /// Place of the query.
    at: Vec2,
    /// Direction that stays on the ground, where the one to the goal does not.
    way: Option<Vec2>,
    /// Most that it can step aside to the right and to the left, radians.
    room_rad: [f32; 2],
}

impl Agent {
    /// Gives up its goal and turns at this rate, rad/s.
    pub fn turn(&mut self, rate_radps: f32) {
        self.give_up();
        self.goal = Goal::Turn(rate_radps);
    }

    /// Goes to a place and stops there: x and z of the crowd's space.
    pub fn go_to(&mut self, place: Vec2) {
        self.give_up();
        self.goal = Goal::Place(place);
    }

    /// Goes from place to place, a route that the game found around obstacles, and stops at the last; without places it keeps its
    /// current goal.
    pub fn go_along(&mut self, places: impl DoubleEndedIterator<Item = Vec2>) {
        self.give_up();
        self.route.extend(places.rev());
        if let Some(first) = self.route.pop() {
            self.goal = Goal::Place(first);
            self.guidance = Guidance::Route;
        }
    }

    /// Stays where it is until the game knows the ground, and with it the way to this place of the crowd's space.
    pub fn await_route(&mut self, to: Vec3) {
        self.give_up();
        self.goal = Goal::Awaited(to);
    }

    /// Returns the place to which it awaits a route.
    pub fn awaited(&self) -> Option<Vec3> {
        match self.goal {
            Goal::Awaited(to) => Some(to),
            Goal::Place(_) | Goal::Turn(_) => None,
        }
    }

    fn give_up(&mut self) {
        self.route.clear();
        self.guidance = Guidance::None;
    }

    /// The direction of its goal as a unit vector, where the game found its route and it has not arrived: a walker that avoids others, or turns in an arc, may leave that ground.
    pub fn straight_way(&self) -> Option<Vec2> {
        match self.goal {
            Goal::Place(place) if self.guidance != Guidance::None && self.is_on_its_way() => {
                (place - self.level()).try_normalize()
            }
            Goal::Place(_) | Goal::Turn(_) | Goal::Awaited(_) => None,
        }
    }

    /// Returns whether it goes along a route and the ground has not been queried since it set out, or came to the last corner.
    pub fn is_on_new_way(&self) -> bool {
        self.guidance == Guidance::Route && self.is_on_its_way()
    }

    /// Sets the ground around it: a direction that stays on it, where the [straight way](Self::straight_way) does not, and how far it may turn aside from that to the right and to the left,
    /// radians.
    pub fn guide(&mut self, way: Option<Vec2>, room_rad: [f32; 2]) {
        self.guidance = Guidance::Ground(Ground {
            at: self.level(),
            way,
            room_rad,
        });
    }

    /// Direction of its goal, or the one that stays on the ground, and how far it may turn aside from it to the right and to the left, radians.
    pub(super) fn way_to(&self, place: Vec2) -> (Vec2, [f32; 2]) {
        let straight = place - self.level();
        match self.guidance {
            Guidance::Ground(ground) if ground.at.distance(self.level()) < KNOWN_M => {
                (ground.way.unwrap_or(straight), ground.room_rad)
            }
            Guidance::None | Guidance::Route | Guidance::Ground(_) => (straight, WIDE),
        }
    }

    /// Returns whether it goes somewhere and has not arrived.
    pub fn is_on_its_way(&self) -> bool {
        match self.goal {
            Goal::Place(place) => !self.route.is_empty() || !self.is_at(place),
            Goal::Turn(_) | Goal::Awaited(_) => false,
        }
    }

    /// Goes on to the next place of its route once it has come to its goal. Each decision does so; before the ground is queried, it has the query be about that place.
    pub fn follow_route(&mut self) {
        if let Goal::Place(place) = self.goal
            && self.is_at(place)
            && let Some(next) = self.route.pop()
        {
            self.goal = Goal::Place(next);
            self.guidance = Guidance::Route;
        }
    }

    fn is_at(&self, place: Vec2) -> bool {
        place.distance(self.level()) < ARRIVED_M
    }
}
