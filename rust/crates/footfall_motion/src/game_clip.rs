//! Clips as games have them: they walk in place, and they loop after two steps.
//!
//! Learning needs the way that the body travels and steps that begin and end within the clip. The way comes [from the standing
//! foot](in_place), and loops are [unrolled](cycle). Repeated steps say nothing about how steps differ: [`Retargeted::report`] keeps how often
//! the clip was repeated.

mod cycle;
mod in_place;

use crate::retarget::Retargeted;

/// Gives a clip that walks in place its way, and finds out whether it is a loop. Frames keep their numbers.
pub fn complete(motion: &mut Retargeted) {
    let first = motion.first_frame;
    motion.report.cycle_frames = cycle::find(&motion.clip, first);
    if let Some(way) = in_place::way_of_feet(&motion.clip, first) {
        for (pose, offset) in motion.clip.poses[first..].iter_mut().zip(way) {
            pose.root_position += offset;
        }
        motion.report.in_place = true;
    }
}

/// Repeats a clip that is a loop until it shows a walk; others stay as they are.
pub fn unroll(motion: &mut Retargeted) {
    if let Some(cycle) = motion.report.cycle_frames {
        motion.report.repeats = cycle::unroll(&mut motion.clip, motion.first_frame, cycle);
        motion.first_frame = 0;
    }
}
