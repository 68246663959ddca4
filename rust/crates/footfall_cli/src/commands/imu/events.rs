//! `footfall imu events`: gait events and strides of a foot that wears a sensor.

use super::{parse_site, read_recording};
use crate::output;
use anyhow::{Result, ensure};
use footfall_core::{Side, Site};
use footfall_imu::events::{detect_swings, events_of};
use footfall_imu::strides::measure_strides;
use serde::Serialize;
use std::path::PathBuf;

/// Detect gait events and stride lengths from a foot sensor
///
/// The sensor may be mounted in any orientation. Times are the recording's. A stride goes from the middle of one stance to the middle of the next.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall imu events imu.csv --site right_foot --json > events.json")]
pub(crate) struct EventsArgs {
    /// The recording of the sensor
    #[arg(value_name = "IMU.csv")]
    input: PathBuf,
    /// Foot that wears the sensor
    #[arg(long, value_parser = parse_site)]
    site: Site,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    events: Vec<Event>,
    strides: Vec<Stride>,
}

#[derive(Serialize)]
struct Event {
    time_s: f64,
    foot: &'static str,
    kind: &'static str,
}

#[derive(Serialize)]
struct Stride {
    start_s: f64,
    end_s: f64,
    length_m: f64,
}

pub(crate) fn run(args: &EventsArgs) -> Result<()> {
    ensure!(
        args.site.is_foot(),
        "events need a sensor on a foot, not {}; pass --site right_foot or left_foot",
        args.site.name()
    );
    let foot = args.site.side().map_or("left", Side::name);
    let recording = read_recording(&args.input)?;
    let swings = detect_swings(&recording);
    let report = Report {
        events: events_of(&swings)
            .iter()
            .map(|event| Event {
                time_s: event.time_secs,
                foot,
                kind: event.kind.name(),
            })
            .collect(),
        strides: measure_strides(&recording, &swings)
            .iter()
            .map(|stride| Stride {
                start_s: stride.start_secs,
                end_s: stride.end_secs,
                length_m: stride.length_m,
            })
            .collect(),
    };
    output::print_report(args.json, &report, |report| text(report, foot))
}

/// An event or a stride a line, and their numbers.
fn text(report: &Report, foot: &str) -> String {
    let events = report.events.iter();
    let mut lines: Vec<String> = events
        .map(|event| format!("{:8.3} s  {}", event.time_s, event.kind.replace('_', " ")))
        .collect();
    lines.extend(report.strides.iter().map(|stride| {
        format!(
            "{:8.3} to {:8.3} s  a stride of {:.2} m",
            stride.start_s, stride.end_s, stride.length_m
        )
    }));
    lines.push(format!(
        "{} events of the {foot} foot, {} strides",
        report.events.len(),
        report.strides.len()
    ));
    lines.join("\n")
}
