//! The HTTP interface under `/api/v1`, and the one router of the server.

mod admin;
mod below;
mod bounds;
mod class;
mod describe;
mod extract;
mod forward;
mod guard;
mod health;
mod lectures;
mod lessons;
mod lti;
mod observed;
mod oidc;
mod scenes;
mod sessions;

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Bytes;
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use serde_json::{Value, json};
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;

use crate::app::App;
use crate::aside;
use crate::docs;
use crate::live::{self, Which};
use crate::page;
use crate::problem::{Problem, ProblemDocument};
use crate::reports;
use crate::store::HEARD;

pub use admin::{admin, admin_of_grader};
use describe::Schemas;
pub(crate) use extract::parse_as;
pub(crate) use lessons::{instances, starter_of, unknown as unknown_lesson};

/// The head of the interface's description; addresses and schemas are added by the routes themselves.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "Triad",
        description = "A teaching workbench for multibody dynamics: lessons, live simulations, submissions. \
            Units are SI. Errors are application/problem+json with a stable `code`, a `hint`, and pointers \
            to the places that are wrong."
    ),
    tags(
        (name = "lessons", description = "What is taught; answers never leave the server"),
        (name = "submissions", description = "What was handed in, and what it earned"),
        (name = "class", description = "Accounts, people and grades of a class: `triad serve --class`"),
        (name = "scenes", description = "Built-in scenes, and what a scene amounts to"),
        (name = "sessions", description = "Live simulations"),
        (name = "rooms", description = "Lectures: one session that many follow"),
        (name = "analyses", description = "What a scene can be asked besides running it"),
        (name = "server", description = "The server itself")
    )
)]
struct Head;

fn described() -> (Router<App>, Value) {
    let mut schemas = Schemas::new();
    schemas.answer::<ProblemDocument>();
    let (routes, document) = OpenApiRouter::with_openapi(Head::openapi())
        .nest(
            "/api/v1",
            OpenApiRouter::new()
                .merge(class::sign_in::routes(&mut schemas))
                .merge(class::people::routes(&mut schemas))
                .merge(class::assignments::routes(&mut schemas))
                .merge(class::grades::routes(&mut schemas))
                .merge(class::exchange::routes(&mut schemas))
                .merge(class::analysis::routes(&mut schemas))
                .merge(class::glance::routes(&mut schemas))
                .merge(class::records::routes(&mut schemas))
                .merge(class::regrades::routes(&mut schemas))
                .merge(class::standing::routes(&mut schemas))
                .merge(lessons::routes(&mut schemas))
                .merge(lessons::predictions::routes(&mut schemas))
                .merge(lessons::submissions::routes(&mut schemas))
                .merge(lessons::waiting::routes(&mut schemas))
                .merge(scenes::routes(&mut schemas))
                .merge(scenes::import::routes(&mut schemas))
                .merge(sessions::routes(&mut schemas))
                .merge(sessions::changes::routes(&mut schemas))
                .merge(scenes::analyses::routes(&mut schemas))
                .merge(scenes::table::routes(&mut schemas))
                .merge(scenes::motion::routes(&mut schemas))
                .merge(sessions::reactions::routes(&mut schemas))
                .merge(sessions::matrices::routes(&mut schemas))
                .merge(sessions::stream::routes(&mut schemas))
                .merge(lectures::routes(&mut schemas))
                .merge(lectures::follow::routes(&mut schemas))
                .merge(lti::state::routes(&mut schemas))
                .merge(oidc::routes(&mut schemas))
                .merge(health::routes(&mut schemas)),
        )
        .split_for_parts();
    (routes, schemas.complete(document))
}

/// The description of the interface (OpenAPI 3.1).
pub fn openapi() -> Value {
    described().1
}

/// The whole server: page, interface and streams on one port.
pub fn router(app: App) -> Router {
    let (routes, mut described) = described();
    if !app.base.is_empty() {
        described["servers"] = json!([{ "url": &*app.base }]);
    }
    let base = Arc::clone(&app.base);
    let document = Bytes::from(described.to_string());
    let server = routes
        .route(
            "/api/openapi.json",
            get(move || async move { ([(header::CONTENT_TYPE, "application/json")], document) }),
        )
        .route("/api/{*rest}", axum::routing::any(unknown_address))
        .merge(lti::pages())
        .merge(oidc::pages())
        .route("/livez", get(health::alive))
        .route("/readyz", get(health::ready))
        .route("/bench", get(reports::bench))
        .route("/stress", get(reports::stress))
        .merge(docs::routes(described))
        .fallback(page::serve)
        .method_not_allowed_fallback(|| async { page::method_not_allowed() })
        .layer(middleware::from_fn_with_state(app.clone(), forward::where_it_lives))
        .layer(middleware::from_fn_with_state(app.clone(), bounds::refuse_large_bodies))
        .layer(middleware::from_fn(uncached_interface))
        .layer(middleware::from_fn_with_state(app.clone(), guard::admit))
        .layer(middleware::from_fn_with_state(app.clone(), observed::observe))
        .with_state(app);
    below::below(&base, server)
}

async fn unknown_address(uri: axum::http::Uri) -> Response {
    Problem::new(
        StatusCode::NOT_FOUND,
        "not-found",
        format!("there is nothing at {}", uri.path()),
        "the API is described at /api/openapi.json",
    )
    .into_response()
}

/// Responses of the interface are not to be cached: they change with each request.
async fn uncached_interface(request: axum::extract::Request, next: Next) -> Response {
    let is_interface = request.uri().path().starts_with("/api/");
    let mut response = next.run(request).await;
    if is_interface {
        response.headers_mut().entry(header::CACHE_CONTROL).or_insert(HeaderValue::from_static("no-store"));
    }
    response
}

pub use lti::keep_told;

/// Hears which verdicts graders elsewhere give, for as long as the server runs.
pub async fn keep_listening(app: App) {
    app.store.hear_verdicts().await;
}

/// Lets the other servers hear of this one for as long as it runs.
pub async fn keep_heard(app: App) {
    let mut often = tokio::time::interval(HEARD);
    loop {
        often.tick().await;
        // Where the database is away nobody else hears anything either.
        drop(app.node.is_here(&app.store).await);
    }
}

/// Closes idle sessions and lectures for as long as the server runs.
pub async fn keep_house(app: App) {
    let mut often = tokio::time::interval(Duration::from_secs(15));
    loop {
        often.tick().await;
        app.sessions.expire(&app.limits);
        app.lectures.expire(&app.limits);
        app.access.forget();
        // What ended sessions held is given back to the system by a thread that ends a second later or more.
        drop(aside::run(|| Ok(())).await);
        if let Some(path) = &app.live {
            // Tried again in a moment; as the server stops it is said.
            drop(live::keep(path, &app.sessions, &app.lectures, Which::Shown).await);
        }
    }
}
