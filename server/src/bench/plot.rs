//! Work-precision plots: time against error, both logarithmic, one line for each integrator.

use std::fmt::Write as _;

use triad_engine::scene::IntegratorKind;

use super::measure::Measured;

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 380.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 96.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 46.0;

/// Colour and name of an integrator.
fn style(integrator: IntegratorKind) -> (&'static str, &'static str) {
    match integrator {
        IntegratorKind::Taylor => ("#0a6e5c", "taylor"),
        IntegratorKind::Dop853 => ("#b4491c", "dop853"),
        IntegratorKind::Dopri5 => ("#4657b8", "dopri5"),
        IntegratorKind::Auto => ("#555555", "auto"),
    }
}

/// Name of an integrator.
pub fn name(integrator: IntegratorKind) -> &'static str {
    style(integrator).1
}

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

/// The plot of one scene as SVG.
pub fn svg(scene: &str, runs: &[&Measured]) -> String {
    let error = |run: &Measured| run.error.filter(|e| *e > 0.0).map(|e| e.max(1e-15));
    let (first_x, last_x) = decades(runs.iter().filter_map(|r| error(r)));
    let (first_y, last_y) = decades(runs.iter().map(|r| r.median()));
    let x = |e: f64| LEFT + (last_x - e.log10()) / (last_x - first_x) * (WIDTH - LEFT - RIGHT);
    let y = |t: f64| HEIGHT - BOTTOM - (t.log10() - first_y) / (last_y - first_y) * (HEIGHT - TOP - BOTTOM);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" \
         aria-label=\"Time against error of {scene}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{LEFT}\" y=\"20\" font-size=\"14\" font-weight=\"bold\">{scene}</text>\n"
    );
    let mut exponent = first_x;
    while exponent <= last_x {
        let at = x(10f64.powf(exponent));
        let (top, bottom, label) = (TOP, HEIGHT - BOTTOM, HEIGHT - BOTTOM + 16.0);
        let _ = writeln!(
            out,
            "<path d=\"M{at:.1} {top}V{bottom}\" stroke=\"#ddd\"/><text x=\"{at:.1}\" y=\"{label}\" \
             text-anchor=\"middle\">1e{exponent}</text>"
        );
        exponent += if last_x - first_x > 8.0 { 2.0 } else { 1.0 };
    }
    let mut exponent = first_y;
    while exponent <= last_y {
        let at = y(10f64.powf(exponent));
        let (right, label) = (WIDTH - RIGHT, LEFT - 6.0);
        let _ = writeln!(
            out,
            "<path d=\"M{LEFT} {at:.1}H{right}\" stroke=\"#ddd\"/><text x=\"{label}\" y=\"{:.1}\" \
             text-anchor=\"end\">{}</text>",
            at + 4.0,
            seconds(exponent)
        );
        exponent += 1.0;
    }
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">largest position error, m (better to the right)</text>",
        0.5 * (LEFT + WIDTH - RIGHT),
        HEIGHT - 10.0
    );
    for integrator in
        [IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Dopri5, IntegratorKind::Auto]
    {
        let (colour, label) = style(integrator);
        let points: Vec<(f64, f64)> = runs
            .iter()
            .filter(|r| r.integrator == integrator)
            .filter_map(|r| Some((x(error(r)?), y(r.median()))))
            .collect();
        let Some(last) = points.last() else { continue };
        let path: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
            path.join(" ")
        );
        for (x, y) in &points {
            let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>");
        }
        let _ = writeln!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"{colour}\">{label}</text>",
            last.0 + 8.0,
            last.1 + 4.0
        );
    }
    out.push_str("</svg>\n");
    out
}

/// A power of ten seconds as people say it.
fn seconds(exponent: f64) -> String {
    let (scale, unit) = if exponent < -3.0 {
        (6.0, "µs")
    } else if exponent < 0.0 {
        (3.0, "ms")
    } else {
        (0.0, "s")
    };
    format!("{:.0} {unit}", 10f64.powf(exponent + scale))
}
