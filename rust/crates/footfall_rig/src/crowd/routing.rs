//! Routing: the goals that a crowd sets for its walkers.

use super::agent::Agent;
use super::goal::Goal;
use footfall_core::rotation::wrap_angle;
use glam::Vec2;

/// Distance of a walker's goal ahead of it on the path, metres.
const AHEAD_M: f32 = 2.5;

/// Number of random places among which a wanderer chooses, and the way that is worth turning by a radian, metres.
const CHOICES: usize = 6;
const M_A_RAD: f32 = 10.0;

/// Source of the walkers' goals.
#[derive(Debug, Default)]
pub enum Routing {
    /// The game sets the goal of each walker.
    #[default]
    Scripted,
    /// Random places of a rectangle around the origin.
    Wander {
        /// Half its sides, metres.
        half: Vec2,
    },
    /// A path, on which walkers go side by side.
    Path(Path),
    /// Routes that the game finds for each walker without a goal.
    Navigate,
}

/// A line through points of the plane.
#[derive(Debug, Default)]
pub struct Path {
    points: Vec<Vec2>,
    /// Length of the way to each point.
    lengths: Vec<f32>,
    closed: bool,
}

impl Path {
    /// A line through these points; `None` for one without length.
    pub fn new(points: Vec<Vec2>) -> Option<Self> {
        let mut lengths = Vec::with_capacity(points.len());
        let mut length = 0.0;
        let mut before: Option<Vec2> = None;
        for point in &points {
            length += before.map_or(0.0, |before| before.distance(*point));
            lengths.push(length);
            before = Some(*point);
        }
        let ends = points.first().zip(points.last());
        let closed = ends.is_some_and(|(first, last)| first.distance(*last) < 0.5);
        (length > 0.1).then_some(Self {
            points,
            lengths,
            closed,
        })
    }

    /// Length from one end to the other, metres.
    pub fn length(&self) -> f32 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// Place and direction at a distance from the beginning, metres. A closed path goes around, an open one there and back.
    pub fn at(&self, along: f32) -> (Vec2, Vec2) {
        let length = self.length();
        let (along, sign) = if self.closed {
            (along.rem_euclid(length), 1.0)
        } else {
            let twice = along.rem_euclid(2.0 * length);
            if twice <= length {
                (twice, 1.0)
            } else {
                (2.0 * length - twice, -1.0)
            }
        };
        let index = self.lengths.partition_point(|at| *at < along);
        let index = index.clamp(1, self.points.len() - 1);
        let (from, to) = (self.points[index - 1], self.points[index]);
        let span = self.lengths[index] - self.lengths[index - 1];
        let share = ((along - self.lengths[index - 1]) / span.max(1e-6)).clamp(0.0, 1.0);
        (
            from.lerp(to, share),
            sign * (to - from).normalize_or(Vec2::Y),
        )
    }

    /// Distance from the beginning to the point of the path that is nearest to a place, to a metre.
    fn nearest(&self, place: Vec2) -> f32 {
        let metres = (0..=self.length() as u32).map(|metre| metre as f32);
        let far = |along: &f32| self.at(*along).0.distance_squared(place);
        let nearest = metres.min_by(|a, b| far(a).total_cmp(&far(b)));
        nearest.unwrap_or(0.0)
    }

    /// Place beside the path, `aside` metres to the left, and the path's direction there.
    pub fn beside(&self, along: f32, aside: f32) -> (Vec2, Vec2) {
        let (place, direction) = self.at(along);
        // Seen from above with +X to the right and +Z towards the viewer, left of +Z is +X.
        let left = Vec2::new(direction.y, -direction.x);
        (place + left * aside, direction)
    }
}

impl Routing {
    /// Returns whether walkers wait for routes from the game.
    pub const fn is_navigated(&self) -> bool {
        matches!(self, Self::Navigate)
    }

    /// Sets the goal of a walker that another machine has led so far.
    pub(super) fn take_up(&self, agent: &mut Agent) {
        match self {
            Self::Scripted => agent.goal = Goal::Turn(0.0),
            Self::Wander { .. } | Self::Navigate => agent.goal = Goal::Place(agent.level()),
            Self::Path(path) => agent.progress_m = path.nearest(agent.level()),
        }
    }

    /// Sets a walker's next goal when it has reached the last one.
    pub(super) fn lead(&self, agent: &mut Agent) {
        match self {
            Self::Scripted | Self::Navigate => agent.follow_route(),
            Self::Wander { half } => {
                if !agent.is_on_its_way() {
                    agent.goal = Goal::Place(wander(agent, *half));
                }
            }
            Self::Path(path) => {
                // Progress is where it stands when its way is laid onto the path's direction.
                let (on_path, direction) = path.beside(agent.progress_m, agent.aside_m);
                let along = (agent.level() - on_path).dot(direction);
                agent.progress_m += along.clamp(0.0, 1.5);
                let ahead = agent.progress_m + AHEAD_M;
                agent.goal = Goal::Place(path.beside(ahead, agent.aside_m).0);
            }
        }
    }
}

/// Chooses a place of a rectangle with these half sides. People go on, and far, rather than back.
fn wander(agent: &mut Agent, half: Vec2) -> Vec2 {
    let mut chosen = (f32::INFINITY, Vec2::ZERO);
    for _ in 0..CHOICES {
        let shares = [agent.chance(), agent.chance()].map(|share| 2.0 * share - 1.0);
        let place = Vec2::from(shares) * half;
        let way = place - agent.level();
        let off = wrap_angle(way.x.atan2(way.y) - agent.heading).abs();
        let cost = off - way.length() / M_A_RAD;
        if cost < chosen.0 {
            chosen = (cost, place);
        }
    }
    chosen.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_followed_there_and_back_or_round() {
        let open = Path::new(vec![Vec2::ZERO, Vec2::new(0.0, 10.0)]).unwrap();
        assert_eq!(open.at(3.0), (Vec2::new(0.0, 3.0), Vec2::Y));
        assert_eq!(open.at(13.0), (Vec2::new(0.0, 7.0), Vec2::NEG_Y));
        let corners = [
            (0.0, 0.0),
            (10.0, 0.0),
            (10.0, 10.0),
            (0.0, 10.0),
            (0.0, 0.0),
        ];
        let round = Path::new(corners.map(Vec2::from).to_vec()).unwrap();
        assert!((round.length() - 40.0).abs() < 1e-4);
        assert_eq!(round.at(45.0), (Vec2::new(5.0, 0.0), Vec2::X));
        assert_eq!(round.beside(5.0, 1.0).0, Vec2::new(5.0, -1.0));
        assert!(Path::new(vec![Vec2::ZERO; 3]).is_none());
    }
}
