//! A document as a page's text: Markdown of the repository becomes HTML with places to link to, and words to search for.

use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};
use triad_lessons::rendering::html::escape;

/// A part of an article, from a heading to the next.
#[derive(Debug, Clone, Default)]
pub(super) struct Section {
    /// Its place in the page; empty for what stands before the first heading with one.
    pub id: String,
    /// Its heading.
    pub heading: String,
    /// 1 for the title of the page, 2 for its parts, and so on.
    pub level: usize,
    /// Its text, without markup.
    pub words: String,
}

/// The text of a page.
#[derive(Debug, Clone, Default)]
pub(super) struct Article {
    /// As HTML.
    pub html: String,
    /// Its parts, in their order.
    pub sections: Vec<Section>,
}

impl Article {
    /// Its title.
    pub fn title(&self) -> &str {
        self.sections.first().map_or("", |first| &first.heading)
    }
}

/// Reads Markdown. `address` tells where a link leads in the site; what leads nowhere stays as text.
pub(super) fn read(text: &str, address: &dyn Fn(&str) -> Option<String>) -> Article {
    let options = Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH;
    let events: Vec<Event> = Parser::new_ext(text, options).collect();
    let mut reader = Reader {
        address,
        article: Article::default(),
        out: Vec::new(),
        in_maths: false,
        dropped: Vec::new(),
    };
    if !matches!(events.first(), Some(Event::Start(Tag::Heading { level: HeadingLevel::H1, .. }))) {
        // A text that is made to stand below a title of its own, as the theory does in the library's documentation.
        reader.title("The equations");
    }
    for (index, event) in events.iter().enumerate() {
        match event {
            Event::Start(Tag::Heading { level, .. }) => reader.heading(*level as usize, &events[index + 1..]),
            other => reader.take(other.clone()),
        }
    }
    let Reader { mut article, out, .. } = reader;
    html::push_html(&mut article.html, out.into_iter());
    // A heading without words is none.
    article.html = article.html.replace("<th></th>", "<td></td>");
    article
}

struct Reader<'a, 'e> {
    address: &'a dyn Fn(&str) -> Option<String>,
    article: Article,
    out: Vec<Event<'e>>,
    /// Within a formula, whose letters are no words.
    in_maths: bool,
    /// For each open link, whether it is left out.
    dropped: Vec<bool>,
}

impl<'e> Reader<'_, 'e> {
    fn raw(&mut self, html: impl Into<String>) {
        self.out.push(Event::Html(CowStr::from(html.into())));
    }

    fn title(&mut self, heading: &str) {
        self.raw(format!("<h1>{}</h1>\n", escape(heading)));
        self.article.sections.push(Section { heading: heading.to_owned(), level: 1, ..Section::default() });
    }

    /// Begins a section, whose heading is in the events up to its end.
    fn heading(&mut self, level: usize, rest: &[Event<'e>]) {
        let own = rest.iter().take_while(|event| !matches!(event, Event::End(TagEnd::Heading(_))));
        let heading: String = own
            .filter_map(|event| match event {
                Event::Text(text) | Event::Code(text) => Some(text.as_ref()),
                _ => None,
            })
            .collect();
        let id = if level == 1 { String::new() } else { self.free(&place(&heading)) };
        if level == 1 {
            self.raw("<h1>");
        } else {
            self.raw(format!("<h{level} id=\"{}\">", escape(&id)));
        }
        self.article.sections.push(Section { id, heading, level, words: String::new() });
    }

    /// A place that no section has yet.
    fn free(&self, wanted: &str) -> String {
        let taken = |id: &str| self.article.sections.iter().any(|section| section.id == id);
        let numbered = (1..).map(|k| format!("{wanted}-{k}"));
        std::iter::once(wanted.to_owned()).chain(numbered).find(|id| !taken(id)).unwrap_or_default()
    }

    fn take(&mut self, event: Event<'e>) {
        self.read_words(&event);
        match event {
            Event::End(TagEnd::Heading(level)) => self.raw(format!("</h{}>\n", level as usize)),
            Event::Start(Tag::Link { dest_url, .. }) => {
                let found = (self.address)(&dest_url);
                self.dropped.push(found.is_none());
                if let Some(found) = found {
                    self.raw(format!("<a href=\"{}\">", escape(&found)));
                }
            }
            Event::End(TagEnd::Link) => {
                if self.dropped.pop() == Some(false) {
                    self.raw("</a>");
                }
            }
            Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
                let dest_url = (self.address)(&dest_url).map_or(dest_url, CowStr::from);
                self.out.push(Event::Start(Tag::Image { link_type, dest_url, title, id }));
            }
            Event::Start(Tag::CodeBlock(_)) => self.raw("<pre tabindex=\"0\"><code>"),
            Event::End(TagEnd::CodeBlock) => self.raw("</code></pre>\n"),
            Event::Start(table @ Tag::Table(_)) => {
                self.raw("<div class=\"scroll\" tabindex=\"0\">");
                self.out.push(Event::Start(table));
            }
            Event::End(end @ TagEnd::Table) => {
                self.out.push(Event::End(end));
                self.raw("</div>\n");
            }
            Event::Html(text) | Event::InlineHtml(text) if text.starts_with("<!--") => {}
            other => self.out.push(other),
        }
    }

    fn read_words(&mut self, event: &Event) {
        let Some(section) = self.article.sections.last_mut() else { return };
        match event {
            Event::InlineHtml(tag) if tag.starts_with("<math") => self.in_maths = true,
            Event::InlineHtml(tag) if tag.starts_with("</math") => self.in_maths = false,
            Event::Text(text) | Event::Code(text) if !self.in_maths => section.words.push_str(text),
            Event::SoftBreak
            | Event::HardBreak
            | Event::End(
                TagEnd::Paragraph | TagEnd::Heading(_) | TagEnd::Item | TagEnd::TableCell | TagEnd::CodeBlock,
            ) if !section.words.ends_with(' ') => section.words.push(' '),
            _ => {}
        }
    }
}

/// A heading as a place, as most programs that show Markdown make it: small letters and digits, dashes for spaces.
pub(super) fn place(heading: &str) -> String {
    let letters = heading.trim().chars().filter_map(|c| match c {
        ' ' | '-' => Some('-'),
        c if c.is_alphanumeric() || c == '_' => Some(c),
        _ => None,
    });
    letters.flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_are_places_links_are_kept_and_words_are_read() {
        let text = "# T\nbegin\n## A *b*, c!\nSee [x](x.md#y) and [lost](lost.md).\n\n|a|\n|-|\n|1|\n\n## A b c\n`code`";
        let article = read(text, &|target| target.strip_prefix("x.md").map(|rest| format!("x.html{rest}")));
        assert_eq!(article.title(), "T");
        let ids: Vec<&str> = article.sections.iter().map(|section| section.id.as_str()).collect();
        assert_eq!(ids, ["", "a-b-c", "a-b-c-1"]);
        assert!(article.html.contains("<h2 id=\"a-b-c\">A <em>b</em>, c!</h2>"), "{}", article.html);
        assert!(article.html.contains("<a href=\"x.html#y\">x</a> and lost."), "{}", article.html);
        assert!(article.html.contains("<div class=\"scroll\" tabindex=\"0\"><table>"), "{}", article.html);
        assert!(
            article.sections[1].words.contains("See x and lost.")
                && article.sections[2].words.contains("code")
        );
    }

    #[test]
    fn formulas_pass_and_their_letters_are_no_words() {
        let article =
            read("# T\nof <math><mi>q</mi></math> and\n\n<div id=\"eq-1\"><math></math></div>\n", &|_| None);
        assert!(article.html.contains("<mi>q</mi>") && article.html.contains("id=\"eq-1\""));
        assert!(!article.sections[0].words.contains('q'), "{}", article.sections[0].words);
    }
}
