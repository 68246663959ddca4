//! TOML text to a sheet; every error knows its line.

use super::{
    Arms, Axis, Feet, Head, Irregular, JointEdit, KeySpec, OneSide, Pelvis, PhaseCurve, Section,
    SheetError, Shoulders, StyleSheet, Trunk, Walk,
};
use crate::curve::PeriodicCurve;
use core::ops::{Range, RangeInclusive};
use footfall_core::Joint;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Degrees of a curve's offset.
const CURVE_OFFSET: RangeInclusive<f32> = -60.0..=60.0;
/// Percent of a curve's amplitude.
const CURVE_AMPLITUDE: RangeInclusive<f32> = 0.0..=300.0;
/// Percent of the gait cycle.
const CURVE_PHASE: RangeInclusive<f32> = 0.0..=100.0;

/// Names of the tables, for messages.
const SECTIONS: &str = "name, summary, [walk], [feet], [pelvis], [trunk], [head], [shoulders], [arms], [left], [right], \
                        [irregular], [joints.NAME] and [[curve]]";

type Value<'i> = Spanned<DeValue<'i>>;

impl StyleSheet {
    /// Reads the text of a sheet.
    ///
    /// # Errors
    /// [`SheetError`] for text that is no TOML, unknown tables, keys and joints, and values of the wrong kind or out of
    /// range, with the line.
    pub fn parse(text: &str) -> Result<Self, SheetError> {
        let reader = Reader { text };
        let table = DeTable::parse(text).map_err(|error| {
            let what = error.message().lines().next().unwrap_or("this is not TOML");
            reader.error(&error.span().unwrap_or(0..0), what.to_owned())
        })?;
        let mut sheet = Self::default();
        for (name, value) in table.get_ref() {
            reader.entry(&mut sheet, name.get_ref(), &name.span(), value)?;
        }
        Ok(sheet)
    }
}

struct Reader<'a> {
    text: &'a str,
}

impl Reader<'_> {
    fn error(&self, span: &Range<usize>, what: String) -> SheetError {
        let before = self.text.get(..span.start).unwrap_or(self.text);
        SheetError {
            line: before.matches('\n').count() + 1,
            what,
        }
    }

    fn entry(
        &self,
        sheet: &mut StyleSheet,
        name: &str,
        span: &Range<usize>,
        value: &Value<'_>,
    ) -> Result<(), SheetError> {
        match name {
            "name" => sheet.name = self.string(name, value)?,
            "summary" => sheet.summary = self.string(name, value)?,
            "walk" => self.fill(&Walk::keys("walk"), value, &mut sheet.walk)?,
            "feet" => self.fill(&Feet::keys("feet"), value, &mut sheet.feet)?,
            "pelvis" => self.fill(&Pelvis::keys("pelvis"), value, &mut sheet.pelvis)?,
            "trunk" => self.fill(&Trunk::keys("trunk"), value, &mut sheet.trunk)?,
            "head" => self.fill(&Head::keys("head"), value, &mut sheet.head)?,
            "shoulders" => self.fill(&Shoulders::keys("shoulders"), value, &mut sheet.shoulders)?,
            "arms" => self.fill(&Arms::keys("arms"), value, &mut sheet.arms)?,
            "left" => self.fill(&OneSide::keys("left"), value, &mut sheet.sides[0])?,
            "right" => self.fill(&OneSide::keys("right"), value, &mut sheet.sides[1])?,
            "irregular" => self.fill(&Irregular::keys("irregular"), value, &mut sheet.irregular)?,
            "joints" => self.joints(sheet, value)?,
            "curve" => self.curves(sheet, value)?,
            _ => {
                return Err(self.error(
                    span,
                    format!("unknown table or key \"{name}\"; a sheet has {SECTIONS}"),
                ));
            }
        }
        Ok(())
    }

    fn fill(
        &self,
        keys: &[KeySpec],
        value: &Value<'_>,
        section: &mut dyn Section,
    ) -> Result<(), SheetError> {
        for (key, value) in self.table(value)? {
            let known = keys.iter().find(|known| known.key == key.get_ref());
            let (Some(known), Some(field)) = (known, section.value_mut(key.get_ref())) else {
                let section = keys.first().map_or("", |known| known.section);
                let all: Vec<&str> = keys.iter().map(|known| known.key).collect();
                return Err(self.error(
                    &key.span(),
                    format!(
                        "[{section}] has no key \"{}\"; its keys are {}",
                        key.get_ref(),
                        all.join(", ")
                    ),
                ));
            };
            *field = self.number(known.key, &known.range, known.unit, value)?;
        }
        Ok(())
    }

    fn joints(&self, sheet: &mut StyleSheet, value: &Value<'_>) -> Result<(), SheetError> {
        for (name, value) in self.table(value)? {
            let mut edit = JointEdit::default();
            self.fill(&JointEdit::keys("joints.NAME"), value, &mut edit)?;
            for (joint, is_mirrored) in self.joint(name.get_ref(), &name.span())? {
                let mut edit = edit.clone();
                if is_mirrored {
                    edit.yaw = -edit.yaw;
                    edit.roll = -edit.roll;
                }
                sheet.joints.push((joint, edit));
            }
        }
        Ok(())
    }

    fn curves(&self, sheet: &mut StyleSheet, value: &Value<'_>) -> Result<(), SheetError> {
        let Some(all) = value.get_ref().as_array() else {
            return Err(self.error(&value.span(), "write each curve as [[curve]]".to_owned()));
        };
        for entry in all {
            let table = self.table(entry)?;
            let (mut joints, mut axis, mut points) = (None, None, None);
            for (key, value) in table {
                match key.get_ref().as_ref() {
                    "joint" => {
                        joints = Some(self.joint(&self.string("joint", value)?, &value.span())?);
                    }
                    "axis" => axis = Some(self.axis(value)?),
                    "points" => points = Some(self.points(value)?),
                    other => {
                        return Err(self.error(
                            &key.span(),
                            format!(
                                "[[curve]] has no key \"{other}\"; its keys are joint, axis and points"
                            ),
                        ));
                    }
                }
            }
            let (Some(joints), Some(axis), Some((offset, amplitude))) = (joints, axis, points)
            else {
                return Err(self.error(
                    &entry.span(),
                    "[[curve]] needs joint, axis and points".to_owned(),
                ));
            };
            for (joint, is_mirrored) in joints {
                let sign = if is_mirrored && axis != Axis::Pitch {
                    -1.0
                } else {
                    1.0
                };
                sheet.curves.push(PhaseCurve {
                    joint,
                    axis,
                    offset: offset.scaled(sign),
                    amplitude: amplitude.clone(),
                });
            }
        }
        Ok(())
    }

    /// The joint of this name, or both of `Left…` and `Right…`; the second is to be mirrored.
    fn joint(&self, name: &str, span: &Range<usize>) -> Result<Vec<(Joint, bool)>, SheetError> {
        let found = match Joint::from_name(name) {
            Some(joint) => vec![(joint, false)],
            None => ["Left", "Right"]
                .iter()
                .filter_map(|side| Joint::from_name(&format!("{side}{name}")))
                .map(|joint| (joint, joint.name().starts_with("Right")))
                .collect(),
        };
        let is_leg = |joint: Joint| joint >= Joint::LeftUpperLeg;
        if found.iter().any(|(joint, _)| is_leg(*joint)) {
            return Err(self.error(
                span,
                format!("{name} follows from where the foot is; use [walk], [feet] and [pelvis]"),
            ));
        }
        if found.is_empty() {
            let names: Vec<&str> = Joint::ALL
                .into_iter()
                .filter(|joint| !is_leg(*joint))
                .map(Joint::name)
                .collect();
            return Err(self.error(
                span,
                format!(
                    "unknown joint \"{name}\"; joints are {} (without Left or Right: both)",
                    names.join(", ")
                ),
            ));
        }
        Ok(found)
    }

    fn axis(&self, value: &Value<'_>) -> Result<Axis, SheetError> {
        match self.string("axis", value)?.as_str() {
            "pitch" => Ok(Axis::Pitch),
            "yaw" => Ok(Axis::Yaw),
            "roll" => Ok(Axis::Roll),
            other => Err(self.error(
                &value.span(),
                format!("axis \"{other}\": write pitch, yaw or roll"),
            )),
        }
    }

    fn points(&self, value: &Value<'_>) -> Result<(PeriodicCurve, PeriodicCurve), SheetError> {
        let shape = || {
            self.error(
                &value.span(),
                "points are [[percent of the cycle, degrees], …], with a third number for the amplitude in percent \
                 if wanted; at least two points, in order"
                    .to_owned(),
            )
        };
        let mut offset: Vec<(f32, f32)> = Vec::new();
        let mut amplitude = Vec::new();
        for point in value.get_ref().as_array().ok_or_else(shape)? {
            let numbers: Vec<&Value<'_>> = match point.get_ref().as_array() {
                Some(numbers) if (2..=3).contains(&numbers.len()) => numbers.iter().collect(),
                _ => return Err(shape()),
            };
            let phase = self.number("phase", &CURVE_PHASE, "%", numbers[0])? / 100.0;
            if offset.last().is_some_and(|last| phase <= last.0) || phase >= 1.0 {
                return Err(shape());
            }
            offset.push((
                phase,
                self.number("offset", &CURVE_OFFSET, "degrees", numbers[1])?,
            ));
            let percent = match numbers.get(2) {
                Some(value) => self.number("amplitude", &CURVE_AMPLITUDE, "%", value)?,
                None => 100.0,
            };
            amplitude.push((phase, percent));
        }
        if offset.len() < 2 {
            return Err(shape());
        }
        Ok((PeriodicCurve::new(offset), PeriodicCurve::new(amplitude)))
    }

    fn table<'v, 'i>(&self, value: &'v Value<'i>) -> Result<&'v DeTable<'i>, SheetError> {
        value.get_ref().as_table().ok_or_else(|| {
            self.error(
                &value.span(),
                "a table is needed here, such as [walk]".to_owned(),
            )
        })
    }

    fn string(&self, key: &str, value: &Value<'_>) -> Result<String, SheetError> {
        let text = value.get_ref().as_str().map(str::to_owned);
        text.ok_or_else(|| self.error(&value.span(), format!("{key}: write text in quotes")))
    }

    fn number(
        &self,
        key: &str,
        range: &RangeInclusive<f32>,
        unit: &str,
        value: &Value<'_>,
    ) -> Result<f32, SheetError> {
        let digits = match value.get_ref() {
            DeValue::Integer(number) => number.as_str().replace('_', ""),
            DeValue::Float(number) => number.as_str().replace('_', ""),
            other => {
                return Err(self.error(
                    &value.span(),
                    format!("{key}: a number is needed, not a {}", other.type_str()),
                ));
            }
        };
        match digits.parse::<f32>() {
            Ok(number) if range.contains(&number) => Ok(number),
            _ => Err(self.error(
                &value.span(),
                format!(
                    "{key} = {digits} is out of range; it takes {} to {} {unit}",
                    range.start(),
                    range.end()
                ),
            )),
        }
    }
}
