//! Lines of numbers or of JSON, as hobby boards print them.
//!
//! Numbers stand between commas, semicolons, tabs or blanks. A header names the columns (`time_ms,ax,ay,az,gx,gy,gz`, `accX_g`, `gyro_x_dps` …),
//! as may labels in every line (`ax:0.1,ay:…`). Without one six columns are specific force and angular rate, and of seven or more the first is time.

mod columns;
mod units;

pub use crate::units::{ForceUnit, RateUnit, TimeUnit};

use super::{Format, Taken};
use crate::live::json;
use crate::live::reading::Reading;
use columns::{LineColumns, Row};
use units::Scale;

/// A line that is longer is no message, bytes.
const LONGEST_LINE: usize = 512;

/// Lines after which units are guessed from the numbers.
const GUESS_AFTER: usize = 25;

/// Meaning of lines of numbers, as far as their header does not say.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextFormat {
    /// Names of the columns as in a header; `None` when the stream has a header or the usual order.
    pub columns: Option<String>,
    /// Unit of time; `None`: from the header, else guessed.
    pub time: Option<TimeUnit>,
    /// Unit of specific force; `None`: from the header, else guessed.
    pub force: Option<ForceUnit>,
    /// Unit of angular rate; `None`: from the header, else the one that goes with the force's.
    pub rate: Option<RateUnit>,
}

impl TextFormat {
    /// Checks the names of the columns.
    ///
    /// # Errors
    /// Text that names the fault and the remedy.
    pub fn check(&self) -> Result<(), String> {
        let named = |columns: &String| LineColumns::of_header(columns).is_some();
        match &self.columns {
            Some(columns) if !named(columns) => Err(format!(
                "the columns '{columns}' do not name all six axes; write them like t,ax,ay,az,gx,gy,gz"
            )),
            _ => Ok(()),
        }
    }
}

/// Lines of a stream or a datagram.
pub(in crate::live) struct Text {
    setting: TextFormat,
    columns: Option<LineColumns>,
    scale: Option<Scale>,
    /// Rows whose units are not known yet.
    waiting: Vec<Row>,
    /// The first line of a stream may be the end of one.
    begun: bool,
}

impl Text {
    pub(in crate::live) fn new(setting: &TextFormat) -> Self {
        Self {
            columns: setting.columns.as_deref().and_then(LineColumns::of_header),
            setting: setting.clone(),
            scale: None,
            waiting: Vec::new(),
            begun: false,
        }
    }

    /// Parser of a stream whose first line is whole.
    pub(in crate::live) fn of_datagrams(setting: &TextFormat) -> Self {
        Self {
            begun: true,
            ..Self::new(setting)
        }
    }

    /// Gives the readings of a line; returns true when it is a message.
    pub(in crate::live) fn line(&mut self, line: &[u8], give: &mut dyn FnMut(Reading)) -> bool {
        let Ok(text) = core::str::from_utf8(line) else {
            return false;
        };
        let text = text.trim();
        if text.is_empty() {
            return true;
        }
        // A stream whose objects are columns is not taken for an app's first.
        let is_object = text.starts_with('{');
        let flat = self.columns.as_ref().is_some_and(LineColumns::has_labels);
        if is_object && !flat && json::parse(line, &mut *give) {
            return true;
        }
        if let Some(columns) = LineColumns::of_header(text) {
            // A header that comes again, after a reset of the board, is the same.
            if self.setting.columns.is_none() && self.columns.as_ref() != Some(&columns) {
                self.columns = Some(columns);
                self.scale = None;
            }
            return true;
        }
        let Some(row) = columns::row(text, &mut self.columns) else {
            return is_object && flat && json::parse(line, give);
        };
        if let Some(scale) = &self.scale {
            give(scale.reading(&row));
            return true;
        }
        self.waiting.push(row);
        let units = self.columns.as_ref().map(LineColumns::units);
        let units = units.unwrap_or_default();
        if self.waiting.len() >= GUESS_AFTER || units.are_told(&self.setting, &row) {
            let scale = Scale::new(&self.setting, units, &self.waiting);
            for row in self.waiting.drain(..) {
                give(scale.reading(&row));
            }
            self.scale = Some(scale);
        }
        true
    }
}

impl Format for Text {
    fn take(&mut self, bytes: &[u8], give: &mut dyn FnMut(Reading)) -> Taken {
        let Some(end) = bytes
            .iter()
            .take(LONGEST_LINE)
            .position(|byte| *byte == b'\n')
        else {
            return if bytes.len() < LONGEST_LINE {
                Taken::More
            } else {
                Taken::Garbage(LONGEST_LINE)
            };
        };
        let line = &bytes[..end];
        let header = core::str::from_utf8(line)
            .is_ok_and(|text| LineColumns::of_header(text.trim()).is_some());
        let part = !core::mem::replace(&mut self.begun, true) && !header;
        if part || !self.line(line, give) {
            return Taken::Garbage(end + 1);
        }
        Taken::Message(end + 1)
    }
}
