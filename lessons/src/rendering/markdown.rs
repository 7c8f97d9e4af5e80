//! From Markdown to safe HTML: maths is kept as TeX for the page to set, raw HTML is never passed on.
//!
//! `$…$` becomes `<span class="math inline">`, `$$…$$` becomes `<div class="math display">`; a `\tag{2.1}` in it
//! gives the div the id `eq-2.1`, to which `[eq. (2.1)](#eq-2.1)` links.

use std::collections::BTreeMap;

use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd};

use super::figure::Figure;
use super::html::escape;

/// Shortest description of a figure, in bytes.
const MIN_DESCRIPTION: usize = 10;

/// Rendered text, with what a checker wants to know about it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Rendered {
    /// Safe HTML.
    pub html: String,
    /// Labels of the numbered equations, in order: `2.1`, with the line they stand in.
    pub labels: Vec<(String, usize)>,
    /// Targets of all links, with their line.
    pub links: Vec<(String, usize)>,
    /// Figures that were used, as paths below the lesson's folder.
    pub figures: Vec<String>,
    /// What an author has to put right: line and sentence.
    pub problems: Vec<(usize, String)>,
}

/// Renders Markdown. `figures` are the SVG files that `![description](figures/name.svg "caption")` may name.
pub fn render(text: &str, figures: &BTreeMap<String, String>) -> Rendered {
    let options = Options::ENABLE_MATH | Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH;
    let mut renderer = Renderer::new(figures);
    for (event, range) in Parser::new_ext(text, options).into_offset_iter() {
        let line = text[..range.start].matches('\n').count() + 1;
        renderer.take(event, line);
    }
    renderer.finish()
}

/// An image whose description is being read.
struct Image {
    path: String,
    caption: String,
    alt: String,
}

/// What has been rendered so far.
struct Renderer<'a> {
    figures: &'a BTreeMap<String, String>,
    out: Rendered,
    events: Vec<Event<'a>>,
    image: Option<Image>,
    /// Inside a link that is not passed on.
    skips_link: bool,
    /// Line of the first dollar sign that is no formula.
    dollar: Option<usize>,
}

impl<'a> Renderer<'a> {
    fn new(figures: &'a BTreeMap<String, String>) -> Self {
        let (out, events) = (Rendered::default(), Vec::new());
        Self { figures, out, events, image: None, skips_link: false, dollar: None }
    }

    fn problem(&mut self, line: usize, what: impl Into<String>) {
        self.out.problems.push((line, what.into()));
    }

    fn take(&mut self, event: Event<'a>, line: usize) {
        if let Some(image) = &mut self.image {
            match event {
                Event::Text(t) | Event::Code(t) | Event::InlineMath(t) => image.alt.push_str(&t),
                Event::SoftBreak => image.alt.push(' '),
                Event::End(TagEnd::Image) => self.end_image(line),
                _ => {}
            }
            return;
        }
        match event {
            Event::InlineMath(tex) => {
                self.events.push(raw(format!("<span class=\"math inline\">{}</span>", escape(&tex))));
            }
            Event::DisplayMath(tex) => self.display_math(&tex, line),
            Event::Html(html) | Event::InlineHtml(html) => {
                self.problem(line, "raw HTML is not passed on; write Markdown instead");
                self.events.push(Event::Text(html));
            }
            Event::Start(Tag::Image { dest_url, title, .. }) => {
                let (path, caption) = (dest_url.to_string(), title.to_string());
                self.image = Some(Image { path, caption, alt: String::new() });
            }
            Event::Start(Tag::Link { ref dest_url, .. }) => {
                self.skips_link = !is_safe_link(dest_url);
                if self.skips_link {
                    self.problem(line, format!("the link {dest_url} is not https, #… or /…"));
                } else {
                    self.out.links.push((dest_url.to_string(), line));
                    self.events.push(event);
                }
            }
            Event::End(TagEnd::Link) if self.skips_link => self.skips_link = false,
            Event::SoftBreak if self.is_after_block() => {}
            other => {
                if matches!(&other, Event::Text(t) if t.contains('$')) {
                    self.dollar.get_or_insert(line);
                }
                self.events.push(other);
            }
        }
    }

    fn display_math(&mut self, tex: &str, line: usize) {
        let label = label(tex);
        let id = label.as_ref().map(|l| format!(" id=\"eq-{l}\"")).unwrap_or_default();
        self.out.labels.extend(label.map(|l| (l, line)));
        self.block(&format!("<div class=\"math display\"{id}>{}</div>", escape(tex.trim())));
    }

    fn end_image(&mut self, line: usize) {
        let Some(Image { path, caption, alt }) = self.image.take() else { return };
        if alt.trim().len() < MIN_DESCRIPTION {
            self.problem(line, format!("the figure {path} needs a description: ![what it shows]({path})"));
        }
        match self.figures.get(&path).map(|svg| Figure::parse(svg)) {
            None => self.problem(line, format!("there is no figure {path}; it belongs into figures/")),
            Some(Err(error)) => self.problem(line, format!("{path}: {error}")),
            Some(Ok(figure)) => self.block(&figure.html(alt.trim(), &caption)),
        }
        self.out.figures.push(path);
    }

    /// Puts a block inside a paragraph by closing the paragraph around it.
    fn block(&mut self, html: &str) {
        if matches!(self.events.last(), Some(Event::SoftBreak)) {
            self.events.pop();
        }
        self.events.push(raw(format!("</p>\n{html}\n<p>")));
    }

    fn is_after_block(&self) -> bool {
        matches!(self.events.last(), Some(Event::InlineHtml(html)) if html.ends_with("<p>"))
    }

    fn finish(mut self) -> Rendered {
        pulldown_cmark::html::push_html(&mut self.out.html, self.events.into_iter());
        if let Some(line) = self.dollar {
            let what = "a $ is left in the text: formulas are $…$ or $$…$$, without spaces inside";
            self.out.problems.push((line, what.to_owned()));
        }
        self.out.html = self.out.html.replace("<p></p>\n", "").replace("<p></p>", "");
        self.out
    }
}

/// HTML of our own making.
fn raw(html: String) -> Event<'static> {
    Event::InlineHtml(CowStr::from(html))
}

fn label(tex: &str) -> Option<String> {
    let label = tex.split_once("\\tag{")?.1.split_once('}')?.0.trim().to_owned();
    let fits = !label.is_empty() && label.chars().all(|c| c.is_ascii_alphanumeric() || c == '.');
    fits.then_some(label)
}

fn is_safe_link(target: &str) -> bool {
    target.starts_with("https://")
        || target.starts_with('#')
        || (target.starts_with('/') && !target.starts_with("//"))
}

/// Renders a short text (a prompt, a hint, a feedback) that has no figures.
pub fn render_short(text: &str) -> String {
    render(text.trim(), &BTreeMap::new()).html.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maths_is_kept_for_the_page_and_labelled() {
        let text = "Let $a<b$ hold.\n\n$$\na < b \\tag{2.1}\n$$\n\nSee [eq. (2.1)](#eq-2.1).";
        let out = render(text, &BTreeMap::new());
        assert_eq!(
            out.html,
            "<p>Let <span class=\"math inline\">a&lt;b</span> hold.</p>\n<div class=\"math display\" \
             id=\"eq-2.1\">a &lt; b \\tag{2.1}</div>\n<p>See <a href=\"#eq-2.1\">eq. (2.1)</a>.</p>\n"
        );
        assert_eq!(out.labels, [("2.1".to_owned(), 3)]);
        assert_eq!(out.links, [("#eq-2.1".to_owned(), 7)]);
        assert!(out.problems.is_empty());
    }

    #[test]
    fn a_formula_inside_a_paragraph_splits_it() {
        let out = render("Before\n$$x$$\nafter.", &BTreeMap::new());
        assert_eq!(out.html, "<p>Before</p>\n<div class=\"math display\">x</div>\n<p>after.</p>\n");
    }

    #[test]
    fn a_formula_that_is_not_closed_is_seen() {
        assert_eq!(render("one $x^2 and no end", &BTreeMap::new()).problems.len(), 1);
        assert!(render("one $x^2$ and an end", &BTreeMap::new()).problems.is_empty());
    }

    #[test]
    fn html_and_scripts_do_not_get_through() {
        for text in [
            "<script>alert(1)</script>",
            "a <img src=x onerror=alert(1)> b",
            "[x](javascript:alert(1))",
            "[x](//evil.example)",
            "$</span><script>alert(1)</script>$",
            "![<script>](figures/none.svg)",
            "```<script>\n</code><script>\n```",
            "[x](https://a.example/\"onmouseover=alert(1))",
        ] {
            let html = render(text, &BTreeMap::new()).html;
            assert!(!html.contains("<script") && !html.contains("<img"), "{html}");
            assert!(
                !html.contains("javascript:") && !html.contains("\"onmouse") && !html.contains("//evil"),
                "{html}"
            );
        }
        let problems = render("one\n\n<b>x</b>", &BTreeMap::new()).problems;
        assert_eq!(problems[0].0, 3);
    }

    #[test]
    fn figures_are_put_into_the_page_with_their_description() {
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1 1\"><circle r=\"1\"/></svg>\n";
        let figures = BTreeMap::from([("figures/a.svg".to_owned(), svg.to_owned())]);
        let out = render("![A circle of radius one](figures/a.svg \"Figure 1\")", &figures);
        assert!(
            out.html.starts_with(
                "<figure class=\"figure\"><svg role=\"img\" aria-label=\"A circle of radius one\""
            )
        );
        assert!(out.html.contains("<figcaption>Figure 1</figcaption>") && out.problems.is_empty());
        assert_eq!(render("![](figures/a.svg)", &figures).problems.len(), 1);
        assert_eq!(render("![A circle of radius one](figures/b.svg)", &figures).problems.len(), 1);
    }
}
