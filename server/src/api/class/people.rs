//! The class and its people, for those who run it.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::sign_in::{Somebody, title_of, way_back};
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters};
use crate::api::guard::Caller;
use crate::app::App;
use crate::problem::Problem;
use crate::store::{CLASS, CourseRow, Role};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<ClassView>();
    schemas.request::<ClassChange>();
    schemas.answer::<PeopleList>();
    schemas.request::<NewRole>();
    schemas.answer::<NewWords>();
    schemas.answer::<Invitation>();
    OpenApiRouter::new()
        .routes(routes!(show, change))
        .routes(routes!(list))
        .routes(routes!(appoint))
        .routes(routes!(renew))
        .routes(routes!(invite))
}

/// The class.
#[derive(Debug, Serialize, JsonSchema)]
struct ClassView {
    /// Its title.
    title: String,
    /// What students type to join.
    join_code: String,
    /// Whether they may.
    join_open: bool,
}

impl From<CourseRow> for ClassView {
    fn from(row: CourseRow) -> Self {
        Self { title: row.title, join_code: row.join_code, join_open: row.join_open }
    }
}

/// The class, with the code with which students join.
#[utoipa::path(get, path = "/course", operation_id = "get_class", tag = "class", responses(
    (status = 200, description = "Title and code", body = ref(of::<ClassView>()))))]
async fn show(State(app): State<App>) -> Result<Answer<ClassView>, Problem> {
    Ok(Answer(app.store.course(CLASS).await?.into()))
}

/// What is to change; what is left out stays.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ClassChange {
    /// The title.
    #[serde(default)]
    title: Option<String>,
    /// Whether students may join.
    #[serde(default)]
    join_open: Option<bool>,
    /// Another code; the one of before opens nothing any more.
    #[serde(default)]
    new_code: bool,
}

/// Change the title, the code, or whether students may join.
#[utoipa::path(put, path = "/course", operation_id = "change_class", tag = "class",
    request_body(content = ref(of::<ClassChange>()), example = json!({"join_open": false})), responses(
    (status = 200, description = "The class after it", body = ref(of::<ClassView>())),
    (status = 422, description = "Not a title", body = ref(PROBLEM))))]
async fn change(
    State(app): State<App>,
    caller: Caller,
    Json(change): Json<ClassChange>,
) -> Result<Answer<ClassView>, Problem> {
    let before = app.store.course(CLASS).await?;
    let title = change.title.as_deref().map_or(Ok(before.title), title_of)?;
    let open = change.join_open.unwrap_or(before.join_open);
    let actor = caller.member()?.id;
    Ok(Answer(app.store.set_course(CLASS, &actor, &title, open, change.new_code).await?.into()))
}

/// People of the class, by name.
#[derive(Debug, Serialize, JsonSchema)]
struct PeopleList(Vec<Somebody>);

/// Everybody in the class.
#[utoipa::path(get, path = "/people", operation_id = "list_people", tag = "class", responses(
    (status = 200, description = "Names and roles", body = ref(of::<PeopleList>()))))]
async fn list(State(app): State<App>) -> Result<Answer<PeopleList>, Problem> {
    Ok(Answer(PeopleList(app.store.people(CLASS).await?.iter().map(Somebody::of).collect())))
}

/// A role.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct NewRole {
    /// `student`, `grader`, `instructor` or `owner`.
    role: String,
}

fn role_of(name: &str) -> Result<Role, Problem> {
    Role::named(name).ok_or_else(|| {
        let wrong = format!("there is no role called \"{name}\"");
        let hint = "roles are student, grader, instructor and owner";
        Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "unknown-role", wrong.clone(), hint).at("/role", wrong)
    })
}

/// Give somebody another role.
#[utoipa::path(put, path = "/people/{person}/role", operation_id = "set_role", tag = "class", params(("person" = String, Path)),
    request_body(content = ref(of::<NewRole>()), example = json!({"role": "grader"})), responses(
    (status = 204, description = "It is so"),
    (status = 404, description = "No such person", body = ref(PROBLEM)),
    (status = 409, description = "The class would be without an owner", body = ref(PROBLEM)),
    (status = 422, description = "No such role", body = ref(PROBLEM))))]
async fn appoint(
    State(app): State<App>,
    PathParameters(person): PathParameters<String>,
    caller: Caller,
    Json(new): Json<NewRole>,
) -> Result<StatusCode, Problem> {
    let role = role_of(&new.role)?;
    app.store.set_role(CLASS, &caller.member()?.id, &person, role).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Words and link of somebody who lost theirs.
#[derive(Debug, Serialize, JsonSchema)]
struct NewWords {
    /// Four words.
    words: String,
    /// The secret of the link `/return#…`.
    link: String,
}

/// Give somebody other words and another link; those of before are worth nothing, and their sessions end.
#[utoipa::path(post, path = "/people/{person}/words", operation_id = "renew_words", tag = "class", params(("person" = String, Path)), responses(
    (status = 201, description = "What to tell them", body = ref(of::<NewWords>())),
    (status = 403, description = "They may more than you", body = ref(PROBLEM)),
    (status = 404, description = "No such person", body = ref(PROBLEM))))]
async fn renew(
    State(app): State<App>,
    PathParameters(person): PathParameters<String>,
    caller: Caller,
) -> Result<(StatusCode, Answer<NewWords>), Problem> {
    let actor = caller.member()?;
    let people = app.store.people(CLASS).await?;
    // Whoever gives words can come in with them.
    if people.iter().any(|other| other.id == person && other.role > actor.role) {
        return Err(Problem::new(
            StatusCode::FORBIDDEN,
            "not-yours",
            "this person may more than you",
            "ask an owner of the class",
        ));
    }
    let (words, back) = way_back().await?;
    app.store.renew_return(CLASS, &actor.id, &person, &back).await?;
    Ok((StatusCode::CREATED, Answer(NewWords { words, link: back.link })))
}

/// An invitation.
#[derive(Debug, Serialize, JsonSchema)]
struct Invitation {
    /// The secret of the link `/setup#…`, good for one person and a week.
    token: String,
}

/// Invite somebody who is to grade or teach.
#[utoipa::path(post, path = "/invitations", operation_id = "invite", tag = "class",
    request_body(content = ref(of::<NewRole>()), example = json!({"role": "instructor"})), responses(
    (status = 201, description = "The secret of the link", body = ref(of::<Invitation>())),
    (status = 422, description = "No such role", body = ref(PROBLEM))))]
async fn invite(
    State(app): State<App>,
    caller: Caller,
    Json(new): Json<NewRole>,
) -> Result<(StatusCode, Answer<Invitation>), Problem> {
    let role = role_of(&new.role)?;
    let token = app.store.invite(CLASS, &caller.member()?.id, role).await?;
    Ok((StatusCode::CREATED, Answer(Invitation { token })))
}
