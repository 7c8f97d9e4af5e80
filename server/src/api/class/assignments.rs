//! How lessons are assigned, for those who teach: policies with their preview, releases, extensions.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::IntoResponse;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;
use triad_lessons::Lesson;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::api::guard::Caller;
use crate::api::lessons;
use crate::api::lessons::told::{self, GradedSubmission};
use crate::app::App;
use crate::blocking;
use crate::grades::{Book, Entry, stands};
use crate::policy::{Extension, InvalidPolicy, Moment, Policy, Standing, wrong_date};
use crate::problem::Problem;
use crate::store::{Assignment, CLASS, Query};

/// Longest reason or remark, in characters.
const LONGEST: usize = 2000;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<AssignmentList>();
    schemas.request::<Policy>();
    schemas.request::<Release>();
    schemas.request::<NewExtension>();
    schemas.request::<PreviewRequest>();
    schemas.answer::<PolicyPreview>();
    OpenApiRouter::new()
        .routes(routes!(list))
        .routes(routes!(set))
        .routes(routes!(release))
        .routes(routes!(extend, take_back))
        .routes(routes!(preview))
}

/// Text of reasonable length that somebody must write.
///
/// Errors if it is empty or too long.
pub(super) fn text_of(typed: &str, place: &str) -> Result<String, Problem> {
    let text = typed.trim();
    if !text.is_empty() && text.chars().count() <= LONGEST {
        return Ok(text.to_owned());
    }
    let wrong = format!("it is empty or has more than {LONGEST} characters");
    let hint = "say in a sentence why";
    Err(Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-decision", wrong.clone(), hint)
        .at(place, wrong))
}

impl From<InvalidPolicy> for Problem {
    fn from(error: InvalidPolicy) -> Self {
        let hint = "dates lie in the years 1970 to 2999, in the order opens, due, late, closes; shares go from 0 to 1 and never rise";
        let detail = format!("this cannot be set: {}", error.problem);
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-policy", detail, hint)
            .at(error.place, error.problem)
    }
}

/// How the lessons are assigned, in the order of the course.
#[derive(Debug, Serialize, JsonSchema)]
struct AssignmentList(Vec<AssignedLesson>);

/// How a lesson is assigned.
#[derive(Debug, Serialize, JsonSchema)]
struct AssignedLesson {
    /// Slug of the lesson.
    slug: String,
    /// Its place in the course.
    number: u32,
    /// Its title.
    title: String,
    /// What is set.
    policy: Policy,
    /// Its version: whoever sends it with another policy overwrites nothing that was set meanwhile.
    version: String,
    /// When the results were released.
    #[serde(skip_serializing_if = "Option::is_none")]
    released: Option<Moment>,
    /// Extensions, by person.
    extensions: Vec<PersonExtension>,
    /// How many people handed in.
    people: usize,
}

/// An extension and whose it is.
#[derive(Debug, Serialize, JsonSchema)]
struct PersonExtension {
    /// The person's id.
    person: String,
    /// What is allowed.
    #[serde(flatten)]
    extension: Extension,
}

/// How every lesson is assigned.
#[utoipa::path(get, path = "/assignments", operation_id = "list_assignments", tag = "class", responses(
    (status = 200, description = "Policies, releases and extensions", body = ref(of::<AssignmentList>()))))]
async fn list(State(app): State<App>) -> Result<Answer<AssignmentList>, Problem> {
    let assignments = app.store.assignments(CLASS).await?;
    let given = app.store.extensions(CLASS, None, None).await?;
    let handed = app.store.handed_by(CLASS).await?;
    let assigned = |lesson: &Lesson| {
        let assignment = assignments.iter().find(|one| one.lesson == lesson.slug).cloned();
        let assignment = assignment.unwrap_or_else(|| Assignment::of(&lesson.slug));
        let own = given.iter().filter(|(_, slug, _)| *slug == lesson.slug);
        let extensions = own.map(|(person, _, extension)| PersonExtension {
            person: person.clone(),
            extension: extension.clone(),
        });
        AssignedLesson {
            slug: lesson.slug.clone(),
            number: lesson.number,
            title: lesson.about.title.clone(),
            version: assignment.version(),
            policy: assignment.policy,
            released: assignment.released,
            extensions: extensions.collect(),
            people: handed.get(&lesson.slug).copied().unwrap_or(0),
        }
    };
    Ok(Answer(AssignmentList(app.course.lessons().iter().map(assigned).collect())))
}

/// In the place of what.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct InPlaceOf {
    /// The `version` of the policy that is to be replaced, from the list of assignments or the last answer: if another is set by
    /// now, it stays. Without it whichever there is is replaced.
    version: Option<String>,
}

/// Set how a lesson is handed in and what is told of it. It replaces what was set before, and holds for what was handed in
/// before too.
#[utoipa::path(put, path = "/assignments/{slug}", operation_id = "set_policy", tag = "class",
    params(("slug" = String, Path), InPlaceOf),
    request_body(content = ref(of::<Policy>()), example = json!({"due": "2026-12-01T18:00:00Z",
        "late": [{"until": "2026-12-03T18:00:00Z", "share": 0.5}], "most_attempts": 3})), responses(
    (status = 204, description = "It is so from now on",
        headers(("etag" = String, description = "The version of it, in quotes"))),
    (status = 404, description = "No such lesson", body = ref(PROBLEM)),
    (status = 409, description = "Another policy than the named one is set", body = ref(PROBLEM)),
    (status = 422, description = "Dates or shares that contradict each other", body = ref(PROBLEM))))]
async fn set(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
    QueryParameters(before): QueryParameters<InPlaceOf>,
    caller: Caller,
    Json(policy): Json<Policy>,
) -> Result<impl IntoResponse, Problem> {
    let slug = lessons::find(&app, &slug)?.slug.clone();
    policy.check()?;
    let (actor, before) = (&caller.member()?.id, before.version.as_deref());
    let version = app.store.set_policy(CLASS, actor, &slug, &policy, before).await?;
    Ok((StatusCode::NO_CONTENT, [(header::ETAG, format!("\"{version}\""))]))
}

/// Whether the results are released.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Release {
    /// True to tell what waits for it.
    released: bool,
}

/// Release the results that wait for it, or take that back.
#[utoipa::path(put, path = "/assignments/{slug}/release", operation_id = "release_results", tag = "class", params(("slug" = String, Path)),
    request_body(content = ref(of::<Release>()), example = json!({"released": true})), responses(
    (status = 204, description = "It is so"),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn release(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
    caller: Caller,
    Json(wanted): Json<Release>,
) -> Result<StatusCode, Problem> {
    let slug = lessons::find(&app, &slug)?.slug.clone();
    app.store.release(CLASS, &caller.member()?.id, &slug, wanted.released).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// More time or attempts for one person. What is left out stays as it was.
#[allow(clippy::option_option)] // null says something else than nothing
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct NewExtension {
    /// Until when it counts in full; late steps and the end follow at the same distance. Null takes it away.
    #[serde(default, deserialize_with = "given")]
    #[schemars(!default)]
    until: Option<Option<Moment>>,
    /// Attempts beyond those of everybody; 0 leaves them as they were, null takes them away.
    #[serde(default, deserialize_with = "given")]
    #[schemars(!default)]
    attempts: Option<Option<u32>>,
    /// Why.
    reason: String,
}

/// A value that is there, be it null.
fn given<'de, T: Deserialize<'de>, D: Deserializer<'de>>(from: D) -> Result<Option<T>, D::Error> {
    T::deserialize(from).map(Some)
}

impl NewExtension {
    /// What is allowed from then on, after what was allowed `before`.
    ///
    /// Errors if it allows nothing beyond what everybody may.
    fn after(
        self,
        before: Option<Extension>,
        policy: &Policy,
        by: &str,
    ) -> Result<Option<Extension>, Problem> {
        let Self { until, attempts, reason } = self;
        let (by, at) = (by.to_owned(), Moment::now());
        let attempts = attempts.filter(|attempts| *attempts != Some(0));
        let (more, takes) =
            ((until.flatten(), attempts.flatten()), [until == Some(None), attempts == Some(None)]);
        let alone = Extension { until: more.0, attempts: more.1.unwrap_or(0), reason, by, at };
        let refused = |wrong: &str, hint: &str| {
            let problem = Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-extension", wrong, hint);
            Err(problem.at("/until", wrong))
        };
        if let Some(wrong) = wrong_date("until", more.0) {
            return refused(&wrong, "give a date within these years");
        }
        if more == (None, None) && takes == [false; 2] {
            return refused(
                "it allows neither more time nor more attempts",
                "give a date, or attempts, or both",
            );
        }
        let is_as_for_all = |given: &Extension| {
            policy.times(Some(given)) == policy.times(None)
                && policy.attempts(Some(given)) == policy.attempts(None)
        };
        if more != (None, None) && is_as_for_all(&alone) {
            return refused(
                "it allows nothing that is not allowed to everybody",
                "give a date after the due date, or attempts where they are bounded",
            );
        }
        let (kept_until, kept_attempts) = before.map_or((None, 0), |before| (before.until, before.attempts));
        let next = Extension {
            until: until.unwrap_or(kept_until),
            attempts: attempts.map_or(kept_attempts, Option::unwrap_or_default),
            ..alone
        };
        Ok(Some(next).filter(|next| next.until.is_some() || next.attempts > 0))
    }
}

/// Allow somebody more time or attempts at a lesson. What is left out stays as it was, null takes it away.
#[utoipa::path(put, path = "/assignments/{slug}/extensions/{person}", operation_id = "extend", tag = "class",
    params(("slug" = String, Path), ("person" = String, Path)),
    request_body(content = ref(of::<NewExtension>()), example = json!({"until": "2026-12-08T18:00:00Z", "reason": "was ill"})), responses(
    (status = 204, description = "It is allowed"),
    (status = 404, description = "No such lesson or person", body = ref(PROBLEM)),
    (status = 422, description = "No reason, or nothing allowed that is not allowed to everybody", body = ref(PROBLEM))))]
async fn extend(
    State(app): State<App>,
    PathParameters((slug, person)): PathParameters<(String, String)>,
    caller: Caller,
    Json(new): Json<NewExtension>,
) -> Result<StatusCode, Problem> {
    let slug = lessons::find(&app, &slug)?.slug.clone();
    let new = NewExtension { reason: text_of(&new.reason, "/reason")?, ..new };
    let actor = caller.member()?;
    let change = |policy: &Policy, before| new.after(before, policy, &actor.name);
    app.store.extend(CLASS, &actor.id, &person, &slug, change).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Take an extension back.
#[utoipa::path(delete, path = "/assignments/{slug}/extensions/{person}", operation_id = "take_back_extension", tag = "class",
    params(("slug" = String, Path), ("person" = String, Path)), responses(
    (status = 204, description = "There is none"),
    (status = 404, description = "No such lesson or person", body = ref(PROBLEM))))]
async fn take_back(
    State(app): State<App>,
    PathParameters((slug, person)): PathParameters<(String, String)>,
    caller: Caller,
) -> Result<StatusCode, Problem> {
    let slug = lessons::find(&app, &slug)?.slug.clone();
    app.store.extend(CLASS, &caller.member()?.id, &person, &slug, |_, _| Ok::<_, Problem>(None)).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// What to look at before it counts.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct PreviewRequest {
    /// The policy; without it the one that holds.
    policy: Option<Policy>,
    /// The person's id; without it somebody who has handed in nothing.
    person: Option<String>,
    /// At what moment; now if it is left out.
    at: Option<Moment>,
}

/// What a policy makes of a person's work.
#[derive(Debug, Serialize, JsonSchema)]
struct PolicyPreview {
    /// At what moment.
    at: Moment,
    /// Where the person then stands.
    standing: Standing,
    /// The person's last submission by then, as it would be told; left out if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    told: Option<GradedSubmission>,
}

/// Look at what a policy makes of a person's work at a moment, before it counts.
#[utoipa::path(post, path = "/assignments/{slug}/preview", operation_id = "preview_policy", tag = "class", params(("slug" = String, Path)),
    request_body(content = ref(of::<PreviewRequest>()), example = json!({"at": "2026-12-02T18:00:00Z"})), responses(
    (status = 200, description = "Where the person stands then, and what they are told", body = ref(of::<PolicyPreview>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM)),
    (status = 422, description = "Dates or shares that contradict each other", body = ref(PROBLEM))))]
async fn preview(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
    Json(wanted): Json<PreviewRequest>,
) -> Result<Answer<PolicyPreview>, Problem> {
    let lesson = lessons::find(&app, &slug)?.clone();
    let at = wanted.at.unwrap_or_else(Moment::now);
    let mut assignment = app.store.assignment(CLASS, &lesson.slug).await?;
    if let Some(policy) = wanted.policy {
        policy.check()?;
        assignment.policy = policy;
    }
    let person = wanted.person.unwrap_or_default();
    let book = Book::open(&app.store, CLASS, Some(&person), Some(&lesson.slug)).await?;
    let entry = book.of(&person, &lesson.slug).cloned().unwrap_or_else(Entry::default).by(at);
    let standing = stands(&assignment, &entry, &lesson, at);
    let newest = entry.handed.iter().filter(|one| one.at <= at).max_by_key(|one| (one.at, one.n));
    let told = match newest {
        Some(newest) => Some(told_of(&app, &lesson, &assignment, &standing, (&person, &newest.id)).await?),
        None => None,
    };
    Ok(Answer(PolicyPreview { at, standing, told }))
}

/// A submission as its student would be told.
async fn told_of(
    app: &App,
    lesson: &Lesson,
    assignment: &Assignment,
    standing: &Standing,
    (person, submission): (&str, &str),
) -> Result<GradedSubmission, Problem> {
    let (course, lesson_slug) = (CLASS.to_owned(), Some(lesson.slug.clone()));
    let query = Query { course, person: Some(person.to_owned()), lesson: lesson_slug, limit: usize::MAX };
    let found = app.store.list(&query).await?.into_iter().find(|one| one.id == submission);
    let mut verdict: Value = found.map(|one| one.verdict).unwrap_or_default();
    let people = app.store.people(CLASS).await?;
    let seed = people.iter().find(|one| one.id == person).map(|one| app.access.seed_of(one));
    let (app, lesson) = (app.clone(), lesson.clone());
    let (policy, revealed) = (assignment.policy.clone(), standing.turn.revealed);
    blocking(move || {
        let own = app.variants.of(&lesson, &seed.unwrap_or_default())?;
        told::tell(&own, &policy, revealed, &mut verdict)?;
        serde_json::from_value(verdict).map_err(Problem::internal)
    })
    .await
}
