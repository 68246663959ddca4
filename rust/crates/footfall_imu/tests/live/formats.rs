//! Every form of a stream: what was sent is what is read, however it is cut and whatever lies between.

use crate::encode::{self, MtiNumbers};
use crate::signal::{check_same, samples};
use footfall_imu::ImuSample;
use footfall_imu::live::serial::detect::Detection;
use footfall_imu::live::serial::{
    ForceUnit, RateUnit, SerialFormat, StreamParser, TextFormat, TimeUnit,
};
use footfall_imu::live::{Quantity, Reading};

type Encode = fn(&ImuSample) -> Vec<u8>;

/// Every form with how well it keeps rates, rad/s.
const FORMS: [(SerialFormat, Encode, f32); 10] = [
    (SerialFormat::WitMotion, encode::witmotion, 2e-3),
    (SerialFormat::XImu3, encode::ximu3_text, 1e-4),
    (SerialFormat::XImu3, encode::ximu3_binary, 1e-5),
    (
        SerialFormat::Mti,
        |s| encode::mti(s, MtiNumbers::Float),
        1e-5,
    ),
    (
        SerialFormat::Mti,
        |s| encode::mti(s, MtiNumbers::Fixed12),
        1e-5,
    ),
    (
        SerialFormat::Mti,
        |s| encode::mti(s, MtiNumbers::Fixed16),
        1e-5,
    ),
    (
        SerialFormat::Mti,
        |s| encode::mti(s, MtiNumbers::Double),
        1e-5,
    ),
    (SerialFormat::ThreeSpace, encode::threespace, 1e-5),
    (SerialFormat::Text, encode::line, 1e-4),
    (SerialFormat::Text, encode::flat_json, 1e-4),
];

fn read(parser: &mut StreamParser, bytes: &[u8]) -> Vec<Reading> {
    let mut readings = Vec::new();
    parser.push(bytes, |reading| readings.push(reading));
    readings
}

fn as_sample(reading: &Reading) -> ImuSample {
    let Quantity::Both { force, rate } = reading.quantity else {
        panic!("{reading:?} is not both");
    };
    ImuSample {
        time_secs: reading.time_secs.unwrap_or(0.0),
        force,
        rate,
    }
}

#[test]
fn every_form_is_read_as_it_was_sent_however_it_is_cut() {
    let sent = samples(200);
    for (format, encode, tolerance) in FORMS {
        for cut in [1, 7, 64, 100_000] {
            let bytes: Vec<u8> = sent.iter().flat_map(encode).collect();
            let mut parser = StreamParser::new(format, &TextFormat::default());
            let readings: Vec<Reading> = bytes
                .chunks(cut)
                .flat_map(|part| read(&mut parser, part))
                .collect();
            // Of a stream of text the first line may be the end of one.
            let lost = usize::from(format == SerialFormat::Text);
            assert_eq!(readings.len(), sent.len() - lost, "{format:?} cut at {cut}");
            for (reading, sent) in readings.iter().zip(&sent[lost..]) {
                check_same(&as_sample(reading), sent, tolerance);
            }
            if let (Some(first), Some(last)) = (
                readings[0].time_secs,
                readings[readings.len() - 1].time_secs,
            ) {
                let took = 0.01 * (readings.len() - 1) as f64;
                assert!(
                    (last - first - took).abs() < 1e-6,
                    "{format:?}: {}",
                    last - first
                );
            }
        }
    }
}

#[test]
fn what_lies_between_messages_costs_at_most_one_of_them() {
    let sent = samples(300);
    let rubbish: [&[u8]; 4] = [
        b"\x55\x51\xFA\xFF\x36\x20",
        b"\n\xAA\xAA\x00",
        b"hello, world\n",
        &[0xFF; 300],
    ];
    for (format, encode, tolerance) in FORMS {
        let mut bytes = encode(&sent[0]);
        for (n, sample) in sent[1..].iter().enumerate() {
            if n % 50 == 10 {
                bytes.extend(rubbish[n / 50 % rubbish.len()]);
                // A stream of lines comes back at the next line.
                bytes.push(b'\n');
            }
            bytes.extend(encode(sample));
        }
        let mut parser = StreamParser::new(format, &TextFormat::default());
        let readings = read(&mut parser, &bytes);
        assert!(
            readings.len() >= sent.len() - 7,
            "{format:?}: {} of {}",
            readings.len(),
            sent.len()
        );
        assert!(
            parser.garbage_bytes() > 300,
            "{format:?}: {}",
            parser.garbage_bytes()
        );
        // Nothing is made up: every reading is one that was sent.
        let mut rest = sent.iter();
        for reading in &readings {
            let found = as_sample(reading);
            let same = |s: &ImuSample| {
                (s.rate - found.rate).length() < 3.0 * tolerance
                    && (s.force - found.force).length() < 0.1
            };
            assert!(rest.any(same), "{format:?}: {found:?} was not sent");
        }
    }
}

#[test]
fn every_form_is_found_out_and_none_is_mistaken() {
    let sent = samples(60);
    let mut forms: Vec<(SerialFormat, Vec<u8>)> = FORMS
        .iter()
        .map(|(format, encode, _)| (*format, sent.iter().flat_map(encode).collect()))
        .collect();
    forms.push((
        SerialFormat::Bno085,
        sent.iter().flat_map(encode::bno085).collect(),
    ));
    for (format, bytes) in forms {
        let mut detection = Detection::new(&TextFormat::default());
        // Listening begins anywhere.
        detection.push(&bytes[5..]);
        assert_eq!(detection.found(), Some(format));
    }
    let mut noise = Detection::new(&TextFormat::default());
    let mut state = 1_u32;
    let bytes: Vec<u8> = (0..20_000)
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        })
        .collect();
    noise.push(&bytes);
    assert_eq!(noise.found(), None);
}

#[test]
fn a_bno085_is_known_by_what_it_lacks() {
    let sent = samples(10);
    let bytes: Vec<u8> = sent.iter().flat_map(encode::bno085).collect();
    let mut parser = StreamParser::new(SerialFormat::Bno085, &TextFormat::default());
    let readings = read(&mut parser, &bytes);
    assert_eq!(readings.len(), 10);
    for (reading, sent) in readings.iter().zip(&sent) {
        let Quantity::Force(force) = reading.quantity else {
            panic!("{reading:?} is no force");
        };
        assert!((force - sent.force).length() < 0.02);
    }
    assert!(
        SerialFormat::Bno085
            .caveat()
            .is_some_and(|text| text.contains("no angular rate"))
    );
}

#[test]
fn units_and_columns_of_lines_are_told_or_guessed() {
    let sent = samples(100);
    let read_lines = |header: &str,
                      setting: TextFormat,
                      line: &dyn Fn(&ImuSample) -> String|
     -> Vec<ImuSample> {
        let mut parser = StreamParser::new(SerialFormat::Text, &setting);
        let lines: String = sent.iter().map(line).collect();
        let text = format!("rest of a line\n{header}{lines}");
        read(&mut parser, text.as_bytes())
            .iter()
            .map(as_sample)
            .collect()
    };
    let check = |found: &[ImuSample], what: &str| {
        assert_eq!(found.len(), sent.len(), "{what}");
        for (found, sent) in found.iter().zip(&sent) {
            check_same(found, sent, 2e-2);
        }
        let step = found[1].time_secs - found[0].time_secs;
        assert!(
            step == 0.0 || (step - 0.01).abs() < 1e-6,
            "{what}: a step of {step} s"
        );
    };
    let g = |s: &ImuSample| s.force / 9.80665;
    let dps = |s: &ImuSample| s.rate * 57.295_78;
    // A header in another order, with a column that is of no use.
    let found = read_lines(
        "temp;gx_dps;gy_dps;gz_dps;ax_g;ay_g;az_g;millis\n",
        TextFormat::default(),
        &|s| {
            let (a, w) = (g(s), dps(s));
            format!(
                "21.5;{};{};{};{};{};{};{}\n",
                w.x,
                w.y,
                w.z,
                a.x,
                a.y,
                a.z,
                s.time_secs * 1e3
            )
        },
    );
    check(&found, "a header");
    // Six numbers between blanks, in g and °/s.
    let found = read_lines("", TextFormat::default(), &|s| {
        let (a, w) = (g(s), dps(s));
        format!("{} {}  {}\t {} {} {}\n", a.x, a.y, a.z, w.x, w.y, w.z).replace('\t', " ")
    });
    check(&found, "six numbers");
    // Counts of an MPU-6050 behind microseconds.
    let found = read_lines("", TextFormat::default(), &|s| {
        let (a, w) = (g(s) * 16384.0, dps(s) * 131.0);
        format!(
            "{:.0},{:.0},{:.0},{:.0},{:.0},{:.0},{:.0}\n",
            s.time_secs * 1e6,
            a.x,
            a.y,
            a.z,
            w.x,
            w.y,
            w.z
        )
    });
    check(&found, "counts");
    // Labels in every line, as for a plotter.
    let found = read_lines("", TextFormat::default(), &|s| {
        let (a, w) = (s.force, s.rate);
        format!(
            "gx:{},gy:{},gz:{},ax:{},ay:{},az:{}\n",
            w.x, w.y, w.z, a.x, a.y, a.z
        )
    });
    check(&found, "labels");
    // What no one could guess is set: mg beside rad/s, seconds.
    let setting = TextFormat {
        columns: Some("t,gx,gy,gz,ax,ay,az".to_owned()),
        time: Some(TimeUnit::Second),
        force: Some(ForceUnit::MilliG),
        rate: Some(RateUnit::RadianPerSecond),
    };
    let found = read_lines("", setting, &|s| {
        let (a, w) = (g(s) * 1000.0, s.rate);
        format!(
            "{},{},{},{},{},{},{}\n",
            s.time_secs, w.x, w.y, w.z, a.x, a.y, a.z
        )
    });
    check(&found, "a setting");
}
