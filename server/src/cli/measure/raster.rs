//! Drawings as pixels, for slides and papers that take no SVG.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, Options, Tree};

/// Pixels for one unit of the drawing: sharp on a projector.
const SCALE: f32 = 2.0;

/// Why a drawing has no picture of pixels.
#[derive(Debug, thiserror::Error)]
pub(in crate::cli) enum RasterError {
    /// The drawing is not SVG.
    #[error("the drawing cannot be read: {0}")]
    Drawing(#[from] usvg::Error),
    /// The drawing has no size, or one that memory cannot hold.
    #[error("a picture of {width} by {height} pixels cannot be made")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// The pixels are not to be had as PNG.
    #[error("the picture cannot be written as PNG: {0}")]
    Encoding(String),
}

/// An SVG drawing as PNG, with a font of its own, so that it looks alike on every machine.
pub(in crate::cli) fn png(svg: &str) -> Result<Vec<u8>, RasterError> {
    let mut options = Options::default();
    let fonts = options.fontdb_mut();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let tree = Tree::from_str(svg, &options)?;
    let size = tree.size().to_int_size().scale_by(SCALE);
    let (width, height) = size.map_or((0, 0), |size| (size.width(), size.height()));
    let mut pixels = Pixmap::new(width, height).ok_or(RasterError::Size { width, height })?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| RasterError::Encoding(error.to_string()))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Width, height and the brightness of one pixel cannot be read without a decoder; the lengths of two pictures that
    /// differ in one word tell that the word was drawn.
    #[test]
    fn words_are_drawn_and_what_is_no_drawing_is_refused() {
        let drawing = |word: &str| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"80\" height=\"20\" \
                 font-family=\"system-ui, sans-serif\"><text x=\"4\" y=\"14\">{word}</text></svg>"
            )
        };
        let (empty, full) = (png(&drawing("")).unwrap(), png(&drawing("time")).unwrap());
        let size = |picture: &[u8]| (picture[16..24].to_vec(), picture.len());
        assert_eq!(size(&empty).0, [0, 0, 0, 160, 0, 0, 0, 40], "twice the drawing's size");
        assert!(size(&full).1 > size(&empty).1 + 200, "{} {}", full.len(), empty.len());
        assert!(matches!(png("no drawing"), Err(RasterError::Drawing(_))));
    }
}
