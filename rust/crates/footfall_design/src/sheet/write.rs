//! A sheet to TOML text, and its numbers by their names.

use super::{Axis, Section as _, StyleSheet};
use std::fmt::{self, Write as _};

impl StyleSheet {
    /// A number of the tables from `[walk]` to `[irregular]`, by its table and key.
    pub fn value_mut(&mut self, section: &str, key: &str) -> Option<&mut f32> {
        match section {
            "walk" => self.walk.value_mut(key),
            "feet" => self.feet.value_mut(key),
            "pelvis" => self.pelvis.value_mut(key),
            "trunk" => self.trunk.value_mut(key),
            "head" => self.head.value_mut(key),
            "shoulders" => self.shoulders.value_mut(key),
            "arms" => self.arms.value_mut(key),
            "left" => self.sides[0].value_mut(key),
            "right" => self.sides[1].value_mut(key),
            "irregular" => self.irregular.value_mut(key),
            _ => None,
        }
    }

    /// The text of the sheet: what changes something, and nothing else. [`StyleSheet::parse`] gives the same sheet back.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        let written = self.write(&mut text);
        debug_assert!(written.is_ok(), "a String takes all that is written to it");
        text
    }

    fn write(&self, text: &mut String) -> fmt::Result {
        writeln!(text, "name = {}", quoted(&self.name))?;
        writeln!(text, "summary = {}", quoted(&self.summary))?;
        let mut copy = self.clone();
        let mut section = "";
        for key in Self::keys() {
            let Some(value) = copy.value_mut(key.section, key.key) else {
                continue;
            };
            if key.is_neutral(*value) {
                continue;
            }
            if section != key.section {
                section = key.section;
                writeln!(text, "\n[{section}]")?;
            }
            writeln!(text, "{} = {value}", key.key)?;
        }
        for (joint, edit) in &self.joints {
            writeln!(text, "\n[joints.{}]", joint.name())?;
            let mut edit = edit.clone();
            for key in super::JointEdit::keys("joints.NAME") {
                if let Some(value) = edit.value_mut(key.key).filter(|v| !key.is_neutral(**v)) {
                    writeln!(text, "{} = {value}", key.key)?;
                }
            }
        }
        for curve in &self.curves {
            let axis = match curve.axis {
                Axis::Pitch => "pitch",
                Axis::Yaw => "yaw",
                Axis::Roll => "roll",
            };
            writeln!(text, "\n[[curve]]")?;
            writeln!(text, "joint = \"{}\"", curve.joint.name())?;
            writeln!(text, "axis = \"{axis}\"")?;
            let points = curve.offset.points().iter().zip(curve.amplitude.points());
            let points: Vec<String> = points
                .map(|((phase, offset), (_, amplitude))| {
                    format!("[{}, {offset}, {amplitude}]", phase * 100.0)
                })
                .collect();
            writeln!(text, "points = [{}]", points.join(", "))?;
        }
        Ok(())
    }
}

/// A TOML basic string.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            '\n' => quoted.push_str("\\n"),
            other if other.is_control() => quoted.push(' '),
            other => quoted.push(other),
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shipped::SHEETS;

    #[test]
    fn every_shipped_sheet_is_the_same_when_written_and_read() {
        for (name, text) in SHEETS {
            let sheet = StyleSheet::parse(text).unwrap();
            let written = sheet.to_toml();
            let read =
                StyleSheet::parse(&written).unwrap_or_else(|e| panic!("{name}: {e}\n{written}"));
            assert_eq!(read.joints.len(), sheet.joints.len(), "{name}");
            for (a, b) in read.curves.iter().zip(&sheet.curves) {
                for phase in 0..20 {
                    let phase = phase as f32 / 20.0;
                    assert!((a.offset.at(phase) - b.offset.at(phase)).abs() < 1e-3);
                }
            }
            let without_curves = |sheet: &StyleSheet| StyleSheet {
                curves: Vec::new(),
                ..sheet.clone()
            };
            assert_eq!(without_curves(&read), without_curves(&sheet), "{name}");
        }
    }

    #[test]
    fn quotes_and_line_ends_in_a_name_survive() {
        let sheet = StyleSheet {
            name: "my \"own\" \\ walk".to_owned(),
            summary: "two\nlines".to_owned(),
            ..StyleSheet::default()
        };
        assert_eq!(StyleSheet::parse(&sheet.to_toml()).unwrap(), sheet);
    }
}
