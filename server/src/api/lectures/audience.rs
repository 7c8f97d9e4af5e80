//! What followers ask, and what the presenter does with it.

use axum::extract::State;
use axum::http::{HeaderMap, StatusCode};
use schemars::JsonSchema;
use serde::Deserialize;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::as_presenter;
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters};
use crate::app::App;
use crate::lecture::{NewRemark, Presence};
use crate::problem::Problem;

pub(super) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<NewRemark>();
    schemas.request::<ShownRemark>();
    schemas.request::<Presence>();
    OpenApiRouter::new()
        .routes(routes!(remark))
        .routes(routes!(show_remark, settle))
        .routes(routes!(lower_hands))
}

/// Ask the presenter something, without a name.
#[utoipa::path(post, path = "/rooms/{code}/remarks", operation_id = "ask_presenter", tag = "rooms", params(("code" = String, Path)),
    request_body(content = ref(of::<NewRemark>())), responses(
    (status = 204, description = "The presenter sees it, and decides whether everybody does"),
    (status = 422, description = "It is empty or too long", body = ref(PROBLEM)),
    (status = 429, description = "It comes too soon after another", body = ref(PROBLEM)),
    (status = 503, description = "Too many wait", body = ref(PROBLEM))))]
async fn remark(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    Json(new): Json<NewRemark>,
) -> Result<StatusCode, Problem> {
    app.lectures.get(&code)?.remark(&new)?;
    Ok(StatusCode::NO_CONTENT)
}

/// Whether a follower's question is shown.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ShownRemark {
    /// To everybody, in place of the one before.
    shown: bool,
}

/// Show everybody a follower's question, or show it no longer. For the presenter.
#[utoipa::path(put, path = "/rooms/{code}/remarks/{number}", operation_id = "show_remark", tag = "rooms",
    params(("code" = String, Path), ("number" = u64, Path)), request_body(content = ref(of::<ShownRemark>())), responses(
    (status = 204, description = "Followers are being sent it"),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM)),
    (status = 404, description = "No such question waits", body = ref(PROBLEM))))]
async fn show_remark(
    State(app): State<App>,
    PathParameters((code, number)): PathParameters<(String, u64)>,
    headers: HeaderMap,
    Json(remark): Json<ShownRemark>,
) -> Result<StatusCode, Problem> {
    as_presenter(&app, &code, &headers)?.show_remark(number, remark.shown)?;
    Ok(StatusCode::NO_CONTENT)
}

/// Take a follower's question from the list. For the presenter.
#[utoipa::path(delete, path = "/rooms/{code}/remarks/{number}", operation_id = "settle_remark", tag = "rooms",
    params(("code" = String, Path), ("number" = u64, Path)), responses(
    (status = 204, description = "It is gone"),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM))))]
async fn settle(
    State(app): State<App>,
    PathParameters((code, number)): PathParameters<(String, u64)>,
    headers: HeaderMap,
) -> Result<StatusCode, Problem> {
    as_presenter(&app, &code, &headers)?.settle(number);
    Ok(StatusCode::NO_CONTENT)
}

/// Put down all hands. For the presenter.
#[utoipa::path(delete, path = "/rooms/{code}/hands", operation_id = "lower_hands", tag = "rooms", params(("code" = String, Path)), responses(
    (status = 204, description = "They are down"),
    (status = 403, description = "The key is missing or wrong", body = ref(PROBLEM))))]
async fn lower_hands(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    headers: HeaderMap,
) -> Result<StatusCode, Problem> {
    as_presenter(&app, &code, &headers)?.lower_hands();
    Ok(StatusCode::NO_CONTENT)
}
