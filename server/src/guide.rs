//! The guide to scenes, docs/SCENES.md: printed by `triad scenes --guide`, shown at `/guide`.

use std::collections::BTreeMap;

use axum::http::header;
use axum::response::{IntoResponse, Response};
use triad_lessons::rendering::markdown;

/// How a scene is written, as Markdown.
pub const GUIDE: &str = include_str!("../../docs/SCENES.md");
/// It is text: nothing in it may run or load.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'self'; base-uri 'none'; form-action 'none'";

/// The guide as a page of its own.
pub async fn show() -> Response {
    let text = markdown::render(GUIDE, &BTreeMap::new()).html;
    let page = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>Triad: how a scene is written</title><style>:root{{color-scheme:light dark}}\
         body{{font:16px/1.6 system-ui,sans-serif;max-width:52rem;margin:2rem auto;padding:0 1rem}}\
         pre{{overflow-x:auto;font-size:.85rem}}table{{border-collapse:collapse}}td,th{{padding:.2rem .8rem .2rem 0;\
         text-align:left;vertical-align:top}}</style>{text}<p><a href=\"/scenes\">To the scenes</a></p></html>"
    );
    let headers = [
        (header::CONTENT_TYPE, "text/html; charset=utf-8"),
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::CACHE_CONTROL, "no-cache"),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    ];
    (headers, page).into_response()
}
