//! Prediction-error refinement (equation 11): the squared one-step errors of all segments, minimised over the system and the
//! states in which segments begin.
//!
//! The gradient runs backwards through each segment; L-BFGS takes the steps (J. Nocedal and S. Wright, "Numerical Optimization",
//! 2006, section 7.2).

use super::{AffineSystem, initial_states};
use crate::error::ProbError;
use nalgebra::{DMatrix, DVector};

/// Steps that shape the next.
const MEMORY: usize = 10;

/// What of an identified gain is tried.
const GAIN_SHARES: [f64; 6] = [1.0, 0.5, 0.25, 0.1, 0.03, 0.0];

/// Share of the promised gain that a step must bring.
const ARMIJO: f64 = 1e-4;

/// A step is halved at most so often.
const HALVINGS: usize = 20;

/// What refinement may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refinement {
    /// Everything but the gain, which counts as 0: segments are foretold from their initial states alone, as generation does.
    Simulation,
    /// The gain alone: what is foretold from the frames before.
    Gain,
}

/// What refinement came to.
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

struct Problem<'a> {
    order: usize,
    channels: usize,
    segments: &'a [&'a [f64]],
    numbers: f64,
    refinement: Refinement,
}

/// Where each part lies in a point.
struct Parts {
    transition: usize,
    drift: usize,
    output: usize,
    offset: usize,
    gain: usize,
    starts: usize,
}

impl Problem<'_> {
    fn parts(&self) -> Parts {
        let (n, m) = (self.order, self.channels);
        Parts {
            transition: 0,
            drift: n * n,
            output: n * n + n,
            offset: n * n + n + m * n,
            gain: n * n + n + m * n + m,
            starts: n * n + n + 2 * m * n + m,
        }
    }

    /// Matrices row by row, so that products run along rows.
    fn pack(system: &AffineSystem, starts: &[DVector<f64>]) -> Vec<f64> {
        let mut point = system.to_rows().concat();
        point.extend(starts.iter().flat_map(|start| start.iter()));
        point
    }

    fn unpack(&self, point: &[f64]) -> (AffineSystem, Vec<DVector<f64>>) {
        let (n, m) = (self.order, self.channels);
        let parts = self.parts();
        let matrix = |at: usize, rows: usize, columns: usize| {
            DMatrix::from_row_slice(rows, columns, &point[at..at + rows * columns])
        };
        let vector = |at: usize, len: usize| DVector::from_column_slice(&point[at..at + len]);
        let system = AffineSystem {
            transition: matrix(parts.transition, n, n),
            drift: vector(parts.drift, n),
            output: matrix(parts.output, m, n),
            offset: vector(parts.offset, m),
            gain: matrix(parts.gain, n, m),
        };
        let starts = point[parts.starts..].chunks_exact(n);
        (system, starts.map(DVector::from_column_slice).collect())
    }

    /// The first value and gradient, with the share of the gain that foretells best.
    fn begin(&self, point: &mut [f64], gradient: &mut [f64]) -> f64 {
        let parts = self.parts();
        let gain = point[parts.gain..parts.starts].to_vec();
        let mut with = |share: f64, gradient: &mut [f64]| {
            for (entry, gain) in point[parts.gain..parts.starts].iter_mut().zip(&gain) {
                *entry = share * gain;
            }
            self.evaluate(point, gradient)
        };
        let best = match self.refinement {
            Refinement::Simulation => 0.0,
            Refinement::Gain => GAIN_SHARES
                .into_iter()
                .map(|share| (with(share, gradient), share))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .map_or(0.0, |(_, share)| share),
        };
        with(best, gradient)
    }

    /// Half the mean squared error and its gradient; infinite where a prediction runs away.
    fn evaluate(&self, point: &[f64], gradient: &mut [f64]) -> f64 {
        let (n, m) = (self.order, self.channels);
        let parts = self.parts();
        let a = &point[parts.transition..parts.drift];
        let b = &point[parts.drift..parts.output];
        let c = &point[parts.output..parts.offset];
        let d = &point[parts.offset..parts.gain];
        let k = &point[parts.gain..parts.starts];
        gradient.fill(0.0);
        let mut total = 0.0;
        let (mut states, mut errors) = (Vec::new(), Vec::new());
        for (index, segment) in self.segments.iter().enumerate() {
            let frames = segment.len() / m;
            states.clear();
            errors.clear();
            states.extend_from_slice(&point[parts.starts + index * n..][..n]);
            for frame in 0..frames {
                let state = states.len() - n;
                for channel in 0..m {
                    let x = &states[state..state + n];
                    let foretold = dot(&c[channel * n..][..n], x) + d[channel];
                    errors.push(segment[frame * m + channel] - foretold);
                }
                let error = errors.len() - m;
                for row in 0..n {
                    let x = &states[state..state + n];
                    let next = dot(&a[row * n..][..n], x)
                        + b[row]
                        + dot(&k[row * m..][..m], &errors[error..error + m]);
                    states.push(next);
                }
            }
            total += dot(&errors, &errors);
            // λ[k] = (A − K C)ᵀ λ[k+1] − Cᵀ e[k], from λ beyond the end being 0.
            let mut ahead = vec![0.0; n];
            let mut output_pull = vec![0.0; m];
            for frame in (0..frames).rev() {
                let x = &states[frame * n..][..n];
                let e = &errors[frame * m..][..m];
                output_pull.copy_from_slice(e);
                for row in 0..n {
                    add(&mut output_pull, &k[row * m..][..m], ahead[row]);
                    add(
                        &mut gradient[parts.transition + row * n..][..n],
                        x,
                        ahead[row],
                    );
                    add(&mut gradient[parts.gain + row * m..][..m], e, ahead[row]);
                    gradient[parts.drift + row] += ahead[row];
                }
                let mut here = vec![0.0; n];
                for row in 0..n {
                    add(&mut here, &a[row * n..][..n], ahead[row]);
                }
                for channel in 0..m {
                    let pull = -output_pull[channel];
                    add(&mut gradient[parts.output + channel * n..][..n], x, pull);
                    gradient[parts.offset + channel] += pull;
                    add(&mut here, &c[channel * n..][..n], pull);
                }
                ahead = here;
            }
            gradient[parts.starts + index * n..][..n].copy_from_slice(&ahead);
        }
        for value in &mut *gradient {
            *value /= self.numbers;
        }
        match self.refinement {
            Refinement::Simulation => gradient[parts.gain..parts.starts].fill(0.0),
            Refinement::Gain => {
                gradient[..parts.gain].fill(0.0);
                gradient[parts.starts..].fill(0.0);
            }
        }
        let value = 0.5 * total / self.numbers;
        if value.is_finite() {
            value
        } else {
            f64::INFINITY
        }
    }

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

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add(target: &mut [f64], values: &[f64], weight: f64) {
    for (target, value) in target.iter_mut().zip(values) {
        *target += weight * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::subspace::{IdentifyConfig, identify, initial_state};

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
