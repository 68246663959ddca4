//! Runtime: model to pose.
