//! Handing in, and looking at what was handed in.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use std::collections::BTreeMap;
use std::sync::Arc;

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tokio::time::timeout;
use triad_lessons::answers::{RunSettings, TypedValue};
use triad_lessons::{Lesson, Submission};
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::api::guard::Caller;
use crate::api::lessons;
use crate::api::lessons::told::{self, GradedSubmission};
use crate::api::lessons::waiting::{self, SubmissionState};
use crate::app::App;
use crate::blocking;
use crate::grades::{Book, assigned};
use crate::handing::{self, Judged, Who};
use crate::policy::{Moment, When};
use crate::problem::Problem;
use crate::request;
use crate::store::{
    Accept, Accepted, CLASS, HOME, Kept, Member, Query, StoreError, StoredSubmission, Whose, identifier,
    names,
};
use crate::work::Asker;

/// Where a client names its request: a request that is repeated under the same name is one submission.
const KEY: &str = "idempotency-key";
/// Longest such name.
const LONGEST_KEY: usize = 200;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<Submission>();
    schemas.answer::<GradedSubmission>();
    schemas.answer::<SubmissionList>();
    OpenApiRouter::new().routes(routes!(submit)).routes(routes!(list))
}

/// Hand in answers to a lesson's exercise.
///
/// What is handed in is kept. Where an answer cannot be read (text for a number, a unit that does not exist) the verdict
/// says `gradable: false` and what to correct; nothing is judged, and no attempt is used. Each question tells its
/// `standing` after all submissions so far. Where its right answer is open (it was right, or there were so many different
/// answers), it has its `reference_html`, and its points stay what they were before. A request that is repeated with the
/// same `Idempotency-Key` is told the verdict of the first and keeps nothing.
#[utoipa::path(post, path = "/lessons/{slug}/submissions", operation_id = "submit_answers", tag = "submissions", params(("slug" = String, Path),
    ("idempotency-key" = Option<String>, Header, description = "A name of this request, never used before")),
    request_body(content = ref(of::<triad_lessons::Submission>()), example = json!({"student": "ada", "answers": {"tension": {"value": "29.4", "unit": "N"}}})),
    responses(
    (status = 201, description = "Graded and kept", body = ref(of::<GradedSubmission>())),
    (status = 200, description = "Kept, but not gradable: says what to correct", body = ref(of::<GradedSubmission>())),
    (status = 202, description = "Kept, and graded in its turn: `Location` says where to ask", body = ref(of::<SubmissionState>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM)),
    (status = 409, description = "Not open, closed, too soon, or all attempts are used", body = ref(PROBLEM)),
    (status = 422, description = "Not a submission", body = ref(PROBLEM)),
    (status = 503, description = "It could not be kept: says why", body = ref(PROBLEM))))]
async fn submit(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
    headers: HeaderMap,
    caller: Caller,
    Json(body): Json<Value>,
) -> Result<Response, Problem> {
    let key = request_key(&headers)?;
    let lesson = lessons::find(&app, &slug)?;
    let who = who(&app, caller, &body)?;
    let policy = app.store.assignment(&who.course, &lesson.slug).await?.policy;
    let lesson = assigned(lesson, &policy);
    let person = who.person();
    let kept = match at_once(&app, &lesson, body.to_string(), &who, key.as_deref()).await? {
        Some((seed, kept)) => (seed, kept.verdict),
        None => match later(&app, &lesson, body.to_string(), &who, key).await? {
            Accepted::Waiting(id) => return waiting::accepted(&app, id).await,
            // Repeated, and graded meanwhile.
            Accepted::Kept(kept) => (seed_of(&who, &kept.verdict), kept.verdict),
        },
    };
    let status = if kept.1["gradable"] == true { StatusCode::CREATED } else { StatusCode::OK };
    Ok((status, Answer(told::graded(&app, lesson, policy, person, kept).await?)).into_response())
}

/// What the numbers of a verdict were drawn from: the class knows it, at home the verdict tells it.
fn seed_of(who: &Who, verdict: &Value) -> String {
    let told = || verdict["provenance"]["seed"].as_str().unwrap_or_default().to_owned();
    who.seed.clone().unwrap_or_else(told)
}

/// Grades and keeps what is handed in; `None` where that has to wait: for a place, or behind others of the same person.
async fn at_once(
    app: &App,
    lesson: &Lesson,
    body: String,
    who: &Who,
    key: Option<&str>,
) -> Result<Option<(String, Kept)>, Problem> {
    let (variants, lesson, who) = (Arc::clone(&app.variants), lesson.clone(), who.clone());
    let (key, places) = (key.map(str::to_owned), Arc::clone(&app.at_once));
    let is_shared = app.store.is_shared();
    // A time of nothing is one in which a fast machine may be done all the same.
    if is_shared && app.limits.at_once.is_zero() {
        return Ok(None);
    }
    // Who leaves, or is put into the queue because it takes too long here, does not keep a place with what nobody reads.
    let (asker, wanted) = Asker::new();
    let judging = async move {
        let _asker = asker;
        // Where nobody else grades, everybody waits here: as many are graded at a time as there are processors.
        let place = places.acquire_owned().await.map_err(Problem::internal)?;
        blocking(move || {
            let _place = place;
            Judged::new(&variants, lesson, &body, who, key, &wanted).map(Arc::new)
        })
        .await
    };
    let judged = if is_shared {
        let Ok(judged) = timeout(app.limits.at_once, judging).await else { return Ok(None) };
        judged?
    } else {
        judging.await?
    };
    judged.tell(&app.metrics);
    loop {
        let received =
            jiff::Timestamp::from_millisecond(app.store.clock().await?).map_err(Problem::internal)?;
        let new = handing::settled(&app.store, &judged, identifier(), received).await?;
        match app.store.hand_in(&new).await {
            // Each time around, one more of theirs is kept.
            Err(StoreError::Overtaken) => {}
            Err(StoreError::Behind) => return Ok(None),
            other => return Ok(Some((new.seed, other?))),
        }
    }
}

/// Puts what is handed in into the queue.
async fn later(
    app: &App,
    lesson: &Lesson,
    body: String,
    who: &Who,
    key: Option<String>,
) -> Result<Accepted, Problem> {
    let accept = Accept {
        course: who.course.clone(),
        lesson: lesson.slug.clone(),
        whose: who.whose.clone(),
        student: who.student.clone(),
        body,
        seed: who.seed.clone(),
        key,
        bundle: lesson.bundle(),
        request: request::current(),
    };
    let (variants, lesson) = (Arc::clone(&app.variants), lesson.clone());
    let gradable = blocking(move || {
        // What nobody could grade is refused now, and not put aside by a grader.
        let submission = Submission::from_json(&accept.body)?;
        let seed = accept.seed.as_deref().unwrap_or_else(|| submission.numbers_of());
        triad_lessons::asked(&*variants.of(&lesson, seed)?, &submission)?;
        Ok(accept)
    });
    Ok(app.store.enqueue(&gradable.await?).await?)
}

/// The name that the client gave to the request.
fn request_key(headers: &HeaderMap) -> Result<Option<String>, Problem> {
    let Some(value) = headers.get(KEY) else { return Ok(None) };
    let text = value.to_str().ok().filter(|text| !text.is_empty() && text.len() <= LONGEST_KEY);
    text.map(|text| Some(text.to_owned())).ok_or_else(|| {
        let detail = format!("the header {KEY} is empty, not ASCII, or longer than {LONGEST_KEY} characters");
        Problem::new(StatusCode::BAD_REQUEST, "invalid-key", detail, "send a UUID, or leave it out")
    })
}

/// At home whoever the submission names, in a class the caller: there a submission names nobody.
pub(super) fn who(app: &App, caller: Caller, body: &Value) -> Result<Who, Problem> {
    if !app.access.is_class() {
        let student = student(body.get("student").and_then(Value::as_str))?;
        return Ok(Who { course: HOME.to_owned(), whose: Whose::Named, student, seed: None });
    }
    if body.get("seed").is_some() || body.get("student").is_some() {
        return Err(Problem::new(
            StatusCode::FORBIDDEN,
            "not-your-numbers",
            "in a class a submission names neither a student nor a seed: both are known",
            "leave out `seed` and `student`",
        ));
    }
    let member = caller.member()?;
    app.access.check_submissions(&member.id)?;
    let seed = Some(app.access.seed_of(&member));
    Ok(Who { course: CLASS.to_owned(), whose: Whose::Person(member.id), student: member.name, seed })
}

/// Who hands in: a name of reasonable length, without control characters.
fn student(name: Option<&str>) -> Result<String, Problem> {
    let typed = name.unwrap_or_default();
    let name = if names::is_endless(typed) { "x".repeat(names::LONGEST + 1) } else { names::shown(typed) };
    let wrong = if name.is_empty() {
        "the submission does not say whose it is".to_owned()
    } else if name.chars().count() > names::LONGEST {
        format!("the student's name has more than {} characters", names::LONGEST)
    } else if typed.trim().chars().any(char::is_control) {
        "the student's name has control characters".to_owned()
    } else {
        return Ok(name);
    };
    let hint = r#"add "student": "your name" beside "answers""#;
    Err(Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-student", wrong.clone(), hint)
        .at("/student", wrong))
}

/// Which submissions to list.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct Filter {
    /// Only this student's, at home; in a class everybody sees their own.
    student: Option<String>,
    /// Only for this lesson.
    lesson: Option<String>,
    /// At most so many; 100 if it is not given.
    limit: Option<usize>,
}

/// Files that were handed in are kept, but a list of submissions only tells their lengths.
fn without_files(mut answers: Value) -> Value {
    for answer in answers.as_object_mut().into_iter().flat_map(|map| map.values_mut()) {
        if let Some(length) = answer["file"].as_str().map(str::len) {
            answer["file"] = json!(KeptFile { bytes: length });
        }
    }
    answers
}

/// A submission that is kept, with its verdict.
#[derive(Debug, Serialize, JsonSchema)]
struct KeptSubmission {
    /// What was handed in, by the question's id.
    #[schemars(with = "BTreeMap<String, KeptAnswer>")]
    answers: Value,
    /// The verdict, as it was given.
    #[serde(flatten)]
    #[schemars(with = "GradedSubmission")]
    verdict: Value,
}

/// The answer to one question, as it is kept.
#[derive(Serialize, JsonSchema)]
struct KeptAnswer {
    /// A number, a list of numbers, or a formula, as typed.
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<TypedValue>,
    /// The unit of the value, as typed.
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<String>,
    /// The id of the option that was chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<String>,
    /// The file that was handed in.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<KeptFile>,
    /// The settings of a run.
    #[serde(skip_serializing_if = "Option::is_none")]
    settings: Option<RunSettings>,
}

/// A file that was handed in.
#[derive(Debug, Serialize, JsonSchema)]
struct KeptFile {
    /// Its length.
    bytes: usize,
}

/// Submissions, newest first.
#[derive(Debug, Serialize, JsonSchema)]
pub(in crate::api) struct SubmissionList(Vec<KeptSubmission>);

/// Submissions with their verdicts, newest first.
#[utoipa::path(get, path = "/submissions", operation_id = "list_submissions", tag = "submissions", params(Filter), responses(
    (status = 200, description = "The verdicts, and the answers they are about", body = ref(of::<SubmissionList>()))))]
async fn list(
    State(app): State<App>,
    caller: Caller,
    QueryParameters(filter): QueryParameters<Filter>,
) -> Result<Answer<SubmissionList>, Problem> {
    let limit = filter.limit.unwrap_or(100).min(app.limits.submissions);
    if app.access.is_class() {
        let member = caller.member()?;
        let query =
            Query { course: CLASS.to_owned(), person: Some(member.id.clone()), lesson: filter.lesson, limit };
        let found = app.store.list(&query).await?;
        return own(app, &member, found).await.map(|found| Answer(listed(found)));
    }
    let person = match filter.student {
        None => None,
        Some(name) => match app.store.person_named(HOME, &name).await? {
            None => return Ok(Answer(SubmissionList(Vec::new()))),
            found => found,
        },
    };
    let query = Query { course: HOME.to_owned(), person, lesson: filter.lesson, limit };
    Ok(Answer(listed(app.store.list(&query).await?)))
}

/// A student's own submissions, without what is held back from them.
async fn own(
    app: App,
    member: &Member,
    mut found: Vec<StoredSubmission>,
) -> Result<Vec<StoredSubmission>, Problem> {
    let book = Book::open(&app.store, CLASS, Some(&member.id), None).await?;
    let (member, now) = (member.clone(), Moment::now());
    blocking(move || {
        for one in &mut found {
            let Some(lesson) = app.course.lesson(&one.lesson) else { continue };
            let revealed = book.standing(&member.id, lesson, now).turn.revealed;
            let policy = book.assignment(&one.lesson).map(|assignment| assignment.policy.clone());
            match policy.filter(|policy| revealed.reference && policy.reveal.reference != When::AtOnce) {
                Some(policy) => {
                    let own = app.variants.of(lesson, &app.access.seed_of(&member))?;
                    told::tell(&own, &policy, revealed, &mut one.verdict)?;
                }
                None => told::hold(&mut one.verdict, revealed),
            }
            if let Some(entry) = book.of(&member.id, &one.lesson).filter(|_| revealed.points) {
                told::mark(&mut one.verdict, entry);
            }
        }
        Ok(found)
    })
    .await
}

/// Submissions as they are shown: files by their lengths.
pub(in crate::api) fn listed(found: Vec<StoredSubmission>) -> SubmissionList {
    let kept = found.into_iter().map(|submission| KeptSubmission {
        answers: without_files(submission.answers),
        verdict: submission.verdict,
    });
    SubmissionList(kept.collect())
}
