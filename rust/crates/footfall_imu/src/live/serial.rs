//! Devices on serial ports, and anything else that sends a stream of bytes.
//!
//! [`SerialFormat`] lists what is understood; [`StreamParser`] cuts a stream into messages, [`detect`] finds out what a stream is, and [`port`]
//! listens at a port.

mod bno085;
pub mod detect;
mod mti;
pub mod port;
mod text;
mod threespace;
mod witmotion;
mod ximu3;

pub use text::{ForceUnit, RateUnit, TextFormat, TimeUnit};

pub(super) use text::Text;

use super::reading::Reading;

/// No message is longer, bytes.
const LONGEST_MESSAGE: usize = 2048;

/// Protocols of serial devices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SerialFormat {
    /// WitMotion's standard protocol (WT901, JY901 and their kin).
    WitMotion,
    /// x-io's x-IMU3, text or binary messages.
    XImu3,
    /// Xsens MTi, `MTData2`.
    Mti,
    /// Yost 3-Space, streaming as [`port`] sets it up.
    ThreeSpace,
    /// CEVA BNO085 in UART-RVC mode, which sends no angular rate.
    Bno085,
    /// Lines of numbers or of JSON, as hobby boards print.
    Text,
}

impl SerialFormat {
    /// All of them; text comes last, as it is the least strict.
    pub const ALL: [Self; 6] = [
        Self::WitMotion,
        Self::XImu3,
        Self::Mti,
        Self::ThreeSpace,
        Self::Bno085,
        Self::Text,
    ];

    /// Its name on the command line and in Godot.
    pub const fn name(self) -> &'static str {
        match self {
            Self::WitMotion => "witmotion",
            Self::XImu3 => "ximu3",
            Self::Mti => "mti",
            Self::ThreeSpace => "threespace",
            Self::Bno085 => "bno085_rvc",
            Self::Text => "text",
        }
    }

    /// The format of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }

    /// Limitation that its users have to know.
    pub const fn caveat(self) -> Option<&'static str> {
        match self {
            Self::Bno085 => Some(
                "a BNO085 in RVC mode sends no angular rate and cannot drive a body; read it by SHTP on a board that prints lines of text",
            ),
            _ => None,
        }
    }
}

/// Classification of the beginning of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Taken {
    /// A message that is not whole yet.
    More,
    /// A message of this many bytes.
    Message(usize),
    /// This many bytes that are no message.
    Garbage(usize),
}

/// One format's way to take a message from the beginning of a stream.
trait Format: Send {
    /// Looks at the beginning of `bytes`, which are not empty.
    fn take(&mut self, bytes: &[u8], give: &mut dyn FnMut(Reading)) -> Taken;
}

/// Cuts a stream into messages. Holds at most two messages' bytes, whatever comes.
pub struct StreamParser {
    format: Box<dyn Format>,
    buffer: Vec<u8>,
    messages: u64,
    message_bytes: u64,
    garbage_bytes: u64,
}

impl core::fmt::Debug for StreamParser {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("StreamParser")
            .field("messages", &self.messages)
            .field("garbage_bytes", &self.garbage_bytes)
            .finish_non_exhaustive()
    }
}

impl StreamParser {
    /// A parser of this format; `text` says what lines of numbers mean.
    pub fn new(format: SerialFormat, text: &TextFormat) -> Self {
        let format: Box<dyn Format> = match format {
            SerialFormat::WitMotion => Box::<witmotion::WitMotion>::default(),
            SerialFormat::XImu3 => Box::new(ximu3::XImu3),
            SerialFormat::Mti => Box::<mti::Mti>::default(),
            SerialFormat::ThreeSpace => Box::<threespace::ThreeSpace>::default(),
            SerialFormat::Bno085 => Box::new(bno085::Bno085),
            SerialFormat::Text => Box::new(text::Text::new(text)),
        };
        Self {
            format,
            buffer: Vec::with_capacity(2 * LONGEST_MESSAGE),
            messages: 0,
            message_bytes: 0,
            garbage_bytes: 0,
        }
    }

    /// Whole messages so far.
    pub const fn messages(&self) -> u64 {
        self.messages
    }

    /// Bytes of whole messages so far.
    pub const fn message_bytes(&self) -> u64 {
        self.message_bytes
    }

    /// Bytes so far that were part of no message.
    pub const fn garbage_bytes(&self) -> u64 {
        self.garbage_bytes
    }

    /// Takes what came and gives every reading that it completes.
    pub fn push(&mut self, bytes: &[u8], mut give: impl FnMut(Reading)) {
        for part in bytes.chunks(LONGEST_MESSAGE) {
            self.buffer.extend_from_slice(part);
            self.take_messages(&mut give);
        }
    }

    fn take_messages(&mut self, give: &mut dyn FnMut(Reading)) {
        let mut start = 0;
        while start < self.buffer.len() {
            let rest = &self.buffer[start..];
            let taken = match self.format.take(rest, give) {
                Taken::More if rest.len() >= LONGEST_MESSAGE => Taken::Garbage(1),
                taken => taken,
            };
            match taken {
                Taken::More => break,
                Taken::Message(length) => {
                    self.messages += 1;
                    self.message_bytes += length as u64;
                    start += length.max(1);
                }
                Taken::Garbage(length) => {
                    self.garbage_bytes += length as u64;
                    start += length.max(1);
                }
            }
        }
        self.buffer.drain(..start.min(self.buffer.len()));
    }
}

/// The first `N` bytes at a place, if there are as many.
fn bytes_at<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at + N)?.try_into().ok()
}

/// Sum of bytes in eight bits, by which most devices close a message.
fn sum(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum.wrapping_add(*byte))
}

/// Bytes before the next one that may begin a message, at least one.
fn garbage_until(bytes: &[u8], begins: u8) -> Taken {
    let next = bytes.iter().skip(1).position(|byte| *byte == begins);
    Taken::Garbage(next.map_or(bytes.len(), |skipped| skipped + 1))
}
