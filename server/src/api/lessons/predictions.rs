//! Predictions: said before the run, kept once, compared with the run afterwards.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use std::collections::BTreeSet;

use axum::Json as Answer;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::IntoResponse;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_lessons::Lesson;
use triad_lessons::lesson::{OptionView, OutcomeView, PredictionView};
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::submissions::who;
use super::{find, variant};
use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::{Json, PathParameters, QueryParameters};
use crate::api::guard::Caller;
use crate::app::App;
use crate::handing::Who;
use crate::policy::Moment;
use crate::problem::{Problem, suggest};
use crate::store::{CLASS, HOME, KeptPrediction, NewPrediction, Role};

/// Longest sentence why, in characters.
const LONGEST_WHY: usize = 1000;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<Predicted>();
    schemas.answer::<GivenPrediction>();
    schemas.answer::<GivenPredictions>();
    schemas.answer::<PredictionTable>();
    OpenApiRouter::new().routes(routes!(predict, given)).routes(routes!(counts))
}

/// A prediction to keep.
#[derive(Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Predicted {
    /// Who predicts, at home; in a class it is the caller.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    student: Option<String>,
    /// Id of the prediction.
    prediction: String,
    /// Id of the option; null or left out: none is made, and that is kept, too.
    #[serde(default)]
    choice: Option<String>,
    /// Why, in a sentence.
    #[serde(default)]
    why: String,
}

/// A prediction that was made, or skipped, with what the run shows.
#[derive(Debug, Serialize, JsonSchema)]
struct GivenPrediction {
    /// Id of the prediction.
    prediction: String,
    /// Id of the option that was chosen; absent if it was skipped.
    #[serde(skip_serializing_if = "Option::is_none")]
    choice: Option<String>,
    /// Why, in the student's words; may be empty.
    why: String,
    /// When.
    given_at: Moment,
    /// What comes true.
    outcome: OutcomeView,
}

/// Predictions, in the order in which they were made.
#[derive(Debug, Serialize, JsonSchema)]
struct GivenPredictions(Vec<GivenPrediction>);

/// Say what will happen before the run shows it.
///
/// It is kept under the name of who says it and never changed: who predicts a second time is told the first.
#[utoipa::path(post, path = "/lessons/{slug}/predictions", operation_id = "predict", tag = "lessons", params(("slug" = String, Path)),
    request_body(content = ref(of::<Predicted>()), example = json!({"student": "ada", "prediction": "pull", "choice": "c", "why": "it moves on a circle"})), responses(
    (status = 201, description = "Kept; tells what comes true", body = ref(of::<GivenPrediction>())),
    (status = 200, description = "It was made before: tells that one", body = ref(of::<GivenPrediction>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM)),
    (status = 409, description = "Not open, or closed: it can be skipped", body = ref(PROBLEM)),
    (status = 422, description = "No such prediction or option, or no name", body = ref(PROBLEM))))]
async fn predict(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
    caller: Caller,
    Json(body): Json<Predicted>,
) -> Result<impl IntoResponse, Problem> {
    let lesson = find(&app, &slug)?;
    let why = known(lesson, &body)?;
    let document = serde_json::to_value(&body).map_err(Problem::internal)?;
    let Who { course, whose, student, .. } = who(&app, caller.clone(), &document)?;
    let new = NewPrediction {
        course: course.clone(),
        whose,
        student: student.clone(),
        lesson: lesson.slug.clone(),
        prediction: body.prediction.clone(),
        choice: body.choice,
        why,
    };
    let (is_new, person) = app.store.predict(&new).await?;
    let own = variant(&app, &slug, (course == HOME).then_some(student.as_str()), &caller)?;
    let kept = app.store.predictions(&course, Some(&person), Some(&lesson.slug)).await?;
    let given = kept.into_iter().find(|one| one.prediction == body.prediction);
    let given = given.and_then(|one| told(&own, one));
    let given = given.ok_or_else(|| Problem::internal("a prediction that was kept is not there"))?;
    Ok((if is_new { StatusCode::CREATED } else { StatusCode::OK }, Answer(given)))
}

/// The sentence of a prediction that the lesson asks for, with an option that it has.
fn known(lesson: &Lesson, body: &Predicted) -> Result<String, Problem> {
    let refused = |pointer: &str, wrong: String, hint: String| {
        let status = StatusCode::UNPROCESSABLE_ENTITY;
        Err(Problem::new(status, "invalid-prediction", wrong.clone(), hint).at(pointer, wrong))
    };
    let asked = &lesson.about.predictions;
    let Some(asked_for) = asked.iter().find(|one| one.id == body.prediction) else {
        let wrong = format!("the lesson {} asks for no prediction {}", lesson.slug, body.prediction);
        return refused(
            "/prediction",
            wrong,
            suggest(&body.prediction, asked.iter().map(|one| one.id.as_str())),
        );
    };
    let ids = || asked_for.options.iter().map(|option| option.id.as_str());
    if let Some(choice) = body.choice.as_deref().filter(|choice| !ids().any(|id| id == *choice)) {
        return refused("/choice", format!("there is no option {choice}"), suggest(choice, ids()));
    }
    let why = body.why.trim();
    if why.chars().count() > LONGEST_WHY {
        let wrong = format!("the sentence has more than {LONGEST_WHY} characters");
        return refused("/why", wrong, "say it shorter".to_owned());
    }
    Ok(why.to_owned())
}

/// A prediction as it is told to who made it; none if the lesson does not ask for it any more.
fn told(lesson: &Lesson, kept: KeptPrediction) -> Option<GivenPrediction> {
    let outcome = lesson.outcome(&kept.prediction)?;
    let KeptPrediction { prediction, choice, why, given_at, .. } = kept;
    Some(GivenPrediction { prediction, choice, why, given_at: Moment(given_at), outcome })
}

/// Whose predictions.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct Own {
    /// A student's name, at home; in a class everybody sees their own.
    student: Option<String>,
}

/// One's own predictions for a lesson, with what came of them.
#[utoipa::path(get, path = "/lessons/{slug}/predictions", operation_id = "list_predictions", tag = "lessons", params(("slug" = String, Path), Own), responses(
    (status = 200, description = "Those that were made or skipped", body = ref(of::<GivenPredictions>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn given(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
    caller: Caller,
    QueryParameters(whose): QueryParameters<Own>,
) -> Result<Answer<GivenPredictions>, Problem> {
    let lesson = find(&app, &slug)?.slug.clone();
    let asked = whose.student.as_deref();
    let (course, person) = match caller.0.as_ref() {
        Some(member) if app.access.is_class() => (CLASS, Some(member.id.clone())),
        _ => (HOME, app.store.person_named(HOME, asked.unwrap_or_default()).await?),
    };
    let Some(person) = person else { return Ok(Answer(GivenPredictions(Vec::new()))) };
    let own = variant(&app, &slug, asked.filter(|_| course == HOME), &caller)?;
    let kept = app.store.predictions(course, Some(&person), Some(&lesson)).await?;
    Ok(Answer(GivenPredictions(kept.into_iter().filter_map(|one| told(&own, one)).collect())))
}

/// What was predicted in a lesson.
#[derive(Debug, Serialize, JsonSchema)]
struct PredictionTable(Vec<PredictionCounts>);

/// How often what was predicted.
#[derive(Debug, Serialize, JsonSchema)]
struct PredictionCounts {
    /// What was asked.
    #[serde(flatten)]
    asked: PredictionView,
    /// Id of the option that comes true.
    happens: String,
    /// How many chose each option, in the order of the options.
    chosen: Vec<usize>,
    /// How many skipped it.
    skipped: usize,
    /// How many have neither predicted nor skipped.
    missing: usize,
    /// The sentences why.
    reasons: Vec<Reason>,
}

/// Why somebody predicts what they do.
#[derive(Debug, Serialize, JsonSchema)]
struct Reason {
    /// The name.
    name: String,
    /// The option; absent if the prediction was skipped.
    #[serde(skip_serializing_if = "Option::is_none")]
    option: Option<OptionView>,
    /// The sentence.
    why: String,
}

/// What a class predicts in a lesson: for those who grade; at home, of all names.
#[utoipa::path(get, path = "/lessons/{slug}/predictions/counts", operation_id = "count_predictions", tag = "lessons", params(("slug" = String, Path)), responses(
    (status = 200, description = "For each prediction how many chose each option", body = ref(of::<PredictionTable>())),
    (status = 404, description = "No such lesson", body = ref(PROBLEM))))]
async fn counts(
    State(app): State<App>,
    PathParameters(slug): PathParameters<String>,
) -> Result<Answer<PredictionTable>, Problem> {
    let lesson = find(&app, &slug)?;
    let course = if app.access.is_class() { CLASS } else { HOME };
    let people = app.store.people(course).await?;
    let students: BTreeSet<&str> =
        people.iter().filter(|one| one.role == Role::Student).map(|one| one.id.as_str()).collect();
    let mut kept = app.store.predictions(course, None, Some(&lesson.slug)).await?;
    kept.retain(|one| students.contains(one.person.as_str()));
    let count = |asked: PredictionView| {
        let of_it: Vec<&KeptPrediction> = kept.iter().filter(|one| one.prediction == asked.id).collect();
        let chose = |id: Option<&str>| of_it.iter().filter(|one| one.choice.as_deref() == id).count();
        let option = |id: &String| asked.options.iter().find(|option| option.id == *id).cloned();
        let reasons = of_it.iter().filter(|one| !one.why.is_empty()).map(|one| Reason {
            name: one.name.clone(),
            option: one.choice.as_ref().and_then(option),
            why: one.why.clone(),
        });
        PredictionCounts {
            happens: lesson.outcome(&asked.id).map(|outcome| outcome.happens).unwrap_or_default(),
            chosen: asked.options.iter().map(|option| chose(Some(&option.id))).collect(),
            skipped: chose(None),
            missing: students.len().saturating_sub(of_it.len()),
            reasons: reasons.collect(),
            asked,
        }
    };
    Ok(Answer(PredictionTable(lesson.predictions().into_iter().map(count).collect())))
}
