//! Detection of the protocol of a stream of bytes.

use super::{SerialFormat, StreamParser, TextFormat};

/// Whole messages that a format has to have, and the share of all bytes that they have to be.
const LEAST_MESSAGES: u64 = 4;
const LEAST_SHARE: f64 = 0.6;

/// Listens with every format at once.
#[derive(Debug)]
pub struct Detection {
    parsers: Vec<(SerialFormat, StreamParser)>,
    bytes: u64,
}

impl Detection {
    /// Nothing was heard yet.
    pub fn new(text: &TextFormat) -> Self {
        let parser = |format| (format, StreamParser::new(format, text));
        Self {
            parsers: SerialFormat::ALL.into_iter().map(parser).collect(),
            bytes: 0,
        }
    }

    /// Takes what came.
    pub fn push(&mut self, bytes: &[u8]) {
        self.bytes += bytes.len() as u64;
        for (_, parser) in &mut self.parsers {
            parser.push(bytes, |_| {});
        }
    }

    /// Number of bytes so far.
    pub const fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The format whose messages are most of what came, if there is one.
    pub fn found(&self) -> Option<SerialFormat> {
        let share =
            |parser: &StreamParser| parser.message_bytes() as f64 / self.bytes.max(1) as f64;
        let fits = |parser: &StreamParser| {
            parser.messages() >= LEAST_MESSAGES && share(parser) > LEAST_SHARE
        };
        let fitting = self.parsers.iter().filter(|(_, parser)| fits(parser));
        fitting
            .max_by(|a, b| share(&a.1).total_cmp(&share(&b.1)))
            .map(|(format, _)| *format)
    }
}
