#![doc = include_str!("../README.md")]

use std::fmt::Write as _;

/// Colours of lines, distinguishable by colour-blind readers.
pub const COLOURS: [&str; 7] = ["#0a6e5c", "#b4491c", "#4657b8", "#8a6d00", "#a02c6a", "#3b7ea1", "#555555"];
/// Dashes of lines; they repeat with another period than the colours.
pub const DASHES: [&str; 3] = ["none", "7 3", "2 3"];

/// Least span of a linear axis beside its largest value, and least values that are told from zero.
const LEAST_SPAN: f64 = 1e-9;
const LEAST_VALUE: f64 = 1e-300;

/// What an axis spans, and the labels of its lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Decimal exponents at its ends; of a linear axis the values there.
    pub decades: (f64, f64),
    /// Whether equal distances are equal differences, not equal ratios.
    pub linear: bool,
    /// Whether large values stand at its beginning (left or bottom).
    pub reversed: bool,
    /// Values with a line across the plot, each with its label.
    pub ticks: Vec<(f64, String)>,
}

impl Axis {
    /// Whole decades that hold all positive, finite values, with a line for each decade, or for every second one
    /// where there are more than eight. `label` names the line of an exponent.
    ///
    /// ```
    /// use triad_plot::Axis;
    ///
    /// let axis = Axis::around([2e-3, 0.5].into_iter(), |exponent| format!("1e{exponent}"));
    /// assert_eq!(axis.decades, (-3.0, 0.0));
    /// assert_eq!(axis.ticks.len(), 4);
    /// ```
    pub fn around(values: impl Iterator<Item = f64>, label: impl Fn(f64) -> String) -> Self {
        let (low, high) = values
            .filter(|x| x.is_finite() && *x > 0.0)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let decades = if low > high {
            (0.0, 1.0)
        } else {
            (libm::log10(low).floor(), libm::log10(high).ceil().max(libm::log10(low).floor() + 1.0))
        };
        let step = if decades.1 - decades.0 > 8.0 { 2.0 } else { 1.0 };
        let mut ticks = Vec::new();
        let mut exponent = decades.0;
        while exponent <= decades.1 {
            ticks.push((libm::pow(10f64, exponent), label(exponent)));
            exponent += step;
        }
        Self { decades, linear: false, reversed: false, ticks }
    }

    /// A linear axis that holds all finite values, with lines at round numbers. Values that are equal but for rounding are drawn as
    /// equal: labels of a few digits could not tell them apart.
    ///
    /// ```
    /// use triad_plot::Axis;
    ///
    /// let axis = Axis::linear([0.0, 9.0, 3.0].into_iter());
    /// assert_eq!(axis.decades, (0.0, 9.0));
    /// assert_eq!(axis.ticks[1], (1.0, "1".to_owned()));
    ///
    /// let small = Axis::linear([1e-16, 9e-15].into_iter());
    /// assert_eq!(small.ticks[1], (1e-15, "1e-15".to_owned()));
    /// ```
    pub fn linear(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = values
            .filter(|x| x.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let largest = low.abs().max(high.abs());
        let (low, high) = match high - low {
            span if span > (LEAST_SPAN * largest).max(LEAST_VALUE) => (low, high),
            _ if !low.is_finite() => (0.0, 1.0),
            _ if largest > LEAST_VALUE => (low - 0.5 * largest, high + 0.5 * largest),
            _ => (-0.5, 0.5),
        };
        // Five to ten lines at 1, 2 or 5 times a power of ten.
        let rough = (high - low) / 5.0;
        let exponent = libm::floor(libm::log10(rough));
        let power = libm::pow(10.0, exponent);
        let times = [5.0, 2.0, 1.0].into_iter().find(|times| times * power <= rough).unwrap_or(1.0);
        let step = times * power;
        let (first, last) = ((low / step).floor(), (high / step).ceil());
        let plain = exponent > -6.0 && largest < 1e7;
        let mut ticks = Vec::new();
        let mut at = first;
        while at <= last {
            // Read from its digits: a multiple of 0.1 is not to be 0.30000000000000004.
            let value = format!("{}e{exponent}", at * times).parse().unwrap_or(at * step);
            ticks
                .push((value, if plain || value == 0.0 { format!("{value}") } else { format!("{value:e}") }));
            at += 1.0;
        }
        Self { decades: (first * step, last * step), linear: true, reversed: false, ticks }
    }

    /// The same axis with large values at its beginning.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        self.reversed = true;
        self
    }

    /// Where a value stands, a positive one on an axis of decades: 0 at the beginning, 1 at the end.
    fn part(&self, value: f64) -> f64 {
        let at = if self.linear { value } else { libm::log10(value) };
        let part = (at - self.decades.0) / (self.decades.1 - self.decades.0);
        if self.reversed { 1.0 - part } else { part }
    }
}

/// The frame of a plot on its paper, lengths in units of the drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotFrame {
    /// Width and height of the paper.
    pub size: (f64, f64),
    /// Margins: left, right, top, bottom.
    pub margins: [f64; 4],
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Colour of the lines of the axes.
    pub grid: &'static str,
}

impl PlotFrame {
    /// Where a point of two values stands.
    pub fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let [left, right, top, bottom] = self.margins;
        (
            left + self.x.part(x) * (self.size.0 - left - right),
            self.size.1 - bottom - self.y.part(y) * (self.size.1 - top - bottom),
        )
    }

    /// Draws the lines of both axes with their labels.
    pub fn axes(&self, out: &mut String) {
        let [left, right, top, bottom] = self.margins;
        let (end, foot, grid) = (self.size.0 - right, self.size.1 - bottom, self.grid);
        let first = |axis: &Axis| if axis.linear { axis.decades.0 } else { libm::pow(10f64, axis.decades.0) };
        let origin = (first(&self.x), first(&self.y));
        for (value, label) in &self.x.ticks {
            let (at, _) = self.place((*value, origin.1));
            let _ = writeln!(
                out,
                "<path d=\"M{at:.1} {top}V{foot}\" stroke=\"{grid}\"/><text x=\"{at:.1}\" y=\"{}\" \
                 text-anchor=\"middle\" fill=\"currentColor\">{label}</text>",
                foot + 16.0
            );
        }
        for (value, label) in &self.y.ticks {
            let (_, at) = self.place((origin.0, *value));
            let _ = writeln!(
                out,
                "<path d=\"M{left} {at:.1}H{end}\" stroke=\"{grid}\"/><text x=\"{}\" y=\"{:.1}\" \
                 text-anchor=\"end\" fill=\"currentColor\">{label}</text>",
                left - 6.0,
                at + 4.0
            );
        }
    }

    /// Draws a line through points, with marks of a radius (0: none).
    pub fn curve(&self, out: &mut String, style: &Style, points: &[(f64, f64)], marks: f64) {
        let places: Vec<(f64, f64)> = points.iter().map(|point| self.place(*point)).collect();
        let path: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(out, "<polyline points=\"{}\" {}/>", path.join(" "), style.stroke());
        for (x, y) in places.iter().filter(|_| marks > 0.0) {
            let _ = writeln!(
                out,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{marks}\" fill=\"{}\"/>",
                style.colour
            );
        }
    }

    /// Draws the line's name beside the plot, as the legend's entry of this number from the top.
    pub fn legend(&self, out: &mut String, style: &Style, entry: usize, name: &str) {
        let [_, right, top, _] = self.margins;
        let (from, y) = (self.size.0 - right + 12.0, top + 8.0 + 18.0 * entry as f64);
        let _ = writeln!(
            out,
            "<path d=\"M{from} {y}H{}\" {}/><text x=\"{}\" y=\"{}\" fill=\"{}\">{name}</text>",
            from + 22.0,
            style.stroke(),
            from + 28.0,
            y + 4.0,
            style.colour
        );
    }
}

/// How a line looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Its colour.
    pub colour: &'static str,
    /// Its dashes, `none` for a full line.
    pub dashes: &'static str,
    /// Its width.
    pub width: f64,
}

impl Style {
    /// The look of the line of this number: no two of the first 21 are alike.
    ///
    /// ```
    /// use triad_plot::Style;
    ///
    /// assert_ne!(Style::number(1), Style::number(8));
    /// ```
    pub const fn number(index: usize) -> Self {
        Self {
            colour: COLOURS[index % COLOURS.len()],
            dashes: DASHES[index / COLOURS.len() % DASHES.len()],
            width: 2.0,
        }
    }

    fn stroke(&self) -> String {
        let Self { colour, dashes, width } = self;
        format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-dasharray=\"{dashes}\"")
    }
}

/// A text between tags or in an attribute.
///
/// ```
/// assert_eq!(triad_plot::escaped("\"a<b\" & c"), "&quot;a&lt;b&quot; &amp; c");
/// ```
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
