//! What lives in another server of the same gradebook is asked for there.

use axum::body::{Body, to_bytes};
use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;

use super::guard::cookie;
use crate::app::App;
use crate::lecture::named;
use crate::nodes::{HANDED_ON, gone, hand_on};
use crate::problem::Problem;
use crate::store::Whereabouts;

/// Runs that a browser begins are begun where its others are, so that a lecture may show each of them: it keeps the name of that
/// server.
const COOKIE: &str = "triad-node";
/// Longest request for a room, in bytes: it names a run.
const LONGEST: usize = 4096;

/// Where a request belongs.
enum Belongs {
    Here,
    /// To the server of that name, and nowhere else.
    There(String),
    /// To the server of that name, if it is there.
    Rather(String),
}

/// Answers here, or hands the request on to the server in which lives what it asks for.
pub(super) async fn where_it_lives(State(app): State<App>, mut request: Request, next: Next) -> Response {
    if app.node.name().is_empty() || request.headers().contains_key(HANDED_ON) {
        return next.run(request).await;
    }
    let matched = request.extensions().get::<MatchedPath>().map(|matched| matched.as_str().to_owned());
    let Some(matched) = matched else { return next.run(request).await };
    let begins = request.method() == Method::POST && matched == "/api/v1/sessions";
    let belongs = if request.method() == Method::POST && matched == "/api/v1/rooms" {
        match room(&app, request).await {
            Ok((whole, belongs)) => {
                request = whole;
                belongs
            }
            Err(problem) => return problem.into_response(),
        }
    } else {
        match named_elsewhere(&app, &matched, request.uri().path()).await {
            // Where that has gone, nothing is open under the name.
            Ok(Some(name)) => Belongs::Rather(name),
            Ok(None) => belongs(&app, &matched, request.uri().path(), request.headers(), begins),
            Err(problem) => return problem.into_response(),
        }
    };
    let answer = match answer(&app, belongs, request, next).await {
        Ok(response) => response,
        Err(problem) => return problem.into_response(),
    };
    if begins { remembered(&app, answer) } else { answer }
}

async fn answer(app: &App, belongs: Belongs, request: Request, next: Next) -> Result<Response, Problem> {
    let (name, only) = match belongs {
        Belongs::Here => return Ok(next.run(request).await),
        Belongs::There(name) => (name, true),
        Belongs::Rather(name) => (name, false),
    };
    match app.store.node(&name).await? {
        Some(Whereabouts::At(address)) => hand_on(&address, request).await,
        Some(Whereabouts::Gone) if only => Err(gone()),
        // Nobody has ever had that name: what is asked for is unknown here as well.
        Some(Whereabouts::Gone) | None => Ok(next.run(request).await),
    }
}

fn belongs(app: &App, matched: &str, path: &str, headers: &HeaderMap, begins: bool) -> Belongs {
    let named = path.split('/').nth(4).unwrap_or_default();
    // A server that came back under another name has what lived in it before.
    let other = if begins {
        let rather = cookie(headers, COOKIE).and_then(|name| app.node.other(&name).map(str::to_owned));
        return rather.map_or(Belongs::Here, Belongs::Rather);
    } else if matched.starts_with("/api/v1/sessions/{id}") {
        app.node.other_of_id(named).filter(|_| app.sessions.get(named).is_err()).map(str::to_owned)
    } else if matched.starts_with("/api/v1/rooms/{code}") {
        app.node.other_of_code(named).filter(|_| app.lectures.get(named).is_err())
    } else if matched.starts_with("/api/v1/regrades/{id}/") {
        app.node.other_of_id(named).map(str::to_owned)
    } else {
        None
    };
    other.map_or(Belongs::Here, Belongs::There)
}

/// The name of another server, in which a lecture was opened last under the name of a room.
async fn named_elsewhere(app: &App, matched: &str, path: &str) -> Result<Option<String>, Problem> {
    let of_room = matched.starts_with("/api/v1/rooms/{code}").then(|| path.split('/').nth(4)).flatten();
    let Some(name) = of_room.and_then(|typed| named::name(typed).ok()) else { return Ok(None) };
    let node = app.store.node_of_room(&name).await?;
    Ok(node.and_then(|node| app.node.other(&node).map(str::to_owned)))
}

/// A room is where the run is that it shows.
async fn room(app: &App, request: Request) -> Result<(Request, Belongs), Problem> {
    #[derive(Deserialize)]
    struct Shows {
        session: String,
    }
    let (head, body) = request.into_parts();
    let bytes = to_bytes(body, LONGEST).await.map_err(|_| {
        Problem::new(
            StatusCode::PAYLOAD_TOO_LARGE,
            "body-too-large",
            format!("the request has more than {LONGEST} bytes"),
            r#"a room is opened with the id of a session: {"session": "…"}"#,
        )
    })?;
    // What it is otherwise, the handler says.
    let shows = serde_json::from_slice(&bytes).map_or(String::new(), |Shows { session }| session);
    let other = app.node.other_of_id(&shows).filter(|_| app.sessions.get(&shows).is_err());
    let belongs = other.map_or(Belongs::Here, |name| Belongs::There(name.to_owned()));
    Ok((Request::from_parts(head, Body::from(bytes)), belongs))
}

/// The answer with the name of this server, for the browser's next run; another's answer has its own.
fn remembered(app: &App, mut response: Response) -> Response {
    let is_ours = response
        .headers()
        .get_all(header::SET_COOKIE)
        .iter()
        .all(|cookie| cookie.to_str().map_or(true, |text| !text.starts_with(COOKIE)));
    if response.status() == StatusCode::CREATED && is_ours {
        let (_, tail) = app.access.cookie();
        let cookie = format!("{COOKIE}={}{tail}", app.node.name());
        if let Ok(cookie) = HeaderValue::try_from(cookie) {
            response.headers_mut().append(header::SET_COOKIE, cookie);
        }
    }
    response
}
