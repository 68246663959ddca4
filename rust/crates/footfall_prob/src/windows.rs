//! Dynamic features: first and second differences of a series (paper, equations 2 to 4).

use crate::error::{ProbError, check_len};

/// Coefficients of the Δ and Δ² windows. The static window is always 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Windows {
    /// Equations 2 and 3: Δ = {-½, 0, ½}, Δ² = {¼, 0, -½, 0, ¼}. They couple only frames of equal
    /// parity, so even and odd frames are two independent chains that only share their states.
    #[default]
    Paper,
    /// HTS's usual set: Δ = {-½, 0, ½}, Δ² = {1, -2, 1}. Couples neighbouring frames.
    Compact,
}

impl Windows {
    /// Coefficients at offsets -2..=2 of the static, Δ and Δ² window.
    pub fn coefficients(self) -> [[f64; 5]; 3] {
        let second = match self {
            Self::Paper => [0.25, 0.0, -0.5, 0.0, 0.25],
            Self::Compact => [0.0, 1.0, -2.0, 1.0, 0.0],
        };
        [
            [0.0, 0.0, 1.0, 0.0, 0.0],
            [0.0, -0.5, 0.0, 0.5, 0.0],
            second,
        ]
    }

    /// Number of frames that the static, Δ and Δ² windows reach to either side.
    ///
    /// In synthesis a window that would reach over an end of the sequence has no say (its precision
    /// is zero), as in `hts_engine`.
    pub fn reach(self) -> [usize; 3] {
        match self {
            Self::Paper => [0, 1, 2],
            Self::Compact => [0, 1, 1],
        }
    }

    /// Distance between frames that are coupled directly: the normal matrix has entries at lags 0,
    /// `stride` and 2 `stride` only.
    pub(crate) fn stride(self) -> usize {
        match self {
            Self::Paper => 2,
            Self::Compact => 1,
        }
    }

    /// Observations O = W C (equation 4): `statics` is T x D, `out` becomes T x 3D, each frame
    /// holding its statics, then Δ, then Δ². Beyond the ends the first and last frame are repeated,
    /// so that a still pose has no velocity there.
    ///
    /// ```
    /// use footfall_prob::windows::Windows;
    ///
    /// let mut observations = Vec::new();
    /// Windows::Compact.append_dynamics(&[0.0, 1.0, 4.0, 9.0], 1, &mut observations)?;
    /// assert_eq!(observations[6..9], [4.0, 4.0, 2.0]); // t = 2 of t²: value, slope, curvature
    /// # Ok::<(), footfall_prob::ProbError>(())
    /// ```
    ///
    /// # Errors
    /// [`ProbError`] when `dim` is zero or `statics` is not a whole number of frames.
    pub fn append_dynamics(
        self,
        statics: &[f64],
        dim: usize,
        out: &mut Vec<f64>,
    ) -> Result<(), ProbError> {
        if dim == 0 {
            return Err(ProbError::Empty { what: "dimensions" });
        }
        let n_frames = statics.len() / dim;
        check_len("statics", statics.len(), n_frames * dim)?;
        out.clear();
        out.reserve(n_frames * 3 * dim);
        let coefficients = self.coefficients();
        for t in 0..n_frames {
            let frame = |offset: usize| {
                let index = (t + offset).saturating_sub(2).min(n_frames - 1);
                &statics[index * dim..][..dim]
            };
            let frames = [0, 1, 2, 3, 4].map(frame);
            for window in &coefficients {
                out.extend((0..dim).map(|d| (0..5).map(|i| window[i] * frames[i][d]).sum::<f64>()));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_equations_2_and_3() {
        let c: Vec<f64> = (0..14).map(|i| (f64::from(i) * 0.9).sin()).collect();
        let mut out = Vec::new();
        Windows::Paper.append_dynamics(&c, 2, &mut out).unwrap();
        let at = |t: usize, d: usize| c[2 * t.min(6) + d];
        for t in 2..7 {
            for d in 0..2 {
                let row = &out[6 * t..6 * t + 6];
                assert!((row[d] - at(t, d)).abs() < 1e-15);
                assert!((row[2 + d] - 0.5 * (at(t + 1, d) - at(t - 1, d))).abs() < 1e-15);
                assert!(
                    (row[4 + d] - 0.25 * (at(t + 2, d) - 2.0 * at(t, d) + at(t - 2, d))).abs()
                        < 1e-15
                );
            }
        }
        // Replicated at the start: Δ of the first frame sees the first frame twice.
        assert!((out[2] - 0.5 * (at(1, 0) - at(0, 0))).abs() < 1e-15);
    }

    #[test]
    fn shapes() {
        let mut out = vec![1.0];
        for windows in [Windows::Paper, Windows::Compact] {
            windows.append_dynamics(&[3.0], 1, &mut out).unwrap();
            assert_eq!(out, [3.0, 0.0, 0.0]);
            windows.append_dynamics(&[], 1, &mut out).unwrap();
            assert!(out.is_empty());
        }
        assert!(matches!(
            Windows::Paper.append_dynamics(&[1.0; 3], 2, &mut out),
            Err(ProbError::Shape { .. })
        ));
        assert!(matches!(
            Windows::Paper.append_dynamics(&[1.0; 3], 0, &mut out),
            Err(ProbError::Empty { .. })
        ));
    }
}
