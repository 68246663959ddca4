//! The index, and conditions on its columns.

use super::CorpusError;
use crate::index_row::IndexRow;
use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Columns that every index has.
const REQUIRED: [&str; 4] = ["path", "category", "style", "subject"];

/// A condition on one column, written `column=value`, or `column!=value` for what must not be; `*` in the value stands for any run of
/// characters.
///
/// ```
/// use footfall_motion::corpus::Where;
/// let condition: Where = "path=cmu/*".parse()?;
/// assert!(condition.matches("cmu/walk_01.bvh") && !condition.matches("other/cmu"));
/// # Ok::<(), footfall_motion::corpus::CorpusError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Where {
    /// Name of the column.
    pub column: String,
    /// Pattern of its value.
    pub pattern: String,
    /// True when it must not be so instead.
    pub negated: bool,
}

impl FromStr for Where {
    type Err = CorpusError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.split_once('=') {
            Some((column, pattern)) if !column.trim_end_matches('!').trim().is_empty() => {
                Ok(Self {
                    column: column.trim_end_matches('!').trim().to_owned(),
                    pattern: pattern.trim().to_owned(),
                    negated: column.ends_with('!'),
                })
            }
            _ => Err(CorpusError::Condition(text.to_owned())),
        }
    }
}

impl fmt::Display for Where {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is = if self.negated { "!=" } else { "=" };
        write!(f, "{}{is}{}", self.column, self.pattern)
    }
}

impl Where {
    /// Returns true when a value of the column meets the condition.
    pub fn matches(&self, value: &str) -> bool {
        self.fits(value) != self.negated
    }

    fn fits(&self, value: &str) -> bool {
        let mut parts = self.pattern.split('*');
        let first = parts.next().unwrap_or_default();
        let Some(mut rest) = value.strip_prefix(first) else {
            return false;
        };
        let Some(last) = parts.next_back() else {
            return rest.is_empty();
        };
        for part in parts {
            match rest.find(part) {
                Some(at) => rest = &rest[at + part.len()..],
                None => return false,
            }
        }
        rest.ends_with(last)
    }
}

/// Reads the rows of an index: a CSV file with at least the columns path, category, style and subject.
///
/// # Errors
/// [`CorpusError`] names file, line and column.
pub fn read_index(index: &Path) -> Result<Vec<IndexRow>, CorpusError> {
    let csv_error = |source| CorpusError::Csv {
        index: index.to_owned(),
        source,
    };
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_path(index)
        .map_err(csv_error)?;
    let names: Vec<String> = reader
        .headers()
        .map_err(csv_error)?
        .iter()
        // Spreadsheets put a byte-order mark in front.
        .map(|name| name.trim_start_matches('\u{feff}').to_owned())
        .collect();
    for column in REQUIRED {
        if !names.iter().any(|name| name == column) {
            return Err(missing_column(index, column, names));
        }
    }
    let folder = index.parent().unwrap_or(Path::new(""));
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(csv_error)?;
        let line = record.position().map_or(0, csv::Position::line);
        let columns: Vec<(String, String)> = names
            .iter()
            .cloned()
            .zip(record.iter().map(str::to_owned))
            .collect();
        let mut row = IndexRow {
            line,
            path: PathBuf::new(),
            columns,
        };
        if let Some(column) = REQUIRED
            .into_iter()
            .find(|column| row.column(column).is_none_or(str::is_empty))
        {
            return Err(CorpusError::EmptyField {
                index: index.to_owned(),
                line,
                column: column.to_owned(),
            });
        }
        row.path = folder.join(row.column("path").unwrap_or_default());
        rows.push(row);
    }
    Ok(rows)
}

fn missing_column(index: &Path, column: &str, columns: Vec<String>) -> CorpusError {
    CorpusError::MissingColumn {
        index: index.to_owned(),
        column: column.to_owned(),
        columns,
    }
}

/// The rows that meet all conditions.
pub(super) fn select(
    index: &Path,
    mut rows: Vec<IndexRow>,
    conditions: &[Where],
) -> Result<Vec<IndexRow>, CorpusError> {
    const MOST_VALUES: usize = 30;
    let nothing = |column: &str, mut values: Vec<String>| {
        if values.len() > MOST_VALUES {
            let more = values.len() - MOST_VALUES;
            values.truncate(MOST_VALUES);
            values.push(format!("and {more} more"));
        }
        let all: Vec<String> = conditions.iter().map(Where::to_string).collect();
        CorpusError::NothingSelected {
            index: index.to_owned(),
            conditions: if all.is_empty() {
                "anything".to_owned()
            } else {
                all.join(" and ")
            },
            column: column.to_owned(),
            values: if values.is_empty() {
                vec!["no values".to_owned()]
            } else {
                values
            },
        }
    };
    if rows.is_empty() {
        return Err(nothing("path", Vec::new()));
    }
    for condition in conditions {
        if rows[0].column(&condition.column).is_none() {
            let columns = rows[0].columns.iter().map(|(name, _)| name.clone());
            return Err(missing_column(index, &condition.column, columns.collect()));
        }
        let values: BTreeSet<String> = rows
            .iter()
            .filter_map(|row| row.column(&condition.column).map(str::to_owned))
            .collect();
        rows.retain(|row| {
            row.column(&condition.column)
                .is_some_and(|value| condition.matches(value))
        });
        if rows.is_empty() {
            return Err(nothing(&condition.column, values.into_iter().collect()));
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_stand_for_any_run() {
        let matches = |pattern: &str, value: &str| {
            let condition: Where = format!("a={pattern}").parse().unwrap();
            condition.matches(value)
        };
        assert!(matches("walk", "walk") && !matches("walk", "walks"));
        assert!(matches("*", "") && matches("*", "x"));
        assert!(matches("a*c", "abc") && matches("a*c", "ac") && !matches("a*c", "ab"));
        assert!(matches("a*b*c", "a-b-b-c") && !matches("a*b*c", "a-c"));
        assert!(!matches("ab*ba", "aba"), "the ends may not overlap");
        let negated: Where = "a!=b*".parse().unwrap();
        assert!(negated.matches("a") && !negated.matches("bc"));
        assert_eq!(negated.to_string(), "a!=b*");
        assert!("!=x".parse::<Where>().is_err());
        assert!("walk".parse::<Where>().is_err() && "=x".parse::<Where>().is_err());
    }
}
