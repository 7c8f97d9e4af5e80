//! A sweep as a picture: an output at the end over the first number that was varied.

use std::fmt::Write as _;

use triad_plot::{Axis, PlotFrame, Style, escaped};

use super::Sweep;

/// Width and height of the picture, px.
const SIZE: (f64, f64) = (720.0, 400.0);
/// Left, right, top and bottom margin, px.
const MARGINS: [f64; 4] = [84.0, 24.0, 34.0, 46.0];
/// Radius of a mark, px.
const MARK: f64 = 2.5;

/// The output of that column over the first varied number as SVG; runs that failed are left out. None if no run has a value to be drawn.
pub fn svg(sweep: &Sweep, column: usize) -> Option<String> {
    let reached = sweep.runs.iter().enumerate().filter_map(|(index, run)| {
        let x = run.values.first().copied().unwrap_or(index as f64);
        Some((x, *run.result.as_ref().ok()?.outputs.get(column)?))
    });
    let points: Vec<(f64, f64)> = reached.filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    if points.is_empty() {
        return None;
    }
    let frame = PlotFrame {
        size: SIZE,
        margins: MARGINS,
        x: Axis::linear(points.iter().map(|point| point.0)),
        y: Axis::linear(points.iter().map(|point| point.1)),
        grid: "#ddd",
    };
    let ((width, height), [left, right, _, _]) = (SIZE, MARGINS);
    let of = sweep.columns.get(column).map_or_else(String::new, |c| format!("{}, {}", c.name, c.unit));
    let shared = sweep.shared.get(column).is_some_and(|shared| *shared);
    let of = if shared { format!("{of} (may not be unique)") } else { of };
    let over = sweep.varied.first().map_or("run", String::as_str);
    let (of, over) = (escaped(&of), escaped(over));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
         {height}\" role=\"img\" aria-label=\"{of} over {over}\" font-family=\"system-ui, sans-serif\" \
         font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{left}\" y=\"20\" font-size=\"14\" font-weight=\"bold\">{of}</text>\n"
    );
    frame.axes(&mut out);
    let (middle, foot) = (0.5 * (left + width - right), height - 10.0);
    let _ = writeln!(out, "<text x=\"{middle:.1}\" y=\"{foot:.1}\" text-anchor=\"middle\">{over}</text>");
    for point in points {
        let (x, y) = frame.place(point);
        let _ = writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{MARK}\" fill=\"{}\"/>",
            Style::number(0).colour
        );
    }
    out.push_str("</svg>\n");
    Some(out)
}
