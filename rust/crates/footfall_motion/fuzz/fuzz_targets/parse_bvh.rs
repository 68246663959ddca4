//! Any text is read or refused without a panic; what is read can be written, read again and retargeted or refused.
#![no_main]

use footfall_motion::bvh::{parse, write};
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::retarget::{RetargetOptions, retarget};
use footfall_motion::steps::segment_walks;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let Ok(file) = parse(text) else { return };
    assert_eq!(parse(&write(&file)).as_ref().ok(), Some(&file));
    if let Ok(retargeted) = retarget(&file, &RetargetOptions::default()) {
        let config = ContactConfig::from_frame(retargeted.first_frame);
        let contacts = detect_contacts(&retargeted.clip, &config);
        segment_walks(&retargeted.clip, &contacts);
    }
});
