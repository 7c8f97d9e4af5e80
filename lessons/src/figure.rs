//! Figures: SVG that is put into the page itself, so that it takes the colour of the text around it.
//!
//! Since it becomes part of the page, only a list of harmless elements and attributes is accepted.

use std::collections::BTreeSet;

use thiserror::Error;

const ELEMENTS: &[&str] = &[
    "svg", "g", "path", "line", "circle", "ellipse", "rect", "polyline", "polygon", "text", "tspan", "defs",
    "marker", "title", "desc",
];

const ATTRIBUTES: &[&str] = &[
    "xmlns",
    "viewBox",
    "width",
    "height",
    "x",
    "y",
    "x1",
    "y1",
    "x2",
    "y2",
    "cx",
    "cy",
    "r",
    "rx",
    "ry",
    "d",
    "dx",
    "dy",
    "points",
    "fill",
    "stroke",
    "stroke-width",
    "stroke-dasharray",
    "stroke-linecap",
    "stroke-linejoin",
    "fill-opacity",
    "stroke-opacity",
    "opacity",
    "transform",
    "id",
    "font-size",
    "font-family",
    "font-style",
    "font-weight",
    "text-anchor",
    "dominant-baseline",
    "baseline-shift",
    "marker-start",
    "marker-mid",
    "marker-end",
    "markerWidth",
    "markerHeight",
    "refX",
    "refY",
    "orient",
    "markerUnits",
];

/// Colours that can be seen on light and on dark paper (contrast above 3:1 on white and on #16181d).
const COLOURS: &[&str] = &["none", "currentColor", "context-stroke", "#d9480f", "#1c7ed6", "#2b8a3e"];

/// Why a figure is refused.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FigureError {
    /// Not an SVG of its own, or not well formed.
    #[error("not readable as SVG at line {line}: {problem}")]
    Malformed {
        /// Line in the file, from 1.
        line: usize,
        /// What is wrong.
        problem: &'static str,
    },
    /// An element, attribute or value outside the accepted list.
    #[error("{what} is not accepted in a figure (line {line}); use plain shapes and text")]
    Forbidden {
        /// Line in the file, from 1.
        line: usize,
        /// The culprit.
        what: String,
    },
    /// A colour that vanishes on light or dark paper.
    #[error("the colour {colour} (line {line}) may vanish on light or dark paper; use one of {}", COLOURS.join(", "))]
    Colour {
        /// Line in the file, from 1.
        line: usize,
        /// The colour as written.
        colour: String,
    },
}

/// Checks a figure and returns the ids it defines.
pub fn check(svg: &str) -> Result<BTreeSet<String>, FigureError> {
    let line_at = |offset: usize| svg[..offset].matches('\n').count() + 1;
    let malformed = |offset, problem| FigureError::Malformed { line: line_at(offset), problem };
    if !svg.starts_with("<svg ") || !svg.trim_end().ends_with("</svg>") {
        return Err(malformed(0, "the file begins with <svg and ends with </svg>"));
    }
    if !svg[..svg.find('>').unwrap_or(0)].contains("viewBox=") {
        return Err(malformed(0, "the svg element needs a viewBox, so that the figure can be scaled"));
    }
    let mut ids = BTreeSet::new();
    let mut open: Vec<&str> = Vec::new();
    let mut at = 0;
    while let Some(start) = svg[at..].find('<').map(|i| at + i) {
        let end = svg[start..]
            .find('>')
            .map(|i| start + i)
            .ok_or_else(|| malformed(start, "a tag is not closed"))?;
        let tag = &svg[start + 1..end];
        at = end + 1;
        if let Some(name) = tag.strip_prefix('/') {
            if open.pop() != Some(name.trim()) {
                return Err(malformed(start, "the closing tags do not match the opening ones"));
            }
            continue;
        }
        let body = tag.strip_suffix('/').unwrap_or(tag);
        let name = body.split_whitespace().next().unwrap_or_default();
        let forbidden = |what: String| FigureError::Forbidden { line: line_at(start), what };
        if !ELEMENTS.contains(&name) {
            return Err(forbidden(format!("<{name}>")));
        }
        for (key, value) in attributes(&body[name.len()..])
            .ok_or_else(|| malformed(start, "an attribute is not written as name=\"value\""))?
        {
            if !ATTRIBUTES.contains(&key) {
                return Err(forbidden(format!("the attribute {key}")));
            }
            let reference = value.strip_prefix("url(#").and_then(|v| v.strip_suffix(')'));
            if key != "xmlns"
                && (value.contains(':')
                    || value.contains('&')
                    || (value.contains("url(") && reference.is_none()))
            {
                return Err(forbidden(format!("the value {value}")));
            }
            if matches!(key, "fill" | "stroke") && !COLOURS.contains(&value) {
                return Err(FigureError::Colour { line: line_at(start), colour: value.to_owned() });
            }
            if key == "id" && !ids.insert(value.to_owned()) {
                return Err(forbidden(format!("a second element with the id {value}")));
            }
        }
        if !tag.ends_with('/') {
            open.push(name);
        }
    }
    if open.is_empty() { Ok(ids) } else { Err(malformed(svg.len(), "an element is not closed")) }
}

/// Reads ` name="value"` pairs.
fn attributes(mut text: &str) -> Option<Vec<(&str, &str)>> {
    let mut out = Vec::new();
    loop {
        text = text.trim_start();
        if text.is_empty() {
            return Some(out);
        }
        let (key, rest) = text.split_once("=\"")?;
        let (value, rest) = rest.split_once('"')?;
        out.push((key.trim(), value));
        text = rest;
    }
}

/// The figure as HTML: the SVG with its description for those who cannot see it, and its caption.
pub(crate) fn html(svg: &str, alt: &str, caption: &str) -> String {
    use crate::markdown::escape;
    let body = svg.trim_end().strip_prefix("<svg").unwrap_or_default();
    let caption = if caption.is_empty() {
        String::new()
    } else {
        format!("<figcaption>{}</figcaption>", escape(caption))
    };
    format!(
        "<figure class=\"figure\"><svg role=\"img\" aria-label=\"{}\"{body}{caption}</figure>",
        escape(alt)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\">\n<g stroke=\"currentColor\"><path id=\"a\" d=\"M0 0L9 9\" marker-end=\"url(#tip)\"/></g>\n</svg>\n";

    #[test]
    fn plain_shapes_pass() {
        assert_eq!(check(GOOD).unwrap().len(), 1);
    }

    #[test]
    fn whatever_could_run_or_load_is_refused() {
        for bad in [
            "<script>1</script>",
            "<foreignObject/>",
            "<g onload=\"x()\"/>",
            "<image href=\"http://x/y.png\"/>",
            "<path d=\"M0 0\" fill=\"url(http://x)\"/>",
            "<text style=\"x\">a</text>",
            "<!-- comment -->",
        ] {
            let svg = GOOD.replace("<g stroke", &format!("{bad}<g stroke"));
            assert!(check(&svg).is_err(), "{bad}");
        }
    }

    #[test]
    fn errors_name_the_line() {
        let svg = GOOD.replace("currentColor", "black");
        assert_eq!(check(&svg), Err(FigureError::Colour { line: 2, colour: "black".to_owned() }));
        assert!(check(&GOOD.replace("</g>", "")).is_err());
        assert!(check("<p>").is_err());
    }
}
