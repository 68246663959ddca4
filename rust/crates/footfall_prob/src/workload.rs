//! A made-up but walk-like MLPG problem for benchmarks and tests: always the same numbers.

/// States, durations and shapes of a long walk.
#[derive(Debug, Clone, PartialEq)]
pub struct MlpgWorkload {
    /// Static dimensions D.
    pub dim: usize,
    /// Frames that each of the S states lasts, in order.
    pub durations: Vec<usize>,
    /// S x 3D, radians (per frame, per frame²).
    pub means: Vec<f64>,
    /// S x 3D.
    pub variances: Vec<f64>,
}

impl MlpgWorkload {
    /// `n_frames` frames in `n_states` states of near-equal duration.
    pub fn new(n_frames: usize, n_states: usize, dim: usize) -> Self {
        let durations: Vec<usize> = (0..n_states)
            .map(|s| (s + 1) * n_frames / n_states - s * n_frames / n_states)
            .collect();
        let mut means = Vec::with_capacity(n_states * 3 * dim);
        let mut variances = Vec::with_capacity(n_states * 3 * dim);
        // Joints swing once per ten states; two irrational rates keep values from repeating.
        let wobble = |i: usize, rate: f64| (i as f64 * rate).sin();
        for state in 0..n_states {
            let angle = |d: usize| 0.628 * state as f64 + 0.7 * d as f64;
            let swing = |d: usize| 0.1 + 0.3 * wobble(d, 1.618).abs();
            means.extend(
                (0..dim).map(|d| swing(d) * angle(d).sin() + 0.02 * wobble(state * dim + d, 2.414)),
            );
            means.extend((0..dim).map(|d| 0.1 * swing(d) * angle(d).cos()));
            means.extend((0..dim).map(|d| -0.01 * swing(d) * angle(d).sin()));
            for scale in [4e-3, 1e-4, 1e-5] {
                variances
                    .extend((0..dim).map(|d| scale * (1.0 + 0.8 * wobble(state * dim + d, 3.303))));
            }
        }
        Self {
            dim,
            durations,
            means,
            variances,
        }
    }

    /// The problem on which the project's figures are quoted: 1000 frames, 165 states, 54 dimensions.
    pub fn reference() -> Self {
        Self::new(1000, 165, 54)
    }

    /// Number of frames T.
    pub fn n_frames(&self) -> usize {
        self.durations.iter().sum()
    }

    /// State of every frame, T values.
    pub fn state_of_frame(&self) -> Vec<u32> {
        (0u32..)
            .zip(&self.durations)
            .flat_map(|(s, d)| std::iter::repeat_n(s, *d))
            .collect()
    }

    /// Reciprocal variances, S x 3D.
    pub fn precisions(&self) -> Vec<f64> {
        self.variances.iter().map(|v| v.recip()).collect()
    }
}
