//! The letters of plots that become PNG: outlines of the signs that plots write, taken out of DejaVu Sans (1.5 MB).

use std::error::Error;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs};

use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// What plots write: ASCII, signs and letters of western Europe, Greek, and a few of mathematics.
fn signs() -> impl Iterator<Item = char> {
    (' '..='~').chain('\u{a0}'..='ÿ').chain('Α'..='ω').chain("–—‘’“”…′″→−√∞≈≤≥".chars())
}

/// Writes the table that `cli/measure/raster/letters.rs` includes.
pub fn write() -> Result<(), Box<dyn Error>> {
    let mut table = String::new();
    font(&mut table, "REGULAR", dejavu::sans::regular())?;
    font(&mut table, "BOLD", dejavu::sans::bold())?;
    fs::write(PathBuf::from(env::var("OUT_DIR")?).join("glyphs.rs"), table)?;
    Ok(())
}

fn font(table: &mut String, name: &str, bytes: &[u8]) -> Result<(), Box<dyn Error>> {
    let face = Face::parse(bytes, 0)?;
    let mut signs: Vec<char> = signs().filter(|sign| face.glyph_index(*sign).is_some()).collect();
    signs.sort_unstable();
    signs.dedup();
    writeln!(table, "static {name}: Font = Font {{ units: {}.0, missing: ", face.units_per_em())?;
    glyph(table, &face, '\0', GlyphId(0))?;
    writeln!(table, ", glyphs: &[")?;
    for sign in signs {
        glyph(table, &face, sign, face.glyph_index(sign).unwrap_or_default())?;
        table.push_str(",\n");
    }
    table.push_str("] };\n");
    Ok(())
}

fn glyph(table: &mut String, face: &Face<'_>, sign: char, id: GlyphId) -> Result<(), Box<dyn Error>> {
    let advance = face.glyph_hor_advance(id).unwrap_or_default();
    write!(table, "Glyph {{ sign: {sign:?}, advance: {advance}, outline: &[")?;
    // A sign without an outline, like the space, leaves the list empty.
    face.outline_glyph(id, &mut Outline(table));
    table.push_str("] }");
    Ok(())
}

/// Writes the pieces of an outline; units of the font are whole numbers of 16 bits.
struct Outline<'t>(&'t mut String);

impl Outline<'_> {
    fn piece(&mut self, kind: &str, numbers: &[f32]) {
        let numbers: Vec<String> = numbers.iter().map(|x| format!("{x:.0}")).collect();
        let _ = write!(self.0, "{kind}({}),", numbers.join(","));
    }
}

impl OutlineBuilder for Outline<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.piece("Move", &[x, y]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.piece("Line", &[x, y]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.piece("Curve", &[x1, y1, x, y]);
    }

    fn curve_to(&mut self, _: f32, _: f32, _: f32, _: f32, x: f32, y: f32) {
        // TrueType has curves of the second order only.
        self.piece("Line", &[x, y]);
    }

    fn close(&mut self) {
        self.0.push_str("Close,");
    }
}
