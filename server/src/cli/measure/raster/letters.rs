//! Letters as outlines: those of DejaVu Sans that plots write, so that a picture looks alike on every machine.

use tiny_skia::PathBuilder;

/// A piece of an outline, in units of the font, upwards.
#[derive(Clone, Copy, Debug)]
enum Piece {
    Move(i16, i16),
    Line(i16, i16),
    /// A parabola: its control point, then its end.
    Curve(i16, i16, i16, i16),
    Close,
}
use Piece::{Close, Curve, Line, Move};

#[derive(Debug)]
struct Glyph {
    sign: char,
    /// From this sign to the next, in units of the font.
    advance: u16,
    outline: &'static [Piece],
}

/// The letters of one weight.
#[derive(Debug)]
pub struct Font {
    /// Units of the font in one font size.
    units: f32,
    /// What stands for a sign that the font does not have: a box.
    missing: Glyph,
    /// In the order of signs.
    glyphs: &'static [Glyph],
}

include!(concat!(env!("OUT_DIR"), "/glyphs.rs"));

impl Font {
    /// The upright letters.
    pub fn of_weight(bold: bool) -> &'static Self {
        if bold { &BOLD } else { &REGULAR }
    }

    fn glyph(&self, sign: char) -> &Glyph {
        let found = self.glyphs.binary_search_by_key(&sign, |glyph| glyph.sign);
        found.map_or(&self.missing, |index| &self.glyphs[index])
    }

    /// How wide a text is.
    pub fn width(&self, text: &str, size: f32) -> f32 {
        text.chars().map(|sign| f32::from(self.glyph(sign).advance)).sum::<f32>() * size / self.units
    }

    /// Adds the outlines of a text that begins at (x, y) on its base line.
    pub fn draw(&self, text: &str, size: f32, (mut x, y): (f32, f32), path: &mut PathBuilder) {
        let scale = size / self.units;
        for sign in text.chars() {
            let glyph = self.glyph(sign);
            let at = |px: i16, py: i16| (x + scale * f32::from(px), y - scale * f32::from(py));
            for piece in glyph.outline {
                match *piece {
                    Move(px, py) => {
                        let (px, py) = at(px, py);
                        path.move_to(px, py);
                    }
                    Line(px, py) => {
                        let (px, py) = at(px, py);
                        path.line_to(px, py);
                    }
                    Curve(cx, cy, px, py) => {
                        let ((cx, cy), (px, py)) = (at(cx, cy), at(px, py));
                        path.quad_to(cx, cy, px, py);
                    }
                    Close => path.close(),
                }
            }
            x += scale * f32::from(glyph.advance);
        }
    }
}
