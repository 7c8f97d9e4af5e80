//! Plots as pixels, for slides and papers that take no SVG.
//!
//! A plot consists of few kinds of elements (`triad_plot`), and its letters are few: a library for all of SVG and for
//! every script would be the larger half of what can be left out of the binary.

mod letters;

use std::str::FromStr;

use roxmltree::{Document, Node};
use tiny_skia::{Color, FillRule, Paint, Path, PathBuilder, Pixmap, Stroke, StrokeDash, Transform};

use letters::Font;

/// Pixels for one unit of the drawing: sharp on a projector.
const SCALE: f32 = 2.0;

/// Why a drawing has no picture of pixels.
#[derive(Debug, thiserror::Error)]
pub(in crate::cli) enum RasterError {
    /// The drawing is not SVG.
    #[error("the drawing cannot be read: {0}")]
    Drawing(#[from] roxmltree::Error),
    /// The drawing has an element or a value that plots do not have.
    #[error("the drawing has {0}, which plots do not have")]
    Unknown(String),
    /// The drawing has no size, or one that memory cannot hold.
    #[error("a picture of {width} by {height} pixels cannot be made")]
    Size {
        /// Pixels across.
        width: f32,
        /// Pixels down.
        height: f32,
    },
    /// The pixels are not to be had as PNG.
    #[error("the picture cannot be written as PNG: {0}")]
    Encoding(String),
}

/// A plot as PNG, with letters of its own, so that it looks alike on every machine.
pub(in crate::cli) fn png(svg: &str) -> Result<Vec<u8>, RasterError> {
    let document = Document::parse(svg)?;
    let root = document.root_element();
    // A plot's own size: numbers without a unit.
    let (width, height) = (SCALE * number(root, "width", 0.0)?, SCALE * number(root, "height", 0.0)?);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // `as` holds the result within u32
    let pixels = Pixmap::new(width.ceil() as u32, height.ceil() as u32);
    let mut picture = Picture { pixels: pixels.ok_or(RasterError::Size { width, height })? };
    for element in root.children().filter(Node::is_element) {
        picture.draw(element)?;
    }
    picture.pixels.encode_png().map_err(|error| RasterError::Encoding(error.to_string()))
}

struct Picture {
    pixels: Pixmap,
}

impl Picture {
    fn draw(&mut self, element: Node<'_, '_>) -> Result<(), RasterError> {
        match element.tag_name().name() {
            "rect" => self.background(element),
            "text" => self.text(element),
            "path" => {
                let data = element.attribute("d").unwrap_or_default();
                self.line(element, straight(data).ok_or_else(|| unknown(element, "d"))?)
            }
            "polyline" => {
                let points = element.attribute("points").unwrap_or_default();
                self.line(element, corners(points).ok_or_else(|| unknown(element, "points"))?)
            }
            "circle" => {
                let [x, y, r] =
                    [number(element, "cx", 0.0)?, number(element, "cy", 0.0)?, number(element, "r", 0.0)?];
                let fill = colour(element, "fill")?;
                self.fill(PathBuilder::from_circle(x, y, r), fill);
                Ok(())
            }
            other => Err(RasterError::Unknown(format!("<{other}>"))),
        }
    }

    /// A rectangle that covers the whole paper.
    fn background(&mut self, element: Node<'_, '_>) -> Result<(), RasterError> {
        for side in ["width", "height"] {
            if element.attribute(side) != Some("100%") {
                return Err(unknown(element, side));
            }
        }
        self.pixels.fill(colour(element, "fill")?);
        Ok(())
    }

    fn text(&mut self, element: Node<'_, '_>) -> Result<(), RasterError> {
        let text = element.text().unwrap_or_default();
        let size = number(element, "font-size", 16.0)?;
        let font = Font::of_weight(inherited(element, "font-weight") == Some("bold"));
        let before = match inherited(element, "text-anchor") {
            Some("end") => 1.0,
            Some("middle") => 0.5,
            _ => 0.0,
        };
        let x = number(element, "x", 0.0)? - before * font.width(text, size);
        let mut path = PathBuilder::new();
        font.draw(text, size, (x, number(element, "y", 0.0)?), &mut path);
        let fill = colour(element, "fill")?;
        self.fill(path.finish(), fill);
        Ok(())
    }

    /// Draws along a path; one without length leaves nothing.
    fn line(&mut self, element: Node<'_, '_>, path: PathBuilder) -> Result<(), RasterError> {
        let dashes = element.attribute("stroke-dasharray").filter(|dashes| *dashes != "none");
        let dash = match dashes {
            Some(lengths) => {
                let lengths = numbers(lengths).ok_or_else(|| unknown(element, "stroke-dasharray"))?;
                Some(StrokeDash::new(lengths, 0.0).ok_or_else(|| unknown(element, "stroke-dasharray"))?)
            }
            None => None,
        };
        let stroke = Stroke { width: number(element, "stroke-width", 1.0)?, dash, ..Stroke::default() };
        let paint = paint(colour(element, "stroke")?);
        if let Some(path) = path.finish() {
            self.pixels.stroke_path(&path, &paint, &stroke, scale(), None);
        }
        Ok(())
    }

    fn fill(&mut self, path: Option<Path>, colour: Color) {
        if let Some(path) = path {
            self.pixels.fill_path(&path, &paint(colour), FillRule::Winding, scale(), None);
        }
    }
}

fn scale() -> Transform {
    Transform::from_scale(SCALE, SCALE)
}

fn paint(colour: Color) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(colour);
    paint
}

/// `M x y` and then lines across (`H`) and down (`V`): the lines of axes and legends.
fn straight(data: &str) -> Option<PathBuilder> {
    let (mut path, mut x, mut y) = (PathBuilder::new(), 0.0, 0.0);
    let mut rest = data.chars();
    while let Some(command) = rest.next() {
        let tail = rest.as_str();
        let end = tail.find(|sign: char| sign.is_ascii_uppercase()).unwrap_or(tail.len());
        match (command, numbers(&tail[..end])?.as_slice()) {
            ('M', [to_x, to_y]) => {
                (x, y) = (*to_x, *to_y);
                path.move_to(x, y);
            }
            ('H', [to]) => {
                x = *to;
                path.line_to(x, y);
            }
            ('V', [to]) => {
                y = *to;
                path.line_to(x, y);
            }
            _ => return None,
        }
        rest = tail[end..].chars();
    }
    Some(path)
}

/// The points of a polyline.
fn corners(points: &str) -> Option<PathBuilder> {
    let mut path = PathBuilder::new();
    for point in numbers(points)?.chunks(2) {
        let [x, y] = *point else { return None };
        if path.is_empty() { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    Some(path)
}

fn numbers(list: &str) -> Option<Vec<f32>> {
    let words = list.split([' ', ',']).filter(|word| !word.is_empty());
    words.map(|word| f32::from_str(word).ok()).collect()
}

/// A length; `otherwise` where the element does not give it.
fn number(element: Node<'_, '_>, name: &str, otherwise: f32) -> Result<f32, RasterError> {
    let Some(value) = inherited(element, name) else { return Ok(otherwise) };
    value.parse().map_err(|_| unknown(element, name))
}

/// A colour as plots write them; black where the element has none, or that of the text around it.
fn colour(element: Node<'_, '_>, name: &str) -> Result<Color, RasterError> {
    let byte = |digits: &str| u8::from_str_radix(digits, 16).ok();
    let found = match inherited(element, name) {
        None | Some("currentColor") => Some(Color::BLACK),
        Some("white") => Some(Color::WHITE),
        Some(value) => value.strip_prefix('#').filter(|digits| digits.is_ascii()).and_then(|digits| {
            let parts = match digits.len() {
                3 => [0, 1, 2].map(|k| Some(17 * byte(&digits[k..=k])?)),
                6 => [0, 2, 4].map(|k| byte(&digits[k..k + 2])),
                _ => [None; 3],
            };
            Some(Color::from_rgba8(parts[0]?, parts[1]?, parts[2]?, u8::MAX))
        }),
    };
    found.ok_or_else(|| unknown(element, name))
}

/// An attribute of the element, or of the nearest one around it.
fn inherited<'d>(element: Node<'d, '_>, name: &str) -> Option<&'d str> {
    element.ancestors().find_map(|node| node.attribute(name))
}

fn unknown(element: Node<'_, '_>, name: &str) -> RasterError {
    let value = inherited(element, name).unwrap_or_default();
    RasterError::Unknown(format!("{name}=\"{value}\" at <{}>", element.tag_name().name()))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn drawing(content: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"80\" height=\"20\" font-size=\"12\" \
             font-family=\"system-ui, sans-serif\">{content}</svg>"
        )
    }

    /// The parts of the paper, in 1/1000, that are darker than half, on the left and on the right.
    fn ink(content: &str) -> [u32; 2] {
        let png = png(&drawing(&format!("<rect width=\"100%\" height=\"100%\" fill=\"white\"/>{content}")))
            .unwrap();
        let pixels = Pixmap::decode_png(&png).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (160, 40), "twice the drawing's size");
        let mut dark = [0, 0];
        for (at, pixel) in pixels.pixels().iter().enumerate() {
            dark[usize::from(at % 160 >= 80)] += u32::from(pixel.green() < 128);
        }
        dark.map(|count| count * 1000 / (80 * 40))
    }

    #[test]
    fn words_stand_at_their_anchor_and_bold_ones_are_darker() {
        let word = |x: f32, more: &str| ink(&format!("<text x=\"{x}\" y=\"14\" {more}>times</text>"));
        let left = word(4.0, "");
        assert!(left[0] > 30 && left[1] == 0, "{left:?}");
        let right = word(76.0, "text-anchor=\"end\"");
        assert!(right[0] == 0 && right[1] > 30, "{right:?}");
        let middle = word(40.0, "text-anchor=\"middle\"");
        assert!(middle[0] > 10 && middle[1] > 10, "{middle:?}");
        assert!(word(4.0, "font-weight=\"bold\"")[0] > left[0] + 10);
        assert!(ink("<text x=\"4\" y=\"14\">\u{4e2d}</text>")[0] > 0, "a box for a sign of another script");
    }

    #[test]
    fn lines_are_drawn_where_they_are_and_dashes_leave_gaps() {
        assert_eq!(ink("<path d=\"M0 10H40\" stroke=\"#000\" stroke-width=\"10\"/>"), [500, 0]);
        assert_eq!(ink("<path d=\"M60 0V20\" stroke=\"#000000\" stroke-width=\"20\"/>"), [0, 500]);
        let dashed =
            "<polyline points=\"0,10 80,10\" stroke=\"#000\" stroke-width=\"20\" stroke-dasharray=\"4 4\"/>";
        assert_eq!(ink(dashed), [500, 500]);
        let disc = ink("<circle cx=\"20\" cy=\"10\" r=\"10\" fill=\"#0a6e5c\"/>");
        assert!((365..=395).contains(&disc[0]), "{disc:?}: a quarter of pi, less the lighter edge");
    }

    #[test]
    fn what_plots_do_not_have_is_refused_by_name() {
        let refused = |content: &str| png(&drawing(content)).unwrap_err().to_string();
        assert!(refused("<image/>").contains("<image>"));
        assert!(refused("<path d=\"M0 0C1 1 2 2 3 3\"/>").contains("M0 0C1"));
        assert!(refused("<circle fill=\"#12é\"/>").contains("#12é"));
        assert!(matches!(png("no drawing"), Err(RasterError::Drawing(_))));
        assert!(matches!(png("<svg/>"), Err(RasterError::Size { .. })));
    }
}
