//! Offline: corpus to model.
