//! Sources of an `ImuReconstructor3D`: any of the source resources, and the ports that live ones share.

use crate::convert;
use crate::device_imu_source::{self, DeviceImuSource};
use crate::network_imu_source::NetworkImuSource;
use crate::node_imu_source::NodeImuSource;
use crate::phone_imu_source::PhoneImuSource;
use crate::replay_imu_source::ReplayImuSource;
use crate::serial_imu_source::SerialImuSource;
use footfall_imu::live::phone::PhoneServer;
use footfall_imu::live::{Device, DeviceStatus, Link};
use footfall_imu::{ImuRecording, ImuSample};
use glam::{Quat, Vec3};
use godot::classes::Resource;
use godot::prelude::*;
use std::cell::RefCell;
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// Classes that a node takes as its source, for the inspector.
pub(crate) const CLASSES: &str =
    "ReplayImuSource,PhoneImuSource,SerialImuSource,NetworkImuSource,DeviceImuSource,NodeImuSource";

/// Time without samples after which a device counts as silent, seconds.
const SILENT_SECS: f64 = 0.5;

/// Samples that a source gives in a frame.
pub(crate) enum SourceSamples {
    /// A recording, and whether it begins anew at its end.
    Recording(Arc<ImuRecording>, bool),
    /// A live sensor.
    Device(Device),
    /// Measurement of the device that the game runs on.
    Now(ImuSample),
    /// Position and orientation of an object that stands for a sensor, now.
    Pose(Vec3, Quat),
    /// Nothing, yet or any more.
    Nothing,
}

/// Asks a source for its samples; live sources open their ports.
pub(crate) fn hear(source: &Gd<Resource>, listener: &Gd<Node>) -> SourceSamples {
    if let Ok(replay) = source.clone().try_cast::<ReplayImuSource>() {
        let replay = replay.bind();
        let recording = replay.recording();
        return recording.map_or(SourceSamples::Nothing, |recording| {
            SourceSamples::Recording(recording, replay.repeats())
        });
    }
    if source.clone().try_cast::<DeviceImuSource>().is_ok() {
        return device_imu_source::measure().map_or(SourceSamples::Nothing, SourceSamples::Now);
    }
    if let Ok(source) = source.clone().try_cast::<NodeImuSource>() {
        let pose = source.bind().pose(listener);
        return pose.map_or(SourceSamples::Nothing, |(place, turn)| {
            SourceSamples::Pose(place, turn)
        });
    }
    let live = |live: &dyn LiveSource| {
        live.live().open(|| live.opened());
        live.live()
            .device(live.place())
            .map_or(SourceSamples::Nothing, SourceSamples::Device)
    };
    if let Ok(source) = source.clone().try_cast::<PhoneImuSource>() {
        return live(&*source.bind());
    }
    if let Ok(source) = source.clone().try_cast::<SerialImuSource>() {
        return live(&*source.bind());
    }
    if let Ok(source) = source.clone().try_cast::<NetworkImuSource>() {
        return live(&*source.bind());
    }
    SourceSamples::Nothing
}

/// A footstep of the character whom a source drives, for what can be felt.
pub(crate) fn footstep(source: &Gd<Resource>) {
    if let Ok(phone) = source.clone().try_cast::<PhoneImuSource>() {
        phone.bind().vibrate();
    }
}

/// Problem with a source's settings, for the node that uses it.
pub(crate) fn problem(source: &Gd<Resource>, listener: &Gd<Node>) -> Option<String> {
    if let Ok(replay) = source.clone().try_cast::<ReplayImuSource>() {
        return replay.bind().recording().err();
    }
    if let Ok(source) = source.clone().try_cast::<NodeImuSource>() {
        return source.bind().problem(listener);
    }
    let known = CLASSES.split(',').any(|class| source.is_class(class));
    (!known).then(|| {
        format!(
            "{} is not a sensor source. Use one of {}",
            source.get_class(),
            CLASSES.replace(',', ", ")
        )
    })
}

/// A source that listens at a port.
pub(crate) trait LiveSource {
    /// Its port, once open.
    fn live(&self) -> &Live;
    /// Index of the device at the port.
    fn place(&self) -> usize;
    /// Opens the port, or joins others that have it open.
    fn opened(&self) -> Result<Opened, String>;
}

/// A port that sources share.
#[derive(Clone, Debug)]
pub(crate) enum Opened {
    Link(Arc<Link>),
    Phone(Arc<PhoneServer>),
}

impl Opened {
    pub(crate) fn link(&self) -> &Link {
        match self {
            Self::Link(link) => link,
            Self::Phone(server) => server.link(),
        }
    }
}

/// A source's hold on its port.
#[derive(Debug, Default)]
pub(crate) struct Live {
    opened: RefCell<Option<Result<Opened, String>>>,
}

impl Live {
    pub(crate) fn open(&self, open: impl FnOnce() -> Result<Opened, String>) {
        let mut opened = self.opened.borrow_mut();
        if opened.is_none() {
            *opened = Some(open());
        }
    }

    pub(crate) fn close(&self) {
        *self.opened.borrow_mut() = None;
    }

    pub(crate) fn with<T>(&self, look: impl FnOnce(&Opened) -> T) -> Option<T> {
        match &*self.opened.borrow() {
            Some(Ok(opened)) => Some(look(opened)),
            _ => None,
        }
    }

    pub(crate) fn device(&self, place: usize) -> Option<Device> {
        self.with(|opened| opened.link().device(place)).flatten()
    }

    pub(crate) fn status(&self, place: usize) -> Option<DeviceStatus> {
        self.device(place).map(|device| device.status())
    }

    /// State of the source: `closed`, `opening`, `listening`, `receiving`, `silent` or `failed`.
    pub(crate) fn state(&self, place: usize) -> &'static str {
        if let Some(Err(_)) = &*self.opened.borrow() {
            return "failed";
        }
        let Some(state) = self.with(|opened| opened.link().state()) else {
            return "closed";
        };
        let receiving = "receiving";
        match self.status(place).filter(|status| status.samples > 0) {
            Some(status) if state.name() == receiving => {
                if status.silent_secs() < SILENT_SECS {
                    receiving
                } else {
                    "silent"
                }
            }
            // Other devices send to the port, but not this one.
            None if state.name() == receiving => "listening",
            _ => state.name(),
        }
    }

    /// Message for the player: empty while all is well.
    pub(crate) fn message(&self, place: usize) -> String {
        if let Some(Err(problem)) = &*self.opened.borrow() {
            return problem.clone();
        }
        let message = self.with(|opened| opened.link().state().message().to_owned());
        match (self.state(place), self.status(place)) {
            ("silent", Some(status)) => format!(
                "no samples from {} for {:.0} s",
                status.name,
                status.silent_secs()
            ),
            ("receiving", Some(status)) => status.fault.unwrap_or_default(),
            ("listening", _) if message.as_deref() == Some("") => {
                "waiting for one more sensor".to_owned()
            }
            _ => message.unwrap_or_default(),
        }
    }
}

/// Ports that are open, by what they are: sources with the same settings share one.
#[derive(Debug)]
pub(crate) struct SharedPorts<K, T> {
    open: Mutex<Vec<(K, Weak<T>)>>,
}

impl<K: PartialEq, T> SharedPorts<K, T> {
    pub(crate) const fn new() -> Self {
        Self {
            open: Mutex::new(Vec::new()),
        }
    }

    /// The open port of this key, or a new one.
    pub(crate) fn get<E>(&self, key: K, open: impl FnOnce() -> Result<T, E>) -> Result<Arc<T>, E> {
        let mut ports = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        ports.retain(|(_, port)| port.strong_count() > 0);
        let known = ports.iter().find(|(own, _)| *own == key);
        if let Some(port) = known.and_then(|(_, port)| port.upgrade()) {
            return Ok(port);
        }
        let port = Arc::new(open()?);
        ports.push((key, Arc::downgrade(&port)));
        Ok(port)
    }
}

/// Methods of every live source for scripts.
macro_rules! live_source_api {
    ($class:ident) => {
        #[godot_api(secondary)]
        impl $class {
            /// Opens the port now. Otherwise it opens when a node first uses this source.
            #[func]
            fn start(&self) {
                $crate::imu_source::LiveSource::live(self)
                    .open(|| $crate::imu_source::LiveSource::opened(self));
            }

            /// Closes the port, unless another source uses it.
            #[func]
            fn stop(&self) {
                $crate::imu_source::LiveSource::live(self).close();
            }

            /// Returns the state of the source: `closed`, `opening`, `listening` (no samples yet), `receiving`, `silent` or `failed` (opening is retried).
            #[func]
            fn get_state(&self) -> StringName {
                let place = $crate::imu_source::LiveSource::place(self);
                StringName::from($crate::imu_source::LiveSource::live(self).state(place))
            }

            /// Returns the message for the player: what is pending, or what is wrong and what to do. Empty while all is well.
            #[func]
            fn get_message(&self) -> GString {
                let place = $crate::imu_source::LiveSource::place(self);
                GString::from(&$crate::imu_source::LiveSource::live(self).message(place))
            }

            /// Returns the status of the sensor: `name`, `format`, `samples`, `lost` and `rejected` (counts), `rate` (samples per second), `jitter` (seconds),
            /// `silent` (seconds), `force` (m/s², last value) and `rotation` (rad/s, last value). Empty before the first sample.
            #[func]
            fn get_sensor_status(&self) -> VarDictionary {
                let place = $crate::imu_source::LiveSource::place(self);
                let status = $crate::imu_source::LiveSource::live(self).status(place);
                status.map_or_else(VarDictionary::new, |status| {
                    $crate::imu_source::dictionary(&status)
                })
            }
        }
    };
}
pub(crate) use live_source_api;

/// A status for scripts.
pub(crate) fn dictionary(status: &DeviceStatus) -> VarDictionary {
    let vector = |pick: fn(&ImuSample) -> glam::Vec3| {
        status
            .last
            .as_ref()
            .map_or(Vector3::ZERO, |sample| convert::vector3(pick(sample)))
    };
    vdict! {
        "name" => status.name.as_str(),
        "format" => status.format,
        "samples" => status.samples.cast_signed(),
        "lost" => status.lost.cast_signed(),
        "rejected" => status.rejected.cast_signed(),
        "rate" => status.rate_hz,
        "jitter" => status.jitter_secs,
        "silent" => status.silent_secs(),
        "force" => vector(|sample| sample.force),
        "rotation" => vector(|sample| sample.rate),
    }
}
