//! The documentation as one site: pages, a search, pictures. The workbench serves it below `/docs/`, and `triad export docs`
//! writes it as files. Addresses within it are relative, so that it can lie anywhere, also on a disk.

mod article;
mod gallery;
mod interface;
mod layout;

use std::collections::BTreeMap;
use std::sync::OnceLock;

use axum::Router;
use axum::extract::Path;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::get;
use serde_json::{Value, json};

use article::Article;

/// How a scene is written, as Markdown: also printed by `triad scenes --guide`.
pub const GUIDE: &str = include_str!("../../../docs/SCENES.md");
/// Text and pictures, and the two small programs that come with them.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; \
                      frame-ancestors 'self'; base-uri 'none'; form-action 'none'";

/// A document of the repository.
struct Document {
    /// Its path in the repository.
    path: &'static str,
    /// Its file in the site.
    file: &'static str,
    /// What it is called in the list of pages.
    label: &'static str,
    /// Under which heading it stands there.
    group: &'static str,
    text: &'static str,
}

macro_rules! documents {
    ($($group:literal { $($path:literal as $file:literal, $label:literal;)* })*) => {
        /// The documents in the order of the list of pages.
        const DOCUMENTS: &[Document] = &[$($(Document {
            path: $path,
            file: $file,
            label: $label,
            group: $group,
            text: include_str!(concat!("../../../", $path)),
        }),*),*];
    };
}

documents! {
    "Begin" {
        "README.md" as "index.html", "What Triad is";
        "docs/SCENES.md" as "scenes.html", "Writing a scene";
        "engine/python/README.md" as "python.html", "Python and notebooks";
        "docs/GLOSSARY.md" as "glossary.html", "Words";
    }
    "Teach" {
        "lessons/README.md" as "course.html", "Writing a course";
        "docs/LMS.md" as "lms.html", "Your learning platform";
    }
    "Run" {
        "docs/OPERATING.md" as "operating.html", "Running it for others";
    }
    "Trust" {
        "docs/theory-mathml.md" as "theory.html", "The equations";
        "docs/ACCURACY.md" as "accuracy.html", "Accuracy";
        "docs/PERFORMANCE.md" as "performance.html", "Performance";
        "docs/TREATMENTS.md" as "treatments.html", "Treatments of constraints";
    }
    "Build" {
        "docs/ARCHITECTURE.md" as "architecture.html", "Architecture";
        "CONTRIBUTING.md" as "contributing.html", "Contributing";
        "CHANGELOG.md" as "changes.html", "Changes";
    }
}

/// The page that is made of the interface's description: file, label and group.
const INTERFACE: (&str, &str, &str) = ("http.html", "HTTP interface", "Build");
/// The page of mechanisms, behind the first.
const GALLERY: (&str, &str, &str) = ("gallery.html", "Ten mechanisms", "Begin");

/// Pictures that documents show: path in the repository, and content.
const PICTURES: [(&str, &str); 4] = [
    ("docs/workbench.svg", include_str!("../../../docs/workbench.svg")),
    ("docs/bricard.svg", include_str!("../../../docs/bricard.svg")),
    ("docs/beside.svg", include_str!("../../../docs/beside.svg")),
    ("docs/treatments.svg", include_str!("../../../docs/treatments.svg")),
];

/// The site: its files by their names.
#[derive(Debug, Clone)]
pub struct Site {
    files: BTreeMap<String, String>,
}

impl Site {
    /// Of the documents and the description of the HTTP interface (OpenAPI); `home` is the address of the workbench, where
    /// there is one beside the site.
    pub fn new(interface: &Value, home: Option<&str>) -> Self {
        let mut articles: Vec<(&str, &str, &str, Article)> = DOCUMENTS
            .iter()
            .map(|document| {
                let article = article::read(document.text, &|target| address(document.path, target));
                (document.file, document.label, document.group, article)
            })
            .collect();
        let (gallery, pictures) = gallery::article(home);
        let (file, label, group) = GALLERY;
        articles.insert(1, (file, label, group, gallery));
        let (file, label, group) = INTERFACE;
        articles.push((file, label, group, interface::article(interface)));
        let mut files: BTreeMap<String, String> = articles
            .iter()
            .map(|(file, .., article)| ((*file).to_owned(), layout::page(file, article, &articles, home)))
            .collect();
        files.insert("search.js".to_owned(), format!("globalThis.triadDocs = {};\n", index(&articles)));
        for (name, text) in layout::PARTS {
            files.insert(name.to_owned(), text.to_owned());
        }
        for (path, picture) in PICTURES {
            files.insert(picture_file(path), picture.to_owned());
        }
        files.extend(pictures);
        Self { files }
    }

    /// The files: name and content.
    pub fn files(&self) -> impl Iterator<Item = (&str, &str)> {
        self.files.iter().map(|(name, text)| (name.as_str(), text.as_str()))
    }
}

/// What the search looks through: a list of sections, each with its address, its page, its heading and its words.
fn index(articles: &[(&str, &str, &str, Article)]) -> Value {
    let sections = articles.iter().flat_map(|(file, label, _, article)| {
        article.sections.iter().map(move |section| {
            let address =
                if section.id.is_empty() { (*file).to_owned() } else { format!("{file}#{}", section.id) };
            json!([address, label, section.heading, section.words])
        })
    });
    sections.collect()
}

fn picture_file(path: &str) -> String {
    path.rsplit('/').next().unwrap_or(path).to_owned()
}

/// The address in the site of what a document at `path` links to: another page, a picture, a place in the page, or another
/// site. None for files that are only in the repository.
fn address(path: &str, target: &str) -> Option<String> {
    if target.starts_with('#') || target.starts_with("https://") || target.starts_with("http://") {
        return Some(target.to_owned());
    }
    let (file, place) = target.split_once('#').map_or((target, None), |(file, place)| (file, Some(place)));
    let mut parts: Vec<&str> = path.split('/').collect();
    parts.pop();
    for part in file.split('/') {
        match part {
            "." => {}
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    let wanted = parts.join("/");
    // The equations have a page of their own that can be read without a program.
    let wanted = if wanted == "THEORY.md" { "docs/theory-mathml.md" } else { wanted.as_str() };
    if PICTURES.iter().any(|(picture, _)| *picture == wanted) {
        return Some(picture_file(wanted));
    }
    let found = DOCUMENTS.iter().find(|document| document.path == wanted)?;
    Some(place.map_or_else(|| found.file.to_owned(), |place| format!("{}#{place}", found.file)))
}

/// The site below `/docs/`, made when somebody first asks for it.
pub fn routes<S: Clone + Send + Sync + 'static>(interface: Value) -> Router<S> {
    let site = std::sync::Arc::new((interface, OnceLock::<Site>::new()));
    let show = move |name: &str| {
        let (interface, made) = &*site;
        let site = made.get_or_init(|| Site::new(interface, Some("../")));
        site.files.get(name).map_or_else(missing, |text| file(name, text))
    };
    let index = show.clone();
    Router::new()
        .route("/docs", get(|| async { Redirect::permanent("/docs/") }))
        .route("/docs/", get(|| async move { index("index.html") }))
        .route("/docs/{name}", get(|Path(name): Path<String>| async move { show(&name) }))
        // Where the guide to scenes was before there was a site.
        .route("/guide", get(|| async { Redirect::permanent("/docs/scenes.html") }))
}

fn file(name: &str, text: &str) -> Response {
    let kind = match name.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("svg") => "image/svg+xml",
        _ => "application/octet-stream",
    };
    let headers = [
        (header::CONTENT_TYPE, kind),
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::CACHE_CONTROL, "no-cache"),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    ];
    (headers, text.to_owned()).into_response()
}

fn missing() -> Response {
    let text = "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Not in the documentation</title>\
                <h1>There is no such page</h1><p><a href=\"./\">To the documentation</a></p></html>";
    let mut response = file("missing.html", text);
    *response.status_mut() = StatusCode::NOT_FOUND;
    response
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::path::Path;

    fn site() -> Site {
        Site::new(&crate::api::openapi(), None)
    }

    fn is_page(name: &str) -> bool {
        Path::new(name).extension().is_some_and(|kind| kind == "html")
    }

    /// What stands in an attribute, at every place: within tags, as examples of HTML have attributes too.
    fn all<'a>(text: &'a str, attribute: &str) -> Vec<&'a str> {
        let opening = format!(" {attribute}=\"");
        let tags = text.split('<').filter_map(|rest| rest.split_once('>')).map(|(tag, _)| tag);
        tags.filter_map(|tag| tag.split_once(&opening)?.1.split('"').next()).collect()
    }

    #[test]
    fn every_link_leads_to_a_page_and_a_place_of_the_site() {
        let site = site();
        let places: BTreeMap<&str, BTreeSet<&str>> =
            site.files().map(|(name, text)| (name, all(text, "id").into_iter().collect())).collect();
        let mut seen = 0;
        for (name, text) in site.files().filter(|(name, _)| is_page(name)) {
            let addresses = all(text, "href").into_iter().chain(all(text, "src"));
            for address in addresses.filter(|address| !address.starts_with("http")) {
                let (file, place) = address.split_once('#').unwrap_or((address, ""));
                let file = if file.is_empty() { name } else { file };
                let known = places.get(file).unwrap_or_else(|| panic!("{name} links to {address}"));
                assert!(place.is_empty() || known.contains(place), "{name} links to {address}");
                seen += 1;
            }
        }
        assert!(seen > 300, "{seen}");
    }

    #[test]
    fn ids_are_there_once_and_every_page_has_a_title_and_one_first_heading() {
        for (name, text) in site().files().filter(|(name, _)| is_page(name)) {
            let ids = all(text, "id");
            let distinct: BTreeSet<&&str> = ids.iter().collect();
            let twice: Vec<_> =
                ids.iter().filter(|id| ids.iter().filter(|other| other == id).count() > 1).collect();
            assert_eq!(distinct.len(), ids.len(), "{name}: {twice:?}");
            assert_eq!(text.matches("<h1").count(), 1, "{name}");
            assert!(text.contains("<title>") && text.contains("<main"), "{name}");
        }
    }

    #[test]
    fn the_search_knows_the_sections_of_all_pages() {
        let site = site();
        let script = &site.files["search.js"];
        let list = script.trim_start_matches("globalThis.triadDocs = ").trim_end_matches(";\n");
        let sections: Vec<[String; 4]> = serde_json::from_str(list).unwrap();
        let finds = |heading: &str, words: &str| {
            sections.iter().any(|[_, _, own, text]| own.contains(heading) && text.contains(words))
        };
        assert!(finds("Power series", "tolerance") && finds("/api/v1/lessons", "lesson"));
        let pages: BTreeSet<&str> = sections.iter().map(|[at, ..]| at.split('#').next().unwrap()).collect();
        assert_eq!(pages.len(), DOCUMENTS.len() + 2);
    }

    #[test]
    fn addresses_are_found_from_where_a_document_lies() {
        assert_eq!(address("docs/GLOSSARY.md", "../THEORY.md#2-a-body").unwrap(), "theory.html#2-a-body");
        assert_eq!(address("README.md", "docs/treatments.svg").unwrap(), "treatments.svg");
        assert_eq!(address("lessons/README.md", "https://example.org").unwrap(), "https://example.org");
        assert_eq!(address("README.md", "LICENSE-MIT"), None);
    }
}
