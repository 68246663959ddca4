//! Files of every kind that is read: recordings, models, motion.

#![no_main]

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
        let _motion = footfall_motion::bvh::parse(text);
    }
});
