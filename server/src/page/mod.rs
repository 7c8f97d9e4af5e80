//! The web page, embedded into the binary when it was built.
//!
//! Files under `assets/` carry a hash of their content in their names, so browsers may keep them for ever.
//! Those that can be compressed are kept packed by Brotli, as most browsers take them. Over plain HTTP, from any host but
//! their own, browsers take gzip only: what they ask for is packed once more when it is first asked for, and kept.

mod asset;
mod player;

use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::app::App;
use crate::problem::Problem;
use asset::{ASSETS, Asset, Encoding, find};
pub use player::playing;

/// First words of the addresses that the page has a view for: those of `web/src/main.ts`.
const VIEWS: [&str; 10] =
    ["lessons", "course", "room", "join", "setup", "return", "class", "record", "scenes", "embed"];
/// The view that pages of other sites may show in a frame: it plays a recorded run, and has no cookie and no session.
const FRAMED: &str = "embed";

/// What may run and load in the page: only what this server sent. The viewer is WebAssembly in a worker. Not every browser
/// takes 'self' for WebSockets: they are named by the server's own name.
///
/// `framed`: pages of other sites may show it.
fn policy(request: &HeaderMap, framed: bool) -> HeaderValue {
    let host = request.get(header::HOST).and_then(|host| host.to_str().ok()).filter(|host| is_host(host));
    let streams = host.map_or(String::new(), |host| format!(" ws://{host} wss://{host}"));
    let policy = format!(
        "default-src 'self'; script-src 'self' 'wasm-unsafe-eval' blob:; worker-src 'self' blob:; style-src 'self' \
         'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; connect-src 'self'{streams} data: blob:; \
         object-src 'none'; frame-ancestors {}; base-uri 'self'; form-action 'self'",
        if framed { "*" } else { "'self'" }
    );
    HeaderValue::try_from(policy).unwrap_or(HeaderValue::from_static("default-src 'none'"))
}

/// Whether a policy lets pages of other sites show what it came with.
pub fn may_be_framed(policy: &HeaderValue) -> bool {
    policy.to_str().is_ok_and(|policy| policy.contains("frame-ancestors *"))
}

/// Whether it has no character that would end a source in a policy.
fn is_host(host: &str) -> bool {
    host.chars().all(|c| c.is_ascii_alphanumeric() || "-._:[]".contains(c))
}

/// Answers every request that is not for the API: a file of the page, or the page itself.
pub async fn serve(State(app): State<App>, request: Request) -> Response {
    if !matches!(*request.method(), Method::GET | Method::HEAD) {
        return method_not_allowed();
    }
    let path = request.uri().path().trim_start_matches('/');
    if let Some(asset) = find(if path.is_empty() { "index.html" } else { path }) {
        return respond(asset, request.headers(), false, &app.base).await;
    }
    let first = path.split('/').next().unwrap_or(path);
    // Addresses without a file name belong to the page, which says of most that there is nothing.
    let last = path.rsplit('/').next().unwrap_or(path);
    let climbs = path.split('/').any(|part| part == "..");
    let is_page = !["api", "assets"].contains(&first) && !last.contains('.') && !climbs;
    match find("index.html").filter(|_| is_page) {
        Some(page) => {
            let mut response = respond(page, request.headers(), first == FRAMED, &app.base).await;
            if !VIEWS.contains(&first) && response.status() == StatusCode::OK {
                *response.status_mut() = StatusCode::NOT_FOUND;
            }
            response
        }
        None => Problem::new(
            StatusCode::NOT_FOUND,
            "not-found",
            format!("there is nothing at /{path}"),
            "the lessons are at /, the API is described at /api/openapi.json",
        )
        .into_response(),
    }
}

/// All files of the page, as browsers see them.
///
/// Errors if one cannot be unpacked.
pub async fn files() -> Result<Vec<(&'static str, axum::body::Bytes)>, Problem> {
    let mut files = Vec::with_capacity(ASSETS.len());
    for asset in &ASSETS {
        files.push((asset.path, asset.bytes(|_| false).await?.1));
    }
    Ok(files)
}

/// The answer to a method that an address does not have.
pub fn method_not_allowed() -> Response {
    Problem::new(
        StatusCode::METHOD_NOT_ALLOWED,
        "method-not-allowed",
        "this address does not take that method",
        "see /api/openapi.json for the methods of each address; the Allow header lists them too",
    )
    .into_response()
}

async fn respond(asset: &'static Asset, request: &HeaderMap, framed: bool, base: &str) -> Response {
    let cache =
        if asset.path.starts_with("assets/") { "public, max-age=31536000, immutable" } else { "no-cache" };
    let mut headers = HeaderMap::new();
    let mut set = |name, value: &'static str| headers.insert(name, HeaderValue::from_static(value));
    set(header::CONTENT_TYPE, media_type(asset.path));
    set(header::CACHE_CONTROL, cache);
    set(header::ETAG, asset.tag);
    set(header::VARY, "accept-encoding");
    set(header::X_CONTENT_TYPE_OPTIONS, "nosniff");
    // Scripts too: a worker is bound by the policy of its own file.
    headers.insert(header::CONTENT_SECURITY_POLICY, policy(request, framed));
    let known = request.get(header::IF_NONE_MATCH).and_then(|value| value.to_str().ok());
    if known.is_some_and(|known| known.split(',').any(|tag| tag.trim().trim_start_matches("W/") == asset.tag))
    {
        return (StatusCode::NOT_MODIFIED, headers).into_response();
    }
    if let Some(page) = asset.text().filter(|_| asset.path == "index.html" && !base.is_empty()) {
        return (headers, below(page, base)).into_response();
    }
    let (encoding, body) = match asset.bytes(|encoding| accepts(request, encoding.name())).await {
        Ok(found) => found,
        Err(problem) => return problem.into_response(),
    };
    if let Some(encoding) = encoding {
        headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static(encoding.name()));
    }
    (headers, body).into_response()
}

/// The page as it stands below a path: it says so, and finds its files there.
fn below(page: &str, base: &str) -> String {
    let named = page.replacen("<html ", &format!("<html data-base=\"{base}\" "), 1);
    named.replace("=\"/assets/", &format!("=\"{base}/assets/"))
}

/// Whether the caller reads gzip.
pub fn reads_gzip(request: &HeaderMap) -> bool {
    accepts(request, Encoding::Gzip.name())
}

/// Whether the caller reads `encoding`: named, and not with a weight of zero.
fn accepts(request: &HeaderMap, encoding: &str) -> bool {
    let listed = request.get_all(header::ACCEPT_ENCODING).iter().filter_map(|value| value.to_str().ok());
    listed.flat_map(|list| list.split(',')).any(|entry| {
        let mut parts = entry.split(';').map(str::trim);
        let refused = |part: &str| part.strip_prefix("q=").is_some_and(|q| q.parse() == Ok(0.0));
        parts.next() == Some(encoding) && !parts.any(refused)
    })
}

fn media_type(path: &str) -> &'static str {
    match path.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" => "application/json",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        "txt" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_address_of_the_page_is_known_here() {
        let routes = include_str!("../../../web/src/main.ts").split("pattern: /^\\/").skip(1);
        let mut seen = 0;
        for route in routes {
            let words = route.split(['$', '\\']).next().unwrap_or_default().trim_matches(['(', ')']);
            for word in words.split('|').filter(|word| !word.is_empty()) {
                assert!(VIEWS.contains(&word), "{word}");
                seen += 1;
            }
        }
        assert!(seen > 8, "{seen}");
    }

    #[test]
    fn a_name_cannot_add_to_the_policy() {
        let of = |host: &'static str| {
            let mut headers = HeaderMap::new();
            headers.insert(header::HOST, HeaderValue::from_static(host));
            policy(&headers, false).to_str().expect("text").to_owned()
        };
        assert!(of("[::1]:8080").contains(" ws://[::1]:8080 wss://[::1]:8080 "));
        for host in ["a; script-src *", "a, b", "a b"] {
            assert!(!of(host).contains(host), "{host}");
            assert!(!of(host).contains("ws:"));
        }
    }

    #[test]
    fn a_weight_of_zero_refuses_an_encoding() {
        let mut headers = HeaderMap::new();
        headers.insert(header::ACCEPT_ENCODING, HeaderValue::from_static("br;q=0, gzip;q=0.5"));
        assert!(!accepts(&headers, "br"));
        assert!(accepts(&headers, "gzip"));
        assert!(!accepts(&headers, "zstd"));
    }
}
