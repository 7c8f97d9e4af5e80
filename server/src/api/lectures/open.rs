//! Opening a lecture, under a new code or under a name of one's own.

use axum::extract::State;
use axum::http::StatusCode;
use axum::response::IntoResponse;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas, of};
use crate::api::extract::Json;
use crate::api::guard::Caller;
use crate::app::App;
use crate::lecture::named;
use crate::problem::Problem;
use crate::store::Taking;
use crate::store::hash::sha256;

pub(super) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.request::<NewLecture>();
    schemas.answer::<OpenedLecture>();
    OpenApiRouter::new().routes(routes!(open))
}

/// The session that a lecture shows.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct NewLecture {
    /// Its id; who knows it may show it.
    session: String,
    /// The room's name, for an address that stays the same: 7 to 40 letters a to z and digits, with single hyphens between. It
    /// belongs to who opens it first; they open it again, and go on with a lecture that is open under it.
    #[serde(default)]
    #[schemars(example = "mbs-2026")]
    name: Option<String>,
    /// At home, where nobody has an account: what shows later that the name is one's own. Long and hard to guess.
    #[serde(default)]
    secret: Option<String>,
}

/// Letters of a secret that shows whose a name is.
const SECRET: std::ops::RangeInclusive<usize> = 16..=200;

/// A room that was opened.
#[derive(Debug, Serialize, JsonSchema)]
struct OpenedLecture {
    /// What followers type to join.
    code: String,
    /// Shows that somebody is the presenter: to be sent as `authorization: Bearer KEY`. It is sent only here.
    key: String,
    /// Where followers go, below the server's address.
    page: String,
}

/// Open a lecture room for a session.
#[utoipa::path(post, path = "/rooms", operation_id = "open_lecture", tag = "rooms", request_body(content = ref(of::<NewLecture>())), responses(
    (status = 201, description = "The room, and the presenter's key", body = ref(of::<OpenedLecture>())),
    (status = 404, description = "No such session", body = ref(PROBLEM)),
    (status = 409, description = "The name is somebody else's", body = ref(PROBLEM)),
    (status = 422, description = "No such name is possible", body = ref(PROBLEM)),
    (status = 503, description = "All rooms are in use", body = ref(PROBLEM))))]
async fn open(
    State(app): State<App>,
    caller: Caller,
    Json(new): Json<NewLecture>,
) -> Result<impl IntoResponse, Problem> {
    let session = app.sessions.get(&new.session)?;
    let name = match &new.name {
        Some(typed) => Some(own_name(&app, caller, typed, new.secret.as_deref()).await?),
        None => None,
    };
    let lecture = app.lectures.open(session, name, &app.limits)?;
    let opened = OpenedLecture {
        code: lecture.code.clone(),
        key: lecture.key().to_owned(),
        page: format!("/room/{}", lecture.code),
    };
    Ok((StatusCode::CREATED, axum::Json(opened)))
}

/// The name of a room that belongs to the caller, from now on or since before.
async fn own_name(app: &App, caller: Caller, typed: &str, secret: Option<&str>) -> Result<String, Problem> {
    let name = named::name(typed)?;
    let owner = match (caller.0, secret) {
        (Some(member), _) => member.id,
        (None, Some(secret)) if SECRET.contains(&secret.len()) => sha256(secret),
        (None, _) => {
            return Err(Problem::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                "missing-room-secret",
                "without accounts a room's name is kept by a secret, and none was sent",
                format!(
                    "send one of {} to {} letters beside the name, and the same again",
                    SECRET.start(),
                    SECRET.end()
                ),
            )
            .at("/secret", "no secret"));
        }
    };
    match app.store.take_room(&name, &owner, app.node.name()).await? {
        Taking::Own => Ok(name),
        Taking::Taken => Err(Problem::new(
            StatusCode::CONFLICT,
            "room-name-taken",
            format!("the room {name} belongs to somebody else"),
            "choose another name, such as one with your own or with the term; a name is opened again only by who opened it first",
        )
        .at("/name", "somebody else's")),
        Taking::TooMany => Err(Problem::new(
            StatusCode::CONFLICT,
            "too-many-room-names",
            "no more names of rooms can be taken",
            "open one of those that you have; one that is not used for a year and a quarter is free again",
        )),
    }
}
