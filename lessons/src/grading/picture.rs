//! The picture of work and precision: error against evaluations, both logarithmic, as SVG for light and dark paper.

use std::fmt::Write as _;

use crate::rendering::html::escape;

const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 58.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;
const COLOURS: [&str; 4] = ["#1c7ed6", "#2b8a3e", "#d9480f", "#9c36b5"];

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
        let frame = Frame::around(self);
        let words = match &self.own {
            Some((name, p)) => format!(
                "Work and precision: your run with {name} took {} evaluations and has an error of {:.1e}; allowed are {} \
                 evaluations and an error of {:.1e}.",
                p.work, p.error, self.budget, self.error
            ),
            None => "Work and precision: your run did not come to its end.".to_owned(),
        };
        let mut svg = format!(
            "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\" class=\"work-precision\">",
            escape(&words)
        );
        frame.axes(&mut svg);
        let (x, y) = (frame.x(self.budget as f64), frame.y(self.error));
        let (width, height) = (x - LEFT, HEIGHT - BOTTOM - y);
        let _ = write!(
            svg,
            "<rect x=\"{LEFT}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"#2b8a3e\" \
             fill-opacity=\"0.14\"/><text x=\"{:.1}\" y=\"{:.1}\" font-size=\"11\" fill=\"#2b8a3e\">asked for</text>",
            LEFT + 6.0,
            HEIGHT - BOTTOM - 7.0
        );
        for ((name, points), colour) in self.curves.iter().zip(COLOURS.iter().cycle()) {
            let at = |p: &Point| (frame.x(p.work as f64), frame.y(p.error));
            let line: Vec<String> = points.iter().map(at).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
            let _ = write!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"/>",
                line.join(" ")
            );
            for (x, y) in points.iter().map(at) {
                let _ = write!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.2\" fill=\"{colour}\"/>");
            }
            if let Some((x, y)) = points.first().map(at) {
                let _ = write!(
                    svg,
                    "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"11\" fill=\"{colour}\">{}</text>",
                    (x + 6.0).min(WIDTH - 60.0),
                    y - 4.0,
                    escape(name)
                );
            }
        }
        if let Some((_, p)) = &self.own {
            let (x, y) = (frame.x(p.work as f64), frame.y(p.error));
            let anchor = if x > WIDTH - 90.0 { ("end", x - 9.0) } else { ("start", x + 9.0) };
            let _ = write!(
                svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5.5\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"2\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12\" text-anchor=\"{}\" fill=\"currentColor\">your run</text>",
                anchor.1,
                y + 4.0,
                anchor.0
            );
        }
        svg.push_str("</svg>");
        svg
    }
}

/// Decades that the axes cover.
struct Frame {
    work: [f64; 2],
    error: [f64; 2],
}

impl Frame {
    fn around(picture: &Picture) -> Self {
        let points = picture.curves.iter().flat_map(|(_, p)| p).chain(picture.own.iter().map(|(_, p)| p));
        let (mut work, mut error) = ([f64::INFINITY, 0.0f64], [f64::INFINITY, 0.0f64]);
        let mut include = |w: f64, e: f64| {
            let (w, e) = (w.max(1.0), e.clamp(1e-15, 1e3));
            work = [work[0].min(w), work[1].max(w)];
            error = [error[0].min(e), error[1].max(e)];
        };
        include(picture.budget as f64 / 3.0, picture.error / 30.0);
        include(picture.budget as f64 * 2.0, picture.error * 30.0);
        for p in points {
            include(p.work as f64, p.error);
        }
        let decades = |[low, high]: [f64; 2]| [low.log10().floor(), high.log10().ceil()];
        Self { work: decades(work), error: decades(error) }
    }

    fn x(&self, work: f64) -> f64 {
        let part = (work.max(1.0).log10() - self.work[0]) / (self.work[1] - self.work[0]);
        LEFT + part * (WIDTH - LEFT - RIGHT)
    }

    fn y(&self, error: f64) -> f64 {
        let part = (error.clamp(1e-15, 1e3).log10() - self.error[0]) / (self.error[1] - self.error[0]);
        HEIGHT - BOTTOM - part * (HEIGHT - TOP - BOTTOM)
    }

    /// Lines and labels of the decades.
    fn axes(&self, svg: &mut String) {
        let mut decade = self.work[0];
        while decade <= self.work[1] {
            let x = self.x(10f64.powf(decade));
            let _ = write!(
                svg,
                "<line x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{TOP}\" y2=\"{:.1}\" stroke=\"currentColor\" stroke-opacity=\"0.2\"/>\
                 <text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"11\" text-anchor=\"middle\" fill=\"currentColor\">10<tspan dy=\"-4\" font-size=\"8\">{decade}</tspan></text>",
                HEIGHT - BOTTOM,
                HEIGHT - BOTTOM + 16.0
            );
            decade += 1.0;
        }
        let step = ((self.error[1] - self.error[0]) / 8.0).ceil().max(1.0);
        let mut decade = self.error[0];
        while decade <= self.error[1] {
            let y = self.y(10f64.powf(decade));
            let _ = write!(
                svg,
                "<line x1=\"{LEFT}\" x2=\"{:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"currentColor\" stroke-opacity=\"0.2\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"11\" text-anchor=\"end\" fill=\"currentColor\">10<tspan dy=\"-4\" font-size=\"8\">{decade}</tspan></text>",
                WIDTH - RIGHT,
                LEFT - 6.0,
                y + 4.0
            );
            decade += step;
        }
        let _ = write!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12\" text-anchor=\"middle\" fill=\"currentColor\">evaluations</text>\
             <text x=\"14\" y=\"{:.1}\" font-size=\"12\" text-anchor=\"middle\" transform=\"rotate(-90 14 {:.1})\" fill=\"currentColor\">error</text>",
            f64::midpoint(LEFT, WIDTH - RIGHT),
            HEIGHT - 8.0,
            f64::midpoint(TOP, HEIGHT - BOTTOM),
            f64::midpoint(TOP, HEIGHT - BOTTOM)
        );
    }
}
