//! Linear-regression transforms: a few frames move every Gaussian of a model.
//!
//! One affine map, shared by a class of Gaussians, takes their means and variances together to a new speaker or style:
//! μ̂ = Aμ − b, Σ̂ = `AΣAᵀ` (equations 5 and 6 of the paper). Both sharing A is the same as leaving the model alone and
//! mapping the frames back, o ↦ Fo + g with F = A⁻¹ ([`LinearTransform`]), at the price of ln|F| a frame: constrained
//! maximum-likelihood linear regression, CMLLR (Gales 1998). With a matrix-variate Gaussian prior on \[g F\] it is
//! constrained maximum a posteriori, and with the prior centred on the transform of the parent in a tree of classes it is
//! CSMAPLR (Yamagishi et al. 2009); [`RegressionTree`] is the tree. [`map_estimate`] then moves each Gaussian on its own.
//!
//! Covariances are diagonal, so blocks of features that no transform mixes are problems of their own: call
//! [`estimate_transform`] once a block; a block of one feature is the scalar form that durations need.

mod dense;
mod transform;
mod tree;

use dense::Factor;
pub use transform::LinearTransform;
pub use tree::{RegressionNode, RegressionTree};

use crate::error::{ProbError, check_finite, check_len, check_positive};
use crate::gaussian::{DiagonalGaussian, GaussianStats};

/// Statistics of the frames that belong to one Gaussian, as a transform needs them: Σ γ ξξᵀ with ξ = (1, o).
#[derive(Debug, Clone, PartialEq)]
pub struct RegressionStats {
    dim: usize,
    /// (D + 1) × (D + 1), row-major; only the lower triangle is kept up.
    moments: Vec<f64>,
}

impl RegressionStats {
    /// Empty statistics over `dim` dimensions.
    pub fn new(dim: usize) -> Self {
        Self {
            dim,
            moments: vec![0.0; (dim + 1) * (dim + 1)],
        }
    }

    /// Adds a frame (D values) with a weight; weights of zero or less, or NaN, change nothing.
    pub fn add(&mut self, frame: &[f64], weight: f64) {
        if weight.is_nan() || weight <= 0.0 {
            return;
        }
        let size = self.dim + 1;
        self.moments[0] += weight;
        for (i, left) in frame.iter().enumerate() {
            let weighted = weight * left;
            let row = &mut self.moments[(i + 1) * size..(i + 2) * size];
            row[0] += weighted;
            for (sum, right) in row[1..].iter_mut().zip(&frame[..=i]) {
                *sum += weighted * right;
            }
        }
    }

    /// Adds what `other` has seen.
    pub fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.moments.iter_mut().zip(&other.moments) {
            *mine += theirs;
        }
    }

    /// Sum of the weights: how many frames were seen, in expectation.
    pub fn weight(&self) -> f64 {
        self.moments[0]
    }

    /// Element (i, j) of Σ γ ξξᵀ.
    fn moment(&self, i: usize, j: usize) -> f64 {
        self.moments[i.max(j) * (self.dim + 1) + i.min(j)]
    }
}

/// A Gaussian of the model and the frames that belong to it.
#[derive(Debug, Clone, Copy)]
pub struct RegressionMember<'a> {
    /// The model's Gaussian.
    pub gaussian: &'a DiagonalGaussian,
    /// Its frames.
    pub stats: &'a RegressionStats,
}

/// A matrix-variate Gaussian prior: element (i, j) of \[g F\] has the mean of `centre` and the precision
/// `row_precision[i]` × `bias_weight` (j = 0) or × `matrix_weight`.
///
/// With the row precisions of the model's Gaussians, the weights count frames: the prior is as strong as that many
/// frames of unit size that say the centre is right.
#[derive(Debug, Clone, Copy)]
pub struct TransformPrior<'a> {
    /// The most probable transform: the parent's, or the identity.
    pub centre: &'a LinearTransform,
    /// Precision of each row, D values above zero.
    pub row_precision: &'a [f64],
    /// Weight on g, above zero.
    pub bias_weight: f64,
    /// Weight on F, above zero.
    pub matrix_weight: f64,
}

impl TransformPrior<'_> {
    fn weight(&self, column: usize) -> f64 {
        if column == 0 {
            self.bias_weight
        } else {
            self.matrix_weight
        }
    }

    /// Log density of a transform, up to a constant: zero at the centre.
    pub fn log_density(&self, transform: &LinearTransform) -> f64 {
        let row = |i: usize| -> f64 {
            let pairs = transform.row(i).iter().zip(self.centre.row(i)).enumerate();
            pairs
                .map(|(j, (value, centre))| self.weight(j) * (value - centre).powi(2))
                .sum()
        };
        (0..transform.dim)
            .map(|i| -0.5 * self.row_precision[i] * row(i))
            .sum()
    }
}

/// A transform and how its search went.
#[derive(Debug, Clone, PartialEq)]
pub struct EstimatedTransform {
    /// The transform.
    pub transform: LinearTransform,
    /// [`transform_objective`] before the first sweep and after each; never falls.
    pub objectives: Vec<f64>,
}

/// Expected log-likelihood of the members' frames under a transform, plus the prior's log density.
///
/// # Errors
/// [`ProbError`] when shapes differ.
pub fn transform_objective(
    members: &[RegressionMember<'_>],
    prior: Option<&TransformPrior<'_>>,
    transform: &LinearTransform,
) -> Result<f64, ProbError> {
    check(members, prior, transform)?;
    let weight: f64 = members.iter().map(|member| member.stats.weight()).sum();
    let mut objective = prior.map_or(0.0, |prior| prior.log_density(transform));
    if weight > 0.0 {
        objective += weight * transform.log_determinant();
    }
    let size = transform.dim + 1;
    for RegressionMember { gaussian, stats } in members {
        // At the origin all that is left of the density is its normaliser and the mean's own term.
        let normaliser = gaussian.log_density(gaussian.mean());
        objective += stats.weight() * normaliser;
        for i in 0..transform.dim {
            let (row, mean) = (transform.row(i), gaussian.mean()[i]);
            let mut distance = stats.weight() * mean * mean;
            for a in 0..size {
                distance -= 2.0 * mean * row[a] * stats.moment(a, 0);
                for b in 0..size {
                    distance += row[a] * row[b] * stats.moment(a, b);
                }
            }
            objective -= 0.5 * gaussian.precision()[i] * distance;
        }
    }
    Ok(objective)
}

/// The transform under which the members' frames are most likely, given the prior if there is one.
///
/// Row by row in closed form (Gales 1998, section 3.2): given the others, the best row is a root of a quadratic equation,
/// and the better of both roots is taken, so no sweep makes the objective fall. Stops after `max_sweeps`, or when a sweep
/// gains less than 1e-9 a frame. Without a frame the result is the prior's centre, or the identity.
///
/// # Errors
/// [`ProbError`] when shapes differ, a weight is not above zero, or, without a prior, the frames are too few or too alike to
/// determine the transform.
pub fn estimate_transform(
    members: &[RegressionMember<'_>],
    prior: Option<&TransformPrior<'_>>,
    start: &LinearTransform,
    max_sweeps: usize,
) -> Result<EstimatedTransform, ProbError> {
    check(members, prior, start)?;
    let weight: f64 = members.iter().map(|member| member.stats.weight()).sum();
    if weight <= 0.0 {
        let transform = prior.map_or_else(
            || LinearTransform::identity(start.dim),
            |prior| prior.centre.clone(),
        );
        return Ok(EstimatedTransform {
            objectives: vec![transform_objective(members, prior, &transform)?],
            transform,
        });
    }
    let rows: Vec<RowProblem> = (0..start.dim)
        .map(|i| RowProblem::new(members, prior, i))
        .collect::<Result<_, _>>()?;
    let mut transform = start.clone();
    let mut objectives = vec![transform_objective(members, prior, start)?];
    for _ in 0..max_sweeps {
        let before = transform.clone();
        sweep(&rows, weight, &mut transform)?;
        let objective = transform_objective(members, prior, &transform)?;
        let last = objectives[objectives.len() - 1];
        if objective < last || objective.is_nan() {
            // Only rounding gets here: at the optimum already.
            transform = before;
            break;
        }
        objectives.push(objective);
        if objective - last < 1e-9 * weight {
            break;
        }
    }
    Ok(EstimatedTransform {
        transform,
        objectives,
    })
}

/// Improves every row once, given the others.
fn sweep(
    rows: &[RowProblem],
    weight: f64,
    transform: &mut LinearTransform,
) -> Result<(), ProbError> {
    let dim = transform.dim;
    let degenerate = ProbError::Degenerate { what: "transform" };
    let (mut inverse, _) = dense::invert(&transform.matrix(), dim).ok_or(degenerate)?;
    for (i, problem) in rows.iter().enumerate() {
        // Column i of the inverse is row i of the cofactors over the determinant.
        let mut cofactors = vec![0.0; dim + 1];
        for j in 0..dim {
            cofactors[j + 1] = inverse[(j, i)];
        }
        let best = problem.best_row(&cofactors, weight);
        let row = &mut transform.rows[i * (dim + 1)..(i + 1) * (dim + 1)];
        let change: Vec<f64> = (1..=dim).map(|j| best[j] - row[j]).collect();
        row.copy_from_slice(&best);
        dense::update_inverse(&mut inverse, i, &change);
    }
    Ok(())
}

/// Everything about one row that does not change: its quadratic form, factored, and its linear term.
struct RowProblem {
    factor: Factor,
    /// The linear term k, and G⁻¹k.
    linear: Vec<f64>,
    solved: Vec<f64>,
}

impl RowProblem {
    fn new(
        members: &[RegressionMember<'_>],
        prior: Option<&TransformPrior<'_>>,
        i: usize,
    ) -> Result<Self, ProbError> {
        let size = members
            .first()
            .map_or(1, |member| member.gaussian.dim() + 1);
        let mut quadratic = vec![0.0; size * size];
        let mut linear = vec![0.0; size];
        for RegressionMember { gaussian, stats } in members {
            let precision = gaussian.precision()[i];
            for (sum, moment) in quadratic.iter_mut().zip(&stats.moments) {
                *sum += precision * moment;
            }
            for (j, sum) in linear.iter_mut().enumerate() {
                *sum += precision * gaussian.mean()[i] * stats.moment(j, 0);
            }
        }
        if let Some(prior) = prior {
            for j in 0..size {
                let precision = prior.row_precision[i] * prior.weight(j);
                quadratic[j * size + j] += precision;
                linear[j] += precision * prior.centre.row(i)[j];
            }
        }
        let degenerate = ProbError::Degenerate {
            what: "row of a transform",
        };
        let factor = Factor::new(&quadratic, size).ok_or(degenerate)?;
        Ok(Self {
            solved: factor.solve(&linear),
            factor,
            linear,
        })
    }

    /// Maximises N ln|p·w| − ½ wᵀGw + kᵀw: w = G⁻¹(αp + k) with α²·pᵀG⁻¹p + α·pᵀG⁻¹k = N.
    fn best_row(&self, cofactors: &[f64], weight: f64) -> Vec<f64> {
        let direction = self.factor.solve(cofactors);
        let square = dot(cofactors, &direction);
        let mixed = dot(&direction, &self.linear);
        let root = (mixed * mixed + 4.0 * weight * square).sqrt();
        let value = |alpha: f64| {
            weight * (alpha * square + mixed).abs().ln() - 0.5 * alpha * alpha * square
        };
        let roots = [(-mixed + root), (-mixed - root)].map(|top| top / (2.0 * square));
        let alpha = if value(roots[0]) >= value(roots[1]) {
            roots[0]
        } else {
            roots[1]
        };
        let pairs = direction.iter().zip(&self.solved);
        pairs.map(|(d, s)| alpha * d + s).collect()
    }
}

/// A Gaussian re-estimated from its own frames, with `prior` counting for `prior_weight` frames (maximum a posteriori, the
/// last step of section 5.1.3): without frames it is the prior, with many it is theirs.
///
/// # Errors
/// [`ProbError`] when the shapes differ or the weight is not above zero.
pub fn map_estimate(
    prior: &DiagonalGaussian,
    stats: &GaussianStats,
    prior_weight: f64,
) -> Result<DiagonalGaussian, ProbError> {
    check_len("statistics", stats.dim(), prior.dim())?;
    check_positive("prior weight", &[prior_weight])?;
    let share = stats.weight() / (stats.weight() + prior_weight);
    let mut mean = prior.mean().to_vec();
    let mut variance = prior.variance().to_vec();
    let seen = stats.variance();
    for d in 0..prior.dim() {
        mean[d] += share * (stats.mean()[d] - prior.mean()[d]);
        let about_mean = seen[d] + (stats.mean()[d] - mean[d]).powi(2);
        variance[d] += share * (about_mean - prior.variance()[d]);
    }
    DiagonalGaussian::new(mean, variance)
}

fn check(
    members: &[RegressionMember<'_>],
    prior: Option<&TransformPrior<'_>>,
    transform: &LinearTransform,
) -> Result<(), ProbError> {
    if members.is_empty() {
        return Err(ProbError::Empty { what: "members" });
    }
    for member in members {
        check_len("mean", member.gaussian.dim(), transform.dim)?;
        check_len("statistics", member.stats.dim, transform.dim)?;
        check_finite("statistics", &member.stats.moments)?;
    }
    if let Some(prior) = prior {
        check_len("prior centre", prior.centre.dim, transform.dim)?;
        check_len("row precision", prior.row_precision.len(), transform.dim)?;
        check_positive("row precision", prior.row_precision)?;
        check_positive("prior weights", &[prior.bias_weight, prior.matrix_weight])?;
    }
    Ok(())
}

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(l, r)| l * r).sum()
}
