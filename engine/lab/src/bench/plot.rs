//! Work-precision plots: time against error, both logarithmic, one line for each way to run.

use std::fmt::Write as _;

use super::measure::Measured;
use super::plan::Method;

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 256.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 46.0;
/// Colours of the lines, told apart by those who do not see all of them; the dashes repeat with another period.
const COLOURS: [&str; 7] = ["#0a6e5c", "#b4491c", "#4657b8", "#8a6d00", "#a02c6a", "#3b7ea1", "#555555"];
const DASHES: [&str; 3] = ["none", "7 3", "2 3"];

/// Decades that hold all values.
fn decades(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|x| x.is_finite() && *x > 0.0)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        (0.0, 1.0)
    } else {
        (low.log10().floor(), high.log10().ceil().max(low.log10().floor() + 1.0))
    }
}

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

/// The frame of a plot: what its axes span.
struct Frame {
    x: (f64, f64),
    y: (f64, f64),
}

impl Frame {
    fn around(runs: &[&Measured]) -> Self {
        Self { x: decades(runs.iter().filter_map(|r| error(r))), y: decades(runs.iter().map(|r| r.median())) }
    }

    fn x(&self, error: f64) -> f64 {
        LEFT + (self.x.1 - error.log10()) / (self.x.1 - self.x.0) * (WIDTH - LEFT - RIGHT)
    }

    fn y(&self, time: f64) -> f64 {
        HEIGHT - BOTTOM - (time.log10() - self.y.0) / (self.y.1 - self.y.0) * (HEIGHT - TOP - BOTTOM)
    }

    fn draw(&self, out: &mut String) {
        let mut exponent = self.x.0;
        while exponent <= self.x.1 {
            let at = self.x(10f64.powf(exponent));
            let (bottom, label) = (HEIGHT - BOTTOM, HEIGHT - BOTTOM + 16.0);
            let _ = writeln!(
                out,
                "<path d=\"M{at:.1} {TOP}V{bottom}\" stroke=\"#ddd\"/><text x=\"{at:.1}\" y=\"{label}\" \
                 text-anchor=\"middle\">1e{exponent}</text>"
            );
            exponent += if self.x.1 - self.x.0 > 8.0 { 2.0 } else { 1.0 };
        }
        let mut exponent = self.y.0;
        while exponent <= self.y.1 {
            let at = self.y(10f64.powf(exponent));
            let (right, label) = (WIDTH - RIGHT, LEFT - 6.0);
            let _ = writeln!(
                out,
                "<path d=\"M{LEFT} {at:.1}H{right}\" stroke=\"#ddd\"/><text x=\"{label}\" y=\"{:.1}\" \
                 text-anchor=\"end\">{} ms</text>",
                at + 4.0,
                10f64.powf(exponent + 3.0)
            );
            exponent += 1.0;
        }
    }
}

/// The error that is drawn: zero has no logarithm.
fn error(run: &Measured) -> Option<f64> {
    run.error.filter(|e| *e > 0.0).map(|e| e.max(1e-15))
}

/// The plot of one scene as SVG.
pub fn svg(scene: &str, runs: &[&Measured]) -> String {
    let frame = Frame::around(runs);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} \
         {HEIGHT}\" role=\"img\" aria-label=\"Time against error of {scene}\" \
         font-family=\"system-ui, sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{LEFT}\" y=\"20\" font-size=\"14\" font-weight=\"bold\">{scene}</text>\n"
    );
    frame.draw(&mut out);
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">largest position error, m (better to the right)</text>",
        0.5 * (LEFT + WIDTH - RIGHT),
        HEIGHT - 10.0
    );
    for (index, method) in methods(runs).into_iter().enumerate() {
        curve(&mut out, &frame, index, method, runs);
    }
    out.push_str("</svg>\n");
    out
}

/// One line with its marks and its name in the legend.
fn curve(out: &mut String, frame: &Frame, index: usize, method: Method, runs: &[&Measured]) {
    let (colour, dashes) = (COLOURS[index % COLOURS.len()], DASHES[index / COLOURS.len() % DASHES.len()]);
    let points: Vec<(f64, f64)> = runs
        .iter()
        .filter(|r| r.method == method)
        .filter_map(|r| Some((frame.x(error(r)?), frame.y(r.median()))))
        .collect();
    let path: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let stroke =
        format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" stroke-dasharray=\"{dashes}\"");
    let _ = writeln!(out, "<polyline points=\"{}\" {stroke}/>", path.join(" "));
    for (x, y) in &points {
        let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>");
    }
    let (from, y) = (WIDTH - RIGHT + 12.0, TOP + 8.0 + 18.0 * index as f64);
    let (to, text) = (from + 22.0, from + 28.0);
    let _ = writeln!(
        out,
        "<path d=\"M{from} {y}H{to}\" {stroke}/><text x=\"{text}\" y=\"{}\" fill=\"{colour}\">{method}</text>",
        y + 4.0
    );
}
