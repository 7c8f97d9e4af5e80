//! The class at a glance, for those who grade.

// The documentation macro writes out paths of its own.
#![allow(unused_qualifications)]

use axum::Json as Answer;
use axum::extract::State;
use triad_lessons::Verdict;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{Schemas, of};
use crate::app::App;
use crate::blocking;
use crate::glance::{Glance, HERE, OF_LATE, glance};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::CLASS;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<Glance>();
    OpenApiRouter::new().routes(routes!(show))
}

/// The class at this moment: who is in which lesson, who has tried a question several times of late and not got it, and what
/// was handed in within the last minutes. Where somebody is, is known to the process that they use, and kept nowhere.
#[utoipa::path(get, path = "/glance", operation_id = "get_glance", tag = "class", responses(
    (status = 200, description = "Who is where, who is stuck, what was handed in", body = ref(of::<Glance>()))))]
async fn show(State(app): State<App>) -> Result<Answer<Glance>, Problem> {
    let now = Moment::now();
    let people = app.store.people(CLASS).await?;
    let recent = app.store.recent(CLASS, now.after(-OF_LATE)).await?;
    let seen = app.presence.since(now.after(-HERE));
    blocking(move || {
        let read = |one| -> Result<_, Problem> {
            let one: crate::store::Recorded = one;
            let verdict: Verdict = serde_json::from_str(&one.body).map_err(Problem::internal)?;
            Ok((one, verdict))
        };
        let recent = recent.into_iter().map(read).collect::<Result<Vec<_>, _>>()?;
        Ok(Answer(glance(&people, &seen, &recent, &app.course, now)))
    })
    .await
}
