//! Sources of steps: styles or two linear systems, each from controls to a step on the ground.

pub(crate) mod buffers;
pub(crate) mod step_source;
pub(crate) mod style_space;
pub(crate) mod styled;
pub(crate) mod switching;
pub(crate) mod window;
