//! Style sheets: what is read, and what is refused and where.

use core::fmt::Write as _;
use footfall_design::{StyleSheet, shipped};

fn error(text: &str) -> (usize, String) {
    let error = StyleSheet::parse(text).expect_err("the sheet is wrong");
    (error.line, error.to_string())
}

#[test]
fn mistakes_are_named_with_their_line() {
    for (text, line, parts) in [
        (
            "name = \"x\"\n\n[walk]\nstrid = 3\n",
            4,
            ["strid", "stride"],
        ),
        (
            "[walk]\nstride = 100\ncadence = 900\n",
            3,
            ["900", "40 to 170"],
        ),
        ("[walk]\nstride = nan\n", 2, ["nan", "30 to 150"]),
        ("[walk]\nstride = 1e40\n", 2, ["1e40", "range"]),
        ("[walk]\nstride = \"long\"\n", 2, ["stride", "number"]),
        ("\n[legs]\nlift = 3\n", 2, ["legs", "[feet]"]),
        ("walk = 3\n", 1, ["table", "[walk]"]),
        ("[walk\nstride = 3\n", 1, ["line 1", ""]),
        ("[joints.Tail]\npitch = 3\n", 1, ["Tail", "UpperArm"]),
        ("[joints.LeftFoot]\npitch = 3\n", 1, ["LeftFoot", "[feet]"]),
        ("[joints.Chest]\n\nbend = 3\n", 3, ["bend", "pitch"]),
        (
            "[[curve]]\njoint = \"Chest\"\naxis = \"up\"\npoints = [[0, 1], [50, 2]]\n",
            3,
            ["up", "yaw"],
        ),
        (
            "[[curve]]\njoint = \"Chest\"\naxis = \"yaw\"\npoints = [[50, 1], [0, 2]]\n",
            4,
            ["points", "order"],
        ),
        (
            "[[curve]]\njoint = \"Chest\"\naxis = \"yaw\"\npoints = [[0, 1]]\n",
            4,
            ["points", "two"],
        ),
        (
            "[[curve]]\njoint = \"Chest\"\naxis = \"yaw\"\n",
            1,
            ["points", "axis"],
        ),
        ("curve = 3\n", 1, ["[[curve]]", "curve"]),
    ] {
        let (found, message) = error(text);
        assert_eq!(found, line, "{message}");
        for part in parts {
            assert!(message.contains(part), "{message} says nothing of {part}");
        }
    }
}

#[test]
fn shipped_sheets_are_read_and_change_something() {
    for (name, text) in shipped::SHEETS {
        let sheet = StyleSheet::parse(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(sheet.name, name);
        assert!(!sheet.summary.is_empty());
        assert_eq!(sheet.is_neutral(), name == "template", "{name}");
    }
    assert!(shipped::text("sad").is_some() && shipped::text("glad").is_none());
}

#[test]
fn every_key_has_a_neutral_value_in_its_range() {
    let mut text = String::new();
    let mut section = "";
    for spec in StyleSheet::keys() {
        assert!(
            spec.range.contains(&spec.neutral),
            "{} {}",
            spec.section,
            spec.key
        );
        let header = spec.section.replace("NAME", "Head");
        if section != spec.section {
            section = spec.section;
            writeln!(text, "[{header}]").unwrap();
        }
        writeln!(text, "{} = {:?}", spec.key, spec.range.end()).unwrap();
    }
    let sheet = StyleSheet::parse(&text).unwrap();
    assert!((sheet.sides[1].drop - 10.0).abs() < 1e-6 && sheet.joints.len() == 1);
}
