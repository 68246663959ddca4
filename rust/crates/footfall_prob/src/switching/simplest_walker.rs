//! The simplest walker: two straight legs that walk down a slope by gravity alone.
//!
//! M. Garcia, A. Chatterjee, A. Ruina and M. Coleman, "The simplest walking model: stability, complexity, and scaling" (1998):
//! massless legs, a point mass at the hip, infinitesimal ones at the feet. The ground truth for switch detection, as in section
//! 2: its switches are computed, not detected. Units: leg length 1, time in √(l/g).

/// Longest step of the integration.
const MAX_DT: f64 = 1e-3;

/// A walker in the middle of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimplestWalker {
    /// Slope of the ground, radians.
    slope: f64,
    /// Angle of the stance leg to the slope's normal, of the swing leg to the stance leg, and their rates.
    state: [f64; 4],
    /// True when the first leg is the one that stands.
    first_stands: bool,
}

/// Motion of a walker, frame by frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WalkerRecord {
    /// Frame by frame, the angles of the first and of the second leg to the slope's normal.
    pub angles: Vec<f64>,
    /// Frame by frame, the rates of these angles.
    pub rates: Vec<f64>,
    /// The first frame after each heel strike.
    pub switches: Vec<usize>,
}

impl SimplestWalker {
    /// Near the stable gait of a slope of 0.009, at the beginning of a step.
    pub fn new(slope: f64) -> Self {
        Self {
            slope,
            state: [0.2, 0.4, -0.2, -0.016],
            first_stands: true,
        }
    }

    /// Walks `frames` frames, `dt` apart. Ends early if it falls.
    pub fn walk(&mut self, frames: usize, dt: f64) -> WalkerRecord {
        let mut record = WalkerRecord::default();
        for frame in 0..frames {
            let [stance, between, rate, between_rate] = self.state;
            if !stance.is_finite() || stance.abs() > 1.0 {
                break;
            }
            let (mut angles, mut rates) = ([stance, stance - between], [rate, rate - between_rate]);
            if !self.first_stands {
                angles.reverse();
                rates.reverse();
            }
            record.angles.extend(angles);
            record.rates.extend(rates);
            if self.advance(dt).is_some() && frame + 1 < frames {
                record.switches.push(frame + 1);
            }
        }
        record
    }

    /// The state at the beginning of the next step: stance angle and rate, which the gait repeats.
    pub fn next_step(&mut self) -> [f64; 2] {
        // No step takes longer than ten units of time.
        for _ in 0..(10.0 / MAX_DT) as usize {
            if let Some(state) = self.advance(MAX_DT) {
                return [state[0], state[2]];
            }
        }
        [self.state[0], self.state[2]]
    }

    /// Lets time pass. Returns the state right after a heel strike, where there was one.
    fn advance(&mut self, dt: f64) -> Option<[f64; 4]> {
        let mut struck = None;
        let mut left = dt;
        while left > 0.0 {
            let step = left.min(MAX_DT);
            let before = self.state;
            let after = runge_kutta(before, step, self.slope);
            if strikes(before, after) {
                // The moment of the strike, by bisection.
                let (mut low, mut high) = (0.0, step);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if strikes(before, runge_kutta(before, middle, self.slope)) {
                        high = middle;
                    } else {
                        low = middle;
                    }
                }
                self.state = heel_strike(runge_kutta(before, high, self.slope));
                self.first_stands = !self.first_stands;
                left -= high.max(f64::EPSILON);
                struck = Some(self.state);
            } else {
                self.state = after;
                left -= step;
            }
        }
        struck
    }
}

/// Returns true when the swing foot comes down between two states. It scuffs the ground as the legs pass; that does not count.
fn strikes(before: [f64; 4], after: [f64; 4]) -> bool {
    let height = |state: [f64; 4]| state[1] - 2.0 * state[0];
    after[0] < -0.05 && height(before) < 0.0 && height(after) >= 0.0
}

/// The jump of the state (equation 3 for this walker): the legs change roles, and the hip's velocity along the new stance leg
/// is lost.
fn heel_strike([stance, _, rate, _]: [f64; 4]) -> [f64; 4] {
    let cos = (2.0 * stance).cos();
    [-stance, -2.0 * stance, cos * rate, cos * (1.0 - cos) * rate]
}

/// Equations of motion (1): stance leg an inverted pendulum, swing leg a pendulum on an accelerated hip.
fn derivative([stance, between, rate, between_rate]: [f64; 4], slope: f64) -> [f64; 4] {
    let stance_acceleration = (stance - slope).sin();
    let between_acceleration =
        stance_acceleration + rate * rate * between.sin() - (stance - slope).cos() * between.sin();
    [
        rate,
        between_rate,
        stance_acceleration,
        between_acceleration,
    ]
}

fn runge_kutta(state: [f64; 4], dt: f64, slope: f64) -> [f64; 4] {
    let moved = |by: [f64; 4], share: f64| core::array::from_fn(|i| state[i] + share * dt * by[i]);
    let k1 = derivative(state, slope);
    let k2 = derivative(moved(k1, 0.5), slope);
    let k3 = derivative(moved(k2, 0.5), slope);
    let k4 = derivative(moved(k3, 1.0), slope);
    core::array::from_fn(|i| state[i] + dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::switching::{PeakConfig, ProjectionResidual, choose_window, peaks};

    #[test]
    fn it_settles_into_the_gait_of_the_paper() {
        let mut walker = SimplestWalker::new(0.009);
        let mut last = [0.0; 2];
        for _ in 0..120 {
            last = walker.next_step();
        }
        // Garcia et al. 1998, the stable gait at a slope of 0.009.
        assert!((last[0] - 0.200_310_9).abs() < 1e-5, "{last:?}");
        assert!((last[1] + 0.199_832_5).abs() < 1e-5, "{last:?}");
    }

    /// Every switch, and none else. Rates jump: the first frame after the strike shows it. Angles only bend: when the strike is
    /// just before a frame, the next one shows it.
    #[test]
    fn every_switch_of_the_walker_is_found_in_its_frame() {
        for dt in [0.05, 0.07, 0.1] {
            let mut walker = SimplestWalker::new(0.009);
            for _ in 0..40 {
                walker.next_step();
            }
            let frames = 700;
            let record = walker.walk(frames, dt);
            assert!(record.switches.len() > 7);
            let states: Vec<f64> = record
                .angles
                .chunks_exact(2)
                .zip(record.rates.chunks_exact(2))
                .flat_map(|(angles, rates)| [angles[0], angles[1], rates[0], rates[1]])
                .collect();
            let (found, known) = (found(&states, 4), inside(&record.switches, frames));
            assert_eq!(found, known, "states, dt {dt}");
            let found = self::found(&record.angles, 2);
            assert_eq!(found.len(), known.len(), "angles, dt {dt}");
            for (found, known) in found.iter().zip(&known) {
                assert!(
                    (0..2).contains(&(found - known)),
                    "{found} for {known}, dt {dt}"
                );
            }
        }
    }

    fn found(outputs: &[f64], channels: usize) -> Vec<usize> {
        let config = PeakConfig::default();
        let window = choose_window(outputs, channels, 2..=8, &config)
            .unwrap()
            .unwrap();
        let residual = ProjectionResidual::new(outputs, channels, window).unwrap();
        let found = peaks(&residual.norms(), &config).into_iter();
        let found: Vec<usize> = found.map(|peak| peak + residual.first_frame()).collect();
        inside(&found, outputs.len() / channels)
    }

    /// A switch near the ends is not seen whole.
    fn inside(switches: &[usize], frames: usize) -> Vec<usize> {
        let whole = 16..frames - 16;
        let switches = switches.iter().copied();
        switches.filter(|frame| whole.contains(frame)).collect()
    }
}
