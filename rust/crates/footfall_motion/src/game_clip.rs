//! Clips as games have them: they walk in place, and they loop after two steps.
//!
//! Learning needs the way that the body travels and steps that begin and end within the clip. The way comes from the standing
//! foot, and loops are unrolled. Repeated steps say nothing about how steps differ: [`Retargeted::report`] keeps how often
//! the clip was repeated.

mod cycle;
mod in_place;

use crate::bvh::BvhFile;
use crate::retarget::{RetargetError, RetargetOptions, Retargeted, retarget_with_way};
use crate::walking_evidence::WalkingEvidence;

/// Puts a clip of a game on the canonical body: one that walks in place travels, and loops are found. Frames are the file's.
///
/// # Errors
/// As [`retarget`](crate::retarget::retarget).
pub fn retarget(file: &BvhFile, options: &RetargetOptions) -> Result<Retargeted, RetargetError> {
    let mut motion = retarget_with_way(file, options, in_place::way_of_feet)?;
    motion.report.cycle_frames = cycle::find(&motion.clip, motion.first_frame);
    Ok(motion)
}

/// The same with hip joints as the file has them, and its evidence about them.
pub(crate) fn retarget_as_recorded(
    file: &BvhFile,
    options: &RetargetOptions,
) -> Result<(Retargeted, WalkingEvidence), RetargetError> {
    let (mut motion, evidence) =
        crate::retarget::retarget_as_recorded(file, options, in_place::way_of_feet)?;
    motion.report.cycle_frames = cycle::find(&motion.clip, motion.first_frame);
    Ok((motion, evidence))
}

/// Repeats a clip that is a loop until it shows a walk; others stay as they are.
pub fn unroll(motion: &mut Retargeted) {
    if let Some(cycle) = motion.report.cycle_frames {
        motion.report.repeats = cycle::unroll(&mut motion.clip, motion.first_frame, cycle);
        motion.first_frame = 0;
    }
}
