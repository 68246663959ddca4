//! Datagrams, posts and messages of the page for phones; what is read goes on to samples.

#![no_main]

use footfall_imu::live::device::DeviceWriter;
use footfall_imu::live::network::{osc, slimevr};
use footfall_imu::live::{Reading, json, phone};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut device = DeviceWriter::new("fuzz", "any");
    let mut arrival_secs = 0.0;
    let mut push = |reading: Reading| {
        arrival_secs += 0.001;
        device.push(reading, arrival_secs);
    };
    let _packet = slimevr::parse(bytes, |_, reading| push(reading));
    let _known = osc::parse(bytes, &mut push);
    let _known = json::parse(bytes, &mut push);
    let _known = phone::parse(bytes, &mut push);
    let mut last = f64::NEG_INFINITY;
    device.device().take(|sample| {
        assert!(sample.is_finite() && sample.time_secs > last);
        last = sample.time_secs;
    });
});
