//! Tables of numbers, and what can be made of them: a grid, a chart, CSV and SVG.

mod show;
mod svg;
pub(crate) mod tables;

/// A table with a name for each row.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Table {
    pub(crate) title: String,
    pub(crate) columns: Vec<String>,
    pub(crate) rows: Vec<(String, Vec<Cell>)>,
    /// Rows and columns are the same things: counts of one taken for the other.
    pub(crate) is_confusion: bool,
}

/// A value of a table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cell {
    Number(f64),
    Text(String),
    /// Value that could not be measured.
    Nothing,
}

/// Name of a column, and the value in it of what a row is about.
pub(crate) type Column<T> = (&'static str, fn(&T) -> Cell);

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::Number(count as f64)
    }
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Nothing, Into::into)
    }
}

impl Cell {
    pub(crate) fn text(&self) -> String {
        match self {
            Self::Number(number) if number.fract() == 0.0 && number.abs() < 1e9 => {
                format!("{number:.0}")
            }
            Self::Number(number) if number.abs() >= 100.0 => format!("{number:.1}"),
            Self::Number(number) if number.abs() >= 0.1 => format!("{number:.3}"),
            Self::Number(number) => format!("{number:.2e}"),
            Self::Text(text) => text.clone(),
            Self::Nothing => "–".to_owned(),
        }
    }

    pub(crate) const fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }
}

impl Table {
    /// Things with their names, a row each. Columns without a value in any row are left out.
    pub(crate) fn of<'a, T: 'a>(
        title: &str,
        things: impl IntoIterator<Item = (impl ToString, &'a T)>,
        columns: &[Column<T>],
    ) -> Self {
        let rows: Vec<(String, &T)> = things
            .into_iter()
            .map(|(name, thing)| (name.to_string(), thing))
            .collect();
        let is_known = |(_, value): &&Column<T>| {
            let mut cells = rows.iter().map(|(_, thing)| value(thing));
            cells.any(|cell| cell != Cell::Nothing)
        };
        let columns: Vec<&Column<T>> = columns.iter().filter(is_known).collect();
        let cells = |thing: &T| columns.iter().map(|(_, value)| value(thing)).collect();
        Self {
            title: title.to_owned(),
            columns: columns.iter().map(|(name, _)| (*name).to_owned()).collect(),
            rows: rows
                .into_iter()
                .map(|(name, thing)| (name, cells(thing)))
                .collect(),
            is_confusion: false,
        }
    }

    /// Values that stand alone, a row each; unknown ones are left out.
    pub(crate) fn values<const N: usize>(title: &str, values: [(&str, Cell); N]) -> Self {
        let known = values
            .into_iter()
            .filter(|(_, cell)| *cell != Cell::Nothing);
        Self {
            title: title.to_owned(),
            columns: vec!["value".to_owned()],
            rows: known
                .map(|(name, cell)| (name.to_owned(), vec![cell]))
                .collect(),
            is_confusion: false,
        }
    }

    /// Counts or shares of things taken for each other: a row for each true name, the columns in the same order.
    pub(crate) fn confusion(
        title: &str,
        names: &[impl ToString],
        rows: impl IntoIterator<Item = Vec<Cell>>,
    ) -> Self {
        let names: Vec<String> = names.iter().map(ToString::to_string).collect();
        Self {
            title: title.to_owned(),
            columns: names.clone(),
            rows: names.into_iter().zip(rows).collect(),
            is_confusion: true,
        }
    }

    /// The values of a column that are numbers, with the places of their rows.
    pub(crate) fn numbers(&self, column: usize) -> impl Iterator<Item = (usize, f64)> {
        let rows = self.rows.iter().enumerate();
        rows.filter_map(move |(row, (_, cells))| Some((row, cells.get(column)?.number()?)))
    }

    /// Columns with a number in them.
    pub(crate) fn numeric_columns(&self) -> Vec<usize> {
        (0..self.columns.len())
            .filter(|column| self.numbers(*column).next().is_some())
            .collect()
    }

    /// The table as a CSV file; numbers in full.
    pub(crate) fn to_csv(&self) -> Result<Vec<u8>, String> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let problem = |error: csv::Error| error.to_string();
        let head = [self.title.as_str()].into_iter();
        writer
            .write_record(head.chain(self.columns.iter().map(String::as_str)))
            .map_err(problem)?;
        for (name, cells) in &self.rows {
            let cells = cells.iter().map(|cell| match cell {
                Cell::Number(number) => number.to_string(),
                Cell::Text(text) => text.clone(),
                Cell::Nothing => String::new(),
            });
            let mut record: Vec<String> = [name.clone()].into_iter().chain(cells).collect();
            record.resize(self.columns.len() + 1, String::new());
            writer.write_record(record).map_err(problem)?;
        }
        writer.into_inner().map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_nobody_has_a_value_for_are_left_out() {
        let things = [("walk", &(0.97, Some(2.0))), ("run", &(1.0, None))];
        let columns: [Column<(f64, Option<f64>)>; 3] = [
            ("F1", |own| own.0.into()),
            ("bias", |own| own.1.into()),
            ("delay", |_| Cell::Nothing),
        ];
        let table = Table::of("categories", things, &columns);
        assert_eq!(table.columns, ["F1", "bias"]);
        assert_eq!(
            table.rows[1],
            ("run".to_owned(), vec![Cell::Number(1.0), Cell::Nothing])
        );
    }

    #[test]
    fn a_table_is_written_as_csv_with_its_names() {
        let table = Table {
            title: "F1".to_owned(),
            columns: vec!["a, b".to_owned()],
            rows: vec![("walk".to_owned(), vec![Cell::Number(0.5)])],
            is_confusion: false,
        };
        let text = String::from_utf8(table.to_csv().unwrap()).unwrap();
        assert_eq!(text, "F1,\"a, b\"\nwalk,0.5\n");
    }
}
