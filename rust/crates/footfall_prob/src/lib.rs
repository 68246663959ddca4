//! Probability and inference on slices: Gaussians, HSMM, MLPG, global variance.
