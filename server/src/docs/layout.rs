//! The frame of every page: what is there, where one is, and what the page holds.

use std::fmt::Write as _;

use triad_lessons::rendering::html::escape;

use super::article::Article;

/// Style and program of the pages, beside the colours and measures of the workbench.
pub(super) const PARTS: [(&str, &str); 3] = [
    ("tokens.css", include_str!("../../../web/src/styles/tokens.css")),
    ("docs.css", include_str!("docs.css")),
    ("docs.js", include_str!("docs.js")),
];
const MARK: &str = include_str!("../../../web/src/mark.svg");

/// One page of the site.
pub(super) fn page(
    file: &str,
    article: &Article,
    articles: &[(&str, &str, &str, Article)],
    home: Option<&str>,
) -> String {
    let title = escape(article.title());
    let back = home.map_or_else(String::new, |home| format!("<a href=\"{home}\">Workbench</a>"));
    // The mark says nothing that the name beside it does not.
    let mark = MARK.trim().replacen("<svg ", "<svg aria-hidden=\"true\" width=\"28\" height=\"28\" ", 1);
    // Written into the page: copied to any place it asks for nothing else.
    let icon = MARK.trim().replace('"', "'").replace('#', "%23");
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{title} · Triad</title>\n<link rel=\"icon\" \
         href=\"data:image/svg+xml,{icon}\">\n<link rel=\"stylesheet\" \
         href=\"tokens.css\">\n<link rel=\"stylesheet\" href=\"docs.css\">\n<script src=\"docs.js\"></script>\n</head>\n\
         <body>\n<a class=\"skip\" href=\"#text\">To the text</a>\n<header>\n<a class=\"name\" href=\"index.html\">{mark}Triad</a>\n\
         <search><label for=\"query\">Search</label><input id=\"query\" type=\"search\" autocomplete=\"off\" spellcheck=\"false\" \
         aria-describedby=\"count\"><p id=\"count\" role=\"status\"></p><ol id=\"found\" hidden></ol></search>\n{back}\n\
         <button id=\"theme\" type=\"button\">Light or dark</button>\n</header>\n<div class=\"columns\">\n{nav}<main id=\"text\" tabindex=\"-1\">\
         \n{text}</main>\n{parts}</div>\n</body>\n</html>\n",
        nav = pages(file, articles),
        text = article.html,
        parts = parts(article),
    )
}

/// The list of all pages; on a narrow screen it is folded.
fn pages(file: &str, articles: &[(&str, &str, &str, Article)]) -> String {
    let mut groups: Vec<&str> = articles.iter().map(|(_, _, group, _)| *group).collect();
    groups.dedup();
    let mut out = "<nav aria-label=\"Pages\"><details open><summary>Pages</summary>\n".to_owned();
    for group in groups {
        let _ = writeln!(out, "<p class=\"group\">{group}</p><ul>");
        for (own, label, ..) in articles.iter().filter(|(_, _, of, _)| *of == group) {
            let here = if *own == file { " aria-current=\"page\"" } else { "" };
            let _ = writeln!(out, "<li><a href=\"{own}\"{here}>{}</a></li>", escape(label));
        }
        out.push_str("</ul>\n");
    }
    out + "</details></nav>\n"
}

/// The parts of a page.
fn parts(article: &Article) -> String {
    let parts: Vec<_> = article.sections.iter().filter(|section| section.level == 2).collect();
    if parts.len() < 2 {
        return String::new();
    }
    let mut out =
        "<nav class=\"parts\" aria-label=\"On this page\"><p class=\"group\">On this page</p><ul>\n"
            .to_owned();
    for part in parts {
        let _ = writeln!(out, "<li><a href=\"#{}\">{}</a></li>", escape(&part.id), escape(&part.heading));
    }
    out + "</ul></nav>\n"
}
