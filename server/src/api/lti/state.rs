//! How it stands with the learning platform, for those who teach.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::Serialize;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::lti;
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::guard::Caller;
use crate::app::App;
use crate::lti::scores;
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::{CLASS, ColumnState, Platform};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<PlatformList>();
    schemas.answer::<Taken>();
    OpenApiRouter::new().routes(routes!(show)).routes(routes!(roster)).routes(routes!(send_again))
}

/// The learning platforms of the class.
#[derive(Debug, Serialize, JsonSchema)]
struct PlatformList {
    /// Whether this server is reached by learning platforms at all.
    reached: bool,
    /// Those that are registered.
    platforms: Vec<PlatformView>,
}

/// A learning platform.
#[derive(Debug, Serialize, JsonSchema)]
struct PlatformView {
    /// What it calls itself.
    issuer: String,
    /// Its courses whose people come into the class.
    courses: Vec<CourseView>,
    /// Where scores go.
    columns: Vec<ColumnView>,
    /// Until when nothing is asked of it, as it did not answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    paused_until: Option<Moment>,
    /// What it did instead; empty if all is well.
    problem: String,
}

/// A course of the platform.
#[derive(Debug, Serialize, JsonSchema)]
struct CourseView {
    /// Its title there.
    title: String,
    /// Whether its people can be taken over.
    roster: bool,
}

/// The column of a lesson.
#[derive(Debug, Serialize, JsonSchema)]
struct ColumnView {
    /// Slug of the lesson.
    lesson: String,
    /// Whether the platform has it; else it is asked for one.
    ready: bool,
    /// Scores that belong there.
    scores: u32,
    /// Those that the platform has.
    sent: u32,
    /// Those that were refused so often that they wait for somebody to ask for it.
    given_up: u32,
    /// Why the last one that waits was refused; empty if none was.
    problem: String,
    /// When one was sent last.
    #[serde(skip_serializing_if = "Option::is_none")]
    last: Option<Moment>,
}

impl From<ColumnState> for ColumnView {
    fn from(state: ColumnState) -> Self {
        let ColumnState { column, scores, sent, given_up, problem, last } = state;
        Self { lesson: column.lesson, ready: !column.url.is_empty(), scores, sent, given_up, problem, last }
    }
}

/// The learning platforms of the class, and which scores they have.
#[utoipa::path(get, path = "/lti", operation_id = "get_lti", tag = "class", responses(
    (status = 200, description = "What is registered, linked, sent and waiting", body = ref(of::<PlatformList>()))))]
async fn show(State(app): State<App>) -> Result<Answer<PlatformList>, Problem> {
    let mut platforms = Vec::new();
    for platform in app.store.platforms(CLASS).await? {
        platforms.push(view(&app, platform).await?);
    }
    Ok(Answer(PlatformList { reached: app.lti.is_some(), platforms }))
}

async fn view(app: &App, platform: Platform) -> Result<PlatformView, Problem> {
    let contexts = app.store.contexts(&platform.id).await?.into_iter();
    let pause = app.store.pause_of(&platform.id).await?;
    Ok(PlatformView {
        courses: contexts
            .map(|one| CourseView { title: one.title, roster: !one.members.is_empty() })
            .collect(),
        columns: app.store.column_states(&platform.id).await?.into_iter().map(ColumnView::from).collect(),
        paused_until: Some(Moment(pause.until)).filter(|until| *until > Moment::now()),
        problem: pause.problem,
        issuer: platform.issuer,
    })
}

/// How many people were taken over.
#[derive(Debug, Serialize, JsonSchema)]
struct Taken {
    /// People whom the platform lists.
    listed: usize,
    /// Those who were not in the class before.
    new: usize,
}

/// Take over the people of the platform's courses, before they have come: they are in the table of the class then. Nobody is
/// removed.
#[utoipa::path(post, path = "/lti/roster", operation_id = "take_roster", tag = "class", responses(
    (status = 200, description = "How many there are", body = ref(of::<Taken>())),
    (status = 404, description = "No platform reaches this server", body = ref(PROBLEM)),
    (status = 502, description = "A platform does not list its people", body = ref(PROBLEM))))]
async fn roster(State(app): State<App>, caller: Caller) -> Result<Answer<Taken>, Problem> {
    let lti = lti(&app)?;
    let mut taken = Taken { listed: 0, new: 0 };
    for platform in app.store.platforms(CLASS).await? {
        for context in app.store.contexts(&platform.id).await?.iter().filter(|one| !one.members.is_empty()) {
            let listed =
                lti.roster(&app.store, &platform, context, Moment::now()).await.map_err(|error| {
                    Problem::new(
                        StatusCode::BAD_GATEWAY,
                        "lti-roster",
                        error.to_string(),
                        "people also come in one by one, as they open a lesson from their course",
                    )
                })?;
            taken.listed += listed.len();
            taken.new += app.store.enlist(CLASS, &platform.id, &context.id, &listed).await?;
        }
    }
    let actor = caller.member()?.id;
    app.store.note(CLASS, &actor, "took over the roster", &taken.listed.to_string()).await?;
    Ok(Answer(taken))
}

/// Send at once what the platforms do not have yet, what was refused too.
#[utoipa::path(post, path = "/lti/scores", operation_id = "send_scores", tag = "class", responses(
    (status = 200, description = "How it stands after it", body = ref(of::<PlatformList>())),
    (status = 404, description = "No platform reaches this server", body = ref(PROBLEM))))]
async fn send_again(State(app): State<App>) -> Result<Answer<PlatformList>, Problem> {
    let lti = lti(&app)?;
    for platform in app.store.platforms(CLASS).await? {
        app.store.send_again(&platform.id).await?;
    }
    scores::plan(&app.store, &app.course, Moment::now()).await?;
    scores::deliver(lti, &app.store, &app.course, &Moment::now).await?;
    show(State(app)).await
}
