//! Handing in, and looking at what was handed in.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use std::collections::BTreeMap;
use std::sync::Arc;

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode};
use axum::response::IntoResponse;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use triad_lessons::answers::{RunSettings, TypedValue};
use triad_lessons::{Lesson, Submission, Verdict};
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::api::guard::Caller;
use crate::api::lessons;
use crate::api::lessons::told::{self, GradedSubmission};
use crate::app::App;
use crate::grades::{Book, assigned};
use crate::policy::{Moment, When};
use crate::problem::Problem;
use crate::store::{
    CLASS, HOME, HandIn, Kept, Member, Query, StoreError, StoredSubmission, Whose, identifier, names,
};
use crate::{blocking, grading};

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

/// A verdict with what names its submission, as it is kept.
#[derive(Debug, Serialize)]
struct KeptVerdict {
    id: String,
    submitted_at: String,
    #[serde(flatten)]
    verdict: Verdict,
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
) -> Result<impl IntoResponse, Problem> {
    let key = request_key(&headers)?;
    let lesson = lessons::find(&app, &slug)?;
    let who = who(&app, caller, &body)?;
    let policy = app.store.assignment(who.course, &lesson.slug).await?.policy;
    let lesson = assigned(lesson, &policy);
    let person = who.person();
    let grading = app.clone();
    let judged = Arc::new(blocking(move || judged(&grading, lesson, &body, who, key)).await?);
    let (new, kept) = keep(&app, &judged).await?;
    let status = if new.counted { StatusCode::CREATED } else { StatusCode::OK };
    let revealed = told::revealed(&app, person.as_deref(), &judged.lesson).await?;
    let document = blocking(move || {
        let mut verdict = kept.verdict;
        let own = app.variants.of(&judged.lesson, &new.seed)?;
        told::tell(&own, &policy, revealed, &mut verdict)?;
        serde_json::from_value::<GradedSubmission>(verdict).map_err(Problem::internal)
    });
    Ok((status, Answer(document.await?)))
}

/// Settles what was judged with what its author handed in before, and keeps it. Where another submission of theirs comes
/// between the two, it is settled again with that one.
async fn keep(app: &App, judged: &Arc<Judged>) -> Result<(HandIn, Kept), Problem> {
    loop {
        let (earlier, after) = earlier(app, judged).await?;
        let settling = Arc::clone(judged);
        let new = blocking(move || settled(&settling, earlier, after)).await?;
        match app.store.hand_in(&new).await {
            // Each time around, one more of theirs is kept.
            Err(StoreError::Overtaken) => {}
            other => return Ok((new, other?)),
        }
    }
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

/// Who hands in.
pub(super) struct Who {
    pub(super) course: &'static str,
    pub(super) whose: Whose,
    pub(super) student: String,
    /// The class decides whose numbers these are; at home the submission says it.
    seed: Option<String>,
}

impl Who {
    /// The person's id, where it is known.
    fn person(&self) -> Option<String> {
        match &self.whose {
            Whose::Person(id) => Some(id.clone()),
            Whose::Named => None,
        }
    }
}

/// At home whoever the submission names, in a class the caller: there a submission names nobody.
pub(super) fn who(app: &App, caller: Caller, body: &Value) -> Result<Who, Problem> {
    if !app.access.is_class() {
        let student = student(body.get("student").and_then(Value::as_str))?;
        return Ok(Who { course: HOME, whose: Whose::Named, student, seed: None });
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
    Ok(Who { course: CLASS, whose: Whose::Person(member.id), student: member.name, seed })
}

/// What a student has handed in to the lesson, the oldest first, and the last entry of it in the log.
async fn earlier(app: &App, judged: &Judged) -> Result<(Vec<StoredSubmission>, i64), Problem> {
    let who = &judged.who;
    let person = match &who.whose {
        Whose::Person(id) => Some(id.clone()),
        Whose::Named => app.store.person_named(HOME, &who.student).await?,
    };
    let Some(person) = person else { return Ok((Vec::new(), 0)) };
    Ok(app.store.earlier(who.course, &person, &judged.lesson.slug).await?)
}

/// What is handed in, judged for itself.
struct Judged {
    /// As it is assigned.
    lesson: Lesson,
    who: Who,
    key: Option<String>,
    submission: Submission,
    verdict: Verdict,
    seed: String,
}

/// Judges what is handed in: without what came before, and without the right answers.
fn judged(app: &App, lesson: Lesson, body: &Value, who: Who, key: Option<String>) -> Result<Judged, Problem> {
    let (submission, mut verdict) =
        grading::grade(&lesson, &app.variants, &body.to_string(), who.seed.as_deref())?;
    verdict.student = Some(who.student.clone());
    let seed = verdict.provenance.seed.clone();
    if who.seed.is_some() {
        // It would let others compute these numbers.
        verdict.provenance.seed.clear();
    }
    Ok(Judged { lesson, who, key, submission, verdict, seed })
}

/// What is kept of it, after what came before: up to the entry `after` of the log.
fn settled(judged: &Judged, earlier: Vec<StoredSubmission>, after: i64) -> Result<HandIn, Problem> {
    let Judged { lesson, who, key, submission, seed, .. } = judged;
    let mut verdict = judged.verdict.clone();
    grading::settle(lesson, earlier, submission, &mut verdict)?;
    let received = jiff::Timestamp::now();
    let counted = verdict.gradable;
    let told = KeptVerdict { id: identifier(), submitted_at: format!("{received:.3}"), verdict };
    Ok(HandIn {
        id: told.id.clone(),
        course: who.course.to_owned(),
        lesson: lesson.slug.clone(),
        whose: who.whose.clone(),
        student: who.student.clone(),
        seed: seed.clone(),
        received_at: received.as_millisecond(),
        answers: serde_json::to_string(&submission.answers).map_err(Problem::internal)?,
        verdict: serde_json::to_value(told).map_err(Problem::internal)?,
        counted,
        after,
        key: key.clone(),
        bundle: lesson.bundle(),
    })
}

/// Who hands in: a name of reasonable length, without control characters.
fn student(name: Option<&str>) -> Result<String, Problem> {
    let typed = name.unwrap_or_default();
    let name = names::shown(typed);
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
    let book = Book::open(&app.store, CLASS, Some(&member.id)).await?;
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
