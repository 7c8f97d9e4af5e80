//! The picture of work and precision: error against evaluations, both logarithmic, as SVG for light and dark paper.

use std::fmt::Write as _;

use triad_plot::{Axis, DASHES, PlotFrame, Style};

use crate::rendering::html::escape;

/// Width and height of the picture, px.
const SIZE: (f64, f64) = (460.0, 300.0);
/// Left, right, top and bottom margin, px.
const MARGINS: [f64; 4] = [58.0, 12.0, 12.0, 44.0];
/// Colours that are seen on light and on dark paper.
const COLOURS: [&str; 4] = ["#1c7ed6", "#2b8a3e", "#d9480f", "#9c36b5"];
/// Errors that are drawn: below is rounding, above nothing is left of the motion.
const ERRORS: (f64, f64) = (1e-15, 1e3);

/// A run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub work: u64,
    pub error: f64,
}

/// The picture while it is drawn.
pub(super) struct Picture {
    budget: u64,
    error: f64,
    curves: Vec<(String, Vec<Point>)>,
    own: Option<(String, Point)>,
}

impl Picture {
    pub(super) fn new(budget: u64, error: f64) -> Self {
        Self { budget, error, curves: Vec::new(), own: None }
    }

    pub(super) fn curve(&mut self, name: &str, points: Vec<Point>) {
        self.curves.push((name.to_owned(), points));
    }

    pub(super) fn own(&mut self, name: &str, point: Point) {
        self.own = Some((name.to_owned(), point));
    }

    pub(super) fn svg(&self) -> String {
        let frame = self.frame();
        let mut svg = format!(
            "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\" class=\"work-precision\" font-size=\"11\">",
            SIZE.0,
            SIZE.1,
            escape(&self.summary())
        );
        frame.axes(&mut svg);
        axis_titles(&mut svg);
        self.draw_goal(&frame, &mut svg);
        for (index, (name, points)) in self.curves.iter().enumerate() {
            let style = Style {
                colour: COLOURS[index % COLOURS.len()],
                dashes: DASHES[index / COLOURS.len() % DASHES.len()],
                width: 1.6,
            };
            let points: Vec<(f64, f64)> = points.iter().map(Point::drawn).collect();
            frame.curve(&mut svg, &style, &points, 2.2);
            if let Some((x, y)) = points.first().map(|point| frame.place(*point)) {
                let (x, y, colour) = ((x + 6.0).min(SIZE.0 - 60.0), y - 4.0, style.colour);
                let name = escape(name);
                let _ = write!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"{colour}\">{name}</text>");
            }
        }
        if let Some((_, point)) = &self.own {
            draw_own(frame.place(point.drawn()), &mut svg);
        }
        svg.push_str("</svg>");
        svg
    }

    /// The picture in words.
    fn summary(&self) -> String {
        match &self.own {
            Some((name, p)) => format!(
                "Work and precision: your run with {name} took {} evaluations and has an error of {:.1e}; allowed are {} \
                 evaluations and an error of {:.1e}.",
                p.work, p.error, self.budget, self.error
            ),
            None => "Work and precision: your run did not come to its end.".to_owned(),
        }
    }

    /// Decades that hold every point, and the goal with some space about it.
    fn frame(&self) -> PlotFrame {
        let (budget, error) = (self.budget as f64, self.error);
        let goal = [(budget / 3.0, error / 30.0), (budget * 2.0, error * 30.0)];
        let points = self.curves.iter().flat_map(|(_, p)| p).chain(self.own.iter().map(|(_, p)| p));
        let all: Vec<(f64, f64)> = goal.map(drawable).into_iter().chain(points.map(Point::drawn)).collect();
        let label = |exponent: f64| format!("10<tspan dy=\"-4\" font-size=\"8\">{exponent}</tspan>");
        PlotFrame {
            size: SIZE,
            margins: MARGINS,
            x: Axis::around(all.iter().map(|(work, _)| *work), label),
            y: Axis::around(all.iter().map(|(_, error)| *error), label),
            grid: "#88888855",
        }
    }

    /// The corner of runs that are cheap and exact enough.
    fn draw_goal(&self, frame: &PlotFrame, svg: &mut String) {
        let ((x, y), [left, _, _, bottom]) = (frame.place((self.budget as f64, self.error)), MARGINS);
        let foot = SIZE.1 - bottom;
        let _ = write!(
            svg,
            "<rect x=\"{left}\" y=\"{y:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#2b8a3e\" \
             fill-opacity=\"0.14\"/><text x=\"{:.1}\" y=\"{:.1}\" fill=\"#2b8a3e\">asked for</text>",
            x - left,
            foot - y,
            left + 6.0,
            foot - 7.0
        );
    }
}

impl Point {
    fn drawn(&self) -> (f64, f64) {
        drawable((self.work as f64, self.error))
    }
}

/// Work and error within what a logarithmic plot can show.
fn drawable((work, error): (f64, f64)) -> (f64, f64) {
    (work.max(1.0), error.clamp(ERRORS.0, ERRORS.1))
}

/// The student's own run: a ring and its name, on the side where there is space.
fn draw_own((x, y): (f64, f64), svg: &mut String) {
    let (anchor, at) = if x > SIZE.0 - 90.0 { ("end", x - 9.0) } else { ("start", x + 9.0) };
    let _ = write!(
        svg,
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5.5\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"2\"/>\
         <text x=\"{at:.1}\" y=\"{:.1}\" font-size=\"12\" text-anchor=\"{anchor}\" fill=\"currentColor\">your run</text>",
        y + 4.0
    );
}

fn axis_titles(svg: &mut String) {
    let ((width, height), [left, right, top, bottom]) = (SIZE, MARGINS);
    let (x, y) = (f64::midpoint(left, width - right), f64::midpoint(top, height - bottom));
    let _ = write!(
        svg,
        "<g font-size=\"12\" text-anchor=\"middle\" fill=\"currentColor\">\
         <text x=\"{x:.1}\" y=\"{:.1}\">evaluations</text>\
         <text x=\"14\" y=\"{y:.1}\" transform=\"rotate(-90 14 {y:.1})\">error</text></g>",
        height - 8.0
    );
}
