//! Fig. 12 as a picture: run time over number of bodies, both axes logarithmic.

use std::fmt::Write;

use super::{Row, Seconds};

/// One curve: name, colour, dashed or not, and (bodies, seconds).
pub(super) struct Curve {
    name: String,
    colour: &'static str,
    dashed: bool,
    points: Vec<(f64, f64)>,
}

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 460.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 250.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 50.0;

/// The time of one kind of linear algebra.
type Time = fn(&Seconds) -> f64;

/// Full (solid) and reduced (dashed) with each kind of linear algebra.
pub(super) fn curves(rows: &[Row]) -> Vec<Curve> {
    let kinds: [(&str, &'static str, Time); 3] = [
        ("full square matrix", "#b3261e", |s| s.dense),
        ("zeros left out", "#1f5fa8", |s| s.sparse),
        ("rows eliminated", "#2e7d32", |s| s.elimination),
    ];
    let mut list = Vec::new();
    for (name, colour, of) in kinds {
        for dashed in [false, true] {
            let body = if dashed { "reduced" } else { "full" };
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
            list.push(Curve { name: format!("{body}, {name}"), colour, dashed, points });
        }
    }
    list
}

/// Draws the curves.
pub(super) fn svg(curves: &[Curve]) -> String {
    let points = || curves.iter().flat_map(|curve| curve.points.iter().copied());
    let seconds = points().map(|(_, s)| s.log10());
    let (low, high) = seconds.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s), h.max(s)));
    let (low, high) = (low.floor(), high.ceil().max(low.floor() + 1.0));
    let most = points().fold(2.0f64, |a, (n, _)| a.max(n)).log10();
    let x = |bodies: f64| LEFT + (WIDTH - LEFT - RIGHT) * bodies.log10() / most;
    let y = |log: f64| HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (log - low) / (high - low);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\" \
         font-size=\"12\" role=\"img\">\n<title>Run time over number of bodies, full and reduced</title>\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"white\"/>\n"
    );
    let line = |out: &mut String, x1: f64, y1: f64, x2: f64, y2: f64| {
        let _ = writeln!(
            out,
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"#ccc\"/>"
        );
    };
    let text = |out: &mut String, x: f64, y: f64, anchor: &str, words: &str| {
        let _ = writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{words}</text>");
    };
    for bodies in [1.0, 2.0, 5.0, 10.0, 20.0, 40.0] {
        if bodies <= 1.05 * 10f64.powf(most) {
            line(&mut out, x(bodies), TOP, x(bodies), HEIGHT - BOTTOM);
            text(&mut out, x(bodies), HEIGHT - BOTTOM + 18.0, "middle", &format!("{bodies}"));
        }
    }
    let mut decade = low;
    while decade <= high {
        line(&mut out, LEFT, y(decade), WIDTH - RIGHT, y(decade));
        text(&mut out, LEFT - 8.0, y(decade) + 4.0, "end", &format!("{} s", 10f64.powf(decade)));
        decade += 1.0;
    }
    text(&mut out, (LEFT + WIDTH - RIGHT) / 2.0, HEIGHT - 12.0, "middle", "moving bodies");
    text(&mut out, LEFT, 18.0, "start", "run time");
    for (place, curve) in curves.iter().enumerate() {
        let dash = if curve.dashed { " stroke-dasharray=\"6 4\"" } else { "" };
        let path: Vec<String> =
            curve.points.iter().map(|(n, s)| format!("{:.1},{:.1}", x(*n), y(s.log10()))).collect();
        let stroke = format!("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{dash}", curve.colour);
        let _ = writeln!(out, "<polyline points=\"{}\" {stroke}/>", path.join(" "));
        let (left, level) = (WIDTH - RIGHT + 20.0, TOP + 12.0 + 22.0 * place as f64);
        let _ = writeln!(out, "<polyline points=\"{left},{level} {},{level}\" {stroke}/>", left + 36.0);
        text(&mut out, left + 44.0, level + 4.0, "start", &curve.name);
    }
    out.push_str("</svg>\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_lies_within_the_picture() {
        let curve = |dashed| Curve {
            name: "full".to_owned(),
            colour: "#000",
            dashed,
            points: vec![(1.0, 0.003), (5.0, 0.2), (39.0, 900.0)],
        };
        let picture = svg(&[curve(false), curve(true)]);
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
        let mut count = 0;
        for (x, y) in numbers {
            assert!(
                (LEFT..=WIDTH).contains(&x) && (TOP - 1.0..=HEIGHT - BOTTOM + 1.0).contains(&y),
                "{x} {y}"
            );
            count += 1;
        }
        assert_eq!(count, 10);
    }
}
