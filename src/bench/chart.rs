//! Draws panels of points with error bars as SVG. Knows nothing of experiments.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Points over a few ticks, for some series.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Panel {
    /// What stands above it.
    pub(super) title: String,
    /// What the ticks are.
    pub(super) x_title: String,
    /// What the values are.
    pub(super) y_title: String,
    /// The names of the ticks.
    pub(super) ticks: Vec<String>,
    /// The series, the same in all panels of a chart.
    pub(super) series: Vec<Series>,
    /// A value to be marked by a line.
    pub(super) line: Option<f64>,
}

/// One colour's points.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Series {
    /// What it is called in the legend.
    pub(super) name: String,
    /// A point a tick, where there is one.
    pub(super) points: Vec<Option<Point>>,
}

/// A value between two others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    /// Where the mark is.
    pub(super) value: f64,
    /// Where the bar begins.
    pub(super) low: f64,
    /// Where the bar ends.
    pub(super) high: f64,
}

/// A chart that could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the chart cannot be drawn: {0}")]
pub struct ChartError(String);

/// Okabe and Ito's colours, which the colour-blind tell apart, without yellow,
/// which white paper swallows.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(86, 180, 233),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(60, 60, 60),
];

const INK: RGBColor = RGBColor(51, 51, 51);
const FONT: &str = "sans-serif";

/// The sizes of a chart, in pixels.
const PANEL: (u32, u32) = (360, 270);
const MOST_COLUMNS: usize = 3;
const LEGEND_ROW: u16 = 22;
const LEGEND_COLUMN: u16 = 200;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// The panels in rows, below a legend.
///
/// # Errors
///
/// If the drawing library refuses.
pub(super) fn svg(panels: &[Panel]) -> Result<String, ChartError> {
    let columns = panels.len().clamp(1, MOST_COLUMNS);
    let rows = panels.len().div_ceil(columns);
    let names: Vec<&str> = panels
        .first()
        .map(|panel| {
            panel
                .series
                .iter()
                .map(|series| series.name.as_str())
                .collect()
        })
        .unwrap_or_default();
    let width = PANEL.0 * columns as u32;
    let per_row = (width as usize / usize::from(LEGEND_COLUMN)).max(1);
    let legend = u32::from(LEGEND_ROW) * names.len().div_ceil(per_row) as u32 + 10;
    let size = (width, legend + PANEL.1 * rows as u32);
    let mut text = String::new();
    draw(
        &mut text,
        size,
        legend,
        per_row,
        (rows, columns),
        panels,
        &names,
    )
    .map_err(|error| ChartError(error.to_string()))?;
    Ok(text)
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(
    text: &mut String,
    size: (u32, u32),
    legend: u32,
    per_row: usize,
    grid: (usize, usize),
    panels: &[Panel],
    names: &[&str],
) -> Drawn {
    let root = SVGBackend::with_string(text, size).into_drawing_area();
    root.fill(&WHITE)?;
    let (top, rest) = root.split_vertically(legend);
    let style = (FONT, 14).into_font().color(&INK);
    let (row, column) = (i32::from(LEGEND_ROW), i32::from(LEGEND_COLUMN));
    let lines = names.chunks(per_row).zip(0..);
    let places =
        lines.flat_map(|(line, y)| line.iter().zip(0..).map(move |(name, x)| (name, x, y)));
    for (place, (name, x, y)) in places.enumerate() {
        let (x, y) = (16 + x * column, 8 + row / 2 + y * row);
        mark(&top, place, (x, y))?;
        let anchor = style.pos(Pos::new(HPos::Left, VPos::Center));
        top.draw(&Text::new((*name).to_owned(), (x + 12, y), anchor))?;
    }
    for (area, panel) in rest.split_evenly(grid).iter().zip(panels) {
        draw_panel(area, panel)?;
    }
    root.present()?;
    Ok(())
}

/// A series' mark: shape and colour both tell it.
fn mark(area: &Area<'_>, series: usize, at: (i32, i32)) -> Drawn {
    let colour = COLOURS[series % COLOURS.len()];
    match series % 4 {
        0 => area.draw(&Circle::new(at, 4, colour.filled()))?,
        1 => area.draw(&Circle::new(at, 4, colour.stroke_width(2)))?,
        2 => area.draw(&TriangleMarker::new(at, 5, colour.filled()))?,
        _ => {
            let corners = [(at.0 - 4, at.1 - 4), (at.0 + 4, at.1 + 4)];
            area.draw(&Rectangle::new(corners, colour.filled()))?;
        }
    }
    Ok(())
}

fn draw_panel(area: &Area<'_>, panel: &Panel) -> Drawn {
    let points = || {
        panel
            .series
            .iter()
            .flat_map(|series| series.points.iter().flatten())
    };
    let highest = points()
        .map(|point| point.high)
        .chain(panel.line)
        .fold(0.0, f64::max);
    let top = if highest > 0.0 { 1.06 * highest } else { 1.0 };
    let digits = usize::from(top < 5.0);
    let last = panel.ticks.len().max(1) as f64 - 0.5;
    let title = (FONT, 15).into_font().color(&INK);
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, title)
        .margin(6)
        .margin_right(12)
        .x_label_area_size(42)
        .y_label_area_size(52)
        .build_cartesian_2d(-0.5..last, 0.0..top)?;
    let small = (FONT, 12).into_font().color(&INK);
    chart
        .configure_mesh()
        .disable_x_mesh()
        .x_labels(0)
        .y_labels(6)
        .y_label_formatter(&|value| format!("{value:.digits$}"))
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225))
        .axis_style(RGBColor(140, 140, 140))
        .label_style(small.clone())
        .x_desc(&panel.x_title)
        .y_desc(&panel.y_title)
        .axis_desc_style(small.clone())
        .draw()?;
    if let Some(value) = panel.line {
        let ends = [(-0.5, value), (last, value)];
        chart.draw_series(LineSeries::new(ends, INK.stroke_width(1)))?;
    }
    let plane = chart.plotting_area();
    let pixels = plane.strip_coord_spec();
    let (left, upper) = pixels.get_base_pixel();
    // Where a point is, in pixels of the plotting area alone.
    let at = |x: f64, y: f64| {
        let (x, y) = plane.map_coordinate(&(x, y));
        (x - left, y - upper)
    };
    let anchor = small.pos(Pos::new(HPos::Center, VPos::Top));
    for (tick, name) in panel.ticks.iter().enumerate() {
        let (x, y) = at(tick as f64, 0.0);
        pixels.draw(&Text::new(name.clone(), (x, y + 14), anchor.clone()))?;
    }
    // Side by side, so that bars do not hide each other.
    let step = 0.7 / panel.series.len().max(1) as f64;
    for (place, series) in panel.series.iter().enumerate() {
        let colour = COLOURS[place % COLOURS.len()];
        let aside = step * (place as f64 - (panel.series.len() as f64 - 1.0) / 2.0);
        for (tick, point) in series.points.iter().enumerate() {
            let Some(point) = point else { continue };
            let x = tick as f64 + aside;
            let bar = [at(x, point.low.max(0.0)), at(x, point.high)];
            pixels.draw(&PathElement::new(bar.to_vec(), colour.stroke_width(2)))?;
            mark(&pixels, place, at(x, point.value))?;
        }
    }
    Ok(())
}
