//! Fig. 12 as a picture: run time over number of bodies, both axes logarithmic.

use std::fmt::Write as _;

use triad_plot::{Axis, PlotFrame, Style};

use super::{Row, Seconds};

/// One curve: its name, its look, and (bodies, seconds).
pub(super) struct PlottedCurve {
    name: String,
    style: Style,
    points: Vec<(f64, f64)>,
}

/// Width and height of the picture, px.
const SIZE: (f64, f64) = (720.0, 460.0);
/// Left, right, top and bottom margin, px; the names of the curves stand in the right one.
const MARGINS: [f64; 4] = [70.0, 250.0, 30.0, 50.0];
/// Numbers of bodies that have a line, if there are as many.
const BODIES: [f64; 6] = [1.0, 2.0, 5.0, 10.0, 20.0, 40.0];

/// The time of one kind of linear algebra.
type Time = fn(&Seconds) -> f64;

/// Full (solid) and reduced (dashed) with each kind of linear algebra.
pub(super) fn curves(rows: &[Row]) -> Vec<PlottedCurve> {
    let kinds: [(&str, &'static str, Time); 3] = [
        ("full square matrix", "#b3261e", |s| s.dense),
        ("zeros left out", "#1f5fa8", |s| s.sparse),
        ("rows eliminated", "#2e7d32", |s| s.elimination),
    ];
    let mut list = Vec::new();
    for (name, colour, of) in kinds {
        for dashed in [false, true] {
            let (body, dashes) = if dashed { ("reduced", "6 4") } else { ("full", "none") };
            let point = |row: &Row| {
                let side = if dashed { &row.reduced } else { &row.full };
                (row.bodies as f64, of(&side.seconds))
            };
            // One model for each number of bodies: the last, which is the pendulum of the two with one body.
            let mut points: Vec<(f64, f64)> = Vec::new();
            for next in rows.iter().map(point) {
                match points.last_mut() {
                    Some(last) if last.0 == next.0 => *last = next,
                    _ => points.push(next),
                }
            }
            let style = Style { colour, dashes, width: 2.0 };
            list.push(PlottedCurve { name: format!("{body}, {name}"), style, points });
        }
    }
    list
}

/// Draws the curves.
pub(super) fn svg(curves: &[PlottedCurve]) -> String {
    let points = || curves.iter().flat_map(|curve| curve.points.iter());
    let most = points().fold(2.0f64, |most, (bodies, _)| most.max(*bodies));
    let lines = BODIES.iter().filter(|bodies| **bodies <= 1.05 * most);
    let frame = PlotFrame {
        size: SIZE,
        margins: MARGINS,
        x: Axis {
            decades: (0.0, libm::log10(most)),
            linear: false,
            reversed: false,
            ticks: lines.map(|bodies| (*bodies, bodies.to_string())).collect(),
        },
        y: Axis::around(points().map(|(_, seconds)| *seconds), |exponent| {
            format!("{} s", libm::pow(10f64, exponent))
        }),
        grid: "#ccc",
    };
    let ((width, height), [left, right, _, _]) = (SIZE, MARGINS);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"12\" role=\"img\">\n<title>Run time over number of bodies, full and reduced</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    frame.axes(&mut out);
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">moving bodies</text>\
         <text x=\"{left:.1}\" y=\"18\">run time</text>",
        0.5 * (left + width - right),
        height - 12.0
    );
    for (entry, curve) in curves.iter().enumerate() {
        frame.curve(&mut out, &curve.style, &curve.points, 0.0);
        frame.legend(&mut out, &curve.style, entry, &curve.name);
    }
    out.push_str("</svg>\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_lies_within_the_picture() {
        let curve = |index| PlottedCurve {
            name: "full".to_owned(),
            style: Style::number(index),
            points: vec![(1.0, 0.003), (5.0, 0.2), (39.0, 900.0)],
        };
        let picture = svg(&[curve(0), curve(1)]);
        let numbers = picture.match_indices("points=\"").flat_map(|(at, key)| {
            let rest = &picture[at + key.len()..];
            let list = rest.split('"').next().unwrap_or_default();
            list.split_whitespace()
                .map(|pair| {
                    let (x, y) = pair.split_once(',').expect("two numbers");
                    (x.parse::<f64>().expect("a number"), y.parse::<f64>().expect("a number"))
                })
                .collect::<Vec<_>>()
        });
        let [left, right, top, bottom] = MARGINS;
        let mut count = 0;
        for (x, y) in numbers {
            assert!((left..=SIZE.0 - right).contains(&x) && (top..=SIZE.1 - bottom).contains(&y), "{x} {y}");
            count += 1;
        }
        assert_eq!(count, 6);
    }
}
