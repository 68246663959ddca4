//! `SerialImuSource`: a sensor on a serial port.

use crate::imu_source::{Live, LiveSource, Opened, SharedPorts, live_source_api};
use footfall_imu::live::Link;
use footfall_imu::live::serial::port::{self, SerialConfig};
use footfall_imu::live::serial::{ForceUnit, RateUnit, SerialFormat, TextFormat, TimeUnit};
use godot::classes::{IResource, Resource};
use godot::prelude::*;
use godot::register::info::PropertyHint;
use godot::register::info::PropertyInfo;

static PORTS: SharedPorts<SerialConfig, Link> = SharedPorts::new();

/// Receives samples from an inertial sensor on a serial port: USB or Bluetooth.
///
/// WitMotion, x-IMU3, Xsens MTi and boards that print lines of text are recognised, with their baud rate; for a Yost 3-Space set `format`.
/// An unplugged port is reopened when it returns. On Linux the user must be in the group `dialout`.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct SerialImuSource {
    /// Name of the port, such as `/dev/ttyUSB0` or `COM3`; empty for the first one on USB.
    #[export]
    #[var(set = set_port)]
    port: GString,

    /// Baud rate; 0 to detect it.
    #[export(range = (0.0, 4_000_000.0, 1.0))]
    #[var(set = set_baud_rate)]
    baud_rate: i64,

    /// Protocol of the device.
    #[export]
    #[var(set = set_format)]
    format: SerialImuFormat,

    /// Names of the columns of lines of text, such as `t,ax,ay,az,gx,gy,gz`; empty if the device prints a header or uses this order.
    ///
    /// A name may include its unit, as in `ax_g`, `gx_dps`, `time_ms`. Missing units are guessed.
    #[export]
    #[var(set = set_columns)]
    columns: GString,

    /// Unit of the acceleration in lines of text without units.
    #[export]
    #[var(set = set_force_unit)]
    force_unit: ImuForceUnit,

    /// Unit of the angular rate in lines of text without units.
    #[export]
    #[var(set = set_rate_unit)]
    rate_unit: ImuRateUnit,

    /// Unit of time in lines of text without units.
    #[export]
    #[var(set = set_time_unit)]
    time_unit: ImuTimeUnit,

    live: Live,
    base: Base<Resource>,
}

/// Protocols of serial devices.
#[derive(GodotConvert, Var, Export, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[godot(via = i64)]
#[repr(i32)]
pub(crate) enum SerialImuFormat {
    #[default]
    Auto = 0,
    WitMotion = 1,
    XImu3 = 2,
    XsensMTi = 3,
    Yost3Space = 4,
    Text = 5,
}

/// A unit of acceleration.
#[derive(GodotConvert, Var, Export, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[godot(via = i64)]
#[repr(i32)]
pub(crate) enum ImuForceUnit {
    #[default]
    Auto = 0,
    MetresPerSecondSquared = 1,
    G = 2,
    MilliG = 3,
    Mpu6050Counts = 4,
}

/// A unit of angular rate.
#[derive(GodotConvert, Var, Export, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[godot(via = i64)]
#[repr(i32)]
pub(crate) enum ImuRateUnit {
    #[default]
    Auto = 0,
    RadiansPerSecond = 1,
    DegreesPerSecond = 2,
    Mpu6050Counts = 3,
}

/// A unit of time.
#[derive(GodotConvert, Var, Export, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[godot(via = i64)]
#[repr(i32)]
pub(crate) enum ImuTimeUnit {
    #[default]
    Auto = 0,
    Seconds = 1,
    Milliseconds = 2,
    Microseconds = 3,
}

#[godot_api]
impl IResource for SerialImuSource {
    fn on_validate_property(&self, property: &mut PropertyInfo) {
        if property.property_name == "port" {
            let names: Vec<String> = port::ports().into_iter().map(|port| port.name).collect();
            property.hint_info.hint = PropertyHint::ENUM_SUGGESTION;
            property.hint_info.hint_string = GString::from(&names.join(","));
        }
    }
}

#[godot_api]
impl SerialImuSource {
    /// `format`, and every unit: detected.
    #[constant]
    const AUTO: i32 = 0;
    /// `format`: WitMotion's standard protocol.
    #[constant]
    const WIT_MOTION: i32 = SerialImuFormat::WitMotion as i32;
    /// `format`: x-IMU3, text or binary.
    #[constant]
    const X_IMU3: i32 = SerialImuFormat::XImu3 as i32;
    /// `format`: Xsens MTi, `MTData2`.
    #[constant]
    const XSENS_MTI: i32 = SerialImuFormat::XsensMTi as i32;
    /// `format`: Yost 3-Space.
    #[constant]
    const YOST_3_SPACE: i32 = SerialImuFormat::Yost3Space as i32;
    /// `format`: lines of numbers or JSON.
    #[constant]
    const TEXT: i32 = SerialImuFormat::Text as i32;
    /// `force_unit`: m/s².
    #[constant]
    const METRES_PER_SECOND_SQUARED: i32 = ImuForceUnit::MetresPerSecondSquared as i32;
    /// `force_unit`: standard gravity.
    #[constant]
    const G: i32 = ImuForceUnit::G as i32;
    /// `force_unit`: thousandths of standard gravity.
    #[constant]
    const MILLI_G: i32 = ImuForceUnit::MilliG as i32;
    /// `rate_unit`: rad/s.
    #[constant]
    const RADIANS_PER_SECOND: i32 = ImuRateUnit::RadiansPerSecond as i32;
    /// `rate_unit`: degrees per second.
    #[constant]
    const DEGREES_PER_SECOND: i32 = ImuRateUnit::DegreesPerSecond as i32;
    /// `time_unit`: seconds.
    #[constant]
    const SECONDS: i32 = ImuTimeUnit::Seconds as i32;
    /// `time_unit`: milliseconds.
    #[constant]
    const MILLISECONDS: i32 = ImuTimeUnit::Milliseconds as i32;
    /// `time_unit`: microseconds.
    #[constant]
    const MICROSECONDS: i32 = ImuTimeUnit::Microseconds as i32;

    /// Returns the serial ports of this machine, those on USB first.
    #[func]
    fn list_ports() -> PackedStringArray {
        port::ports()
            .iter()
            .map(|port| GString::from(&port.name))
            .collect()
    }

    #[func]
    fn set_port(&mut self, port: GString) {
        self.port = port;
        self.restart();
    }

    #[func]
    fn set_baud_rate(&mut self, baud_rate: i64) {
        self.baud_rate = baud_rate;
        self.restart();
    }

    #[func]
    fn set_format(&mut self, format: SerialImuFormat) {
        self.format = format;
        self.restart();
    }

    #[func]
    fn set_columns(&mut self, columns: GString) {
        self.columns = columns;
        self.restart();
    }

    #[func]
    fn set_force_unit(&mut self, force_unit: ImuForceUnit) {
        self.force_unit = force_unit;
        self.restart();
    }

    #[func]
    fn set_rate_unit(&mut self, rate_unit: ImuRateUnit) {
        self.rate_unit = rate_unit;
        self.restart();
    }

    #[func]
    fn set_time_unit(&mut self, time_unit: ImuTimeUnit) {
        self.time_unit = time_unit;
        self.restart();
    }
}

live_source_api!(SerialImuSource);

impl SerialImuSource {
    fn restart(&mut self) {
        self.live.close();
        self.base_mut().emit_changed();
    }
}

impl LiveSource for SerialImuSource {
    fn live(&self) -> &Live {
        &self.live
    }

    /// Another kind of device at the same port comes after the first.
    fn place(&self) -> usize {
        let last = self.live.with(|opened| opened.link().device_count());
        last.unwrap_or_default().saturating_sub(1)
    }

    fn opened(&self) -> Result<Opened, String> {
        let columns = self.columns.to_string();
        let config = SerialConfig {
            port: self.port.to_string(),
            baud_rate: u32::try_from(self.baud_rate).ok().filter(|rate| *rate > 0),
            format: match self.format {
                SerialImuFormat::Auto => None,
                SerialImuFormat::WitMotion => Some(SerialFormat::WitMotion),
                SerialImuFormat::XImu3 => Some(SerialFormat::XImu3),
                SerialImuFormat::XsensMTi => Some(SerialFormat::Mti),
                SerialImuFormat::Yost3Space => Some(SerialFormat::ThreeSpace),
                SerialImuFormat::Text => Some(SerialFormat::Text),
            },
            text: TextFormat {
                columns: (!columns.is_empty()).then_some(columns),
                time: match self.time_unit {
                    ImuTimeUnit::Auto => None,
                    ImuTimeUnit::Seconds => Some(TimeUnit::Second),
                    ImuTimeUnit::Milliseconds => Some(TimeUnit::Millisecond),
                    ImuTimeUnit::Microseconds => Some(TimeUnit::Microsecond),
                },
                force: match self.force_unit {
                    ImuForceUnit::Auto => None,
                    ImuForceUnit::MetresPerSecondSquared => Some(ForceUnit::MetrePerSecondSquared),
                    ImuForceUnit::G => Some(ForceUnit::G),
                    ImuForceUnit::MilliG => Some(ForceUnit::MilliG),
                    ImuForceUnit::Mpu6050Counts => Some(ForceUnit::Counts),
                },
                rate: match self.rate_unit {
                    ImuRateUnit::Auto => None,
                    ImuRateUnit::RadiansPerSecond => Some(RateUnit::RadianPerSecond),
                    ImuRateUnit::DegreesPerSecond => Some(RateUnit::DegreePerSecond),
                    ImuRateUnit::Mpu6050Counts => Some(RateUnit::Counts),
                },
            },
        };
        config.text.check()?;
        let link = PORTS.get(config.clone(), || Ok::<_, String>(port::listen(config)))?;
        Ok(Opened::Link(link))
    }
}
