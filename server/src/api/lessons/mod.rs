//! Lessons, as students may see them.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

mod asked_table;
pub(in crate::api) mod predictions;
pub(in crate::api) mod submissions;
pub(in crate::api) mod told;
pub(in crate::api) mod waiting;

use std::sync::Arc;

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_lessons::CourseError;
use triad_lessons::lesson::{Lesson, LessonSummary, LessonView};
use triad_lessons::tasks::starter::{Language, UnknownLanguage};
use triad_lessons::{InstancesView, NotionGraph, Understood};
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::api::guard::Caller;
use crate::app::App;
use crate::blocking;
use crate::grades::assigned;
use crate::problem::{Problem, suggest};
use crate::store::{CLASS, Role};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<LessonList>();
    schemas.answer::<NotionGraph>();
    schemas.answer::<LessonView>();
    schemas.answer::<Hint>();
    schemas.answer::<InstancesView>();
    schemas.request::<TypedAnswer>();
    schemas.answer::<Understood>();
    OpenApiRouter::new()
        .routes(routes!(list))
        .routes(routes!(notions))
        .routes(routes!(show))
        .routes(routes!(hint))
        .routes(routes!(reading))
        .routes(routes!(states))
        .routes(routes!(starter))
        .merge(asked_table::routes(schemas))
}

impl From<CourseError> for Problem {
    fn from(error: CourseError) -> Self {
        Self::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            error.code(),
            format!("the course was refused: {error}"),
            "correct that file, then run `triad lesson check`",
        )
    }
}

/// The lesson of that name.
pub(in crate::api) fn find<'a>(app: &'a App, name: &str) -> Result<&'a Lesson, Problem> {
    app.course.lesson(name).ok_or_else(|| unknown(&app.course, name))
}

/// The answer to the name of a lesson that does not exist.
pub(crate) fn unknown(course: &triad_lessons::Course, name: &str) -> Problem {
    Problem::new(
        StatusCode::NOT_FOUND,
        "unknown-lesson",
        format!("there is no lesson called \"{name}\""),
        suggest(name, course.lessons().iter().map(|lesson| lesson.slug.as_str())),
    )
}

/// The lessons of a course.
#[derive(Debug, Serialize, JsonSchema)]
struct LessonList(Vec<LessonSummary>);

/// The lessons, in the order of the course.
#[utoipa::path(get, path = "/lessons", operation_id = "list_lessons", tag = "lessons", responses(
    (status = 200, description = "Slug, number, title, summary, minutes and objectives of each", body = ref(of::<LessonList>()))))]
async fn list(State(app): State<App>) -> Answer<LessonList> {
    Answer(LessonList(app.course.lessons().iter().map(Lesson::summary).collect()))
}

/// What each lesson introduces, and what it needs from which other: the lessons that are taken, and those at hand beside them.
#[utoipa::path(get, path = "/notions", operation_id = "get_notions", tag = "lessons", responses(
    (status = 200, description = "The graph", body = ref(of::<NotionGraph>()))))]
async fn notions(State(app): State<App>) -> Answer<NotionGraph> {
    Answer(NotionGraph::of(&app.course))
}

/// Whose numbers.
#[derive(Debug, Default, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct Whose {
    /// A student's name; the same name gives the same numbers for ever. Without it, the numbers that everybody sees.
    student: Option<String>,
    /// Another seed in the place of a student's name.
    seed: Option<String>,
}

impl Whose {
    fn seed(&self) -> Option<&str> {
        self.seed.as_deref().or(self.student.as_deref())
    }
}

/// The lesson of that name with the numbers of who asks: at home those of the name or seed that is asked for, in a class
/// the caller's own. Those who grade may look at any.
///
/// Errors if somebody else's are asked for.
pub(in crate::api) fn variant(
    app: &App,
    name: &str,
    asked: Option<&str>,
    caller: &Caller,
) -> Result<Arc<Lesson>, Problem> {
    numbered(app, find(app, name)?, asked, caller)
}

/// The same of a lesson that was found.
fn numbered(
    app: &App,
    lesson: &Lesson,
    asked: Option<&str>,
    caller: &Caller,
) -> Result<Arc<Lesson>, Problem> {
    if !app.access.is_class() {
        return app.variants.of(lesson, asked.unwrap_or_default());
    }
    let member = caller.0.as_ref();
    match (asked.filter(|asked| !asked.is_empty()), member) {
        (None, None) => app.variants.of(lesson, ""),
        (None, Some(member)) => app.variants.of(lesson, &app.access.seed_of(member)),
        (Some(asked), Some(member)) if member.role > Role::Student => app.variants.of(lesson, asked),
        (Some(_), _) => Err(Problem::new(
            StatusCode::FORBIDDEN,
            "not-your-numbers",
            "in a class everybody has their own numbers, and they are not chosen",
            "leave out `seed` and `student`",
        )),
    }
}

/// Whose numbers a student is told that they see: in a class the name, since the seed would let others compute them.
fn told_seed(app: &App, caller: &Caller, seed: &mut String) {
    if app.access.is_class() && !seed.is_empty() {
        *seed = caller.0.as_ref().map_or_else(String::new, |member| member.name.clone());
    }
}

/// A lesson: its text, its scenario and its exercise, without the answers.
#[utoipa::path(get, path = "/lessons/{slug}", operation_id = "get_lesson", tag = "lessons", params(("slug" = String, Path), Whose), responses(
    (status = 200, description = "The lesson", body = ref(of::<LessonView>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn show(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
    caller: Caller,
    QueryParameters(whose): QueryParameters<Whose>,
) -> Result<Answer<LessonView>, Problem> {
    let mut lesson = find(&app, &slug)?.clone();
    if app.access.is_class() {
        // It promises no right answers that a policy never tells.
        lesson = assigned(&lesson, &app.store.assignment(CLASS, &lesson.slug).await?.policy);
    }
    blocking(move || {
        let mut view = numbered(&app, &lesson, whose.seed(), &caller)?.public_view();
        told_seed(&app, &caller, &mut view.seed);
        Ok(Answer(view))
    })
    .await
}

/// One hint.
#[derive(Debug, Serialize, JsonSchema)]
struct Hint {
    /// Its text.
    html: String,
}

/// A hint to a question; the first is number 1.
#[utoipa::path(get, path = "/lessons/{slug}/questions/{id}/hints/{k}", operation_id = "get_hint", tag = "lessons",
    params(("slug" = String, Path), ("id" = String, Path), ("k" = usize, Path), Whose), responses(
    (status = 200, description = "The hint", body = ref(of::<Hint>())),
    (status = 404, description = "No such lesson, question or hint", body = ref(PROBLEM))))]
async fn hint(
    State(app): State<App>,
    PathParameters((slug, id, k)): PathParameters<(String, String, usize)>,
    caller: Caller,
    QueryParameters(whose): QueryParameters<Whose>,
) -> Result<Answer<Hint>, Problem> {
    let lesson = blocking(move || variant(&app, &slug, whose.seed(), &caller)).await?;
    let question = lesson.question(&id).ok_or_else(|| unknown_question(&lesson, &id))?;
    let html = lesson.hint_html(&id, k).ok_or_else(|| {
        Problem::new(
            StatusCode::NOT_FOUND,
            "unknown-hint",
            format!("question {id} has {} hints, there is no number {k}", question.hints.len()),
            "hints are counted from 1",
        )
    })?;
    Ok(Answer(Hint { html }))
}

/// An answer to read.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TypedAnswer {
    /// A number, a list of numbers, or a formula, as typed.
    #[schemars(with = "triad_lessons::answers::TypedValue")]
    value: triad_lessons::answers::TypedValue,
    /// The unit of the value, as typed.
    #[serde(default)]
    unit: Option<String>,
}

/// How an answer is understood: the same reader as the grader's, which compares nothing here and keeps nothing.
#[utoipa::path(post, path = "/lessons/{slug}/questions/{id}/reading", operation_id = "read_answer", tag = "lessons",
    params(("slug" = String, Path), ("id" = String, Path)),
    request_body(content = ref(of::<TypedAnswer>()), example = json!({"value": "3*9.81 newton"})), responses(
    (status = 200, description = "The answer as it is read, or what to change", body = ref(of::<Understood>())),
    (status = 404, description = "No such lesson, or no such question with a typed answer", body = ref(PROBLEM))))]
async fn reading(
    State(app): State<App>,
    PathParameters((slug, id)): PathParameters<(String, String)>,
    Json(body): Json<TypedAnswer>,
) -> Result<Answer<Understood>, Problem> {
    let lesson = find(&app, &slug)?;
    let question = lesson.question(&id).ok_or_else(|| unknown_question(lesson, &id))?;
    let typed = triad_lessons::Answer { value: Some(body.value), unit: body.unit, ..Default::default() };
    let understood = triad_lessons::understand(question, &typed).ok_or_else(|| {
        let detail = format!("the answer to question {id} is not typed");
        Problem::new(
            StatusCode::NOT_FOUND,
            "not-typed",
            detail,
            "ask about a number, a vector, a matrix or a formula",
        )
    })?;
    Ok(Answer(understood))
}

/// The states at which a student's own program evaluates the equations.
#[utoipa::path(get, path = "/lessons/{slug}/questions/{id}/states", operation_id = "get_question_states", tag = "lessons",
    params(("slug" = String, Path), ("id" = String, Path), Whose), responses(
    (status = 200, description = "The mechanism in numbers, names of rows and columns, and the states", body = ref(of::<InstancesView>())),
    (status = 404, description = "No such lesson, or no such question of kind implement", body = ref(PROBLEM))))]
async fn states(
    State(app): State<App>,
    PathParameters((slug, id)): PathParameters<(String, String)>,
    caller: Caller,
    QueryParameters(whose): QueryParameters<Whose>,
) -> Result<Answer<InstancesView>, Problem> {
    let instances = blocking(move || {
        let lesson = variant(&app, &slug, whose.seed(), &caller)?;
        let mut view = instances(&lesson, &id)?;
        told_seed(&app, &caller, &mut view.seed);
        Ok(view)
    });
    Ok(Answer(instances.await?))
}

/// The states of a question.
pub(crate) fn instances(lesson: &Lesson, id: &str) -> Result<InstancesView, Problem> {
    let instances = lesson.instances(id).ok_or_else(|| not_to_implement(lesson, id))?;
    instances.map_err(Problem::internal)
}

/// A program that reads the states and writes the answer, without the equations.
#[utoipa::path(get, path = "/lessons/{slug}/questions/{id}/starters/{language}", operation_id = "get_starter", tag = "lessons",
    params(("slug" = String, Path), ("id" = String, Path), ("language" = String, Path,
    description = "python, octave (the same as matlab) or julia")), responses(
    (status = 200, description = "The program", body = String, content_type = "text/plain"),
    (status = 404, description = "No such lesson, question or language", body = ref(PROBLEM))))]
async fn starter(
    State(app): State<App>,
    PathParameters((slug, id, language)): PathParameters<(String, String, String)>,
) -> Result<impl IntoResponse, Problem> {
    let lesson = find(&app, &slug)?;
    let (name, text) = starter_of(lesson, &id, &language)?;
    let disposition = format!("attachment; filename=\"{name}\"");
    Ok((
        [
            (header::CONTENT_TYPE, "text/plain; charset=utf-8".to_owned()),
            (header::CONTENT_DISPOSITION, disposition),
        ],
        text,
    ))
}

/// Name and text of a starter.
pub(crate) fn starter_of(
    lesson: &Lesson,
    id: &str,
    language: &str,
) -> Result<(&'static str, String), Problem> {
    let known: Language = language.parse().map_err(|error: UnknownLanguage| {
        Problem::new(
            StatusCode::NOT_FOUND,
            "unknown-language",
            format!("there is no starter in {language}"),
            error.to_string(),
        )
    })?;
    let text = lesson.starter(id, known).ok_or_else(|| not_to_implement(lesson, id))?;
    Ok((known.file(), text))
}

pub(in crate::api) fn unknown_question(lesson: &Lesson, id: &str) -> Problem {
    Problem::new(
        StatusCode::NOT_FOUND,
        "unknown-question",
        format!("the lesson {} has no question called \"{id}\"", lesson.slug),
        suggest(id, lesson.exercise.questions.iter().map(|question| question.id.as_str())),
    )
}

/// The answer to a question that is not there, or that asks for no program.
fn not_to_implement(lesson: &Lesson, id: &str) -> Problem {
    not_asked(
        lesson,
        id,
        "not-to-implement",
        "a program",
        "states and starters belong to questions of kind implement",
    )
}

/// The answer to a question that is not there, or does not ask for such a thing.
fn not_asked(lesson: &Lesson, id: &str, code: &'static str, thing: &str, remedy: &'static str) -> Problem {
    if lesson.question(id).is_none() {
        return unknown_question(lesson, id);
    }
    Problem::new(StatusCode::NOT_FOUND, code, format!("the question {id} does not ask for {thing}"), remedy)
}
