//! What a lecture tells its followers and its presenter.

use axum::extract::ws::Utf8Bytes;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use triad_session::{Links, SceneSource, SessionState};

use super::audience::Remark;
use super::question::{LectureQuestion, Tally};

/// What followers see beside the run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[schemars(rename = "LectureState")]
pub struct PublicState {
    /// What followers type to join.
    pub code: String,
    /// Title of the scene; nothing while no session is shown.
    pub title: Option<String>,
    /// Where the scene came from.
    pub source: Option<SceneSource>,
    /// What the presenter looks at, in the page's own words.
    pub view: Value,
    /// The question that is asked.
    pub question: Option<LectureQuestion>,
    /// A follower's question that the presenter shows to everybody.
    pub remark: Option<Remark>,
    /// How often the presenter has put down all hands: who raised one before puts it down when this grows.
    pub lowered: u64,
}

/// What only the presenter sees.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PresenterState {
    /// How many follow now.
    pub followers: usize,
    /// How many windows show the lecture to the hall: the presenter's own page is then seen by the presenter alone.
    pub screens: usize,
    /// How many followers look around on their own.
    pub roaming: usize,
    /// How many raise a hand.
    pub hands: usize,
    /// Questions of followers that wait, the oldest first; nobody is told by whom.
    pub remarks: Vec<Remark>,
    /// The question that is asked, as followers see it.
    pub question: Option<LectureQuestion>,
    /// How the answers stand.
    pub tally: Option<Tally>,
}

/// What followers are sent in text.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case")]
pub enum LectureMessage<'a> {
    /// What is shown and asked beside the run.
    Room(&'a PublicState),
    /// The state of the session that is shown.
    State(&'a SessionState),
    /// A recording begins: the viewer must forget the one before.
    Reset,
    /// The lecture is over.
    Closed,
}

impl LectureMessage<'_> {
    /// The message as it is sent, written once for all followers.
    pub(super) fn text(&self) -> Utf8Bytes {
        serde_json::to_string(self).unwrap_or_default().into()
    }
}

/// The state without the name by which the session could be steered.
pub(super) fn anonymous(state: &SessionState, code: &str) -> SessionState {
    let links = Links::below(format!("/api/v1/rooms/{code}"));
    SessionState { id: format!("room-{code}"), links, ..state.clone() }
}
