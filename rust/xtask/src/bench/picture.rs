//! The table of one machine as a picture (SVG): a bar for each line, as long as the factor between the measurement and what stands beside it.

use super::machine::Machine;
use super::table::{LINES, Reading};

/// Sizes in pixels: the picture's width, the heights of its head, a row and a bar; then the ends of the longest bars, and the beginning of all.
const WIDTH: f64 = 1100.0;
const HEAD: f64 = 74.0;
const ROW: f64 = 34.0;
const BAR: f64 = 18.0;
const LEFT: f64 = 500.0;
const EVEN: f64 = 600.0;
const RIGHT: f64 = 800.0;
/// Factor at the right end.
const MOST: f64 = 100.0;
/// Colours of a bar that is better than its reference, and of one that is not.
const BETTER: &str = "#2f7d5b";
const WORSE: &str = "#c0662b";

/// The picture. Lines without a measurement are left out.
pub(super) fn svg(machine: &Machine) -> String {
    let readings: Vec<(&str, Reading)> = LINES
        .iter()
        .filter_map(|line| Some((line.title(), line.reading(machine)?)))
        .collect();
    let height = HEAD + ROW * readings.len() as f64 + 12.0;
    let head = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#fff\"/>\n\
         <text x=\"16\" y=\"26\" font-size=\"15\" font-weight=\"bold\">{}</text>\n\
         <text x=\"16\" y=\"46\" fill=\"#666\">Bars to the right: times faster than the reference (logarithmic). Bars to the left: slower.</text>\n",
        escaped(&machine.title())
    );
    let marks = [(1.0, "1"), (10.0, "10"), (MOST, "100 times")];
    let marks = marks.map(|(factor, label)| {
        format!(
            "<path d=\"M{x:.1} {HEAD}V{:.1}\" stroke=\"#ccc\"/><text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#666\">{label}</text>\n",
            height - 12.0,
            HEAD - 6.0,
            x = place(factor),
        )
    });
    let rows = readings.iter().enumerate();
    let rows = rows.map(|(index, (title, reading))| row(index, title, reading));
    head + &marks.concat() + &rows.collect::<String>() + "</svg>\n"
}

/// One line of the table: its title, its bar and its figures.
fn row(index: usize, title: &str, reading: &Reading) -> String {
    let top = HEAD + ROW * index as f64 + 0.5 * (ROW - BAR);
    let end = place(reading.factor());
    let colour = if reading.factor() >= 1.0 {
        BETTER
    } else {
        WORSE
    };
    format!(
        "<text x=\"16\" y=\"{text:.1}\">{}</text>\
         <rect x=\"{:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{BAR}\" fill=\"{colour}\"/>\
         <text x=\"{:.1}\" y=\"{text:.1}\">{}</text>\n",
        escaped(title),
        end.min(EVEN),
        (end - EVEN).abs().max(1.0),
        RIGHT + 12.0,
        escaped(&reading.short()),
        text = top + 0.5 * BAR + 4.0,
    )
}

/// Place of a factor across the picture; beyond the ends at the ends.
fn place(factor: f64) -> f64 {
    let decades = factor.max(1e-9).log10();
    (EVEN + decades * (RIGHT - EVEN) / MOST.log10()).clamp(LEFT, RIGHT)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn machine() -> Machine {
        let kernels = json!({"mlpg_f64_us_per_frame": 0.25, "jbonsai_us_per_frame": 2.5, "walker_us_per_frame": 50.0});
        let mut machine = Machine::here(kernels, json!({"skeleton_us_per_walker": 2.5}));
        machine.processor = "Test <CPU> & more".to_owned();
        machine.threads = 2;
        machine
    }

    #[test]
    fn a_bar_is_as_long_as_its_factor() {
        assert!((place(1.0) - EVEN).abs() < 1e-9);
        assert!((place(10.0) - 0.5 * (EVEN + RIGHT)).abs() < 1e-9);
        assert!((place(1e6) - RIGHT).abs() < 1e-9);
        assert!((place(0.0) - LEFT).abs() < 1e-9);
        let svg = svg(&machine());
        let better = format!("width=\"100.0\" height=\"{BAR}\" fill=\"{BETTER}\"");
        let worse = format!("width=\"100.0\" height=\"{BAR}\" fill=\"{WORSE}\"");
        assert!(svg.contains(&better) && svg.contains(&worse), "{svg}");
    }

    #[test]
    fn the_picture_is_a_document_with_every_measured_line() {
        let svg = svg(&machine());
        let document = roxmltree::Document::parse(&svg).expect("well-formed");
        let texts: Vec<&str> = document
            .descendants()
            .filter_map(|node| node.text())
            .collect();
        assert!(texts.contains(&"Test <CPU> & more, 2 threads"), "{texts:?}");
        for line in LINES
            .iter()
            .filter(|line| line.reading(&machine()).is_some())
        {
            assert!(texts.contains(&line.title()));
        }
        assert!(texts.contains(&"0.250 µs; jbonsai 2.50 µs"), "{texts:?}");
        assert!(texts.contains(&"2.50 µs; goal 2.50 µs"), "{texts:?}");
    }
}
