//! Inertial sensors: samples, recordings, orientation, gait events and strides of a foot, and live ports.
//!
//! An [`ImuSample`] is a time, a specific force in m/s² (at rest [`GRAVITY_MPS2`] along up) and an angular rate in rad/s. An [`ImuRecording`] is a sequence of samples; the
//! module [`csv`] reads and writes its file, and reads those of other programs whose header names units, with an [`ImuCsvError`] that names line and column. [`check_recording`] detects wrong units, axes and rates, each a [`RecordingFault`].
//!
//! ```
//! use footfall::glam::Vec3;
//! use footfall::sensor::{GRAVITY_MPS2, ImuCsvError, ImuRecording, ImuSample, RecordingFault, check_recording, csv};
//! use std::path::Path;
//!
//! let mut resting = ImuRecording {
//!     samples: (0..200)
//!         .map(|n| ImuSample {
//!             time_secs: f64::from(n) / 100.0,
//!             force: GRAVITY_MPS2 * Vec3::Y,
//!             rate: Vec3::ZERO,
//!         })
//!         .collect(),
//! };
//! let text = csv::write(&resting);
//! assert_eq!(csv::parse_text(&text, Path::new("memory"))?, resting);
//! let wrong = csv::parse_text("time_s,ax\n0.0,fast\n", Path::new("memory"));
//! assert!(wrong.is_err_and(|error: ImuCsvError| error.to_string().contains("memory")));
//!
//! check_recording(&resting)?;
//! for sample in &mut resting.samples {
//!     sample.force /= GRAVITY_MPS2; // In g instead of m/s²: a common mistake.
//! }
//! let fault: RecordingFault = check_recording(&resting).expect_err("nobody weighs so little");
//! println!("{fault}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`StreamMonitor`] checks samples as they arrive. A [`StreamFault`] says what is wrong and what to do; a [`FaultSpan`] adds the time. [`find_rest`] finds a time at which a sensor was still: its
//! [`Rest`] holds the sensor's bias and gravity.
//!
//! ```
//! use footfall::glam::Vec3;
//! use footfall::sensor::{
//!     FaultSpan, GRAVITY_MPS2, ImuRecording, ImuSample, Rest, StreamFault, StreamMonitor, find_rest,
//! };
//!
//! let bias = Vec3::new(0.01, 0.0, -0.02);
//! let still = |gravity: f32| ImuRecording {
//!     samples: (0..300)
//!         .map(|n| ImuSample { time_secs: f64::from(n) / 100.0, force: gravity * Vec3::Y, rate: bias })
//!         .collect(),
//! };
//! let mut monitor = StreamMonitor::new(Some(100.0));
//! for sample in still(GRAVITY_MPS2).samples {
//!     monitor.push(sample); // A game does this as samples come.
//! }
//! assert_eq!(monitor.fault(), None);
//! // A recording as a whole, in g instead of m/s².
//! let spans: Vec<FaultSpan> = StreamMonitor::faults_of(&still(1.0), None);
//! assert!(matches!(spans[0].fault, StreamFault::ForceInG { .. }));
//!
//! let rest: Rest = find_rest(&still(9.7)).expect("it never moves");
//! assert!(rest.rate_bias.distance(bias) < 1e-4 && (rest.force.length() - 9.7).abs() < 1e-3);
//! ```
//!
//! [`detect_swings`] finds each [`Swing`] of a foot with a sensor, [`events_of`] its [`SensorEvent`]s, [`measure_strides`] the [`SensorStride`]s.
//!
//! ```
//! use footfall::sensor::{SensorEvent, SensorStride, Swing, csv, detect_swings, events_of, measure_strides};
//! use std::path::Path;
//!
//! # std::env::set_current_dir("../../..")?;
//! let recording = csv::read(Path::new("tests/data/walker_1_slow.right_foot.csv"))?;
//! let swings: Vec<Swing> = detect_swings(&recording);
//! let events: Vec<SensorEvent> = events_of(&swings);
//! assert_eq!(events.len(), 2 * swings.len());
//! let strides: Vec<SensorStride> = measure_strides(&recording, &swings);
//! // The recording begins and ends within a swing; whole strides lie between.
//! let whole = &strides[1..strides.len() - 1];
//! assert!(whole.iter().all(|stride| (1.2..1.4).contains(&stride.length_m)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! An [`OrientationFilter`] tracks the orientation of a sensor.
//!
//! ```
//! use footfall::glam::Vec3;
//! use footfall::sensor::{GRAVITY_MPS2, OrientationFilter};
//!
//! // Upright, then turned by a radian a second about the vertical for one second.
//! let force = GRAVITY_MPS2 * Vec3::Y;
//! let mut filter = OrientationFilter::new(force);
//! for _ in 0..100 {
//!     filter.step(0.01, force, Vec3::Y);
//! }
//! let forward = filter.world_from_sensor() * Vec3::Z;
//! assert!((forward.angle_between(Vec3::Z) - 1.0).abs() < 0.05);
//! assert!(filter.up().angle_between(Vec3::Y) < 0.01);
//! ```
#![cfg_attr(
    feature = "live",
    doc = r#"
The module [`live`] opens ports. A [`Link`](live::Link) listens on a thread of its own until it is dropped and lists the [`Device`](live::Device)s that it heard;
[`live::serial::port`], [`live::network`] and [`live::phone`] make links.

```
use footfall::sensor::live::network::udp::{UdpConfig, listen};
use std::net::UdpSocket;
use std::time::Duration;

let link = listen(UdpConfig { port: 0, ..UdpConfig::default() });
let port = loop {
    match link.address() {
        Some(address) => break address.port(),
        None => std::thread::sleep(Duration::from_millis(5)),
    }
};
// A sensor sends lines of numbers: seconds, specific force, angular rate.
let socket = UdpSocket::bind("127.0.0.1:0")?;
let mut samples = Vec::new();
for n in 0..400 {
    let line = format!("{:.2},0,9.81,0,0,0,0\n", f64::from(n) * 0.01);
    socket.send_to(line.as_bytes(), ("127.0.0.1", port))?;
    std::thread::sleep(Duration::from_millis(10));
    // A game does this once a frame.
    if let Some(device) = link.device(0) {
        device.take(|sample| samples.push(sample));
    }
    if samples.len() > 50 {
        break;
    }
}
assert!(samples.len() > 50 && (samples[50].force.y - 9.81).abs() < 0.01);
# Ok::<(), Box<dyn std::error::Error>>(())
```
"#
)]

pub use footfall_imu::events::{SensorEvent, Swing, detect_swings, events_of};
#[cfg(feature = "live")]
pub use footfall_imu::live;
pub use footfall_imu::strides::{SensorStride, measure_strides};
pub use footfall_imu::{
    FaultSpan, GRAVITY_MPS2, ImuCsvError, ImuRecording, ImuSample, OrientationFilter,
    RecordingFault, Rest, StreamFault, StreamMonitor, check_recording, csv, find_rest,
};
