//! The forms as their makers document them, written a second time: what devices send.

use footfall_imu::{GRAVITY_MPS2, ImuSample};
use std::f32::consts::PI;

fn in_g(sample: &ImuSample) -> [f32; 3] {
    (sample.force / GRAVITY_MPS2).to_array()
}

fn in_dps(sample: &ImuSample) -> [f32; 3] {
    (sample.rate * (180.0 / PI)).to_array()
}

fn micros(sample: &ImuSample) -> u64 {
    (sample.time_secs * 1e6).round() as u64
}

fn sum(bytes: &[u8]) -> u8 {
    (bytes.iter().map(|byte| u32::from(*byte)).sum::<u32>() % 256) as u8
}

pub(crate) fn witmotion(sample: &ImuSample) -> Vec<u8> {
    let message = |kind: u8, values: [f32; 3], scale: f32| {
        let mut bytes = vec![0x55, kind];
        for value in values {
            bytes.extend(((value / scale * 32768.0).round() as i16).to_le_bytes());
        }
        bytes.extend([0x10, 0x0A]);
        bytes.push(sum(&bytes));
        bytes
    };
    let angles = message(0x53, [0.1, 0.2, 0.3], 1.0);
    [
        message(0x51, in_g(sample), 16.0),
        message(0x52, in_dps(sample), 2000.0),
        angles,
    ]
    .concat()
}

pub(crate) fn ximu3_text(sample: &ImuSample) -> Vec<u8> {
    let ([ax, ay, az], [gx, gy, gz]) = (in_g(sample), in_dps(sample));
    let time = micros(sample);
    format!("I,{time},{gx:.4},{gy:.4},{gz:.4},{ax:.4},{ay:.4},{az:.4}\nQ,{time},1.0,0.0,0.0,0.0\n")
        .into_bytes()
}

pub(crate) fn ximu3_binary(sample: &ImuSample) -> Vec<u8> {
    let mut plain = micros(sample).to_le_bytes().to_vec();
    for value in in_dps(sample).into_iter().chain(in_g(sample)) {
        plain.extend(value.to_le_bytes());
    }
    let mut bytes = vec![b'I' | 0x80];
    for byte in plain {
        match byte {
            0x0A => bytes.extend([0xDB, 0xDC]),
            0xDB => bytes.extend([0xDB, 0xDD]),
            _ => bytes.push(byte),
        }
    }
    bytes.push(0x0A);
    bytes
}

/// Number formats of `MTData2`.
#[derive(Clone, Copy, Debug)]
pub(crate) enum MtiNumbers {
    Float = 0,
    Fixed12 = 1,
    Fixed16 = 2,
    Double = 3,
}

pub(crate) fn mti(sample: &ImuSample, numbers: MtiNumbers) -> Vec<u8> {
    let item = |identifier: u16, values: [f32; 3]| {
        let mut data = Vec::new();
        for value in values {
            match numbers {
                MtiNumbers::Float => data.extend(value.to_be_bytes()),
                MtiNumbers::Fixed12 => {
                    data.extend(((f64::from(value) * 1_048_576.0).round() as i32).to_be_bytes());
                }
                MtiNumbers::Fixed16 => {
                    let fixed = (f64::from(value) * 4_294_967_296.0).round() as i64;
                    data.extend((fixed as u32).to_be_bytes());
                    data.extend(((fixed >> 32) as i16).to_be_bytes());
                }
                MtiNumbers::Double => data.extend(f64::from(value).to_be_bytes()),
            }
        }
        let identifier = (identifier | numbers as u16).to_be_bytes();
        [identifier.to_vec(), vec![data.len() as u8], data].concat()
    };
    let ticks = ((sample.time_secs * 1e4).round() as u64 + 4_294_967_000) as u32;
    let content = [
        vec![0x10, 0x20, 2, 0x12, 0x34],
        [vec![0x10, 0x60, 4], ticks.to_be_bytes().to_vec()].concat(),
        item(0x4020, sample.force.to_array()),
        item(0x8020, sample.rate.to_array()),
    ]
    .concat();
    let mut bytes = vec![0xFA, 0xFF, 0x36, content.len() as u8];
    bytes.extend(content);
    bytes.push(sum(&bytes[1..]).wrapping_neg());
    bytes
}

pub(crate) fn threespace(sample: &ImuSample) -> Vec<u8> {
    let values = sample.rate.to_array().into_iter().chain(in_g(sample));
    let data: Vec<u8> = values.flat_map(f32::to_be_bytes).collect();
    let mut bytes = vec![0];
    bytes.extend((micros(sample) as u32).to_be_bytes());
    bytes.extend([0xFF, sum(&data), data.len() as u8]);
    bytes.extend(data);
    bytes
}

pub(crate) fn bno085(sample: &ImuSample) -> Vec<u8> {
    let mut bytes = vec![0xAA, 0xAA, 7];
    for angle in [100_i16, -200, 300] {
        bytes.extend(angle.to_le_bytes());
    }
    for value in in_g(sample) {
        bytes.extend(((value * 1000.0).round() as i16).to_le_bytes());
    }
    bytes.extend([0, 0, 0]);
    bytes.push(sum(&bytes[2..]));
    bytes
}

/// One line of numbers in our units, time in milliseconds.
pub(crate) fn line(sample: &ImuSample) -> Vec<u8> {
    let ([ax, ay, az], [gx, gy, gz]) = (sample.force.to_array(), sample.rate.to_array());
    let time = sample.time_secs * 1e3;
    format!("{time:.3},{ax:.5},{ay:.5},{az:.5},{gx:.5},{gy:.5},{gz:.5}\r\n").into_bytes()
}

/// A line of JSON with members of its own names, in g and °/s.
pub(crate) fn flat_json(sample: &ImuSample) -> Vec<u8> {
    let ([ax, ay, az], [gx, gy, gz]) = (in_g(sample), in_dps(sample));
    let time = micros(sample);
    format!("{{\"t_us\":{time},\"accX_g\":{ax},\"accY_g\":{ay},\"accZ_g\":{az},\"gyroX_dps\":{gx},\"gyroY_dps\":{gy},\"gyroZ_dps\":{gz}}}\n")
        .into_bytes()
}

/// A packet of owoTrack or of a SlimeVR tracker.
pub(crate) fn slimevr(kind: u32, number: u64, content: &[u8]) -> Vec<u8> {
    [
        &kind.to_be_bytes(),
        number.to_be_bytes().as_slice(),
        content,
    ]
    .concat()
}

pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_be_bytes())
        .collect()
}

/// One of Android's sensors as SensorServer and SensaGram send it.
pub(crate) fn android(kind: &str, time_secs: f64, values: [f32; 3]) -> Vec<u8> {
    let [x, y, z] = values;
    let nanos = (time_secs * 1e9).round() as u64;
    format!("{{\"accuracy\":2,\"timestamp\":{nanos},\"type\":\"android.sensor.{kind}\",\"values\":[{x},{y},{z}]}}").into_bytes()
}

/// A batch of Sensor Logger: each sensor in turn.
pub(crate) fn sensor_logger(samples: &[ImuSample]) -> Vec<u8> {
    let entry = |name: &str, sample: &ImuSample, [x, y, z]: [f32; 3]| {
        let nanos = 1_700_000_000_000_000_000 + (sample.time_secs * 1e9).round() as u64;
        format!(
            "{{\"name\":\"{name}\",\"time\":{nanos},\"values\":{{\"x\":{x},\"y\":{y},\"z\":{z}}}}}"
        )
    };
    let up = [0.0, GRAVITY_MPS2, 0.0];
    let gravity = samples.iter().map(|s| entry("gravity", s, up));
    let linear = samples.iter().map(|s| {
        entry(
            "accelerometer",
            s,
            (s.force - glam::Vec3::from_array(up)).to_array(),
        )
    });
    let rates = samples
        .iter()
        .map(|s| entry("gyroscope", s, s.rate.to_array()));
    let entries: Vec<String> = gravity.chain(linear).chain(rates).collect();
    format!(
        "{{\"messageId\":3,\"sessionId\":\"s\",\"deviceId\":\"pixel\",\"payload\":[{}]}}",
        entries.join(",")
    )
    .into_bytes()
}

/// ZIG SIM in JSON: iOS's signs, g.
pub(crate) fn zig_sim_json(sample: &ImuSample) -> Vec<u8> {
    let [ax, ay, az] = (-(sample.force - glam::Vec3::Y * GRAVITY_MPS2) / GRAVITY_MPS2).to_array();
    let [gx, gy, gz] = sample.rate.to_array();
    format!(
        "{{\"device\":{{\"name\":\"p\",\"os\":\"ios\"}},\"timestamp\":\"2026/11/21\",\"sensordata\":{{\"accel\":{{\"x\":{ax},\"y\":{ay},\"z\":{az}}},\
         \"gravity\":{{\"x\":0,\"y\":-1,\"z\":0}},\"gyro\":{{\"x\":{gx},\"y\":{gy},\"z\":{gz}}}}}}}"
    )
    .into_bytes()
}

/// A message of the browser's page.
pub(crate) fn browser(samples: &[ImuSample]) -> Vec<u8> {
    let mut bytes = vec![1];
    for sample in samples {
        bytes.extend(sample.time_secs.to_le_bytes());
        for value in sample
            .force
            .to_array()
            .into_iter()
            .chain(sample.rate.to_array())
        {
            bytes.extend(value.to_le_bytes());
        }
    }
    bytes
}
