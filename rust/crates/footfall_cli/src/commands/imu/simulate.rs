//! `footfall imu simulate`: what a sensor on a recorded body would have measured.

use super::parse_site;
use crate::motion_input::{MapArgs, read_file};
use crate::output;
use anyhow::{Result, ensure};
use footfall_core::Site;
use footfall_imu::csv;
use footfall_motion::virtual_imu::{SensorNoise, VirtualImuConfig, Wear, simulate};
use glam::{EulerRot, Quat};
use serde::Serialize;
use std::path::PathBuf;

/// Simulate the measurements of a sensor on a recorded body
///
/// Times are the recording's; frames before its motion (an artificial T-pose) are left out.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall imu simulate walk.bvh --site right_foot -o imu.csv\n  \
    footfall imu simulate walk.bvh --site right_thigh --rate 50 --noise 1 --uncalibrated --strap 1 --mounting 90,0,30 -o imu.csv")]
pub(crate) struct SimulateArgs {
    /// The recording, .bvh, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Site of the sensor
    #[arg(long, value_parser = parse_site)]
    site: Site,
    /// Samples per second
    #[arg(long, default_value_t = 100.0)]
    rate: f64,
    /// Errors of the sensor: 0 none, 1 as of a phone or hobby board
    #[arg(long, default_value_t = 0.0)]
    noise: f32,
    /// Simulate an uncalibrated board: errors of scales and clock, lost samples, and a range of 4 g and 1000 °/s as well
    #[arg(long, requires = "noise")]
    uncalibrated: bool,
    /// Looseness of the strap: 0 fixed to the body, 1 up to 5 cm off the site and swinging at 8 Hz
    #[arg(long, default_value_t = 0.0)]
    strap: f32,
    /// Seed of the errors and of the place on the strap
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Rotation of the sensor relative to the site's axes: degrees about x, then y, then z of the site
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_angles, default_value = "0,0,0", allow_hyphen_values = true)]
    mounting: Angles,
    /// Output file
    #[arg(short, long, value_name = "IMU.csv")]
    output: PathBuf,
    #[command(flatten)]
    map: MapArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Three angles, radians.
#[derive(Clone, Copy, Debug)]
struct Angles([f32; 3]);

fn parse_angles(text: &str) -> Result<Angles, String> {
    let numbers: Vec<f32> = text
        .split(',')
        .filter_map(|n| n.trim().parse().ok())
        .collect();
    match numbers.try_into() {
        Ok(degrees) => Ok(Angles(<[f32; 3]>::map(degrees, f32::to_radians))),
        Err(_) => Err("give three numbers separated by commas, for example 90,0,30".to_owned()),
    }
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a PathBuf,
    site: &'static str,
    rate_hz: f64,
    samples: usize,
    start_s: f64,
    seconds: f64,
}

pub(crate) fn run(args: &SimulateArgs) -> Result<()> {
    output::refuse_overwrite(&[&args.input], &args.output)?;
    ensure!(
        (1.0..=2000.0).contains(&args.rate),
        "cannot simulate a sensor of {} samples a second; set --rate to 1 to 2000",
        args.rate
    );
    ensure!(
        (0.0..=100.0).contains(&args.noise),
        "--noise {} is out of range; give a factor from 0 to 100",
        args.noise
    );
    ensure!(
        (0.0..=10.0).contains(&args.strap),
        "--strap {} is out of range; give a looseness from 0 to 10",
        args.strap
    );
    let noise = if args.uncalibrated {
        SensorNoise::uncalibrated
    } else {
        SensorNoise::consumer
    };
    let (_, motion) = read_file(&args.input, &args.map.read(None)?)?;
    let Angles([x, y, z]) = args.mounting;
    let config = VirtualImuConfig {
        mounting: Quat::from_euler(EulerRot::ZYXEx, z, y, x),
        noise: (args.noise > 0.0).then(|| noise(args.noise)),
        wear: (args.strap > 0.0).then(|| Wear::strapped(args.strap)),
        seed: args.seed,
        ..VirtualImuConfig::ideal(args.rate)
    };
    let recording = simulate(&motion.clip, motion.first_frame, args.site, &config);
    ensure!(
        recording.samples.len() >= 2,
        "{}: the motion is too short for two samples; give a longer recording",
        args.input.display()
    );
    output::write_atomic(&args.output, csv::write(&recording).as_bytes())?;
    let report = Report {
        output: &args.output,
        site: args.site.name(),
        rate_hz: args.rate,
        samples: recording.samples.len(),
        start_s: recording.start_secs(),
        seconds: recording.duration_secs(),
    };
    if args.json {
        return output::print_json(&report);
    }
    output::note(&format!(
        "{}: {} samples of {}, {} a second",
        args.output.display(),
        report.samples,
        report.site,
        report.rate_hz
    ));
    Ok(())
}
