//! Lectures: open, join, show, ask, answer, reveal, close.

mod audience;
pub(in crate::api) mod follow;
mod open;

use std::sync::Arc;

use axum::body::Bytes;
use axum::extract::State;
use axum::http::header::CONTENT_TYPE;
use axum::http::{HeaderMap, HeaderName, StatusCode, header};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use triad_engine::run::StateView;
use triad_session::change::SessionScene;
use triad_session::forces::{MultipliersList, ReactionQuery, ReactionsView};
use triad_session::matrices::{JacobianView, SymmetricView};
use triad_session::requests::AtTime;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::api::sessions::matrices::{jacobian_of, symmetric_of};
use crate::api::sessions::reactions::{multipliers_of, reactions_of};
use crate::app::App;
use crate::lecture::{Lecture, NewQuestion, PresenterState, PublicState, Vote, named};
use crate::problem::Problem;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<PublicState>();
    schemas.request::<NewLectureView>();
    schemas.answer::<PresenterState>();
    schemas.request::<NewQuestion>();
    schemas.request::<Vote>();
    OpenApiRouter::new()
        .merge(open::routes(schemas))
        .merge(audience::routes(schemas))
        .routes(routes!(public_state, close))
        .routes(routes!(show))
        .routes(routes!(presenter_state))
        .routes(routes!(ask, forget))
        .routes(routes!(reveal))
        .routes(routes!(ask_again))
        .routes(routes!(answer))
        .routes(routes!(scene))
        .routes(routes!(jacobian))
        .routes(routes!(augmented))
        .routes(routes!(schur))
        .routes(routes!(multipliers))
        .routes(routes!(reactions))
}

/// What is shown and asked in a room.
#[utoipa::path(get, path = "/rooms/{code}", operation_id = "get_lecture", tag = "rooms", params(("code" = String, Path)), responses(
    (status = 200, description = "What followers see", body = ref(of::<PublicState>())),
    (status = 404, description = "No such room, or no lecture in it", body = ref(PROBLEM))))]
async fn public_state(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
) -> Result<axum::Json<PublicState>, Problem> {
    match app.lectures.get(&code) {
        Ok(lecture) => Ok(axum::Json(lecture.public_state())),
        Err(unknown) => match named::name(&code) {
            Ok(name) if app.store.node_of_room(&name).await?.is_some() => Err(Problem::new(
                StatusCode::NOT_FOUND,
                "room-not-open",
                format!("no lecture is open in the room {name} at the moment"),
                "ask again in a moment: it opens when the lecture begins",
            )),
            _ => Err(unknown),
        },
    }
}

/// End a lecture. For the presenter.
#[utoipa::path(delete, path = "/rooms/{code}", operation_id = "close_lecture", tag = "rooms", params(("code" = String, Path)), responses(
    (status = 204, description = "It is over"),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM))))]
async fn close(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    headers: HeaderMap,
) -> Result<StatusCode, Problem> {
    let lecture = as_presenter(&app, &code, &headers)?;
    app.lectures.close(&lecture.code);
    Ok(StatusCode::NO_CONTENT)
}

/// What the presenter shows.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct NewLectureView {
    /// Another session than before.
    session: Option<String>,
    /// Time, selection and panels in the page's own words.
    view: Option<Value>,
}

/// Show something else. For the presenter.
#[utoipa::path(put, path = "/rooms/{code}/view", operation_id = "show_view", tag = "rooms", params(("code" = String, Path)),
    request_body(content = ref(of::<NewLectureView>())), responses(
    (status = 204, description = "Followers are being sent it"),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM))))]
async fn show(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    headers: HeaderMap,
    Json(new): Json<NewLectureView>,
) -> Result<StatusCode, Problem> {
    let lecture = as_presenter(&app, &code, &headers)?;
    if let Some(session) = new.session {
        lecture.show_session(app.sessions.get(&session)?);
    }
    if let Some(view) = new.view {
        lecture.show(view)?;
    }
    Ok(StatusCode::NO_CONTENT)
}

/// How many follow, and how the answers stand. For the presenter.
#[utoipa::path(get, path = "/rooms/{code}/desk", operation_id = "get_presenter_state", tag = "rooms", params(("code" = String, Path)), responses(
    (status = 200, description = "Followers and answers", body = ref(of::<PresenterState>())),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM))))]
async fn presenter_state(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    headers: HeaderMap,
) -> Result<axum::Json<PresenterState>, Problem> {
    Ok(axum::Json(as_presenter(&app, &code, &headers)?.presenter_state()))
}

/// Ask a question. For the presenter.
#[utoipa::path(put, path = "/rooms/{code}/question", operation_id = "ask_question", tag = "rooms", params(("code" = String, Path)),
    request_body(content = ref(of::<NewQuestion>())), responses(
    (status = 204, description = "It is asked"),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM)),
    (status = 422, description = "The question was refused", body = ref(PROBLEM))))]
async fn ask(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    headers: HeaderMap,
    Json(new): Json<NewQuestion>,
) -> Result<StatusCode, Problem> {
    as_presenter(&app, &code, &headers)?.ask(new)?;
    Ok(StatusCode::NO_CONTENT)
}

/// Take the question away. For the presenter.
#[utoipa::path(delete, path = "/rooms/{code}/question", operation_id = "withdraw_question", tag = "rooms", params(("code" = String, Path)), responses(
    (status = 204, description = "It is gone"),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM))))]
async fn forget(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    headers: HeaderMap,
) -> Result<StatusCode, Problem> {
    as_presenter(&app, &code, &headers)?.withdraw_question();
    Ok(StatusCode::NO_CONTENT)
}

/// Tell everybody how the answers stand and which is right. For the presenter.
#[utoipa::path(post, path = "/rooms/{code}/reveal", operation_id = "reveal_answer", tag = "rooms", params(("code" = String, Path)), responses(
    (status = 204, description = "The answer is open to everybody"),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM))))]
async fn reveal(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    headers: HeaderMap,
) -> Result<StatusCode, Problem> {
    as_presenter(&app, &code, &headers)?.reveal()?;
    Ok(StatusCode::NO_CONTENT)
}

/// Ask the same question again: the counts so far are kept beside the new ones. For the presenter.
#[utoipa::path(post, path = "/rooms/{code}/second-vote", operation_id = "ask_question_again", tag = "rooms", params(("code" = String, Path)), responses(
    (status = 204, description = "It takes answers again"),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM)),
    (status = 409, description = "No question is asked", body = ref(PROBLEM))))]
async fn ask_again(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    headers: HeaderMap,
) -> Result<StatusCode, Problem> {
    as_presenter(&app, &code, &headers)?.ask_again()?;
    Ok(StatusCode::NO_CONTENT)
}

/// Answer the question.
#[utoipa::path(post, path = "/rooms/{code}/answers", operation_id = "vote", tag = "rooms", params(("code" = String, Path)),
    request_body(content = ref(of::<Vote>())), responses(
    (status = 204, description = "It is counted"),
    (status = 409, description = "There is no such question any more", body = ref(PROBLEM))))]
async fn answer(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    Json(vote): Json<Vote>,
) -> Result<StatusCode, Problem> {
    app.lectures.get(&code)?.vote(&vote)?;
    Ok(StatusCode::NO_CONTENT)
}

/// The lecture, if the request has its presenter's key.
fn as_presenter(app: &App, code: &str, headers: &HeaderMap) -> Result<Arc<Lecture>, Problem> {
    let lecture = app.lectures.get(code)?;
    let given = headers.get(header::AUTHORIZATION).and_then(|value| value.to_str().ok());
    lecture.check_key(given.and_then(|value| value.strip_prefix("Bearer ")))?;
    Ok(lecture)
}

/// The scene that is shown, as it is now.
#[utoipa::path(get, path = "/rooms/{code}/scene", operation_id = "get_lecture_scene", tag = "rooms", params(("code" = String, Path)), responses(
    (status = 200, description = "As /sessions/{id}/scene", body = ref(of::<SessionScene>()))))]
async fn scene(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
) -> Result<JsonText, Problem> {
    let answer =
        app.lectures.get(&code)?.cached("scene", |session| async move { session.scene().await }).await;
    answer.map(json)
}

/// The Jacobian of the session that is shown.
#[utoipa::path(get, path = "/rooms/{code}/jacobian", operation_id = "get_lecture_jacobian", tag = "rooms", params(("code" = String, Path),
    ("at" = Option<f64>, Query)), responses((status = 200, description = "As /sessions/{id}/jacobian", body = ref(of::<JacobianView>()))))]
async fn jacobian(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    QueryParameters(when): QueryParameters<AtTime>,
) -> Result<JsonText, Problem> {
    let what = format!("jacobian {:?}", when.at);
    let answer = app
        .lectures
        .get(&code)?
        .cached(&what, |session| async move { jacobian_of(&session, when.at).await })
        .await;
    answer.map(json)
}

/// The augmented matrix of the session that is shown.
#[utoipa::path(get, path = "/rooms/{code}/augmented", operation_id = "get_lecture_augmented_matrix", tag = "rooms", params(("code" = String, Path),
    ("at" = Option<f64>, Query)), responses((status = 200, description = "As /sessions/{id}/augmented", body = ref(of::<SymmetricView>()))))]
#[allow(
    clippy::redundant_closure_for_method_calls,
    reason = "the method itself is not general enough in its lifetime"
)]
async fn augmented(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    QueryParameters(when): QueryParameters<AtTime>,
) -> Result<JsonText, Problem> {
    symmetric(&app, &code, "augmented", when, |state| state.augmented()).await
}

/// The matrix that the solver factors, of the session that is shown.
#[utoipa::path(get, path = "/rooms/{code}/schur", operation_id = "get_lecture_schur_complement", tag = "rooms", params(("code" = String, Path),
    ("at" = Option<f64>, Query)), responses((status = 200, description = "As /sessions/{id}/schur", body = ref(of::<SymmetricView>()))))]
#[allow(
    clippy::redundant_closure_for_method_calls,
    reason = "the method itself is not general enough in its lifetime"
)]
async fn schur(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    QueryParameters(when): QueryParameters<AtTime>,
) -> Result<JsonText, Problem> {
    symmetric(&app, &code, "schur", when, |state| state.schur()).await
}

async fn symmetric(
    app: &App,
    code: &str,
    name: &str,
    when: AtTime,
    matrix: fn(&StateView) -> triad_engine::reactions::matrices::Symmetric,
) -> Result<JsonText, Problem> {
    let what = format!("{name} {:?}", when.at);
    let lecture = app.lectures.get(code)?;
    let answer =
        lecture.cached(&what, |session| async move { symmetric_of(&session, when.at, matrix).await }).await;
    answer.map(json)
}

/// The multipliers of the session that is shown.
#[utoipa::path(get, path = "/rooms/{code}/multipliers", operation_id = "get_lecture_multipliers", tag = "rooms", params(("code" = String, Path),
    ("at" = Option<f64>, Query)),
    responses((status = 200, description = "As /sessions/{id}/multipliers", body = ref(of::<MultipliersList>()))))]
async fn multipliers(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    QueryParameters(when): QueryParameters<AtTime>,
) -> Result<JsonText, Problem> {
    let what = format!("multipliers {:?}", when.at);
    let lecture = app.lectures.get(&code)?;
    let answer =
        lecture.cached(&what, |session| async move { multipliers_of(&session, when.at).await }).await;
    answer.map(json)
}

/// The reactions of the session that is shown.
#[utoipa::path(get, path = "/rooms/{code}/reactions", operation_id = "get_lecture_reactions", tag = "rooms", params(("code" = String, Path),
    ("on" = Option<String>, Query), ("about" = Option<String>, Query), ("in" = Option<String>, Query),
    ("at" = Option<f64>, Query)),
    responses((status = 200, description = "As /sessions/{id}/reactions", body = ref(of::<ReactionsView>()))))]
async fn reactions(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    QueryParameters(wanted): QueryParameters<ReactionQuery>,
) -> Result<JsonText, Problem> {
    let what = format!("reactions {wanted:?}");
    let lecture = app.lectures.get(&code)?;
    let answer = lecture.cached(&what, |session| async move { reactions_of(&session, wanted).await }).await;
    answer.map(json)
}

/// A response that was written before.
type JsonText = ([(HeaderName, &'static str); 1], Bytes);

fn json(text: Bytes) -> JsonText {
    ([(CONTENT_TYPE, "application/json")], text)
}
