//! The table of platforms.

use anyhow::Error;

/// A step of the way from sources to a game, in the order of the table's columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Column {
    Built,
    Linked,
    Symbols,
    Run,
}

const TITLES: [&str; 4] = ["built", "linked", "symbols checked", "run"];

/// Outcome of a step.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Finding {
    /// It went well, and what was seen.
    Done(String),
    /// It failed, and why.
    Failed(String),
    /// It was not tried here, and why.
    Open(String),
}

/// A platform's line.
#[derive(Debug)]
pub(super) struct Row {
    name: &'static str,
    promised: bool,
    at: Column,
    findings: [Finding; 4],
}

impl Row {
    pub(super) fn new(name: &'static str, promised: bool) -> Self {
        Self {
            name,
            promised,
            at: Column::Built,
            findings: [const { Finding::Open(String::new()) }; 4],
        }
    }

    pub(super) fn name(&self) -> &'static str {
        self.name
    }

    /// Goes on to a step; what fails from here on is entered there.
    pub(super) fn begin(&mut self, column: Column) {
        self.at = column;
    }

    /// Enters that the step went well.
    pub(super) fn done(&mut self, seen: &str) {
        self.findings[self.at as usize] = Finding::Done(seen.to_owned());
    }

    /// Enters that a step failed.
    pub(super) fn failed(&mut self, error: &Error) {
        // The first line says what; a program's output follows on others.
        let error = format!("{error:#}");
        let first = error.lines().next().unwrap_or_default();
        self.findings[self.at as usize] = Finding::Failed(first.to_owned());
    }

    /// Enters why a step cannot be tried here.
    pub(super) fn open(&mut self, column: Column, reason: &str) {
        self.findings[column as usize] = Finding::Open(reason.to_owned());
    }

    /// Returns whether users were promised what failed.
    pub(super) fn breaks_a_promise(&self) -> bool {
        let failed = |finding: &Finding| matches!(finding, Finding::Failed(_));
        self.promised && self.findings.iter().any(failed)
    }

    fn line(&self) -> String {
        let cells = self.findings.iter().map(|finding| match finding {
            Finding::Done(seen) => seen.clone(),
            Finding::Failed(reason) => format!("**fails**: {reason}"),
            Finding::Open(reason) if reason.is_empty() => "–".into(),
            Finding::Open(reason) => format!("not here: {reason}"),
        });
        // A bar would begin another cell.
        let cells: Vec<String> = cells.map(|cell| cell.replace('|', "/")).collect();
        format!("| {} | {} |\n", self.name, cells.join(" | "))
    }
}

/// The rows in Markdown.
pub(super) fn table(rows: &[Row]) -> String {
    let dashes = ["---"; TITLES.len() + 1].join(" | ");
    let mut table = format!("| platform | {} |\n| {dashes} |\n", TITLES.join(" | "));
    table.extend(rows.iter().map(Row::line));
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_stands_in_the_column_of_its_step_and_breaks_only_promises() {
        let mut row = Row::new("amiga", true);
        row.begin(Column::Built);
        row.done("yes");
        row.open(Column::Run, "no Amiga");
        assert!(!row.breaks_a_promise());
        row.begin(Column::Symbols);
        row.failed(&anyhow::anyhow!("no | here\nwith a log"));
        assert!(row.breaks_a_promise());
        assert_eq!(
            table(&[row]),
            "| platform | built | linked | symbols checked | run |\n| --- | --- | --- | --- | --- |\n\
             | amiga | yes | – | **fails**: no / here | not here: no Amiga |\n"
        );
        let mut row = Row::new("web", false);
        row.failed(&anyhow::anyhow!("no"));
        assert!(!row.breaks_a_promise());
    }
}
