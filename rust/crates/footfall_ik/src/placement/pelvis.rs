//! Height of the pelvis over uneven ground.

use crate::placement::terrain::rise_along;
use footfall_core::ease::smooth_step;
use glam::Vec3;

/// A critically damped follower of a height.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Follower {
    pub(crate) value: f32,
    velocity: f32,
}

impl Follower {
    /// Approaches `target` for a time; `half_life_secs` is the approximate time for half of the distance.
    pub(crate) fn follow(&mut self, target: f32, half_life_secs: f32, dt_secs: f32) {
        // A critically damped spring passes half of the way after 1.68 / omega.
        let omega = 1.68 / half_life_secs.max(1e-3);
        let offset = self.value - target;
        let momentum = self.velocity + omega * offset;
        let decay = (-omega * dt_secs).exp();
        self.value = target + (offset + momentum * dt_secs) * decay;
        self.velocity = (self.velocity - omega * momentum * dt_secs) * decay;
    }

    /// Sets `value` at once, at rest.
    pub(crate) fn jump(&mut self, value: f32) {
        *self = Self {
            value,
            velocity: 0.0,
        };
    }

    /// Raises it to `value` at least, from where it comes down.
    pub(crate) fn lift_to(&mut self, value: f32) {
        if self.value < value {
            self.jump(value);
        }
    }
}

/// A height that reaches its targets smoothly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Ride {
    pub(crate) value: f32,
    velocity: f32,
    acceleration: f32,
    course: Option<Course>,
}

/// A curve of least jerk from one height, velocity and acceleration to another height and velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Course {
    from: [f32; 3],
    to: [f32; 2],
    /// Height in the middle above that curve.
    bow_m: f32,
    secs: f32,
    passed_secs: f32,
}

/// Differences of a request, in metres and seconds, up to which the current course is kept.
const SAME_M: f32 = 0.004;
const SAME_SECS: f32 = 0.03;
/// Least duration of a course, seconds.
const LEAST_SECS: f32 = 0.1;
/// Times to a landing, seconds: a way that is shorter than the first is not bowed, one longer than the second fully.
const BOW_SECS: [f32; 2] = [0.25, 0.4];
/// Least time of a frame in which a height has a velocity, seconds.
const LEAST_DT_SECS: f32 = 1e-3;
/// Share of a course's duration after which half of the distance is covered, for courses that are always replaced before their end.
const HALF_SHARE: f32 = 0.55;

impl Course {
    /// Height, velocity and acceleration now.
    fn now(&self) -> [f32; 3] {
        let ([from, departure, bend], [to, arrival], secs) = (self.from, self.to, self.secs);
        let s = self.passed_secs / secs;
        if s >= 1.0 {
            return [to + arrival * (self.passed_secs - secs), arrival, 0.0];
        }
        let (c1, c2) = (departure * secs, 0.5 * bend * secs * secs);
        let way = to - (from + c1 + c2);
        let speed = arrival * secs - (c1 + 2.0 * c2);
        let turn = -2.0 * c2;
        let c3 = 10.0 * way - 4.0 * speed + 0.5 * turn;
        let c4 = -15.0 * way + 7.0 * speed - turn;
        let c5 = 6.0 * way - 3.0 * speed + 0.5 * turn;
        // 1 in the middle, without a velocity or an acceleration at the ends.
        let (room, slant, bow) = (s * (1.0 - s), 1.0 - 2.0 * s, 64.0 * self.bow_m);
        [
            from + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5)))) + bow * room.powi(3),
            (c1 + s * (2.0 * c2 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))
                + bow * 3.0 * room * room * slant)
                / secs,
            (2.0 * c2
                + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))
                + bow * 6.0 * room * (slant * slant - room))
                / (secs * secs),
        ]
    }
}

impl Ride {
    /// Advances towards `target`, to pass it in `secs` at a velocity, on a way that is bowed up by so much in its middle.
    pub(crate) fn arrive(
        &mut self,
        [target, velocity]: [f32; 2],
        bow_m: f32,
        secs: f32,
        dt_secs: f32,
    ) {
        let kept = self.course.filter(|course| {
            let left = course.secs - course.passed_secs - dt_secs;
            (course.to[0] - target).abs() < SAME_M && (left - secs).abs() < SAME_SECS
        });
        let course = kept.unwrap_or(Course {
            from: [self.value, self.velocity, self.acceleration],
            to: [target, velocity],
            bow_m: bow_m * smooth_step((secs - BOW_SECS[0]) / (BOW_SECS[1] - BOW_SECS[0])),
            secs: (secs + dt_secs).max(LEAST_SECS),
            passed_secs: 0.0,
        });
        self.go(course, dt_secs);
        self.course = self.course.filter(|_| dt_secs > 0.0 || kept.is_some());
    }

    /// Approaches `target` for a time; `half_life_secs` is the approximate time for half of the distance.
    pub(crate) fn settle(&mut self, target: f32, half_life_secs: f32, dt_secs: f32) {
        let course = Course {
            from: [self.value, self.velocity, self.acceleration],
            to: [target, 0.0],
            bow_m: 0.0,
            secs: (half_life_secs / HALF_SHARE).max(1e-3),
            passed_secs: 0.0,
        };
        self.go(course, dt_secs);
        self.course = None;
    }

    fn go(&mut self, mut course: Course, dt_secs: f32) {
        course.passed_secs += dt_secs;
        [self.value, self.velocity, self.acceleration] = course.now();
        self.course = Some(course);
    }

    /// Sets `value` at once, at rest.
    pub(crate) fn jump(&mut self, value: f32) {
        *self = Self {
            value,
            ..Self::default()
        };
    }

    /// Moves it along with a support.
    pub(crate) fn carry(&mut self, rise_m: f32) {
        self.value += rise_m;
        if let Some(course) = &mut self.course {
            course.from[0] += rise_m;
            course.to[0] += rise_m;
        }
    }

    /// Lowers it to `limit` at most, from where it rises no faster than it has come there from `before` in this time.
    pub(crate) fn hold_below(&mut self, limit: f32, before: f32, dt_secs: f32) {
        if self.value > limit {
            let rise = (limit - before).max(0.0) / dt_secs.max(LEAST_DT_SECS);
            *self = Self {
                value: limit,
                velocity: self.velocity.min(rise),
                ..Self::default()
            };
        }
    }
}

/// Height of a plane under a place, for planes that are not upright.
pub(crate) fn plane_height(on_plane: Vec3, normal: Vec3, place: Vec3) -> f32 {
    let run = Vec3::new(place.x - on_plane.x, 0.0, place.z - on_plane.z).clamp_length_max(0.6);
    on_plane.y + rise_along(normal, run)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_follower_arrives_without_overshooting() {
        let mut follower = Follower::default();
        let mut before = 0.0;
        for frame in 0..120 {
            follower.follow(1.0, 0.1, 1.0 / 60.0);
            assert!(follower.value >= before && follower.value <= 1.0);
            before = follower.value;
            if frame == 5 {
                assert!((follower.value - 0.5).abs() < 0.02, "{}", follower.value);
            }
        }
        assert!(follower.value > 0.999);
    }

    #[test]
    fn a_ride_arrives_in_time_without_a_jerk_whatever_it_comes_from() {
        let mut ride = Ride::default();
        let dt = 1.0 / 60.0;
        let mut heights = vec![0.0, 0.0];
        for (target, velocity) in [(0.15, 0.3), (0.3, 0.3), (0.3, 0.0), (0.1, -0.2)] {
            for frame in 0..30 {
                let secs = (29 - frame) as f32 * dt;
                ride.arrive([target, velocity], 0.03, secs, dt);
                heights.push(ride.value);
            }
            assert!((ride.value - target).abs() < 1e-4, "{}", ride.value);
            assert!((ride.velocity - velocity).abs() < 1e-3);
        }
        for _ in 0..60 {
            ride.settle(0.2, 0.2, dt);
            heights.push(ride.value);
        }
        assert!((ride.value - 0.2).abs() < 1e-3);
        for at in heights.windows(3) {
            let bend = (at[0] - 2.0 * at[1] + at[2]).abs() / (dt * dt);
            assert!(bend < 8.0, "{bend} m/s²");
        }
    }

    #[test]
    fn a_bowed_way_is_higher_in_its_middle_alone() {
        let dt = 1.0 / 60.0;
        let way = |bow_m: f32| {
            let mut ride = Ride::default();
            let heights = (0..36).map(|frame| {
                ride.arrive([-0.1, -0.2], bow_m, (35 - frame) as f32 * dt, dt);
                ride.value
            });
            heights.collect::<Vec<f32>>()
        };
        let raised: Vec<f32> = way(0.03).iter().zip(way(0.0)).map(|(a, b)| a - b).collect();
        assert!((raised[17] - 0.03).abs() < 1e-3, "{raised:?}");
        assert!(raised[2] < 0.003 && raised[33] < 0.003, "{raised:?}");
        assert!(raised[35].abs() < 1e-5, "{raised:?}");
    }

    #[test]
    fn a_plane_is_followed_up_and_down() {
        let normal = Vec3::new(0.0, 1.0, -0.5).normalize();
        let ahead = plane_height(Vec3::Y, normal, Vec3::Z * 0.5);
        assert!((ahead - 1.25).abs() < 1e-6);
    }
}
