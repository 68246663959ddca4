//! Streams of serial devices, cut as the first byte says; what is read goes on to samples.

#![no_main]

use footfall_imu::live::device::DeviceWriter;
use footfall_imu::live::serial::detect::Detection;
use footfall_imu::live::serial::{SerialFormat, StreamParser, TextFormat};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let Some((cut, bytes)) = input.split_first() else {
        return;
    };
    let cut = usize::from(*cut) + 1;
    for format in SerialFormat::ALL {
        let mut parser = StreamParser::new(format, &TextFormat::default());
        let mut device = DeviceWriter::new("fuzz", format.name());
        let mut arrival_secs = 0.0;
        for part in bytes.chunks(cut) {
            arrival_secs += 0.01;
            parser.push(part, |reading| device.push(reading, arrival_secs));
        }
        let mut last = f64::NEG_INFINITY;
        device.device().take(|sample| {
            assert!(sample.is_finite() && sample.time_secs > last);
            last = sample.time_secs;
        });
        assert!(parser.message_bytes() + parser.garbage_bytes() <= bytes.len() as u64);
    }
    let mut detection = Detection::new(&TextFormat::default());
    detection.push(bytes);
    let _found = detection.found();
});
