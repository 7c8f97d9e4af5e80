//! One person's work: as they see it themselves, and as those who teach see it.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
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
use crate::api::lessons::told::{GradedSubmission, hold};
use crate::app::App;
use crate::grades::{Book, Record, record};
use crate::policy::{Moment, Revealed};
use crate::problem::Problem;
use crate::store::{CLASS, DecisionKind, Member, Role, Said, StoreError, VerdictHistory};

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<Record>();
    schemas.request::<Words>();
    schemas.answer::<VerdictList>();
    OpenApiRouter::new()
        .routes(routes!(own))
        .routes(routes!(of_person))
        .routes(routes!(ask))
        .routes(routes!(comment))
        .routes(routes!(verdicts))
        .routes(routes!(file))
}

/// What is kept about oneself: where one stands in every lesson, what was decided, said and regraded, and why.
#[utoipa::path(get, path = "/record", operation_id = "get_own_record", tag = "class", responses(
    (status = 200, description = "One's own record, without what is held back", body = ref(of::<Record>()))))]
async fn own(State(app): State<App>, caller: Caller) -> Result<Answer<Record>, Problem> {
    let member = caller.class_member()?;
    Ok(Answer(record(&app.store, CLASS, &app.course, &member, false, Moment::now()).await?))
}

/// The same of anybody, with what is held back from them.
#[utoipa::path(get, path = "/people/{person}/record", operation_id = "get_record", tag = "class", params(("person" = String, Path)), responses(
    (status = 200, description = "The whole record", body = ref(of::<Record>())),
    (status = 404, description = "No such person", body = ref(PROBLEM))))]
async fn of_person(
    State(app): State<App>,
    PathParameters(person): PathParameters<String>,
) -> Result<Answer<Record>, Problem> {
    let member = somebody(&app, &person).await?;
    Ok(Answer(record(&app.store, CLASS, &app.course, &member, true, Moment::now()).await?))
}

async fn somebody(app: &App, person: &str) -> Result<Member, Problem> {
    let found = app.store.people(CLASS).await?.into_iter().find(|member| member.id == person);
    Ok(found.ok_or(StoreError::Unknown("person in this course"))?)
}

/// Something that is said about work in a lesson.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Words {
    /// Slug of the lesson.
    lesson: String,
    /// What.
    text: String,
}

/// Ask those who teach to look again at one's own work in a lesson.
#[utoipa::path(post, path = "/record/requests", operation_id = "ask_for_a_look", tag = "class",
    request_body(content = ref(of::<Words>()), example = json!({"lesson": "screw", "text": "I measured about the other axis; is that not right too?"})), responses(
    (status = 201, description = "It is asked"),
    (status = 404, description = "No such lesson", body = ref(PROBLEM)),
    (status = 409, description = "Nothing was handed in, or one was asked before", body = ref(PROBLEM)),
    (status = 422, description = "Nothing said", body = ref(PROBLEM))))]
async fn ask(
    State(app): State<App>,
    caller: Caller,
    Json(words): Json<Words>,
) -> Result<StatusCode, Problem> {
    let member = caller.class_member()?;
    let lesson = lessons::find(&app, &words.lesson)?;
    let text = text_of(&words.text, "/text")?;
    let book = Book::open(&app.store, CLASS, Some(&member.id), Some(&lesson.slug)).await?;
    let entry = book.of(&member.id, &lesson.slug).filter(|entry| !entry.handed.is_empty());
    let conflict =
        |code, detail: &str, hint: &str| Err(Problem::new(StatusCode::CONFLICT, code, detail, hint));
    match entry {
        None => {
            return conflict(
                "nothing-handed-in",
                "there is nothing to look at yet",
                "hand in your answers first",
            );
        }
        Some(entry) if crate::grades::asks(entry) => {
            return conflict(
                "asked-before",
                "you have asked already, and nobody has answered yet",
                "wait for the answer",
            );
        }
        Some(_) => {}
    }
    let said = Said::words(DecisionKind::Request, &text);
    app.store.decide(CLASS, &member.id, &member.id, &lesson.slug, said).await?;
    Ok(StatusCode::CREATED)
}

/// Say something about a person's work in a lesson: they see it. It answers their request for a look again.
#[utoipa::path(post, path = "/people/{person}/comments", operation_id = "comment", tag = "class", params(("person" = String, Path)),
    request_body(content = ref(of::<Words>()), example = json!({"lesson": "screw", "text": "Well drawn; mind the sign of the lead."})), responses(
    (status = 201, description = "It is said"),
    (status = 404, description = "No such person or lesson", body = ref(PROBLEM)),
    (status = 422, description = "Nothing said", body = ref(PROBLEM))))]
async fn comment(
    State(app): State<App>,
    PathParameters(person): PathParameters<String>,
    caller: Caller,
    Json(words): Json<Words>,
) -> Result<StatusCode, Problem> {
    let lesson = lessons::find(&app, &words.lesson)?;
    let text = text_of(&words.text, "/text")?;
    let said = Said::words(DecisionKind::Comment, &text);
    app.store.decide(CLASS, &caller.member()?.id, &person, &lesson.slug, said).await?;
    Ok(StatusCode::CREATED)
}

/// Every verdict of a submission, the first at the beginning.
#[derive(Debug, Serialize, JsonSchema)]
struct VerdictList(Vec<GivenVerdict>);

/// A verdict that was given.
#[derive(Debug, Serialize, JsonSchema)]
struct GivenVerdict {
    /// When.
    at: Moment,
    /// What was told.
    #[schemars(with = "GradedSubmission")]
    verdict: Value,
}

/// Every verdict that a submission was given: the first, and those of regrades. One's own; those who grade see all.
#[utoipa::path(get, path = "/submissions/{id}/verdicts", operation_id = "list_verdicts", tag = "submissions", params(("id" = String, Path)), responses(
    (status = 200, description = "The verdicts, as they were told", body = ref(of::<VerdictList>())),
    (status = 404, description = "No such submission, or it is another's", body = ref(PROBLEM))))]
async fn verdicts(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    caller: Caller,
) -> Result<Answer<VerdictList>, Problem> {
    let member = caller.class_member()?;
    let (found, revealed) = seen(&app, &member, &id).await?;
    let given = |one: VerdictHistory| {
        let mut verdict = one.body;
        hold(&mut verdict, revealed);
        GivenVerdict { at: one.at, verdict }
    };
    Ok(Answer(VerdictList(found.into_iter().map(given).collect())))
}

/// The verdicts of a submission that somebody may see, and what of them they are told.
async fn seen(app: &App, member: &Member, id: &str) -> Result<(Vec<VerdictHistory>, Revealed), Problem> {
    let found = app.store.verdicts_of(CLASS, id).await?;
    let first = found.first().ok_or(StoreError::Unknown("submission"))?;
    if member.role > Role::Student {
        return Ok((found, Revealed::ALL));
    }
    if first.person != member.id {
        return Err(StoreError::Unknown("submission").into());
    }
    let lesson = lessons::find(app, &first.lesson)?;
    let book = Book::open(&app.store, CLASS, Some(&member.id), Some(&lesson.slug)).await?;
    let revealed = book.standing(&member.id, lesson, Moment::now()).turn.revealed;
    Ok((found, revealed))
}

/// A file that was handed in. One's own; those who grade see all.
#[utoipa::path(get, path = "/submissions/{id}/files/{question}", operation_id = "get_file", tag = "submissions",
    params(("id" = String, Path), ("question" = String, Path)), responses(
    (status = 200, description = "The file as it came", body = String, content_type = "text/plain"),
    (status = 404, description = "No such file, or it is another's", body = ref(PROBLEM))))]
async fn file(
    State(app): State<App>,
    PathParameters((id, question)): PathParameters<(String, String)>,
    caller: Caller,
) -> Result<impl IntoResponse, Problem> {
    let member = caller.class_member()?;
    seen(&app, &member, &id).await?;
    let submission = app.store.submission(CLASS, &id).await?;
    let text = submission.and_then(|(_, one)| one.answers[&question]["file"].as_str().map(str::to_owned));
    let text = text.ok_or(StoreError::Unknown("file"))?;
    let headers = [
        (header::CONTENT_TYPE, "text/plain; charset=utf-8"),
        (header::CONTENT_DISPOSITION, "attachment; filename=\"answer.txt\""),
    ];
    Ok((headers, text))
}
