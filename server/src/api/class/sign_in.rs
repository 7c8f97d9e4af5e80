//! Coming in, coming back, going.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::access::phrase;
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::Json;
use crate::api::guard::{Caller, Peer, session_token};
use crate::app::App;
use crate::problem::Problem;
use crate::store::{CLASS, LIFE, Member, Return, names, secret};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<Me>();
    schemas.answer::<Welcome>();
    schemas.request::<Setup>();
    schemas.request::<Join>();
    schemas.request::<ComeBack>();
    OpenApiRouter::new()
        .routes(routes!(me))
        .routes(routes!(setup))
        .routes(routes!(join))
        .routes(routes!(come_back))
        .routes(routes!(sign_out))
}

/// How this server is used, and by whom.
#[derive(Debug, Serialize, JsonSchema)]
struct Me {
    /// `home`: no accounts, grades are for oneself; `class`: with accounts.
    mode: &'static str,
    /// Title of the class.
    #[serde(skip_serializing_if = "Option::is_none")]
    course: Option<String>,
    /// Whether students may join now.
    join_open: bool,
    /// Who is signed in.
    #[serde(skip_serializing_if = "Option::is_none")]
    person: Option<Somebody>,
    /// Signing in with the account of an institution, where the server knows its provider.
    #[serde(skip_serializing_if = "Option::is_none")]
    institution: Option<Institution>,
}

/// The institution with whose accounts people sign in.
#[derive(Debug, Serialize, JsonSchema)]
struct Institution {
    /// What people call it.
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    /// Whether who is signed in has connected an account.
    connected: bool,
}

/// How a class looks to whom it looks at.
async fn class_of(app: &App, member: Option<&Member>) -> Result<Me, Problem> {
    let course = app.store.course(CLASS).await?;
    let connected = match (&app.oidc, member) {
        (Some(_), Some(member)) => app.store.has_account(&member.id).await?,
        _ => false,
    };
    let named = |name: Option<&str>| Institution { name: name.map(str::to_owned), connected };
    let institution = app.oidc.as_ref().map(|oidc| named(oidc.name()));
    let person = member.map(Somebody::of);
    Ok(Me { mode: "class", course: Some(course.title), join_open: course.join_open, person, institution })
}

/// Somebody of the class.
#[derive(Debug, Serialize, JsonSchema)]
pub(in crate::api) struct Somebody {
    /// The person's id.
    pub(in crate::api) id: String,
    /// The name.
    pub(in crate::api) name: String,
    /// `student`, `grader`, `instructor` or `owner`.
    pub(in crate::api) role: &'static str,
}

impl Somebody {
    pub(in crate::api) fn of(member: &Member) -> Self {
        Self { id: member.id.clone(), name: member.name.clone(), role: member.role.name() }
    }
}

/// How this server is used, and who is signed in.
#[utoipa::path(get, path = "/me", operation_id = "get_me", tag = "class", responses(
    (status = 200, description = "The mode, the class and the person", body = ref(of::<Me>()))))]
async fn me(State(app): State<App>, Caller(member): Caller) -> Result<Answer<Me>, Problem> {
    if !app.access.is_class() {
        let me = Me { mode: "home", course: None, join_open: false, person: None, institution: None };
        return Ok(Answer(me));
    }
    Ok(Answer(class_of(&app, member.as_ref()).await?))
}

/// What somebody needs to come back on another device; it is told once.
#[derive(Debug, Serialize, JsonSchema)]
struct Welcome {
    /// Who came in.
    person: Somebody,
    /// Four words, to be written down.
    words: String,
    /// The secret of the link `/return#…`, for whoever prefers a bookmark.
    link: String,
}

/// An invitation that is followed.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Setup {
    /// The secret of the link `/setup#…`.
    token: String,
    /// The name that others see.
    name: String,
    /// Title of the class, if it is to be named now.
    #[serde(default)]
    title: Option<String>,
}

/// Follow an invitation, as the link that `triad serve --class` prints; it is used up.
#[utoipa::path(post, path = "/setup", operation_id = "follow_invitation", tag = "class",
    request_body(content = ref(of::<Setup>()), example = json!({"token": "…", "name": "Prof. Newton", "title": "Mechanics II"})), responses(
    (status = 201, description = "Welcome; the session is in a cookie", body = ref(of::<Welcome>())),
    (status = 404, description = "No such invitation", body = ref(PROBLEM)),
    (status = 409, description = "The name is taken", body = ref(PROBLEM)),
    (status = 429, description = "Too many tries", body = ref(PROBLEM))))]
async fn setup(
    State(app): State<App>,
    Peer(address): Peer,
    Json(setup): Json<Setup>,
) -> Result<Response, Problem> {
    app.access.check_tries(address)?;
    let name = person_name(&setup.name)?;
    let (words, back) = way_back().await?;
    let member = app.store.accept(&setup.token, &name, &back).await?;
    if let Some(title) = setup.title.filter(|_| member.role == crate::store::Role::Owner) {
        let title = title_of(&title)?;
        let course = app.store.course(CLASS).await?;
        app.store.set_course(CLASS, &member.id, &title, course.join_open, false).await?;
    }
    welcome(&app, &member, words, back.link).await
}

/// Somebody who joins.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Join {
    /// The code on the board.
    code: String,
    /// The name that the teacher knows.
    name: String,
}

/// Join the class as a student.
#[utoipa::path(post, path = "/join", operation_id = "join_class", tag = "class",
    request_body(content = ref(of::<Join>()), example = json!({"code": "bcdfghjk", "name": "Ada Lovelace"})), responses(
    (status = 201, description = "Welcome; the session is in a cookie", body = ref(of::<Welcome>())),
    (status = 403, description = "The code is wrong, or joining is closed", body = ref(PROBLEM)),
    (status = 409, description = "The name is taken", body = ref(PROBLEM)),
    (status = 429, description = "Too many tries", body = ref(PROBLEM))))]
async fn join(
    State(app): State<App>,
    Peer(address): Peer,
    Json(join): Json<Join>,
) -> Result<Response, Problem> {
    app.access.check_tries(address)?;
    let course = app.store.course(CLASS).await?;
    let typed: String = join.code.chars().filter(char::is_ascii_alphanumeric).collect();
    if !course.join_open || !typed.eq_ignore_ascii_case(&course.join_code) {
        return Err(Problem::new(
            StatusCode::FORBIDDEN,
            "wrong-code",
            "this code opens no class here, or joining is closed",
            "type the code as your teacher shows it; if it is right, ask whether joining is still open",
        ));
    }
    let name = person_name(&join.name)?;
    let (words, back) = way_back().await?;
    let member = app.store.join(CLASS, &name, &back).await?;
    welcome(&app, &member, words, back.link).await
}

/// Somebody who comes back: by name and words, or by a link.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ComeBack {
    /// The name.
    #[serde(default)]
    name: String,
    /// The four words.
    #[serde(default)]
    words: String,
    /// The secret of a link, instead of both.
    #[serde(default)]
    link: Option<String>,
}

/// Come back, on this or on another device.
#[utoipa::path(post, path = "/return", operation_id = "come_back", tag = "class",
    request_body(content = ref(of::<ComeBack>()), example = json!({"name": "Ada Lovelace", "words": "otter maple zinc harbor"})), responses(
    (status = 200, description = "Welcome back; the session is in a cookie", body = ref(of::<Me>())),
    (status = 403, description = "Name and words do not belong together, or the link leads to nobody", body = ref(PROBLEM)),
    (status = 429, description = "Too many tries", body = ref(PROBLEM))))]
async fn come_back(
    State(app): State<App>,
    Peer(address): Peer,
    Json(back): Json<ComeBack>,
) -> Result<Response, Problem> {
    app.access.check_tries(address)?;
    let person = if let Some(link) = &back.link {
        app.store.person_of_link(link).await?
    } else {
        // Who guesses is remembered by the name that was tried: one that nobody can have is none.
        let name = if names::is_endless(&back.name) { "" } else { back.name.as_str() };
        app.access.check_words(address, names::key(name))?;
        let known = app.store.phrase_of(CLASS, name).await?;
        let fits = phrase::in_turn(move || {
            Ok((phrase::fits(&back.words, known.as_ref().map(|k| k.1.as_str())), known))
        });
        let (fits, known) = fits.await?;
        known.filter(|_| fits).map(|(person, _)| person)
    };
    let person = person.ok_or_else(|| {
        Problem::new(
            StatusCode::FORBIDDEN,
            "wrong-words",
            "this name and these words do not belong together, or the link leads to nobody",
            "look at what you wrote down; your teacher can give you other words",
        )
    })?;
    let token = app.store.begin_session(&person).await?;
    let member = app.store.member_of_session(CLASS, &token).await?;
    let me = class_of(&app, member.as_ref()).await?;
    Ok((StatusCode::OK, [(header::SET_COOKIE, cookie(&app, &token, LIFE / 1000)?)], Answer(me))
        .into_response())
}

/// End the session of this browser.
#[utoipa::path(post, path = "/sign-out", operation_id = "sign_out", tag = "class", responses(
    (status = 204, description = "It is over")))]
async fn sign_out(State(app): State<App>, headers: HeaderMap) -> Result<Response, Problem> {
    if let Some(token) = session_token(&app, &headers) {
        app.store.end_session(&token).await?;
    }
    Ok((StatusCode::NO_CONTENT, [(header::SET_COOKIE, cookie(&app, "", 0)?)]).into_response())
}

/// The cookie of a session.
pub(in crate::api) fn cookie(app: &App, token: &str, seconds: i64) -> Result<HeaderValue, Problem> {
    let (name, rest) = app.access.cookie();
    HeaderValue::from_str(&format!("{name}={token}; Max-Age={seconds}{rest}")).map_err(Problem::internal)
}

/// Four words and a link, with what is kept of them.
pub(in crate::api) async fn way_back() -> Result<(String, Return), Problem> {
    phrase::in_turn(|| {
        let words = phrase::generate()?;
        let link = secret();
        let phrase = phrase::hash(&words)?;
        Ok((words, Return { phrase, link }))
    })
    .await
}

async fn welcome(app: &App, member: &Member, words: String, link: String) -> Result<Response, Problem> {
    let token = app.store.begin_session(&member.id).await?;
    let welcome = Welcome { person: Somebody::of(member), words, link };
    let cookie = [(header::SET_COOKIE, cookie(app, &token, LIFE / 1000)?)];
    Ok((StatusCode::CREATED, cookie, Answer(welcome)).into_response())
}

/// A name of reasonable length, as it is shown.
fn person_name(typed: &str) -> Result<String, Problem> {
    text_of(typed, "/name", "name").map(|name| names::shown(&name))
}

/// A title of reasonable length.
pub(in crate::api) fn title_of(typed: &str) -> Result<String, Problem> {
    text_of(typed, "/title", "title")
}

fn text_of(typed: &str, pointer: &str, what: &str) -> Result<String, Problem> {
    let shown = if names::is_endless(typed) { String::new() } else { names::shown(typed) };
    if !shown.is_empty() && shown.chars().count() <= names::LONGEST {
        return Ok(shown);
    }
    let wrong = format!("the {what} is empty or has more than {} characters", names::LONGEST);
    let hint = "write it as others know it";
    Err(Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-name", wrong.clone(), hint)
        .at(pointer, wrong))
}
