//! What every request passes before it is answered: that this server is meant, that our own page asks, who asks, and whether
//! they may.

use std::convert::Infallible;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use axum::extract::{ConnectInfo, DefaultBodyLimit, FromRequestParts, MatchedPath, Request, State};
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::access::rights;
use crate::app::App;
use crate::glance::lesson_of;
use crate::page;
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::{CLASS, Member};

/// Who asks: somebody of the class, or nobody in particular.
#[derive(Debug, Clone, Default)]
pub(in crate::api) struct Caller(pub(in crate::api) Option<Member>);

impl<S: Send + Sync> FromRequestParts<S> for Caller {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Infallible> {
        Ok(parts.extensions.get::<Self>().cloned().unwrap_or_default())
    }
}

impl Caller {
    /// Somebody of the class.
    ///
    /// Errors if nobody is signed in: the table of rights lets none come so far.
    pub(in crate::api) fn member(self) -> Result<Member, Problem> {
        self.0.ok_or_else(|| Problem::internal("an operation of the class was reached by nobody"))
    }
}

impl Caller {
    /// Somebody of the class, where there may be none: what is asked for exists in classes alone.
    ///
    /// Errors at home.
    pub(in crate::api) fn class_member(self) -> Result<Member, Problem> {
        self.0.ok_or_else(rights::no_class)
    }
}

/// From where somebody asks.
#[derive(Debug, Clone, Copy)]
pub(in crate::api) struct Peer(pub(in crate::api) IpAddr);

impl FromRequestParts<App> for Peer {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Infallible> {
        let peer = parts.extensions.get::<ConnectInfo<SocketAddr>>();
        let peer = peer.map_or(IpAddr::V4(Ipv4Addr::LOCALHOST), |ConnectInfo(address)| address.ip());
        let lists = parts.headers.get_all("x-forwarded-for").iter().filter_map(|value| value.to_str().ok());
        Ok(Self(app.access.client(peer, &lists.collect::<Vec<_>>().join(","))))
    }
}

/// The secret of the session that a request brings.
pub(in crate::api) fn session_token(app: &App, headers: &HeaderMap) -> Option<String> {
    cookie(headers, app.access.cookie().0)
}

/// The value of a cookie.
pub(in crate::api) fn cookie(headers: &HeaderMap, name: &str) -> Option<String> {
    let lists = headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
    let mut pairs = lists.flat_map(|list| list.split(';')).filter_map(|pair| pair.trim().split_once('='));
    pairs.find(|(key, _)| *key == name).map(|(_, value)| value.to_owned())
}

/// What a page of a learning platform sends here: signed tickets and words of the platform hold it instead.
const FROM_PLATFORMS: [&str; 2] = ["/lti/login", "/lti/launch"];

/// Bytes that anybody who is not of the class may send at a time: names, words, votes, and what a learning platform signs. What
/// strangers send is held in memory before it is read, for a minute and on as many connections as they like.
const OF_STRANGERS: usize = 256 << 10;

/// Lets a request pass, with the [`Caller`] found out, or answers why not.
pub(super) async fn admit(State(app): State<App>, request: Request, next: Next) -> Response {
    let (mut parts, body) = request.into_parts();
    match admitted(&app, &parts).await {
        Ok(caller) => {
            let is_stranger = app.access.is_class() && caller.0.is_none();
            let most = app.limits.request_bytes;
            let most = DefaultBodyLimit::max(if is_stranger { most.min(OF_STRANGERS) } else { most });
            parts.extensions.insert(caller);
            let mut request = Request::from_parts(parts, body);
            most.apply(&mut request);
            secured(next.run(request).await)
        }
        Err(problem) => secured(problem.into_response()),
    }
}

async fn admitted(app: &App, request: &Parts) -> Result<Caller, Problem> {
    let headers = &request.headers;
    let host = headers.get(header::HOST).and_then(|value| value.to_str().ok());
    if let Some(host) = host {
        app.access.check_host(host)?;
    }
    let matched = request.extensions.get::<MatchedPath>().map(MatchedPath::as_str);
    let opens_stream = headers.contains_key(header::UPGRADE);
    let is_safe = matches!(request.method, Method::GET | Method::HEAD | Method::OPTIONS);
    if opens_stream || !(is_safe || matched.is_some_and(|address| FROM_PLATFORMS.contains(&address))) {
        same_origin(headers, host)?;
    }
    let Some(address) = matched.filter(|address| address.starts_with("/api/v1/")) else {
        return Ok(Caller(None));
    };
    if !app.access.is_class() {
        return rights::check_home(request.method.as_str(), address).map(|()| Caller(None));
    }
    let member = match session_token(app, headers) {
        Some(token) => app.store.member_of_session(CLASS, &token).await?,
        None => None,
    };
    rights::check(request.method.as_str(), address, member.as_ref())?;
    if let Some(member) = &member {
        app.presence.note(&member.id, lesson_of(request.uri.path()), Moment::now());
    }
    Ok(Caller(member))
}

/// Errors if a page of another site asks. Programs that are no browsers say nothing of where they are.
fn same_origin(headers: &HeaderMap, host: Option<&str>) -> Result<(), Problem> {
    let text = |name: HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or_default());
    let foreign = match (text(header::ORIGIN), text(HeaderName::from_static("sec-fetch-site"))) {
        (Some(origin), _) => {
            let authority = origin.split_once("://").map(|(_, authority)| authority);
            !authority.zip(host).is_some_and(|(authority, host)| authority.eq_ignore_ascii_case(host))
        }
        (None, Some(site)) => !matches!(site, "same-origin" | "none"),
        (None, None) => false,
    };
    if !foreign {
        return Ok(());
    }
    Err(Problem::new(
        StatusCode::FORBIDDEN,
        "foreign-origin",
        "a page of another site asks for this",
        "open Triad's own page; behind a proxy, let it hand on the header Host as it came",
    ))
}

/// Nothing of what is sent is to be guessed at, framed by others, or told where a link leads.
fn secured(mut response: Response) -> Response {
    let headers = response.headers_mut();
    let framed = headers.get(header::CONTENT_SECURITY_POLICY).is_some_and(page::may_be_framed);
    for (name, value) in [
        // What is no page of ours runs and loads nothing.
        (header::CONTENT_SECURITY_POLICY, "default-src 'none'; frame-ancestors 'none'"),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "same-origin"),
        (header::X_FRAME_OPTIONS, "SAMEORIGIN"),
    ] {
        if !(framed && name == header::X_FRAME_OPTIONS) {
            headers.entry(name).or_insert(HeaderValue::from_static(value));
        }
    }
    response
}
