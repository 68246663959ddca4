//! The perceptual study of Tilmanne et al. (2012, section 6) as one web page: real or synthetic, which style, how alike.
//!
//! The page holds everything: figures as positions of joints in millimetres, drawing, tests, answers.

mod clip;
mod page;

pub(crate) use clip::{Excerpt, excerpts};
pub(crate) use page::{StudyOptions, page};
