//! Regrades, for those who teach: look first, apply, take back.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::assignments::text_of;
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters};
use crate::api::guard::Caller;
use crate::api::lessons;
use crate::api::lessons::told::GradedSubmission;
use crate::app::App;
use crate::policy::Moment;
use crate::problem::Problem;
use crate::regrade::Preview;
use crate::store::{CLASS, RegradeRow};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<Preview>();
    schemas.answer::<RegradeProgress>();
    schemas.answer::<BothVerdicts>();
    schemas.request::<Application>();
    schemas.answer::<RegradeList>();
    OpenApiRouter::new()
        .routes(routes!(preview, progress))
        .routes(routes!(both))
        .routes(routes!(apply))
        .routes(routes!(undo))
        .routes(routes!(list))
}

/// Grade everything that was handed in to a lesson again, with the lesson as this server has it now, and look at what would
/// change. Nothing is written. A control run with the lesson of before shows apart what is this program's doing.
#[utoipa::path(post, path = "/assignments/{slug}/regrades", operation_id = "preview_regrade", tag = "class", params(("slug" = String, Path)), responses(
    (status = 200, description = "What would change, for whom", body = ref(of::<Preview>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn preview(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
) -> Result<Answer<Preview>, Problem> {
    let lesson = lessons::find(&app, &slug)?.clone();
    let progress = app.regrades.begin(&lesson.slug);
    let computed =
        crate::regrade::preview(&app.store, app.node.identifier(), CLASS, &lesson, progress).await?;
    Ok(Answer(app.regrades.keep(computed).shown.clone()))
}

/// How far a preview is.
#[derive(Debug, Serialize, JsonSchema)]
struct RegradeProgress {
    /// Whether one is being made.
    under_way: bool,
    /// Submissions that were graded again.
    done: usize,
    /// Submissions that are to be; 0 until they are counted.
    of: usize,
}

/// How far the preview of a lesson is that is being made.
#[utoipa::path(get, path = "/assignments/{slug}/regrades", operation_id = "get_regrade_progress", tag = "class", params(("slug" = String, Path)), responses(
    (status = 200, description = "How far it is", body = ref(of::<RegradeProgress>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn progress(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
) -> Result<Answer<RegradeProgress>, Problem> {
    let told = app.regrades.progress(&lessons::find(&app, &slug)?.slug);
    let (done, of) = told.unwrap_or_default();
    Ok(Answer(RegradeProgress { under_way: told.is_some(), done, of }))
}

/// The verdicts of a submission side by side.
#[derive(Debug, Serialize, JsonSchema)]
struct BothVerdicts {
    /// As it was told.
    #[schemars(with = "GradedSubmission")]
    before: Value,
    /// As it would be told; left out where the new lesson cannot grade it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<GradedSubmission>")]
    after: Option<Value>,
}

/// Both verdicts on a submission in a preview.
#[utoipa::path(get, path = "/regrades/{id}/submissions/{submission}", operation_id = "compare_verdicts", tag = "class",
    params(("id" = String, Path), ("submission" = String, Path)), responses(
    (status = 200, description = "Before and after", body = ref(of::<BothVerdicts>())),
    (status = 404, description = "No such preview, or it is too old", body = ref(PROBLEM))))]
async fn both(
    State(app): State<App>,
    PathParameters((id, submission)): PathParameters<(String, String)>,
) -> Result<Answer<BothVerdicts>, Problem> {
    let (before, after) = app.regrades.get(&id)?.verdicts(&submission)?;
    Ok(Answer(BothVerdicts { before, after }))
}

/// What counts of a regrade.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum Choice {
    /// The new verdicts, for everybody.
    Replace,
    /// The new verdicts for those who do not lose by them.
    Better,
}

/// How to apply a preview.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Application {
    /// What counts.
    choice: Choice,
    /// Why: students see it.
    reason: String,
}

/// Apply a preview: all of it or nothing. What was told before stays readable.
#[utoipa::path(post, path = "/regrades/{id}/apply", operation_id = "apply_regrade", tag = "class", params(("id" = String, Path)),
    request_body(content = ref(of::<Application>()), example = json!({"choice": "better", "reason": "the reference had the wrong sign"})), responses(
    (status = 204, description = "It counts"),
    (status = 404, description = "No such preview, or it is too old", body = ref(PROBLEM)),
    (status = 409, description = "Something was handed in, decided, set or allowed since", body = ref(PROBLEM)),
    (status = 422, description = "No reason", body = ref(PROBLEM))))]
async fn apply(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    caller: Caller,
    Json(how): Json<Application>,
) -> Result<StatusCode, Problem> {
    let reason = text_of(&how.reason, "/reason")?;
    let computed = app.regrades.get(&id)?;
    let new = computed.applied(CLASS, &caller.member()?.id, how.choice == Choice::Better, &reason);
    app.store.regrade(&new).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Take a regrade back: the verdicts of before hold again. The last one of a lesson first.
#[utoipa::path(post, path = "/regrades/{id}/undo", operation_id = "undo_regrade", tag = "class", params(("id" = String, Path)), responses(
    (status = 204, description = "The verdicts of before hold"),
    (status = 404, description = "No such regrade is in force", body = ref(PROBLEM)),
    (status = 409, description = "A later one is in force", body = ref(PROBLEM))))]
async fn undo(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    caller: Caller,
) -> Result<StatusCode, Problem> {
    app.store.undo_regrade(CLASS, &caller.member()?.id, &id).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Regrades that were applied, the latest first.
#[derive(Debug, Serialize, JsonSchema)]
struct RegradeList(Vec<AppliedRegrade>);

/// A regrade that was applied.
#[derive(Debug, Serialize, JsonSchema)]
struct AppliedRegrade {
    /// Its id.
    id: String,
    /// Slug of the lesson.
    lesson: String,
    /// What counted: `replace` or `better`.
    choice: String,
    /// Why.
    reason: String,
    /// Who asked for it.
    by: String,
    /// When.
    at: Moment,
    /// When it was taken back.
    #[serde(skip_serializing_if = "Option::is_none")]
    undone: Option<Moment>,
}

/// The regrades of the class.
#[utoipa::path(get, path = "/regrades", operation_id = "list_regrades", tag = "class", responses(
    (status = 200, description = "What was regraded, when and why", body = ref(of::<RegradeList>()))))]
async fn list(State(app): State<App>) -> Result<Answer<RegradeList>, Problem> {
    let applied = |row: RegradeRow| {
        let RegradeRow { id, lesson, choice, reason, by, at, undone } = row;
        AppliedRegrade { id, lesson, choice, reason, by, at, undone }
    };
    Ok(Answer(RegradeList(app.store.regrades(CLASS).await?.into_iter().map(applied).collect())))
}
