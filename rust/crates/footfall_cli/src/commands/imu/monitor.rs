//! `footfall imu monitor`: what arrives from sensors, for trouble-shooting.

mod source;
mod watch;

use crate::output;
use anyhow::{Context as _, Result, ensure};
use footfall_imu::live::recorder::Recorder;
use footfall_imu::live::serial::port::ports;
use source::{Source, SourceArgs};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use watch::{Report, Watch};

/// Interval at which samples are taken from the ports.
const LOOK_EVERY: Duration = Duration::from_millis(10);

/// Show the samples of sensors: rates, gaps, axes, and problems
///
/// Prints one line per second and device, until Ctrl-C or --seconds. Protocol and rate of a serial port are detected by listening.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall imu monitor --ports\n  \
    footfall imu monitor --serial /dev/ttyUSB0\n  \
    footfall imu monitor --udp 6969 --record imu.csv\n  \
    footfall imu monitor --phone")]
pub(crate) struct MonitorArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// List the serial ports of this machine and exit
    #[arg(long, conflicts_with = "source")]
    ports: bool,
    /// Seconds after which to stop
    #[arg(long, value_name = "SECONDS")]
    seconds: Option<f64>,
    /// Write the samples of the first device to a recording
    #[arg(long, value_name = "IMU.csv")]
    record: Option<PathBuf>,
    /// Print one JSON object on stdout at the end
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &MonitorArgs) -> Result<()> {
    if args.ports {
        return list_ports(args.json);
    }
    let seconds = args.seconds.unwrap_or(f64::INFINITY);
    ensure!(
        seconds > 0.0,
        "cannot monitor for {seconds} seconds; set --seconds above 0"
    );
    let source = Source::open(&args.source)?;
    let mut recorder = match &args.record {
        Some(path) => Some(Recorder::new(path).with_context(|| path.display().to_string())?),
        None => None,
    };
    let stop = Arc::new(AtomicBool::new(false));
    let signal = Arc::clone(&stop);
    ctrlc::set_handler(move || signal.store(true, Ordering::Relaxed))
        .context("Ctrl-C cannot be heard")?;
    let mut watch = Watch::new();
    while watch.seconds() < seconds && !stop.load(Ordering::Relaxed) {
        std::thread::sleep(LOOK_EVERY);
        watch.look(source.link(), recorder.as_mut())?;
        if let Some(lines) = watch.due(source.link()) {
            if args.json {
                output::note(&lines);
            } else {
                output::print_text(&lines)?;
            }
        }
    }
    let report = watch.report(source.link());
    if let (Some(recorder), Some(path)) = (recorder, &args.record) {
        let samples = recorder.samples();
        recorder
            .finish()
            .with_context(|| path.display().to_string())?;
        output::note(&format!("{}: {samples} samples", path.display()));
    }
    output::print_report(args.json, &report, verdict)
}

/// The last line: what to do, when nothing came.
fn verdict(report: &Report) -> String {
    if report.devices.is_empty() {
        return format!("no samples in {:.0} s: {}", report.seconds, report.message);
    }
    let samples: u64 = report.devices.iter().map(|device| device.samples).sum();
    let lost: u64 = report.devices.iter().map(|device| device.lost).sum();
    format!(
        "{} devices, {samples} samples, {lost} lost",
        report.devices.len()
    )
}

fn list_ports(json: bool) -> Result<()> {
    let ports = ports();
    if json {
        let listed: Vec<_> = ports
            .iter()
            .map(|port| serde_json::json!({ "port": port.name, "description": port.description, "usb": port.is_usb }))
            .collect();
        return output::print_json(&serde_json::json!({ "ports": listed }));
    }
    if ports.is_empty() {
        return output::print_text("there is no serial port; plug in the sensor");
    }
    let line = |port: &footfall_imu::live::serial::port::PortInfo| {
        format!("{}  {}", port.name, port.description)
    };
    output::print_text(&ports.iter().map(line).collect::<Vec<_>>().join("\n"))
}
