//! Whatever comes, nothing panics, and nothing grows.

use footfall_imu::live::network::{osc, slimevr};
use footfall_imu::live::serial::detect::Detection;
use footfall_imu::live::serial::{SerialFormat, StreamParser, TextFormat};
use footfall_imu::live::{Reading, json, phone};
use proptest::prelude::*;

/// Bytes that look like messages in parts.
fn hostile() -> impl Strategy<Value = Vec<u8>> {
    let piece = prop_oneof![
        proptest::collection::vec(any::<u8>(), 0..64),
        Just(b"\x55\x51\x00\x00\x00\x00\x00\x08\x00\x00\xae".to_vec()),
        Just(b"\x55\x52".to_vec()),
        Just(b"\xFA\xFF\x36\xFF\xFF\xFF".to_vec()),
        Just(b"\xFA\xFF\x36\x03\x40\x20\x0C".to_vec()),
        Just(b"\xC9\xDB\xDB\x0A".to_vec()),
        Just(b"I,1,nan,inf,-inf,1e999,0,0\n".to_vec()),
        Just(b"\x00\x00\x00\x00\x00\xFF\x00\x18".to_vec()),
        Just(b"\xAA\xAA\xAA".to_vec()),
        Just(b"1,2,3,4,5,6,7\n".to_vec()),
        Just(b"{\"ax\":1,\"ay\":2,\"az\":1e400}\n".to_vec()),
        Just(
            b"{\"values\":[1,2],\"type\":\"android.sensor.gyroscope\",\"timestamp\":-1e300}"
                .to_vec()
        ),
        Just(b"{\"payload\":[{\"name\":\"gravity\",\"time\":1,\"values\":{}}]}".to_vec()),
        Just(b"/gravity\0\0\0\0,fff\0\0\0\0".to_vec()),
        Just(b"#bundle\0\0\0\0\0\0\0\0\0\xFF\xFF\xFF\xFF".to_vec()),
        Just(b"\x00\x00\x00\x64\x00\x00\x00\x00\x00\x00\x00\x00\x00\x03\x00\x00".to_vec()),
        Just(b"\x00\x00\x00\x11\x00\x00\x00\x00\x00\x00\x00\x01\x07\x01".to_vec()),
    ];
    proptest::collection::vec(piece, 0..24).prop_map(|pieces| pieces.concat())
}

proptest! {
    #[test]
    fn any_stream_is_read_in_full(bytes in hostile(), cut in 1_usize..200) {
        for format in SerialFormat::ALL {
            let mut parser = StreamParser::new(format, &TextFormat::default());
            for part in bytes.chunks(cut) {
                parser.push(part, |_reading: Reading| {});
            }
            let read = parser.message_bytes() + parser.garbage_bytes();
            prop_assert!(read <= bytes.len() as u64);
            // What waits is less than a message.
            prop_assert!(bytes.len() as u64 - read < 2048);
        }
        let mut detection = Detection::new(&TextFormat::default());
        detection.push(&bytes);
        let _found = detection.found();
    }

    #[test]
    fn any_packet_is_read_or_refused(bytes in hostile()) {
        let _packet = slimevr::parse(&bytes, |_, _| {});
        let _osc = osc::parse(&bytes, |_| {});
        let _json = json::parse(&bytes, |_| {});
        let mut page = bytes.clone();
        page.insert(0, phone::VERSION);
        let _page = phone::parse(&page, |_| {});
    }

    #[test]
    fn a_lone_message_of_any_length_is_refused(length in 0_usize..5000) {
        // Deep nesting and long rows of nothing.
        let nested = "[".repeat(length);
        let known = json::parse(nested.as_bytes(), |_| {});
        prop_assert!(!known);
        let mut bundle = Vec::new();
        for _ in 0..length / 20 {
            bundle.extend(b"#bundle\0\0\0\0\0\0\0\0\0");
            bundle.extend(((length / 20 * 20) as u32).to_be_bytes());
        }
        let _refused = osc::parse(&bundle, |_| {});
    }
}
