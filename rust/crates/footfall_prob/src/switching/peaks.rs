//! Peaks of a residual, at which something switched.

use super::ProjectionResidual;
use crate::error::ProbError;

/// Conditions on a peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeakConfig {
    /// Number of frames within which a peak is the greatest value; odd.
    pub span: usize,
    /// A peak exceeds the residual's own median by this factor.
    pub factor: f64,
    /// And the greatest residual by this one: without noise the median is next to nothing.
    pub share: f64,
}

impl Default for PeakConfig {
    /// Eleven frames as in section 4; three medians.
    fn default() -> Self {
        Self {
            span: 11,
            factor: 3.0,
            share: 0.05,
        }
    }
}

/// The indices of the peaks of a residual; none when nothing stands out.
pub fn peaks(norms: &[f64], config: &PeakConfig) -> Vec<usize> {
    let greatest = norms.iter().copied().fold(0.0, f64::max);
    let threshold = (config.factor * median(norms)).max(config.share * greatest);
    let half = config.span / 2;
    (0..norms.len())
        .filter(|index| {
            let around = index.saturating_sub(half)..(index + half + 1).min(norms.len());
            let first_greatest = around.clone().fold(around.start, |best, other| {
                if norms[other] > norms[best] {
                    other
                } else {
                    best
                }
            });
            norms[*index] > threshold && first_greatest == *index
        })
        .collect()
}

/// The middle value; 0 of nothing.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// The window of `candidates` whose residual has the clearest peaks: the greatest mean of its peaks over its median.
///
/// A window below the observability index leaves a residual everywhere, a long one smears the peaks (section 3.1). Windows for
/// which there are too few frames, or without any peak, are passed over; `None` when none is left.
///
/// # Errors
/// As [`ProjectionResidual::new`] for outputs that no window can take.
pub fn choose_window(
    outputs: &[f64],
    channels: usize,
    candidates: impl IntoIterator<Item = usize>,
    config: &PeakConfig,
) -> Result<Option<usize>, ProbError> {
    let mut best: Option<(usize, f64)> = None;
    for window in candidates {
        let norms = match ProjectionResidual::new(outputs, channels, window) {
            Ok(residual) => residual.norms(),
            Err(ProbError::SequenceTooShort { .. }) => continue,
            Err(error) => return Err(error),
        };
        let found = peaks(&norms, config);
        if found.is_empty() {
            continue;
        }
        let mean = found.iter().map(|peak| norms[*peak]).sum::<f64>() / found.len() as f64;
        let level = median(&norms).max(f64::MIN_POSITIVE);
        if best.is_none_or(|(_, clearest)| mean / level > clearest) {
            best = Some((window, mean / level));
        }
    }
    Ok(best.map(|(window, _)| window))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_stand_out_and_stand_alone() {
        let mut norms = vec![1.0; 60];
        for (at, height) in [(10, 9.0), (13, 8.0), (30, 2.5), (45, 5.0), (46, 5.0)] {
            norms[at] = height;
        }
        // 13 is too near to 10, 30 too low, and of two equal ones the first counts.
        assert_eq!(peaks(&norms, &PeakConfig::default()), [10, 45]);
        assert!(peaks(&[1.0; 40], &PeakConfig::default()).is_empty());
        assert!(peaks(&[], &PeakConfig::default()).is_empty());
        assert!(peaks(&[0.0; 40], &PeakConfig::default()).is_empty());
    }
}
