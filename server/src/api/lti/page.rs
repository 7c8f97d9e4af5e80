//! Small pages that stand between a platform and ours. They work without a script, and most of them in a frame.

use std::fmt::Write;

use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::problem::Problem;
use crate::store::identifier;

const STYLE: &str = "body{font:1rem/1.5 system-ui,sans-serif;max-width:40rem;margin:2rem auto;padding:0 1rem;\
    color:#1c2430;background:#fff}button{font:inherit;padding:.5rem 1rem;border:1px solid #1f5fbf;border-radius:.3rem;\
    background:#1f5fbf;color:#fff;cursor:pointer}button:focus-visible,input:focus-visible{outline:3px solid #f0a020;\
    outline-offset:2px}ul{list-style:none;padding:0}li label{display:flex;gap:.6rem;padding:.35rem 0}\
    .muted{color:#556}@media(prefers-color-scheme:dark){body{color:#e6eaf0;background:#14181f}.muted{color:#a8b0bd}}";

/// A text as it stands in HTML, in attributes too.
pub(super) fn escaped(text: &str) -> String {
    text.chars().fold(String::with_capacity(text.len()), |mut safe, c| {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            _ => safe.push(c),
        }
        safe
    })
}

/// A page: `body` is HTML. Platforms show it in their frames: nothing on it acts in anybody's name.
pub(super) fn page(status: StatusCode, title: &str, body: &str) -> Response {
    respond(status, title, body, "")
}

/// A form that is sent to the platform: by itself where scripts run, else by its button.
pub(super) fn sent_on(title: &str, action: &str, fields: &[(&str, &str)], button: &str) -> Response {
    let nonce = identifier();
    let script = format!("<script nonce=\"{nonce}\">document.forms[0].submit()</script>");
    let form = form(action, "", fields, button);
    respond(StatusCode::OK, title, &format!("{form}{script}"), &format!("; script-src 'nonce-{nonce}'"))
}

/// A form with hidden fields and a button. `target` is an attribute, or nothing.
pub(super) fn form(action: &str, target: &str, fields: &[(&str, &str)], button: &str) -> String {
    let mut text = format!("<form method=\"post\" action=\"{}\"{target}>", escaped(action));
    for (name, value) in fields {
        let _ =
            write!(text, "<input type=\"hidden\" name=\"{}\" value=\"{}\">", escaped(name), escaped(value));
    }
    let _ = write!(text, "<p><button>{}</button></p></form>", escaped(button));
    text
}

fn respond(status: StatusCode, title: &str, body: &str, more: &str) -> Response {
    let title = escaped(title);
    let text = format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>{title}</title><style>{STYLE}</style></head><body><main><h1>{title}</h1>\
         {body}</main></body></html>"
    );
    let policy =
        format!("default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; frame-ancestors *{more}");
    let mut headers = HeaderMap::new();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static("text/html; charset=utf-8"));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    let policy = HeaderValue::from_str(&policy).unwrap_or(HeaderValue::from_static("default-src 'none'"));
    headers.insert(header::CONTENT_SECURITY_POLICY, policy);
    (status, headers, text).into_response()
}

/// A refusal for whoever asks: a page for people, a document for programs. `more` is HTML: where to go from there.
pub(in crate::api) fn refused(problem: Problem, headers: &HeaderMap, more: &str) -> Response {
    let accepts = headers.get(header::ACCEPT).and_then(|value| value.to_str().ok()).unwrap_or_default();
    let document = problem.document();
    // It is written to the log and counted, whoever reads it.
    let told = problem.into_response();
    if !accepts.contains("text/html") {
        return told;
    }
    let mut why = document.detail.chars();
    let first = why.next().map(|first| first.to_uppercase().to_string()).unwrap_or_default();
    let trace = if told.status().is_server_error() { document.trace_id.as_str() } else { "" };
    let body = format!(
        "<p>{}.</p><p>What to do: {}.</p>{more}<p class=\"muted\">{} {}</p>",
        escaped(&(first + why.as_str())),
        escaped(&document.hint),
        escaped(&document.code),
        escaped(trace)
    );
    let mut page = page(told.status(), "This did not work", &body);
    page.extensions_mut().extend(told.into_parts().0.extensions);
    page
}
