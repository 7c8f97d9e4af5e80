//! What the answers of the class say about the questions, for those who grade.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use std::collections::HashSet;

use axum::Json as Answer;
use axum::extract::State;
use axum::http::header;
use axum::response::IntoResponse;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::analysis::{Class, ClassWords, LessonFigures, QuestionAnalysis, answers_csv, figures_csv};
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::PathParameters;
use crate::api::guard::Caller;
use crate::api::lessons;
use crate::app::App;
use crate::blocking;
use crate::grades::Book;
use crate::problem::Problem;
use crate::store::{CLASS, Role};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<LessonFigures>();
    schemas.answer::<QuestionAnalysis>();
    schemas.answer::<ClassWords>();
    OpenApiRouter::new()
        .routes(routes!(figures))
        .routes(routes!(figures_sheet))
        .routes(routes!(question))
        .routes(routes!(answers_sheet))
        .routes(routes!(words))
}

async fn of_lesson(app: &App, slug: &str) -> Result<LessonFigures, Problem> {
    let lesson = lessons::find(app, slug)?;
    let class = Class::open(&app.store, CLASS, &lesson.slug).await?;
    Ok(LessonFigures::of(lesson, &class))
}

/// The questions of a lesson in figures: how hard each is, whether it tells the strong from the weak, which mistakes are made.
/// Without names.
#[utoipa::path(get, path = "/assignments/{slug}/questions", operation_id = "analyse_lesson", tag = "class", params(("slug" = String, Path)), responses(
    (status = 200, description = "Figures of each question", body = ref(of::<LessonFigures>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn figures(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
) -> Result<Answer<LessonFigures>, Problem> {
    Ok(Answer(of_lesson(&app, &slug).await?))
}

/// The same as CSV.
#[utoipa::path(get, path = "/assignments/{slug}/questions.csv", operation_id = "analyse_lesson_csv", tag = "class", params(("slug" = String, Path)), responses(
    (status = 200, description = "A row for each question", body = String, content_type = "text/csv"),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn figures_sheet(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
) -> Result<impl IntoResponse, Problem> {
    Ok(sheet("questions.csv", figures_csv(&of_lesson(&app, &slug).await?)?))
}

/// What the answers of the class say about one question: its figures, the mistakes with the answers behind each, options, drawn
/// numbers, and answers that are almost right.
#[utoipa::path(get, path = "/assignments/{slug}/questions/{id}", operation_id = "analyse_question", tag = "class",
    params(("slug" = String, Path), ("id" = String, Path)), responses(
    (status = 200, description = "The analysis, with names", body = ref(of::<QuestionAnalysis>())),
    (status = 404, description = "No such lesson or question", body = ref(PROBLEM))))]
async fn question(
    State(app): State<App>,
    PathParameters((slug, id)): PathParameters<(String, String)>,
) -> Result<Answer<QuestionAnalysis>, Problem> {
    let lesson = lessons::find(&app, &slug)?.clone();
    let mut class = Class::open(&app.store, CLASS, &lesson.slug).await?;
    blocking(move || {
        let works = class.questions.remove(&id).unwrap_or_default();
        let found = QuestionAnalysis::of(&lesson, (&app.variants, &app.near), &id, &works)?;
        found.map(Answer).ok_or_else(|| lessons::unknown_question(&lesson, &id))
    })
    .await
}

/// Every answer of the class to one question as CSV.
#[utoipa::path(get, path = "/assignments/{slug}/questions/{id}/answers.csv", operation_id = "list_answers_csv", tag = "class",
    params(("slug" = String, Path), ("id" = String, Path)), responses(
    (status = 200, description = "A row for each answer", body = String, content_type = "text/csv"),
    (status = 404, description = "No such lesson or question", body = ref(PROBLEM))))]
async fn answers_sheet(
    State(app): State<App>,
    PathParameters((slug, id)): PathParameters<(String, String)>,
    caller: Caller,
) -> Result<impl IntoResponse, Problem> {
    let lesson = lessons::find(&app, &slug)?;
    lesson.question(&id).ok_or_else(|| lessons::unknown_question(lesson, &id))?;
    let class = Class::open(&app.store, CLASS, &lesson.slug).await?;
    let text = answers_csv(&class, &id)?;
    app.store.note(CLASS, &caller.member()?.id, "exported", &format!("{}/{id}", lesson.slug)).await?;
    Ok(sheet("answers.csv", text))
}

/// What the class predicted and explained in a lesson, by student, with what the explanations were given.
#[utoipa::path(get, path = "/assignments/{slug}/words", operation_id = "read_words", tag = "class", params(("slug" = String, Path)), responses(
    (status = 200, description = "Predictions and explanations, with names", body = ref(of::<ClassWords>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn words(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
) -> Result<Answer<ClassWords>, Problem> {
    let lesson = lessons::find(&app, &slug)?;
    let class = Class::open(&app.store, CLASS, &lesson.slug).await?;
    let book = Book::open(&app.store, CLASS, None, Some(&lesson.slug)).await?;
    let people = app.store.people(CLASS).await?.into_iter();
    let students: HashSet<String> =
        people.filter(|one| one.role == Role::Student).map(|one| one.id).collect();
    let mut predicted = app.store.predictions(CLASS, None, Some(&lesson.slug)).await?;
    predicted.retain(|one| students.contains(&one.person));
    Ok(Answer(ClassWords::of(lesson, &class, &predicted, &book)))
}

fn sheet(name: &str, text: String) -> impl IntoResponse {
    let headers = [
        (header::CONTENT_TYPE, "text/csv; charset=utf-8".to_owned()),
        (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\"")),
    ];
    (headers, text)
}
