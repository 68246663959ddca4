//! Errors of evaluating walks.

/// Errors of evaluating walks.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EvaluateError {
    /// A class without a sample.
    #[error("class {class} has no sample to learn from")]
    EmptyClass {
        /// The class, from 0.
        class: usize,
    },
    /// Fewer samples than a spread can be estimated from.
    #[error(
        "{samples} samples of {classes} classes are too few to estimate a covariance; add recordings"
    )]
    TooFewSamples {
        /// Number found.
        samples: usize,
        /// Of how many classes.
        classes: usize,
    },
    /// Features that cannot be used.
    #[error(
        "features are not finite, or their number differs between samples; check the recordings for invalid frames"
    )]
    Features,
    /// A pose that is no pose.
    #[error(
        "style {style}: frame {frame} of a recording is not finite; capture or export it again"
    )]
    NotFinite {
        /// The style.
        style: String,
        /// Frame of the clip.
        frame: usize,
    },
    /// The covariance has no inverse.
    #[error("the features are linearly dependent, so their covariance has no inverse; shrink it")]
    Singular,
    /// Nothing to classify.
    #[error(
        "the real recordings show {found} style with strides, recognition needs two; widen --where"
    )]
    OneStyle {
        /// Number of styles: none or one.
        found: usize,
    },
    /// A style that cannot be split.
    #[error("style {style}: {reason}")]
    Split {
        /// The style.
        style: String,
        /// Lack, and the next step to take.
        reason: String,
    },
    /// A synthesised style that no real recording shows.
    #[error("no real recording shows style {style} of the synthesised ones; the real styles are {}", known.join(", "))]
    UnknownStyle {
        /// The style.
        style: String,
        /// Those that the real recordings show.
        known: Vec<String>,
    },
    /// Synthesised recordings without a stride.
    #[error(
        "the synthesised recordings have no two consecutive steps; synthesise walks of at least four steps"
    )]
    NoSynthesisedStride,
    /// Too few walkers to learn from some and judge others.
    #[error(
        "{kind}: {found} walkers show a stride, {least} are needed for training and evaluation; add recordings"
    )]
    TooFewWalkers {
        /// `captured` or `generated`.
        kind: &'static str,
        /// Number found.
        found: usize,
        /// Number needed.
        least: usize,
    },
}
