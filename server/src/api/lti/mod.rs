//! What learning platforms and their browsers ask: `/lti/…` for them, `/api/v1/lti` for those who teach.

mod launch;
mod login;
pub(super) mod page;
pub(super) mod state;

use std::time::{Duration, Instant};

use axum::Json;
use axum::Router;
use axum::extract::State;
use axum::routing::{get, post};
use jsonwebtoken::jwk::JwkSet;
use serde_json::Value;

use crate::app::App;
use crate::lti::refusal::Refusal;
use crate::lti::registration::Tool;
use crate::lti::{Lti, keys, scores};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::CLASS;

/// How often it is looked whether there is something to tell a platform, at most.
const OFTEN: Duration = Duration::from_secs(5);
/// How often it is looked although nothing was logged: dates pass, and waits end.
const SELDOM: Duration = Duration::from_mins(1);
/// The share of the time that looking may take: one tenth.
const SHARE: u32 = 10;

/// Pages and keys for platforms: no part of the interface, as 1EdTech describes them.
pub(super) fn pages() -> Router<App> {
    Router::new()
        .route("/lti/login", get(login::by_address).post(login::by_form))
        .route("/lti/launch", post(launch::launch))
        .route("/lti/choice", post(launch::choose))
        .route("/lti/keys", get(published))
        .route("/lti/configuration", get(configuration))
}

/// What platforms reach of this server.
///
/// Errors if they reach nothing.
fn lti(app: &App) -> Result<&Lti, Problem> {
    Ok(app.lti.as_deref().ok_or(Refusal::Off)?)
}

async fn published(State(app): State<App>) -> Result<Json<JwkSet>, Problem> {
    lti(&app)?;
    Ok(Json(keys::published(&app.store).await?))
}

async fn configuration(State(app): State<App>) -> Result<Json<Value>, Problem> {
    let tool = Tool::at(&lti(&app)?.url(""));
    Ok(Json(tool.configuration(&app.store.course(CLASS).await?.title)))
}

/// Tells platforms the scores that they should have, for as long as the server runs.
pub async fn keep_told(app: App) {
    let Some(lti) = app.lti.clone() else { return };
    let mut seen = (0, Instant::now());
    let mut took = Duration::ZERO;
    let mut is_first = true;
    loop {
        tokio::time::sleep(OFTEN.max(took * SHARE)).await;
        let began = Instant::now();
        let round = async {
            let last = app.store.last_event(CLASS).await?;
            if is_first || last != seen.0 || seen.1.elapsed() >= SELDOM {
                scores::plan(&app.store, &app.course, Moment::now()).await?;
                seen = (last, began);
                is_first = false;
            }
            scores::deliver(&lti, &app.store, &app.course, &Moment::now).await
        };
        // Tried again in a moment: what is to be told is in the gradebook.
        if let Err(problem) = round.await {
            // What the platform answered may name people.
            tracing::error!(target: "triad", code = problem.code(), "scores for the learning platform wait");
        }
        took = began.elapsed();
    }
}
