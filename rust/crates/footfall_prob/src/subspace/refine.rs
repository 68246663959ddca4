//! Prediction-error refinement (equation 11): the squared one-step errors of all segments, minimised over the system and the
//! states in which segments begin.
//!
//! The gradient runs backwards through each segment; L-BFGS takes the steps (J. Nocedal and S. Wright, "Numerical Optimization",
//! 2006, section 7.2).

use super::problem::{Problem, add, dot};
use super::{AffineSystem, initial_states};
use crate::error::ProbError;
use nalgebra::DVector;

/// Steps that shape the next.
const MEMORY: usize = 10;

/// Share of the promised gain that a step must bring.
const ARMIJO: f64 = 1e-4;

/// Most bisections of a step.
const HALVINGS: usize = 20;

/// Parameters that refinement may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refinement {
    /// Everything but the gain, which counts as 0: segments are foretold from their initial states alone, as generation does.
    Simulation,
    /// The gain alone: what is foretold from the frames before.
    Gain,
}

/// Result of refinement.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// The system.
    pub system: AffineSystem,
    /// The state in which each segment begins.
    pub starts: Vec<DVector<f64>>,
    /// Mean squared error a frame and output, before and after every step; never rises.
    pub errors: Vec<f64>,
}

/// Minimises the squared prediction errors of segments from an identified system, in at most `steps` steps.
///
/// A gain with which predictions run away is made smaller first.
///
/// # Errors
/// As [`initial_states`] for a segment that is empty or not finite.
pub fn refine(
    system: &AffineSystem,
    segments: &[&[f64]],
    refinement: Refinement,
    steps: usize,
) -> Result<Refined, ProbError> {
    let starts = initial_states(system, segments)?;
    let problem = Problem {
        order: system.order(),
        channels: system.channels(),
        segments,
        numbers: segments.iter().map(|segment| segment.len()).sum::<usize>() as f64,
        refinement,
    };
    let mut point = Problem::pack(system, &starts);
    let mut gradient = vec![0.0; point.len()];
    let mut value = problem.begin(&mut point, &mut gradient);
    let mut errors = vec![value];
    let mut history: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for _ in 0..steps {
        let mut direction = descent(&gradient, value, &history);
        let mut slope = dot(&direction, &gradient);
        if slope >= 0.0 {
            history.clear();
            direction = descent(&gradient, value, &history);
            slope = dot(&direction, &gradient);
        }
        let Some((next, next_gradient, next_value)) =
            problem.search(&point, value, &direction, slope)
        else {
            break;
        };
        let moved: Vec<f64> = next.iter().zip(&point).map(|(a, b)| a - b).collect();
        let bent = next_gradient.iter().zip(&gradient);
        let bent: Vec<f64> = bent.map(|(a, b)| a - b).collect();
        if dot(&moved, &bent) > 0.0 {
            if history.len() == MEMORY {
                history.remove(0);
            }
            history.push((moved, bent));
        }
        let gained = value - next_value;
        (point, gradient, value) = (next, next_gradient, next_value);
        errors.push(value);
        if gained < 1e-7 * value {
            break;
        }
    }
    let (system, starts) = problem.unpack(&point);
    Ok(Refined {
        system,
        starts,
        errors,
    })
}

/// The two-loop recursion. The first step is as long as would bring the error to zero, were it to go on as steeply.
fn descent(gradient: &[f64], value: f64, history: &[(Vec<f64>, Vec<f64>)]) -> Vec<f64> {
    let mut direction: Vec<f64> = gradient.iter().map(|g| -g).collect();
    let mut shares = Vec::with_capacity(history.len());
    for (moved, bent) in history.iter().rev() {
        let share = dot(moved, &direction) / dot(moved, bent);
        add(&mut direction, bent, -share);
        shares.push(share);
    }
    let scale = match history.last() {
        Some((moved, bent)) => dot(moved, bent) / dot(bent, bent),
        None => value / dot(gradient, gradient).max(f64::MIN_POSITIVE),
    };
    for value in &mut direction {
        *value *= scale;
    }
    for ((moved, bent), share) in history.iter().zip(shares.into_iter().rev()) {
        let correction = share - dot(bent, &direction) / dot(moved, bent);
        add(&mut direction, moved, correction);
    }
    direction
}

impl Problem<'_> {
    /// The first of ever shorter steps that gains enough.
    fn search(
        &self,
        point: &[f64],
        value: f64,
        direction: &[f64],
        slope: f64,
    ) -> Option<(Vec<f64>, Vec<f64>, f64)> {
        let mut step = 1.0;
        let mut gradient = vec![0.0; point.len()];
        for _ in 0..HALVINGS {
            let mut next = point.to_vec();
            add(&mut next, direction, step);
            let found = self.evaluate(&next, &mut gradient);
            if found <= value + ARMIJO * step * slope {
                return Some((next, gradient, found));
            }
            step *= 0.5;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::subspace::{IdentifyConfig, identify, initial_state};
    use nalgebra::DMatrix;

    /// Two mixed oscillations, one of them growing, on offsets.
    fn known() -> AffineSystem {
        let block = |angle: f64, growth: f64| {
            let (sin, cos) = angle.sin_cos();
            [growth * cos, -growth * sin, growth * sin, growth * cos]
        };
        let mut transition = DMatrix::zeros(4, 4);
        for (at, part) in [(0, block(0.35, 1.01)), (2, block(0.12, 0.98))] {
            for index in 0..4 {
                transition[(at + index / 2, at + index % 2)] = part[index];
            }
        }
        AffineSystem {
            transition,
            drift: DVector::from_vec(vec![0.1, -0.05, 0.02, 0.08]),
            output: DMatrix::from_row_slice(
                3,
                4,
                &[1.0, 0.2, 0.5, 0.0, 0.0, 1.0, -0.3, 0.4, 0.3, -0.5, 0.0, 1.0],
            ),
            offset: DVector::from_vec(vec![0.5, -1.0, 2.0]),
            gain: DMatrix::zeros(4, 3),
        }
    }

    fn segments(noise: f64) -> Vec<Vec<f64>> {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as f64 / f64::from(1_u32 << 31) - 0.5
        };
        (0..12)
            .map(|_| {
                let start = DVector::from_fn(4, |_, _| 2.0 * random());
                let mut outputs = known().simulate(&start, 25);
                for value in &mut outputs {
                    *value += noise * 12.0_f64.sqrt() * random();
                }
                outputs
            })
            .collect()
    }

    fn config() -> IdentifyConfig {
        IdentifyConfig {
            order: 4,
            window: 3,
        }
    }

    #[test]
    fn a_known_system_is_identified_from_segments_too_short_for_one() {
        let segments = segments(0.0);
        let views: Vec<&[f64]> = segments.iter().map(Vec::as_slice).collect();
        // One segment of six frames has too few columns, twelve have enough.
        assert!(identify(&[&views[0][..18]], 3, &config()).is_err());
        let short: Vec<&[f64]> = views.iter().map(|view| &view[..18]).collect();
        let of_short = identify(&short, 3, &config()).unwrap();
        let radius = |system: &AffineSystem| {
            let poles = system.transition.complex_eigenvalues();
            poles.iter().map(|z| z.norm()).fold(0.0, f64::max)
        };
        assert!((radius(&of_short) - 1.01).abs() < 1e-3);
        let found = identify(&views, 3, &config()).unwrap();
        let mut poles: Vec<f64> = found
            .transition
            .complex_eigenvalues()
            .iter()
            .map(|z| z.norm())
            .collect();
        poles.sort_by(f64::total_cmp);
        for (found, known) in poles.iter().zip([0.98, 0.98, 1.01, 1.01]) {
            assert!((found - known).abs() < 1e-4, "{poles:?}");
        }
        for segment in &views {
            let start = initial_state(&found, segment).unwrap();
            let simulated = found.simulate(&start, 25);
            let worst = simulated
                .iter()
                .zip(*segment)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(worst < 1e-3, "{worst}");
        }
    }

    #[test]
    fn refinement_comes_down_towards_the_noise_and_never_goes_up() {
        let noise = 0.02;
        let segments = segments(noise);
        let views: Vec<&[f64]> = segments.iter().map(Vec::as_slice).collect();
        let found = identify(&views, 3, &config()).unwrap();
        let refined = refine(&found, &views, Refinement::Simulation, 60).unwrap();
        for pair in refined.errors.windows(2) {
            assert!(pair[1] <= pair[0]);
        }
        assert_eq!(refined.system.gain, DMatrix::zeros(4, 3));
        let last = (2.0 * refined.errors.last().unwrap()).sqrt();
        assert!(last < 1.25 * noise, "{last} for a noise of {noise}");
        assert!(refined.errors[0] > *refined.errors.last().unwrap());
        // A gain cannot foretell noise, but it makes up for what is left of the system's errors.
        let mut wild = refined.system.clone();
        wild.gain = DMatrix::from_element(4, 3, 5.0);
        let gained = refine(&wild, &views, Refinement::Gain, 60).unwrap();
        assert!(gained.errors.last() <= refined.errors.last());
        assert_eq!(gained.system.transition, wild.transition);
    }

    #[test]
    fn the_gradient_is_that_of_differences() {
        let segments = segments(0.05);
        let views: Vec<&[f64]> = segments.iter().take(3).map(Vec::as_slice).collect();
        let mut system = known();
        system.gain = DMatrix::from_fn(4, 3, |i, j| 0.05 * (i as f64 - j as f64));
        let point = Problem::pack(&system, &vec![DVector::from_element(4, 0.3); 3]);
        let problem = |refinement| Problem {
            order: 4,
            channels: 3,
            segments: &views,
            numbers: 225.0,
            refinement,
        };
        let parts = problem(Refinement::Gain).parts();
        let mut gradient = vec![0.0; point.len()];
        problem(Refinement::Gain).evaluate(&point, &mut gradient);
        let of_gain = gradient[parts.gain..parts.starts].to_vec();
        let problem = problem(Refinement::Simulation);
        problem.evaluate(&point, &mut gradient);
        gradient[parts.gain..parts.starts].copy_from_slice(&of_gain);
        let mut scratch = vec![0.0; point.len()];
        for index in 0..point.len() {
            let mut at = |by: f64| {
                let mut moved = point.clone();
                moved[index] += by;
                problem.evaluate(&moved, &mut scratch)
            };
            let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
            let error = (difference - gradient[index]).abs();
            assert!(
                error < 1e-5 * (1.0 + difference.abs()),
                "number {index}: {difference}"
            );
        }
        assert_eq!(problem.unpack(&point).0, system);
    }

    #[test]
    fn bad_input_is_named() {
        let flat = vec![0.0; 300];
        assert!(
            identify(
                &[&flat],
                3,
                &IdentifyConfig {
                    order: 20,
                    window: 3
                }
            )
            .is_err()
        );
        assert!(identify(&[], 3, &config()).is_err());
        assert!(identify(&[&[f64::NAN; 300]], 3, &config()).is_err());
        assert!(identify(&[&flat[..299]], 3, &config()).is_err());
        assert!(initial_state(&known(), &[]).is_err());
    }
}
