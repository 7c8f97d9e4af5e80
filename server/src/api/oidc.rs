//! Signing in with the account of an institution: `/oidc/…` for browsers, `/api/v1/me/account` for those who connect theirs.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::Router;
use axum::extract::{Query, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use schemars::JsonSchema;
use serde::Serialize;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::class::sign_in;
use super::describe::{PROBLEM, Schemas, of};
use super::guard::{Caller, Peer, cookie, session_token};
use super::lti::page;
use crate::app::App;
use crate::lti::ticket::LAUNCH;
use crate::oidc::refusal::Refusal;
use crate::oidc::{BACK, Oidc, Return};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::{CLASS, LIFE, Role};

/// Where a page of ours that refuses leads to. It stands at `/oidc/…`, wherever that is.
const WAY_IN: &str = "<p><a href=\"../join\">To the ways in</a></p>";

/// Pages between the provider and ours.
pub(super) fn pages() -> Router<App> {
    Router::new().route("/oidc/login", get(login)).route(BACK, get(back))
}

pub(super) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<WayOut>();
    OpenApiRouter::new().routes(routes!(connect, disconnect))
}

fn oidc(app: &App) -> Result<&Oidc, Problem> {
    Ok(app.oidc.as_deref().ok_or(Refusal::Off)?)
}

/// The cookie by which a browser is known again as it comes back from the provider's page.
fn given(app: &App, name: &str, value: &str, seconds: i64) -> Result<HeaderValue, Problem> {
    let secure = if app.lti.as_ref().is_some_and(|lti| lti.is_encrypted()) { "; Secure" } else { "" };
    let text = format!("{name}={value}; Max-Age={seconds}; Path=/; HttpOnly; SameSite=Lax{secure}");
    HeaderValue::from_str(&text).map_err(Problem::internal)
}

/// Somebody comes back with their account: their browser is sent to the provider.
async fn login(State(app): State<App>, Peer(address): Peer, headers: HeaderMap) -> Response {
    let answer = async {
        app.access.check_tries(address)?;
        let departure = oidc(&app)?.begin(None, Moment::now()).await?;
        let (name, value) = &departure.cookie;
        let location = HeaderValue::from_str(&departure.to).map_err(Problem::internal)?;
        let heads = [
            (header::LOCATION, location),
            (header::SET_COOKIE, given(&app, name, value, LAUNCH / 1000)?),
            (header::CACHE_CONTROL, HeaderValue::from_static("no-store")),
        ];
        Ok((StatusCode::FOUND, heads).into_response())
    };
    answer.await.unwrap_or_else(|problem: Problem| page::refused(problem, &headers, WAY_IN))
}

/// Somebody comes from the provider: they are in, or their account is connected.
async fn back(
    State(app): State<App>,
    Peer(address): Peer,
    headers: HeaderMap,
    Query(back): Query<Return>,
) -> Response {
    let answer = async {
        app.access.check_tries(address)?;
        let oidc = oidc(&app)?;
        let (begun, (name, secret)) = oidc.begun(&back, |name| cookie(&headers, name), Moment::now())?;
        // Whoever connects an account is still who began it.
        let session = session_token(&app, &headers);
        let here = match &session {
            Some(token) => app.store.member_of_session(CLASS, token).await?.map(|member| member.id),
            None => None,
        };
        if begun.person.is_some() && begun.person != here {
            return Err(Refusal::Browser.into());
        }
        let account = oidc.account(&back, &begun, &secret, Moment::now()).await?;
        let person = if let Some(person) = begun.person {
            if !app.store.connect_account(CLASS, &person, &account).await? {
                return Err(Refusal::Taken.into());
            }
            person
        } else {
            app.store.person_of_account(CLASS, &account).await?.ok_or(Refusal::Unknown)?
        };
        let token = app.store.begin_session(&person).await?;
        let member = app.store.member_of_session(CLASS, &token).await?;
        // The path below which we stand comes before it on the way out.
        let to = if member.is_some_and(|member| member.role > Role::Student) { "/class" } else { "/" };
        let heads = [(header::CACHE_CONTROL, "no-store"), (header::LOCATION, to)];
        let mut answer = (StatusCode::SEE_OTHER, heads).into_response();
        answer.headers_mut().append(header::SET_COOKIE, sign_in::cookie(&app, &token, LIFE / 1000)?);
        answer.headers_mut().append(header::SET_COOKIE, given(&app, &name, "", 0)?);
        Ok(answer)
    };
    answer.await.unwrap_or_else(|problem: Problem| page::refused(problem, &headers, WAY_IN))
}

/// Where the browser goes next.
#[derive(Debug, Serialize, JsonSchema)]
struct WayOut {
    /// An address of the institution's provider, where its page is shown.
    to: String,
}

/// Begin to connect the account that one has at an institution: it is then another way to come back. What one may do stays what the
/// class says.
#[utoipa::path(post, path = "/me/account", operation_id = "connect_account", tag = "class", responses(
    (status = 200, description = "Where to go; a cookie knows the browser as it comes back", body = ref(of::<WayOut>())),
    (status = 404, description = "This server knows no institution", body = ref(PROBLEM)),
    (status = 502, description = "The institution's provider does not answer as it should", body = ref(PROBLEM))))]
async fn connect(State(app): State<App>, caller: Caller) -> Result<Response, Problem> {
    let member = caller.class_member()?;
    let departure = oidc(&app)?.begin(Some(member.id), Moment::now()).await?;
    let (name, value) = &departure.cookie;
    let cookie = [(header::SET_COOKIE, given(&app, name, value, LAUNCH / 1000)?)];
    Ok((StatusCode::OK, cookie, Answer(WayOut { to: departure.to })).into_response())
}

/// Disconnect the account of an institution; words and link still lead back.
#[utoipa::path(delete, path = "/me/account", operation_id = "disconnect_account", tag = "class", responses(
    (status = 204, description = "It leads here no more")))]
async fn disconnect(State(app): State<App>, caller: Caller) -> Result<StatusCode, Problem> {
    app.store.disconnect_account(CLASS, &caller.class_member()?.id).await?;
    Ok(StatusCode::NO_CONTENT)
}
