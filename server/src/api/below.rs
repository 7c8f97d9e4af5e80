//! A workbench that stands at a path below another site's name: a proxy hands requests on with their whole path, and everything that
//! names an address of ours to a browser names it with that path.

use axum::Router;
use axum::extract::Request;
use axum::http::{HeaderMap, HeaderValue, StatusCode, Uri, header};
use axum::response::{IntoResponse, Redirect, Response};
use tower::ServiceExt;

use crate::problem::Problem;

/// The same server, at `base`: empty, or as `/triad`.
pub(super) fn below(base: &str, server: Router) -> Router {
    if base.is_empty() {
        return server;
    }
    let base = base.to_owned();
    let answer = move |request: Request| {
        let (base, server) = (base.clone(), server.clone());
        async move { answer(&base, server, request).await }
    };
    Router::new().fallback(answer)
}

async fn answer(base: &str, server: Router, mut request: Request) -> Response {
    let path = request.uri().path_and_query().map_or("/", |path| path.as_str());
    let rest = path.strip_prefix(base).unwrap_or("elsewhere");
    if rest.is_empty() || rest.starts_with('?') {
        return Redirect::permanent(&format!("{base}/{rest}")).into_response();
    }
    let inner = rest.starts_with('/').then(|| rest.parse::<Uri>().ok()).flatten();
    let Some(inner) = inner else {
        return Problem::new(
            StatusCode::NOT_FOUND,
            "not-found",
            format!("there is nothing at {}", request.uri().path()),
            format!("the workbench is at {base}/"),
        )
        .into_response();
    };
    *request.uri_mut() = inner;
    // A router never fails: what goes wrong is an answer.
    let mut response = server.oneshot(request).await.unwrap_or_else(|never| match never {});
    name(base, response.headers_mut());
    response
}

/// Puts the path before addresses of ours in an answer's head.
fn name(base: &str, headers: &mut HeaderMap) {
    let own = |location: &HeaderValue| {
        let location =
            location.to_str().ok().filter(|text| text.starts_with('/') && !text.starts_with("//"))?;
        HeaderValue::try_from(format!("{base}{location}")).ok()
    };
    if let Some(location) = headers.get(header::LOCATION).and_then(own) {
        headers.insert(header::LOCATION, location);
    }
    let cookies: Vec<HeaderValue> = headers.get_all(header::SET_COOKIE).iter().cloned().collect();
    headers.remove(header::SET_COOKIE);
    for cookie in cookies {
        let below = cookie.to_str().ok().map(|text| text.replace("; Path=/;", &format!("; Path={base};")));
        let below = below.and_then(|text| HeaderValue::try_from(text).ok());
        headers.append(header::SET_COOKIE, below.unwrap_or(cookie));
    }
}
