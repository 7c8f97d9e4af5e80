//! Figures: SVG that is put into the page itself, so that it takes the colour of the text around it.
//!
//! Since it becomes part of the page, only a list of harmless elements and attributes is accepted.

use std::collections::BTreeSet;

use roxmltree::{Document, Node, NodeType};
use thiserror::Error;

use super::html::escape;

/// Namespace of SVG.
const SVG: &str = "http://www.w3.org/2000/svg";
/// Namespace of the prefix `xml`, which every document has.
const XML: &str = "http://www.w3.org/XML/1998/namespace";

/// Deepest nesting of elements.
const MAX_DEPTH: usize = 40;

/// Elements that draw and do nothing else.
const ELEMENTS: &[&str] = &[
    "svg", "g", "path", "line", "circle", "ellipse", "rect", "polyline", "polygon", "text", "tspan", "defs",
    "marker", "title", "desc",
];

/// Attributes that neither run nor load anything.
const ATTRIBUTES: &[&str] = &[
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
        problem: String,
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

/// A figure that may be put into a page: what the browser gets is written from the tree that was checked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// Ids that it defines; they must be unique in the whole page.
    pub ids: BTreeSet<String>,
    /// Attributes of the svg element, and everything inside and after it.
    inner: String,
}

impl Figure {
    /// Reads and checks an SVG file.
    ///
    /// Errors if it is not SVG, or has elements or attributes that are not on the lists.
    pub fn parse(svg: &str) -> Result<Self, FigureError> {
        if !svg.starts_with("<svg ") || !svg.trim_end().ends_with("</svg>") {
            let problem = "the file begins with <svg and ends with </svg>".to_owned();
            return Err(FigureError::Malformed { line: 1, problem });
        }
        let document = Document::parse(svg).map_err(|error| FigureError::Malformed {
            line: usize::try_from(error.pos().row).unwrap_or(1),
            problem: error.to_string(),
        })?;
        let root = document.root_element();
        if !root.has_attribute("viewBox") {
            let problem = "the svg element needs a viewBox, so that the figure can be scaled".to_owned();
            return Err(FigureError::Malformed { line: 1, problem });
        }
        let mut ids = BTreeSet::new();
        for node in document.descendants() {
            checked(node, &mut ids)?;
        }
        let mut written = String::with_capacity(svg.len());
        write_element(root, &mut written);
        let inner = written.strip_prefix("<svg").unwrap_or_default().to_owned();
        Ok(Self { ids, inner })
    }

    /// The figure as HTML: the SVG with its description for those who cannot see it, and its caption.
    pub(crate) fn html(&self, alt: &str, caption: &str) -> String {
        let caption = if caption.is_empty() {
            String::new()
        } else {
            format!("<figcaption>{}</figcaption>", escape(caption))
        };
        format!(
            "<figure class=\"figure\"><svg role=\"img\" aria-label=\"{}\"{}{caption}</figure>",
            escape(alt),
            self.inner
        )
    }
}

/// Refuses whatever is not on the lists, and collects ids.
fn checked(node: Node, ids: &mut BTreeSet<String>) -> Result<(), FigureError> {
    let line = || usize::try_from(node.document().text_pos_at(node.range().start).row).unwrap_or(1);
    let forbidden = |what: String| Err(FigureError::Forbidden { line: line(), what });
    match node.node_type() {
        NodeType::Root | NodeType::Text => return Ok(()),
        NodeType::Comment => return forbidden("a comment".to_owned()),
        NodeType::PI => return forbidden("a processing instruction".to_owned()),
        NodeType::Element => {}
    }
    if node.ancestors().take(MAX_DEPTH + 2).count() > MAX_DEPTH {
        return forbidden("deep nesting".to_owned());
    }
    let name = node.tag_name();
    if !ELEMENTS.contains(&name.name()) || name.namespace().is_some_and(|n| n != SVG) {
        return forbidden(format!("<{}>", name.name()));
    }
    if node.namespaces().any(|n| n.name().is_some() && n.uri() != XML || n.name().is_none() && n.uri() != SVG)
    {
        return forbidden("a namespace other than that of SVG".to_owned());
    }
    for attribute in node.attributes() {
        let (key, value) = (attribute.name(), attribute.value());
        if attribute.namespace().is_some() || !ATTRIBUTES.contains(&key) {
            return forbidden(format!("the attribute {key}"));
        }
        if !is_harmless(key, value) {
            return forbidden(format!("the value {value}"));
        }
        if matches!(key, "fill" | "stroke") && !COLOURS.contains(&value) {
            return Err(FigureError::Colour { line: line(), colour: value.to_owned() });
        }
        if key == "id" && !ids.insert(value.to_owned()) {
            return forbidden(format!("a second element with the id {value}"));
        }
    }
    Ok(())
}

/// Whether a value loads nothing: brackets stand in transforms or around the id of a marker, and CSS escapes,
/// addresses and entities nowhere.
fn is_harmless(key: &str, value: &str) -> bool {
    let reference = value.strip_prefix("url(#").and_then(|v| v.strip_suffix(')'));
    let plain_id = |id: &str| id.chars().all(|c| c.is_alphanumeric() || matches!(c, '-' | '_' | '.'));
    if let Some(id) = reference {
        return plain_id(id);
    }
    let call = value.contains('(') && key != "transform" || value.to_lowercase().contains("url(");
    !call && !value.contains([':', '&', '\\', '<', '>', '"']) && !value.contains("//")
}

/// Writes an element as it was checked, with everything in it.
fn write_element(node: Node, out: &mut String) {
    let name = node.tag_name().name();
    out.push('<');
    out.push_str(name);
    let inherited = node.parent_element().and_then(|parent| parent.default_namespace());
    if let Some(uri) = node.default_namespace().filter(|uri| Some(*uri) != inherited) {
        write_attribute("xmlns", uri, out);
    }
    for attribute in node.attributes() {
        write_attribute(attribute.name(), attribute.value(), out);
    }
    if !node.has_children() {
        out.push_str("/>");
        return;
    }
    out.push('>');
    for child in node.children() {
        match child.text() {
            Some(text) if child.is_text() => out.push_str(&escape_text(text)),
            _ => write_element(child, out),
        }
    }
    out.push_str("</");
    out.push_str(name);
    out.push('>');
}

fn write_attribute(name: &str, value: &str, out: &mut String) {
    out.push(' ');
    out.push_str(name);
    out.push_str("=\"");
    out.push_str(&escape(value));
    out.push('"');
}

/// Text between elements: quotation marks need no escape there.
fn escape_text(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\">\n<g stroke=\"currentColor\"><path id=\"a\" d=\"M0 0L9 9\" marker-end=\"url(#tip)\"/><text x=\"1\">a &lt; b</text></g>\n</svg>\n";

    /// The good figure with something before its group.
    fn with(bad: &str) -> Result<Figure, FigureError> {
        Figure::parse(&GOOD.replace("<g stroke", &format!("{bad}<g stroke")))
    }

    #[test]
    fn plain_shapes_pass_and_are_written_as_they_were() {
        let figure = Figure::parse(GOOD).unwrap();
        assert_eq!(figure.ids.len(), 1);
        assert_eq!(format!("<svg{}\n", figure.inner), GOOD);
    }

    #[test]
    fn elements_that_could_run_or_load_are_refused() {
        for bad in [
            "<script>1</script>",
            "<SCRIPT/>",
            "<foreignObject/>",
            "<foreignObject><body xmlns=\"http://www.w3.org/1999/xhtml\" onload=\"x()\"/></foreignObject>",
            "<x:script xmlns:x=\"http://www.w3.org/2000/svg\">1</x:script>",
            "<path xmlns=\"http://www.w3.org/1999/xhtml\"/>",
            "<g onload=\"x()\"/>",
            "<g onclick='x()'/>",
            "<style>*{fill:url(//x)}</style>",
            "<animate attributeName=\"href\"/>",
            "<set attributeName=\"onload\" to=\"x()\"/>",
            "<use href=\"#a\"/>",
            "<a href=\"javascript:x()\"><path d=\"M0 0\"/></a>",
            "<image href=\"http://x/y.png\"/>",
            "<g xmlns:xlink=\"http://www.w3.org/1999/xlink\"><path xlink:href=\"http://x\"/></g>",
            "<path d=\"M0 0\" fill=\"url(http://x)\"/>",
            "<path d=\"M0 0\" marker-end=\"url(//x)\"/>",
            "<path d=\"M0 0\" marker-end=\"URL(//x)\"/>",
            "<path d=\"M0 0\" marker-end=\"u\\72l(x)\"/>",
            "<path d=\"M0 0\" marker-end=\"url(#a)url(x)\"/>",
            "<path d=\"M0 0\" marker-end=\"image-set('x')\"/>",
            "<path d=\"M0 0\" id=\"&#34;&#62;&#60;script&#62;\"/>",
            "<text style=\"x\">a</text>",
            "<text font-family=\"java&#115;cript&#58;x\">a</text>",
            "<!-- comment -->",
            "<!-- > <script>1</script> -->",
            "<?xml-stylesheet href=\"x.css\"?>",
            "&xxe;",
        ] {
            assert!(with(bad).is_err(), "{bad}");
        }
        assert!(with(&format!("{}{}", "<g>".repeat(100_000), "</g>".repeat(100_000))).is_err());
        let entity = format!("<!DOCTYPE svg [<!ENTITY x \"y\">]>{GOOD}");
        assert!(Figure::parse(&entity).is_err());
    }

    #[test]
    fn text_stays_text() {
        for bad in ["&lt;script&gt;1&lt;/script&gt;", "<![CDATA[<script>1</script>]]>"] {
            let html = with(&format!("<text>{bad}</text>")).unwrap().html("what it shows", "");
            assert!(html.contains("<text>&lt;script&gt;1&lt;/script&gt;</text>"), "{html}");
        }
    }

    #[test]
    fn errors_name_the_line() {
        let svg = GOOD.replace("currentColor", "black");
        assert_eq!(Figure::parse(&svg), Err(FigureError::Colour { line: 2, colour: "black".to_owned() }));
        let open = Figure::parse(&GOOD.replace("</g>", "")).unwrap_err();
        assert!(matches!(open, FigureError::Malformed { line: 3, .. }), "{open}");
        assert!(Figure::parse("<p>").is_err());
    }
}
