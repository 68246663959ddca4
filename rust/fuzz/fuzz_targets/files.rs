//! Files of every kind that is read: recordings, models, motion.

#![no_main]

use footfall_motion::bvh::{parse, write};
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::retarget::{RetargetOptions, retarget};
use footfall_motion::steps::segment_walks;
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let _model = footfall_model::ImuModel::from_bytes(bytes);
    let _model = footfall_model::WalkModel::from_bytes(bytes);
    let _style = footfall_model::GaitStyle::from_bytes(bytes);
    if let Ok(text) = core::str::from_utf8(bytes) {
        if let Ok(recording) = footfall_imu::csv::parse_text(text, Path::new("fuzz.csv")) {
            let _verdict = footfall_imu::check_recording(&recording);
        }
        read_motion(text);
    }
});

/// Motion that is read can be written, read again, and retargeted or refused.
fn read_motion(text: &str) {
    let Ok(file) = parse(text) else { return };
    assert_eq!(parse(&write(&file)).as_ref().ok(), Some(&file));
    if let Ok(retargeted) = retarget(&file, &RetargetOptions::default()) {
        let config = ContactConfig::from_frame(retargeted.first_frame);
        let contacts = detect_contacts(&retargeted.clip, &config);
        segment_walks(&retargeted.clip, &contacts);
    }
}
