//! Speed of reading every form that devices send, alone and all the way to samples with times.

#[expect(dead_code, reason = "some forms are of use to tests alone")]
#[path = "../tests/live/encode.rs"]
mod encode;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use footfall_imu::live::device::DeviceWriter;
use footfall_imu::live::network::slimevr;
use footfall_imu::live::serial::{SerialFormat, StreamParser, TextFormat};
use footfall_imu::live::{json, phone};
use footfall_imu::{GRAVITY_MPS2, ImuSample};
use glam::Vec3;
use std::hint::black_box;

const SAMPLES: usize = 1000;

/// The bytes of a sample.
type Encode = fn(&ImuSample) -> Vec<u8>;

fn samples() -> Vec<ImuSample> {
    let sample = |n: usize| {
        let wave = (n as f32 * 0.05).sin();
        ImuSample {
            time_secs: n as f64 * 0.01,
            force: Vec3::new(wave, GRAVITY_MPS2, 0.3 * wave),
            rate: Vec3::new(2.0 * wave, 0.1, wave),
        }
    };
    (0..SAMPLES).map(sample).collect()
}

fn streams(c: &mut Criterion) {
    let mut group = c.benchmark_group("streams");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    let forms: [(&str, SerialFormat, Encode); 7] = [
        ("witmotion", SerialFormat::WitMotion, encode::witmotion),
        ("ximu3_text", SerialFormat::XImu3, encode::ximu3_text),
        ("ximu3_binary", SerialFormat::XImu3, encode::ximu3_binary),
        ("mti", SerialFormat::Mti, |s| {
            encode::mti(s, encode::MtiNumbers::Float)
        }),
        ("threespace", SerialFormat::ThreeSpace, encode::threespace),
        ("lines", SerialFormat::Text, encode::line),
        ("flat_json", SerialFormat::Text, encode::flat_json),
    ];
    for (name, format, encode) in forms {
        let bytes: Vec<u8> = samples().iter().flat_map(encode).collect();
        let mut parser = StreamParser::new(format, &TextFormat::default());
        group.bench_function(name, |b| {
            b.iter(|| {
                parser.push(black_box(&bytes), |reading| {
                    black_box(reading);
                });
            });
        });
    }
    group.finish();
}

fn packets(c: &mut Criterion) {
    let mut group = c.benchmark_group("packets");
    let samples = samples();
    let page = encode::browser(&samples[..64]);
    group.throughput(Throughput::Elements(64));
    group.bench_function("browser", |b| {
        b.iter(|| {
            phone::parse(black_box(&page), |reading| {
                black_box(reading);
            })
        });
    });
    let batch = encode::sensor_logger(&samples[..64]);
    group.bench_function("sensor_logger", |b| {
        b.iter(|| {
            json::parse(black_box(&batch), |reading| {
                black_box(reading);
            })
        });
    });
    group.throughput(Throughput::Elements(1));
    let packet = encode::slimevr(4, 1, &encode::floats(&[0.1, 0.2, 0.3]));
    group.bench_function("slimevr", |b| {
        b.iter(|| {
            slimevr::parse(black_box(&packet), |sensor, reading| {
                black_box((sensor, reading));
            })
        });
    });
    let android = encode::android("gyroscope", 1.0, [0.1, 0.2, 0.3]);
    group.bench_function("android", |b| {
        b.iter(|| {
            json::parse(black_box(&android), |reading| {
                black_box(reading);
            })
        });
    });
    group.finish();
}

/// From readings to what the game takes: clock, assembly, checks, queue.
fn devices(c: &mut Criterion) {
    let mut group = c.benchmark_group("devices");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    let mut readings = Vec::new();
    let bytes: Vec<u8> = samples().iter().flat_map(encode::ximu3_binary).collect();
    StreamParser::new(SerialFormat::XImu3, &TextFormat::default())
        .push(&bytes, |reading| readings.push(reading));
    group.bench_function("to_samples", |b| {
        b.iter_batched(
            || DeviceWriter::new("bench", "any"),
            |mut device| {
                for (n, reading) in readings.iter().enumerate() {
                    device.push(*reading, n as f64 * 0.01);
                }
                device.device().take(|sample| {
                    black_box(sample);
                });
            },
            BatchSize::SmallInput,
        );
    });
    group.finish();
}

criterion_group!(benches, streams, packets, devices);
criterion_main!(benches);
