//! The trainer's measure of slip and the independent evaluator's agree, though they share no code.

use footfall_motion::bvh::{self, BvhFile};
use footfall_motion::retarget::{RetargetOptions, retarget};
use footfall_tests::data::{own_file, own_recordings};
use footfall_tests::evaluator::evaluate;
use footfall_train::evaluate::naturalness::contact_slips;

fn median_slip(file: &BvhFile) -> f64 {
    let clip = retarget(file, &RetargetOptions::default())
        .expect("our own skeleton")
        .clip;
    let mut slips = contact_slips(&clip);
    slips.sort_by(f64::total_cmp);
    slips[slips.len() / 2]
}

/// Lets the whole walk drift sideways.
fn drifting(mut file: BvhFile, speed_mps: f32) -> BvhFile {
    let width = file.channel_count();
    let secs = file.frame_time_secs as f32;
    for (frame, row) in file.values.chunks_exact_mut(width).enumerate() {
        row[0] += speed_mps * secs * frame as f32;
    }
    file
}

#[test]
fn both_measure_the_same_slip() {
    for name in own_recordings() {
        let file = bvh::read(own_file(name)).expect("our own recording");
        for drift in [0.0, 0.05, 0.15] {
            let file = drifting(file.clone(), drift);
            let (ours, reference) = (median_slip(&file), evaluate(&file).median_slip_mps);
            assert!(
                (ours - reference).abs() < 0.003,
                "{name} drifting at {drift} m/s: {ours} m/s, the evaluator has {reference}"
            );
        }
    }
}
