//! The residual of live data: the predictor of the future from the past learned as frames come in.

use crate::error::ProbError;

/// Weight that a frame keeps with each new one: half of it after some 140.
const FORGETTING: f64 = 0.995;

/// Variance of the predictor's entries before any frame, relative to the outputs' own.
const PRIOR_VARIANCE: f64 = 1e3;

/// Frames over which the residual's own level is taken.
const LEVEL_FRAMES: usize = 180;

/// Recursive least squares for M of equation 6, `Y_f = M [Y_p; 1]`. Every frame yields the residual of the frame `window` frames ago
/// against its prediction from the frames before. Allocates nothing after construction.
#[derive(Clone, Debug)]
pub struct StreamingResidual {
    window: usize,
    channels: usize,
    /// The last 2 × window frames, oldest first.
    frames: Vec<f64>,
    /// Rows of M, one a number of the future.
    predictor: Vec<f64>,
    /// Covariance of the predictor.
    covariance: Vec<f64>,
    gain: Vec<f64>,
    past: Vec<f64>,
    levels: Vec<f64>,
    sorted: Vec<f64>,
    seen: usize,
}

impl StreamingResidual {
    /// For outputs of `channels` numbers a frame.
    ///
    /// # Errors
    /// [`ProbError::Empty`] without channels or window.
    pub fn new(channels: usize, window: usize) -> Result<Self, ProbError> {
        if channels == 0 || window == 0 {
            return Err(ProbError::Empty {
                what: "channels or window",
            });
        }
        let inputs = channels * window + 1;
        let mut covariance = vec![0.0; inputs * inputs];
        for diagonal in covariance.iter_mut().step_by(inputs + 1) {
            *diagonal = PRIOR_VARIANCE;
        }
        Ok(Self {
            window,
            channels,
            frames: vec![0.0; 2 * window * channels],
            predictor: vec![0.0; window * channels * inputs],
            covariance,
            gain: vec![0.0; inputs],
            past: vec![0.0; inputs],
            levels: Vec::with_capacity(LEVEL_FRAMES),
            sorted: Vec::with_capacity(LEVEL_FRAMES),
            seen: 0,
        })
    }

    /// Takes in a frame (`channels` numbers) and returns the residual norm of the frame [`delay`](Self::delay) frames ago over the
    /// median of the last ones: above 3 or so, and the greatest for a while, it is a switch. `None` until there are enough frames,
    /// and for a frame of the wrong length or with numbers that are not finite, which is left out.
    pub fn push(&mut self, outputs: &[f64]) -> Option<f64> {
        if outputs.len() != self.channels || !outputs.iter().all(|value| value.is_finite()) {
            return None;
        }
        self.frames.rotate_left(self.channels);
        let tail = self.frames.len() - self.channels;
        self.frames[tail..].copy_from_slice(outputs);
        self.seen += 1;
        if self.seen < 2 * self.window {
            return None;
        }
        let (past, future) = self.frames.split_at(self.window * self.channels);
        let inputs = self.past.len();
        self.past[..inputs - 1].copy_from_slice(past);
        self.past[inputs - 1] = 1.0;
        let mut innovation = FORGETTING;
        for (gain, row) in self
            .gain
            .iter_mut()
            .zip(self.covariance.chunks_exact(inputs))
        {
            *gain = row.iter().zip(&self.past).map(|(a, b)| a * b).sum();
        }
        innovation += self
            .gain
            .iter()
            .zip(&self.past)
            .map(|(a, b)| a * b)
            .sum::<f64>();
        let mut square = 0.0;
        for (row, value) in self.predictor.chunks_exact_mut(inputs).zip(future) {
            let foretold: f64 = row.iter().zip(&self.past).map(|(a, b)| a * b).sum();
            let error = value - foretold;
            square += error * error;
            for (entry, gain) in row.iter_mut().zip(&self.gain) {
                *entry += error * gain / innovation;
            }
        }
        for (row, own) in self.covariance.chunks_exact_mut(inputs).zip(&self.gain) {
            for (entry, gain) in row.iter_mut().zip(&self.gain) {
                *entry = (*entry - own * gain / innovation) / FORGETTING;
            }
        }
        Some(square.sqrt() / self.level(square.sqrt()))
    }

    /// Number of frames by which the result of [`push`](Self::push) lags behind.
    pub fn delay(&self) -> usize {
        self.window - 1
    }

    fn level(&mut self, norm: f64) -> f64 {
        if self.levels.len() == LEVEL_FRAMES {
            self.levels.rotate_left(1);
            self.levels.pop();
        }
        self.levels.push(norm);
        self.sorted.clear();
        self.sorted.extend_from_slice(&self.levels);
        self.sorted.sort_unstable_by(f64::total_cmp);
        let middle = self.sorted[self.sorted.len() / 2];
        middle.max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::switching::SimplestWalker;

    #[test]
    fn live_switches_of_the_walker_are_found() {
        let mut walker = SimplestWalker::new(0.009);
        for _ in 0..40 {
            walker.next_step();
        }
        let record = walker.walk(3000, 0.1);
        let window = 3;
        let mut live = StreamingResidual::new(2, window).unwrap();
        let ratios: Vec<f64> = record
            .angles
            .chunks_exact(2)
            .map(|angles| live.push(angles).unwrap_or(0.0))
            .collect();
        let delay = live.delay();
        // Once it has seen a few steps, every switch is the greatest within half a step.
        let known = record
            .switches
            .iter()
            .filter(|switch| (1000..2900).contains(*switch));
        let mut found = 0;
        for switch in known {
            let around = switch - 15..switch + 15;
            let top = around
                .max_by(|a, b| ratios[a + delay].total_cmp(&ratios[b + delay]))
                .unwrap();
            assert!(
                top.abs_diff(*switch) <= window,
                "switch {switch}, found {top}"
            );
            assert!(ratios[top + delay] > 3.0);
            found += 1;
        }
        assert!(found > 40);
    }

    #[test]
    fn wrong_frames_are_left_out() {
        let mut live = StreamingResidual::new(2, 2).unwrap();
        assert_eq!(live.push(&[1.0]), None);
        assert_eq!(live.push(&[f64::NAN, 0.0]), None);
        for _ in 0..3 {
            assert_eq!(live.push(&[0.5, 0.5]), None);
        }
        assert!(live.push(&[0.5, 0.5]).is_some());
        assert!(StreamingResidual::new(0, 2).is_err());
    }
}
