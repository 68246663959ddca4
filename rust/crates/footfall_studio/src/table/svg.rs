//! A table as a picture.

use super::Table;
use plotters::prelude::*;

const WIDTH: u32 = 960;
const HEIGHT: u32 = 540;

impl Table {
    /// Bars of the chosen columns, or the shaded matrix of a confusion, as an SVG file.
    pub(crate) fn to_svg(&self, columns: &[usize]) -> Result<String, String> {
        let mut svg = String::new();
        let drawn = if self.is_confusion {
            self.draw_matrix(&mut svg)
        } else {
            self.draw_bars(&mut svg, columns)
        };
        drawn.map_err(|error| error.to_string())?;
        Ok(svg)
    }

    fn draw_bars(
        &self,
        svg: &mut String,
        columns: &[usize],
    ) -> Result<(), Box<dyn core::error::Error>> {
        let area = SVGBackend::with_string(svg, (WIDTH, HEIGHT)).into_drawing_area();
        area.fill(&WHITE)?;
        let values = || columns.iter().flat_map(|column| self.numbers(*column));
        let highest = values().map(|(_, value)| value).fold(0.0, f64::max);
        let lowest = values().map(|(_, value)| value).fold(0.0, f64::min);
        let room = 0.08 * (highest - lowest).max(1e-9);
        let rows = self.rows.len() as f64;
        let mut chart = ChartBuilder::on(&area)
            .caption(&self.title, ("sans-serif", 18))
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(56)
            .build_cartesian_2d(
                -0.6..rows - 0.4,
                lowest - room * f64::from(u8::from(lowest < 0.0))..highest + room,
            )?;
        let name = |at: &f64| {
            let is_row = (at - at.round()).abs() < 1e-6 && *at >= 0.0;
            let row = self.rows.get(at.round() as usize).filter(|_| is_row);
            row.map_or_else(String::new, |(name, _)| name.clone())
        };
        chart
            .configure_mesh()
            .disable_x_mesh()
            .x_labels(2 * self.rows.len() + 1)
            .x_label_formatter(&name)
            .draw()?;
        let width = 0.8 / columns.len().max(1) as f64;
        for (place, column) in columns.iter().enumerate() {
            let [r, g, b, _] =
                crate::palette::SERIES[place % crate::palette::SERIES.len()].to_array();
            let color = RGBColor(r, g, b);
            let left = -0.4 + place as f64 * width;
            let bars = self.numbers(*column).map(|(row, value)| {
                let from = row as f64 + left;
                let corners = [(from, 0.0), (from + 0.95 * width, value)];
                Rectangle::new(corners, color.filled())
            });
            chart
                .draw_series(bars)?
                .label(&self.columns[*column])
                .legend(move |(x, y)| {
                    Rectangle::new([(x, y - 5), (x + 12, y + 5)], color.filled())
                });
        }
        chart
            .configure_series_labels()
            .background_style(WHITE.mix(0.8))
            .draw()?;
        area.present()?;
        Ok(())
    }

    fn draw_matrix(&self, svg: &mut String) -> Result<(), Box<dyn core::error::Error>> {
        const CELL: i32 = 44;
        const MARGIN: i32 = 130;
        let at = |place: usize| MARGIN + CELL * i32::try_from(place).unwrap_or(0);
        let side = (at(self.rows.len()) + 20) as u32;
        let area = SVGBackend::with_string(svg, (side, side)).into_drawing_area();
        area.fill(&WHITE)?;
        let font = ("sans-serif", 13).into_font();
        area.draw(&Text::new(self.title.clone(), (10, 8), ("sans-serif", 16)))?;
        for (row, (name, cells)) in self.rows.iter().enumerate() {
            let top = at(row);
            area.draw(&Text::new(name.clone(), (10, top + 15), font.clone()))?;
            let above = font.clone().transform(FontTransform::Rotate270);
            area.draw(&Text::new(name.clone(), (top + 15, MARGIN - 8), above))?;
            let total: f64 = cells.iter().filter_map(super::Cell::number).sum();
            for (column, cell) in cells.iter().enumerate() {
                let value = cell.number().unwrap_or(0.0);
                let left = at(column);
                let share = value / total.max(1e-9);
                let corners = [(left, top), (left + CELL - 2, top + CELL - 2)];
                area.draw(&Rectangle::new(
                    corners,
                    RGBColor(20, 130, 200).mix(0.05 + 0.9 * share).filled(),
                ))?;
                area.draw(&Text::new(cell.text(), (left + 8, top + 15), font.clone()))?;
            }
        }
        area.present()?;
        Ok(())
    }
}
