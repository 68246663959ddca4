//! Tables of numbers from a report, and what can be made of them: a grid, a chart, CSV and SVG.

mod report;
mod show;
mod svg;

pub(crate) use report::tables;

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
