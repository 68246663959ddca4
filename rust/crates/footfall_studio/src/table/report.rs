//! The JSON of `footfall evaluate` as tables.

use super::{Cell, Table};
use serde_json::{Map, Value};

/// Every table that a report holds, in the order of the report. Objects of objects of values are tables; a matrix `confusion` beside a
/// list `styles` is one; values that stand alone go together.
pub(crate) fn tables(report: &Value) -> Vec<Table> {
    let mut found = Vec::new();
    let labels = report["styles"].as_array().map(|labels| {
        let names = labels.iter().filter_map(Value::as_str);
        names.map(ToOwned::to_owned).collect::<Vec<_>>()
    });
    visit("", report, labels.as_deref(), &mut found);
    found
}

fn visit(path: &str, value: &Value, labels: Option<&[String]>, found: &mut Vec<Table>) {
    match value {
        Value::Object(members) => {
            if let Some(table) = rows_table(path, members) {
                found.push(table);
                return;
            }
            scalars(path, members, found);
            for (name, member) in members {
                let path = joined(path, name);
                if let Some(table) = confusion(&path, member, labels) {
                    found.push(table);
                } else if member.is_object() || member.is_array() {
                    visit(&path, member, labels, found);
                }
            }
        }
        Value::Array(items) if items.iter().all(|item| item["subject"].is_string()) => {
            let rows = items.iter().filter_map(|item| {
                let mut item = item.as_object()?.clone();
                let name = item.remove("subject")?;
                Some((name.as_str()?.to_owned(), Value::Object(item)))
            });
            found.extend(rows_table(path, &rows.collect()));
        }
        Value::Array(items) => {
            for (place, item) in items
                .iter()
                .enumerate()
                .filter(|(_, item)| item.is_object())
            {
                let sites = item["sites"].as_array().into_iter().flatten();
                let sites: Vec<&str> = sites.filter_map(Value::as_str).collect();
                let name = if sites.is_empty() {
                    (place + 1).to_string()
                } else {
                    sites.join(" and ")
                };
                visit(&joined(path, &name), item, labels, found);
            }
        }
        _ => {}
    }
}

/// Members that stand alone.
fn scalars(path: &str, members: &Map<String, Value>, found: &mut Vec<Table>) {
    let rows: Vec<(String, Vec<Cell>)> = members
        .iter()
        .filter(|(_, value)| value.is_number() || value.is_string())
        .map(|(name, value)| (words(name), vec![cell(value)]))
        .collect();
    if !rows.is_empty() {
        found.push(Table {
            title: if path.is_empty() { "summary" } else { path }.to_owned(),
            columns: vec!["value".to_owned()],
            rows,
            is_confusion: false,
        });
    }
}

/// An object all of whose members are objects, as rows; objects within those become columns by their paths.
fn rows_table(path: &str, members: &Map<String, Value>) -> Option<Table> {
    let is_table =
        !members.is_empty() && members.values().all(Value::is_object) && !path.is_empty();
    // An object of tables is no table itself.
    let is_deep = members.values().any(|member| {
        let inner = member.as_object();
        inner.is_some_and(|inner| inner.values().all(Value::is_object) && inner.len() > 4)
    });
    if !is_table || is_deep {
        return None;
    }
    let mut columns: Vec<String> = Vec::new();
    let mut rows = Vec::new();
    for (name, member) in members {
        let mut flat = Vec::new();
        flatten("", member, &mut flat);
        let mut cells = vec![Cell::Nothing; columns.len()];
        for (column, cell) in flat {
            if let Some(place) = columns.iter().position(|own| *own == column) {
                cells[place] = cell;
            } else {
                columns.push(column);
                cells.push(cell);
            }
        }
        rows.push((name.clone(), cells));
    }
    for (_, cells) in &mut rows {
        cells.resize(columns.len(), Cell::Nothing);
    }
    Some(Table {
        title: path.to_owned(),
        columns,
        rows,
        is_confusion: false,
    })
}

/// Values of an object and of the objects in it, but for those by joint, which would be a table of their own.
fn flatten(path: &str, value: &Value, out: &mut Vec<(String, Cell)>) {
    let Some(members) = value.as_object() else {
        return;
    };
    for (name, member) in members {
        let path = joined(path, name);
        if member.is_object() {
            if name != "joints" {
                flatten(&path, member, out);
            }
        } else if !member.is_array() {
            out.push((path, cell(member)));
        }
    }
}

fn confusion(path: &str, value: &Value, labels: Option<&[String]>) -> Option<Table> {
    let (labels, rows) = (labels?, value.as_array()?);
    if rows.len() != labels.len() || !rows.iter().all(Value::is_array) {
        return None;
    }
    Some(Table {
        title: path.to_owned(),
        columns: labels.to_vec(),
        rows: labels
            .iter()
            .zip(rows)
            .map(|(label, row)| {
                let cells = row.as_array().into_iter().flatten().map(cell);
                (label.clone(), cells.collect())
            })
            .collect(),
        is_confusion: true,
    })
}

fn cell(value: &Value) -> Cell {
    match value {
        Value::Number(number) => number.as_f64().map_or(Cell::Nothing, Cell::Number),
        Value::String(text) => Cell::Text(text.clone()),
        Value::Bool(is) => Cell::Text(if *is { "yes" } else { "no" }.to_owned()),
        _ => Cell::Nothing,
    }
}

fn joined(path: &str, name: &str) -> String {
    if path.is_empty() {
        words(name)
    } else {
        format!("{path}, {}", words(name))
    }
}

fn words(name: &str) -> String {
    name.replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn categories_of_figures_are_rows_and_columns() {
        let report = json!({
            "tolerance_ms": 33.4,
            "categories": {"walk": {"f1": 0.97, "bias_ms": -2.0}, "run": {"f1": 1.0, "bias_ms": null}},
            "sensors": {}
        });
        let tables = tables(&report);
        assert_eq!(tables.len(), 2, "{tables:?}");
        assert_eq!(tables[0].rows[0].1, [Cell::Number(33.4)]);
        let categories = &tables[1];
        assert_eq!(categories.columns.len(), 2);
        let run = &categories
            .rows
            .iter()
            .find(|(name, _)| name == "run")
            .unwrap()
            .1;
        assert!(run.contains(&Cell::Nothing) && run.contains(&Cell::Number(1.0)));
    }

    #[test]
    fn a_confusion_has_the_styles_on_both_sides() {
        let report =
            json!({"styles": ["sad", "old"], "real": {"rate": 0.9, "confusion": [[9, 1], [0, 7]]}});
        let tables = tables(&report);
        let confusion = tables.iter().find(|table| table.is_confusion).unwrap();
        assert_eq!(confusion.columns, ["sad", "old"]);
        assert_eq!(confusion.rows[1].1[1], Cell::Number(7.0));
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
