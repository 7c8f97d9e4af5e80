//! Work-precision plots: time against error, both logarithmic, one line for each way to run.

use std::fmt::Write as _;

use triad_plot::{Axis, PlotFrame, Style};

use super::measure::Measured;
use super::plan::Method;

/// Width and height of a plot, px.
const SIZE: (f64, f64) = (720.0, 400.0);
/// Left, right, top and bottom margin, px; the right one holds the legend.
const MARGINS: [f64; 4] = [64.0, 256.0, 34.0, 46.0];

/// The ways to run that occur, in order.
pub fn methods(runs: &[&Measured]) -> Vec<Method> {
    let mut found: Vec<Method> = Vec::new();
    for run in runs {
        if !found.contains(&run.method) {
            found.push(run.method);
        }
    }
    found
}

/// The error that is drawn: zero has no logarithm.
fn error(run: &Measured) -> Option<f64> {
    run.error.filter(|e| *e > 0.0).map(|e| e.max(1e-15))
}

/// The plot of one scene as SVG.
pub fn svg(scene: &str, runs: &[&Measured]) -> String {
    let frame = PlotFrame {
        size: SIZE,
        margins: MARGINS,
        x: Axis::around(runs.iter().filter_map(|r| error(r)), |exponent| format!("1e{exponent}")).reversed(),
        y: Axis::around(runs.iter().map(|r| r.median()), |e| format!("{} ms", libm::pow(10f64, e + 3.0))),
        grid: "#ddd",
    };
    let ((width, height), [left, right, _, _]) = (SIZE, MARGINS);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
         {height}\" role=\"img\" aria-label=\"Time against error of {scene}\" \
         font-family=\"system-ui, sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{left}\" y=\"20\" font-size=\"14\" font-weight=\"bold\">{scene}</text>\n"
    );
    frame.axes(&mut out);
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">largest position error, m (better to the right)</text>",
        0.5 * (left + width - right),
        height - 10.0
    );
    for (index, method) in methods(runs).into_iter().enumerate() {
        let points: Vec<(f64, f64)> = runs
            .iter()
            .filter(|r| r.method == method)
            .filter_map(|r| Some((error(r)?, r.median())))
            .collect();
        frame.curve(&mut out, &Style::number(index), &points, 3.0);
        frame.legend(&mut out, &Style::number(index), index, &method.to_string());
    }
    out.push_str("</svg>\n");
    out
}
