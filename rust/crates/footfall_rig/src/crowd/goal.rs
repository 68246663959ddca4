//! Goals of a walker: a turn, a place, or a route to one.

use super::agent::Agent;
use glam::Vec2;
use std::f32::consts::PI;

/// Distance at which a walker has arrived at a place, metres.
pub(super) const ARRIVED_M: f32 = 1.0;

/// Room of a walker on ground of which nobody knows where it ends: it may turn aside to the right and to the left as far as this, radians.
pub(super) const WIDE: [f32; 2] = [PI; 2];

/// A walker steps aside no nearer to where the ground of its route ends, for it goes on for a step before it turns back, metres.
const MARGIN_M: f32 = 0.2;

/// Goals of a walker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// A turn rate, rad/s.
    Turn(f32),
    /// A place, in the plane of the crowd: x and z of its space.
    Place(Vec2),
}

/// Knowledge of the ground on which a walker's route lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Guidance {
    /// Nobody knows where it may go.
    None,
    /// The game found the route around what is in the way.
    Map,
    /// The same, and its goal is a place on the way back to the route.
    BackToMap,
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

    /// Goes from place to place, a route that the game found around what is in the way, and stops at the last; without places it keeps the goal
    /// that it has.
    pub fn go_along(&mut self, places: impl DoubleEndedIterator<Item = Vec2>) {
        self.route.clear();
        self.route.extend(places.rev());
        if let Some(first) = self.route.pop() {
            self.goal = Goal::Place(first);
            self.guidance = Guidance::Map;
        }
    }

    fn give_up(&mut self) {
        self.route.clear();
        self.guidance = Guidance::None;
        self.room_rad = WIDE;
    }

    /// Returns whether it may leave the ground on which its route lies: somebody is near whom it may go round, perhaps beside a wall.
    pub fn may_stray(&self) -> bool {
        self.guidance != Guidance::None && self.meets && self.is_on_its_way()
    }

    /// The direction of its goal as a unit vector, and so the way that it takes when nobody is near; `None` without a goal or at it.
    pub fn way(&self) -> Option<Vec2> {
        match self.goal {
            Goal::Place(place) => (place - self.level()).try_normalize(),
            Goal::Turn(_) => None,
        }
    }

    /// Sets the room to the right and to the left of its [`way`](Self::way), metres, some way ahead: it steps aside no farther.
    pub fn set_room(&mut self, ahead_m: f32, sides_m: [f32; 2]) {
        self.room_rad = sides_m.map(|side| (side - MARGIN_M).max(0.0).atan2(ahead_m));
    }

    /// Goes by way of a place, back to where its route lies, before it goes on.
    pub fn lead_back(&mut self, by_way_of: Vec2) {
        if let Goal::Place(place) = self.goal
            && self.guidance != Guidance::BackToMap
        {
            self.route.push(place);
            self.guidance = Guidance::BackToMap;
        }
        self.goal = Goal::Place(by_way_of);
    }

    /// Returns whether it goes somewhere and has not arrived.
    pub fn is_on_its_way(&self) -> bool {
        match self.goal {
            Goal::Place(place) => !self.route.is_empty() || !self.is_at(place),
            Goal::Turn(_) => false,
        }
    }

    /// Goes on to the next place of its route once it has come to its goal.
    pub(super) fn follow_route(&mut self) {
        if let Goal::Place(place) = self.goal
            && self.is_at(place)
            && let Some(next) = self.route.pop()
        {
            self.goal = Goal::Place(next);
            if self.guidance == Guidance::BackToMap {
                self.guidance = Guidance::Map;
            }
        }
    }

    fn is_at(&self, place: Vec2) -> bool {
        place.distance(self.level()) < ARRIVED_M
    }
}
